//! The vehicle model of eq. 1: the kind of vehicle, and how the real vehicle differs from it, enter; the parameters in
//! SI units, and the forces that follow from them, leave.

use holdover::model::Body;

use crate::input::kind::{Difference, Kind};

/// Standard gravity.
const GRAVITY_MPS2: f64 = 9.806_65;

/// The parameters of eq. 1 and the actuators' limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Machine {
    /// `m`.
    pub mass_kg: f64,
    /// `R`, brake force per brake torque.
    pub ratio_per_m: f64,
    /// `c_v`, in N/(m/s)².
    pub drag: f64,
    /// `c_f`, in N/(m/s).
    pub friction: f64,
    /// `d_m`.
    pub mechanical_n: f64,
    /// Largest force of the engine, from standstill on.
    pub engine_force_n: f64,
    /// Largest power of the engine, which limits the force at speed.
    pub engine_power_w: f64,
    /// Fraction of engine force and power that is available.
    pub throttle: f64,
    /// Largest brake torque.
    pub brake_limit_nm: f64,
    /// Time constant of engine and brakes; 0 for no lag.
    pub lag_s: f64,
    /// Sine of the road's angle.
    pub slope: f64,
    /// Head wind.
    pub headwind_mps: f64,
}

impl Machine {
    /// A vehicle of a kind, with these differences, and actuators with this time constant.
    #[must_use]
    pub fn new(kind: Kind, lag_s: f64, difference: &Difference) -> Self {
        let Body { mass_kg, ratio_milli, drag_milli, friction_milli, mechanical_n } = kind.body();
        Self {
            mass_kg: f64::from(mass_kg) * difference.mass_scale,
            ratio_per_m: f64::from(ratio_milli) / 1e3,
            drag: f64::from(drag_milli) / 1e3,
            friction: f64::from(friction_milli) / 1e3,
            mechanical_n: f64::from(mechanical_n),
            engine_force_n: kind.engine_force_n(),
            engine_power_w: kind.engine_power_w(),
            throttle: difference.throttle,
            brake_limit_nm: kind.brake_limit_nm(),
            lag_s,
            slope: difference.grade.atan().sin(),
            headwind_mps: difference.headwind_mps,
        }
    }

    /// The largest force of the engine at a speed.
    #[must_use]
    pub fn engine_limit_n(&self, speed_mps: f64) -> f64 {
        self.throttle * (self.engine_power_w / speed_mps.max(0.0)).min(self.engine_force_n)
    }

    /// The resistance to a motion at this speed, or to one that is about to begin.
    #[must_use]
    pub fn resistance_n(&self, speed_mps: f64) -> f64 {
        let through_air = speed_mps + self.headwind_mps;
        self.drag * through_air * through_air.abs()
            + self.friction * speed_mps
            + self.mechanical_n
            + self.mass_kg * GRAVITY_MPS2 * self.slope
    }
}
