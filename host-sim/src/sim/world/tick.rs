//! One tick of one vehicle, for the trace: the vehicle enters; its true motion, its command and its unit's estimate of
//! the target leave. The estimate is the one on the bus.

use holdover::units::Speed;
use holdover::wire::command::ModeCode;
use holdover::wire::estimate::TargetEstimate;

use crate::sim::quantities::metres;
use crate::sim::vehicle::Vehicle;

/// One tick of one vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// True position of the front bumper.
    pub position_m: f64,
    /// True speed.
    pub speed_mps: f64,
    /// True acceleration.
    pub acceleration_mps2: f64,
    /// Acceleration that its unit commanded.
    pub command_mps2: f64,
    /// Whether the envelope changed that command.
    pub limited: bool,
    /// Its unit's mode.
    pub mode: ModeCode,
    /// Its unit's estimate of the target.
    pub target: Option<TargetBelief>,
}

/// A unit's estimate of its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetBelief {
    /// Front bumper.
    pub position_m: f64,
    /// Speed.
    pub speed_mps: f64,
    /// Age of the newest sample that it is based on.
    pub age_s: f64,
    /// The bound; `None`: there is none, or it exceeds the range of the message.
    pub bound: Option<Bounds>,
}

/// Both ends of the bound of a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest possible position.
    pub lowest_position_m: f64,
    /// Highest possible position.
    pub highest_position_m: f64,
    /// Lowest possible speed.
    pub lowest_speed_mps: f64,
    /// Highest possible speed.
    pub highest_speed_mps: f64,
}

impl TargetBelief {
    /// The same on an axis that begins so far ahead.
    #[must_use]
    pub fn behind(self, way_m: f64) -> Self {
        let bound = self.bound.map(|bound| Bounds {
            lowest_position_m: bound.lowest_position_m - way_m,
            highest_position_m: bound.highest_position_m - way_m,
            ..bound
        });
        Self { position_m: self.position_m - way_m, bound, ..self }
    }
}

impl Bounds {
    /// Whether a vehicle with this motion is inside the bound.
    #[must_use]
    pub fn hold(&self, position_m: f64, speed_mps: f64) -> bool {
        (self.lowest_position_m..=self.highest_position_m).contains(&position_m)
            && (self.lowest_speed_mps..=self.highest_speed_mps).contains(&speed_mps)
    }

    /// Width of the range of positions.
    #[must_use]
    pub fn width_m(&self) -> f64 {
        self.highest_position_m - self.lowest_position_m
    }
}

/// Hardest braking and acceleration of any road vehicle, in m/s².
const WORST_MPS2: (f64, f64) = (12.0, 8.0);

impl Tick {
    /// The tick of a vehicle, after its unit's tick.
    pub(super) fn of(vehicle: &Vehicle, at_s: f64, period_s: f64) -> Self {
        // A unit outside ticks by its own clock. Its last estimate is of an instant between its message before that and
        // that message.
        let since_s = at_s - vehicle.estimate_s();
        let apart_s = if since_s < 1e-6 { (0.0, 0.0) } else { (since_s, since_s + period_s) };
        let belief = |estimate| TargetBelief::of(estimate, vehicle.plant.position_m).carried(apart_s);
        Self {
            position_m: vehicle.plant.position_m,
            speed_mps: vehicle.plant.speed_mps,
            acceleration_mps2: vehicle.plant.acceleration_mps2,
            command_mps2: vehicle.command_mps2,
            limited: vehicle.limited,
            mode: vehicle.mode,
            target: vehicle.estimate.as_ref().map(belief),
        }
    }
}

impl TargetBelief {
    /// The estimate on the bus of a vehicle that is near `near_m`.
    #[must_use]
    pub fn of(estimate: &TargetEstimate, near_m: f64) -> Self {
        let mps = |speed: Speed| speed.get().to_num::<f64>();
        let position_m: f64 = estimate.position.nearest_to(metres(near_m)).get().to_num();
        let speed_mps = mps(estimate.speed);
        let bound = estimate.ends.map(|ends| Bounds {
            lowest_position_m: position_m - ends.behind.get().to_num::<f64>(),
            highest_position_m: position_m + ends.ahead.get().to_num::<f64>(),
            lowest_speed_mps: (speed_mps - mps(ends.slower)).max(0.0),
            highest_speed_mps: speed_mps + mps(ends.faster),
        });
        let age_s = estimate.age.as_micros() as f64 * 1e-6;
        Self { position_m, speed_mps, age_s, bound }
    }

    /// The same estimate later, by a time that is known to lie between these two.
    fn carried(self, (least_s, most_s): (f64, f64)) -> Self {
        let (braking, accelerating) = WORST_MPS2;
        let carried = |bound: Bounds| Bounds {
            lowest_position_m: bound.lowest_position_m + bound.lowest_speed_mps * least_s
                - 0.5 * braking * most_s.powi(2),
            highest_position_m: bound.highest_position_m
                + bound.highest_speed_mps * most_s
                + 0.5 * accelerating * most_s.powi(2),
            lowest_speed_mps: (bound.lowest_speed_mps - braking * most_s).max(0.0),
            highest_speed_mps: bound.highest_speed_mps + accelerating * most_s,
        };
        Self {
            position_m: self.position_m + self.speed_mps * least_s,
            bound: self.bound.map(carried),
            age_s: self.age_s + least_s,
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_belief_of_a_known_instant_stays_what_it_is_and_one_of_a_span_widens() {
        let bound =
            Bounds { lowest_position_m: 9.9, highest_position_m: 10.1, lowest_speed_mps: 9.0, highest_speed_mps: 11.0 };
        let belief = TargetBelief { position_m: 10.0, speed_mps: 10.0, age_s: 0.1, bound: Some(bound) };
        assert_eq!(belief.carried((0.0, 0.0)), belief);
        let later = belief.carried((0.01, 0.02));
        assert!((later.position_m - 10.1).abs() < 1e-9);
        let bound = later.bound.unwrap();
        // The places of a vehicle that drove at 9 to 11 m/s and braked or accelerated at its hardest for 10 to 20 ms.
        assert!(bound.lowest_position_m < 9.9 + 0.09 && bound.highest_position_m > 10.1 + 0.22);
        assert!(bound.width_m() < 0.4);
    }
}
