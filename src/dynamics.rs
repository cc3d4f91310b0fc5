//! From the command to the actuators, the last stage before sending: the commanded acceleration and the ego's state enter, the net
//! engine force or the brake torque that brings it about leaves. Eqs 1 to 3 are [`Body`]'s; what they do not know of is measured
//! and made up for by [`Correction`].
//!
//! *Deadband:* a demand near coasting, moved by a few mm/s² at every message, would go back and forth between engine and
//! brake. So the one that acts gives way to the other only when that one is wanted for more than [`DEADBAND`]; until then
//! it does nothing, and the acceleration is off by at most that.

mod correction;

pub use correction::Correction;

use crate::config::Config;
use crate::model::{Body, State};
use crate::units::{Acceleration, Speed};
use crate::wire::command::Effort;

/// Half the width of the deadband between engine and brakes: three times what a tick's rounding and a message's news move
/// the demand by, and below what anyone feels.
pub const DEADBAND: Acceleration = Acceleration::from_mm_per_s2(15);

/// From the demand to the actuators: what eq. 1 does not know of is made up for, and which of the two acts is remembered.
#[derive(Clone, Debug, Default)]
pub struct Inversion {
    correction: Correction,
    braking: bool,
}

impl Inversion {
    /// The engine acts, and nothing is known that eq. 1 does not know.
    #[must_use]
    pub const fn new() -> Self {
        Self { correction: Correction::new(), braking: false }
    }

    /// What brings the demand about from the ego's state on. `is_driving`: it is this unit that drives.
    #[must_use]
    pub fn effort(&mut self, config: &Config, ego: Option<&State>, is_driving: bool, demand: Acceleration) -> Effort {
        let asked = self.correction.apply(config, ego.filter(|_| is_driving), demand);
        self.choose(&config.body, asked, ego.map_or(Speed::ZERO, |ego| ego.speed))
    }

    /// Eqs 2 and 3 with the deadband; as [`Body::effort`] outside it.
    fn choose(&mut self, body: &Body, acceleration: Acceleration, speed: Speed) -> Effort {
        let force = body.net_force(acceleration, speed);
        let band = body.inertia(DEADBAND);
        self.braking = if self.braking { force <= band } else { force < band.saturating_neg() };
        if self.braking { body.brake(force.min(0)) } else { body.drive(force.max(0)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eq. 1 in float64.
    fn acceleration(body: &Body, effort: Effort, v: f64) -> f64 {
        let (force, torque) = match effort {
            Effort::Force(newtons) => (f64::from(newtons), 0.0),
            Effort::BrakeTorque(newton_metres) => (0.0, f64::from(newton_metres)),
        };
        let resistance = f64::from(body.drag_milli) / 1000.0 * v * v
            + f64::from(body.friction_milli) / 1000.0 * v
            + f64::from(body.mechanical_n);
        (force - f64::from(body.ratio_milli) / 1000.0 * torque - resistance) / f64::from(body.mass_kg)
    }

    #[test]
    fn inverting_and_then_eq_1_returns_the_acceleration() {
        let body = Body::CAR;
        for demand in (-8000..=4000).step_by(37) {
            for speed in (0..=60_000).step_by(1711) {
                let effort = body.effort(Acceleration::from_mm_per_s2(demand), Speed::from_mm_per_s(speed));
                let back = acceleration(&body, effort, f64::from(speed) / 1000.0);
                // Half a newton, half a newton metre times R, over the mass.
                let tolerance = 0.5 * f64::from(body.ratio_milli) / 1000.0 / 1500.0 + 1e-9;
                assert!((back - f64::from(demand) / 1000.0).abs() <= tolerance, "{demand} {speed} {effort:?} {back}");
            }
        }
    }

    #[test]
    fn the_other_actuator_acts_only_beyond_the_deadband_and_the_error_stays_within_it() {
        let (body, speed) = (Body::CAR, Speed::from_mm_per_s(10_000));
        // Where coasting is: -(0.4 · 10² + 2 · 10 + 150)/1500 m/s².
        let coasting = -140;
        let mut inversion = Inversion::new();
        let mut changes = 0;
        let mut was_braking = false;
        // Up and down around coasting, first within the band and then beyond it.
        for amplitude in [14, 40] {
            for step in 0..40 {
                let demand = coasting + if step % 2 == 0 { amplitude } else { -amplitude };
                let effort = inversion.choose(&body, Acceleration::from_mm_per_s2(demand), speed);
                let back = acceleration(&body, effort, 10.0) * 1e3;
                let tolerance = if amplitude > 15 { 2.0 } else { 15.0 };
                assert!((back - f64::from(demand)).abs() <= tolerance, "{demand} {effort:?} {back}");
                let is_braking = matches!(effort, Effort::BrakeTorque(_));
                changes += usize::from(is_braking != was_braking);
                was_braking = is_braking;
            }
            assert_eq!(changes, if amplitude > 15 { 39 } else { 0 });
        }
    }

    #[test]
    fn beyond_the_deadband_the_inversion_is_eqs_2_and_3() {
        let mut inversion = Inversion::new();
        for demand in (-8000..=4000).step_by(37) {
            for speed in (0..=60_000).step_by(1711) {
                let (demand, speed) = (Acceleration::from_mm_per_s2(demand), Speed::from_mm_per_s(speed));
                let coasting = Body::CAR.net_force(demand, speed);
                if coasting.abs() > Body::CAR.inertia(DEADBAND) {
                    assert_eq!(inversion.choose(&Body::CAR, demand, speed), Body::CAR.effort(demand, speed));
                }
            }
        }
    }

    #[test]
    fn coasting_down_needs_neither_force_nor_brake() {
        let effort = Body::CAR.effort(Acceleration::from_mm_per_s2(-100), Speed::ZERO);
        assert_eq!(effort, Effort::Force(0));
    }

    #[test]
    fn the_effort_saturates_at_the_ends_of_the_wire() {
        let truck = Body { mass_kg: 40_000, ratio_milli: 1, ..Body::CAR };
        assert_eq!(truck.effort(Acceleration::MAX, Speed::MAX), Effort::Force(65_534));
        assert_eq!(truck.effort(Acceleration::MIN, Speed::ZERO), Effort::BrakeTorque(65_534));
    }
}
