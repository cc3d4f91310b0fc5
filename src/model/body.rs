//! The body of a vehicle, eqs 1-3. An acceleration and a speed enter; the net engine force or the brake torque for them leaves.
//!
//! Eq. 1: `a = (F_net - R·T_br - c_v v² - c_f v - d_m)/m`. Driving (eq. 2): `F_net = m a + c_v v² + c_f v + d_m`. Braking: eq. 3 is read
//! as `T_br = -(m a + c_v v² + c_f v + d_m)/R >= 0`. As printed it has the speed in the place of the acceleration, two names for the
//! friction coefficient, and the sign of a brake that accelerates.

use crate::units::{Acceleration, Speed};
use crate::wire::command::Effort;

/// The vehicle of eq. 1, in integers that a calibration tool can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Body {
    /// Mass `m` in kg; 300 to 40,000.
    pub mass_kg: u32,
    /// Brake force per brake torque, `R` in 1/m, in thousandths; 1 to 100,000.
    pub ratio_milli: u32,
    /// Aerodynamic drag `c_v` in N/(m/s)², in thousandths; up to 20,000.
    pub drag_milli: u32,
    /// Friction `c_f` in N/(m/s), in thousandths; up to 1,000,000.
    pub friction_milli: u32,
    /// Mechanical drag `d_m` in N; up to 10,000.
    pub mechanical_n: u32,
}

impl Body {
    /// A car: 1,500 kg, wheels of 0.31 m radius, 0.4 N/(m/s)² of drag, 150 N of rolling resistance.
    pub const CAR: Self =
        Self { mass_kg: 1500, ratio_milli: 3226, drag_milli: 400, friction_milli: 2000, mechanical_n: 150 };
    /// A high van: 2,800 kg, wheels of 0.345 m radius, 0.96 N/(m/s)² of drag, 300 N of rolling resistance.
    pub const VAN: Self =
        Self { mass_kg: 2800, ratio_milli: 2899, drag_milli: 960, friction_milli: 4000, mechanical_n: 300 };
    /// A city bus, half full: 12,500 kg, wheels of 0.47 m radius, 3.06 N/(m/s)² of drag, 980 N of rolling resistance.
    pub const BUS: Self =
        Self { mass_kg: 12_500, ratio_milli: 2128, drag_milli: 3060, friction_milli: 10_000, mechanical_n: 980 };

    /// Whether every number is in its range.
    #[must_use]
    pub fn is_sane(&self) -> bool {
        (300..=40_000).contains(&self.mass_kg)
            && (1..=100_000).contains(&self.ratio_milli)
            && self.drag_milli <= 20_000
            && self.friction_milli <= 1_000_000
            && self.mechanical_n <= 10_000
    }

    /// Eqs 2 and 3, rounded to nearest N or N·m, saturating at the wire's 65,534. Bodies outside their ranges saturate too.
    #[must_use]
    pub fn effort(&self, acceleration: Acceleration, speed: Speed) -> Effort {
        let force = self.net_force(acceleration, speed);
        if force >= 0 { self.drive(force) } else { self.brake(force) }
    }

    /// The force for the acceleration: engine if positive, brakes if negative. It is in nano-newtons, so that every term is an integer:
    /// kg·mm/s² is 1e6 nN, and mN/(m/s)² by (mm/s)² is 1e3·1e-6·1e9.
    pub(crate) fn net_force(&self, acceleration: Acceleration, speed: Speed) -> i64 {
        let v = speed.to_mm_per_s().max(0) as i64;
        let scaled = |x: u32| x as i64;
        let drag = scaled(self.drag_milli).saturating_mul(v).saturating_mul(v);
        let friction = scaled(self.friction_milli).saturating_mul(v).saturating_mul(1000);
        let mechanical = scaled(self.mechanical_n).saturating_mul(1_000_000_000);
        self.inertia(acceleration).saturating_add(drag).saturating_add(friction).saturating_add(mechanical)
    }

    /// `m a` in nano-newtons.
    pub(crate) fn inertia(&self, acceleration: Acceleration) -> i64 {
        i64::from(self.mass_kg).saturating_mul(i64::from(acceleration.to_mm_per_s2())).saturating_mul(1_000_000)
    }

    pub(crate) fn drive(&self, force: i64) -> Effort {
        Effort::Force(rounded(force, 1_000_000_000))
    }

    pub(crate) fn brake(&self, force: i64) -> Effort {
        Effort::BrakeTorque(rounded(
            force.saturating_neg(),
            i64::from(self.ratio_milli.max(1)).saturating_mul(1_000_000),
        ))
    }
}

/// `dividend / divisor` to nearest, at most 65,534 (65,535 stands for "not available" on the wire).
#[allow(clippy::arithmetic_side_effects, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
// the divisor is positive by construction, and the quotient is clamped
fn rounded(dividend: i64, divisor: i64) -> u16 {
    crate::fixed::quotient(dividend.saturating_add(divisor / 2), divisor).clamp(0, 65_534) as u16
}
