//! The configuration as a plain C struct: what an integrator fills in. All numbers are magnitudes, so all are unsigned.

mod identifiers;
mod typed;

pub use identifiers::{HOLDOVER_EXTENDED, HOLDOVER_STANDARD, Identifiers, PeerIdentifiers};

/// Everything that the unit has to be told. Times that are compared with the clock are in us, as the clock is; all else is
/// in thousandths of its unit. `docs/INTEGRATION.md` has ranges and defaults.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// The own station's 8-bit hash.
    pub station: u8,
    /// Whether a range sensor is fitted: 0 or 1. With one, the gate trusts other vehicles' passes.
    pub range_sensor: u8,
    /// First CAN identifier of the block in which all messages lie.
    pub base_id: u16,
    /// The whole identity of the own station, of which `station` is the low 8 bits. At intersections no two vehicles have the same.
    pub station_id: u32,
    /// Messages that lie elsewhere.
    pub identifiers: Identifiers,
    /// Period of the task that calls `holdover_tick`, in us.
    pub period_us: u32,
    /// Bumper to bumper, in mm.
    pub length_mm: u32,
    /// Time constant of the actuators, in ms.
    pub lag_ms: u32,
    /// Limits of the controller, and of the vehicle.
    pub limits: Limits,
    /// The vehicle of eqs 1 to 3.
    pub body: Body,
    /// 1: what the body does not say, such as a grade, is measured and made up for; 0: it is not.
    pub correction: u8,
    /// 1: passes are kept at intersections while the envelope is engaged; 0: they are not, for studies and where the modem does not relay
    /// them.
    pub passes: u8,
    /// The law.
    pub law: Law,
    /// The prediction.
    pub prediction: Prediction,
    /// The link.
    pub link: Link,
    /// The last gate.
    pub envelope: Envelope,
}

/// Limits of the controller, and of the vehicle.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Largest acceleration in mm/s2.
    pub acceleration_mm_s2: u32,
    /// Hardest braking in normal driving in mm/s2.
    pub braking_mm_s2: u32,
    /// Fastest change of acceleration in mm/s3.
    pub jerk_mm_s3: u32,
    /// Hardest braking in an emergency in mm/s2.
    pub emergency_braking_mm_s2: u32,
}

/// The vehicle of eqs 1 to 3.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Body {
    /// Mass in kg.
    pub mass_kg: u32,
    /// Brake force per brake torque in 1/(1000 m).
    pub ratio_milli: u32,
    /// Aerodynamic drag in mN/(m/s)^2.
    pub drag_milli: u32,
    /// Friction in mN/(m/s).
    pub friction_milli: u32,
    /// Mechanical drag in N.
    pub mechanical_n: u32,
}

/// The law of eqs 5 and 7.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Law {
    /// Desired time gap in ms; 1600 by default. With a range sensor 800 will do in a car (`range_sensor`, and
    /// `feed_forward_milli` of 500), 1000 in a van, and 1400 in a bus, with a `feed_forward_milli` of 0.
    pub time_gap_ms: u32,
    /// Time gap in ms to which that opens, by 100 ms a second, while the vehicle ahead is neither heard nor seen; 1800 by default. If it
    /// is no larger than the gap in force, the gap does not open.
    pub silent_time_gap_ms: u32,
    /// Distance kept at standstill in mm.
    pub standstill_mm: u32,
    /// 1: the gains come from the tables of eq. 6; 0: they are the following two.
    pub gain_table: u8,
    /// Gain in 1/(1000 s^2).
    pub gain_milli: u32,
    /// Damping in ms.
    pub damping_ms: u32,
    /// Share of the predecessor's acceleration that is passed on, in thousandths: 0 or 500. The latter needs a step and a period of at
    /// least 7.813 ms.
    pub feed_forward_milli: u32,
    /// Largest acceleration on a free road in mm/s2.
    pub free_road_acceleration_mm_s2: u32,
    /// Speed wanted on a free road until `DriverRequest` says otherwise, in mm/s.
    pub target_speed_mm_s: u32,
    /// Share by which the ego may exceed that speed to catch up with the vehicle that it follows, in thousandths: 0 (the speed is
    /// a cap) to 750 by 50.
    pub catch_up_milli: u32,
    /// Speed never demanded beyond, in mm/s.
    pub max_speed_mm_s: u32,
}

/// The prediction.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Prediction {
    /// Prediction step in us.
    pub step_us: u32,
    /// How far ahead, in us.
    pub horizon_us: u32,
    /// What is in the model.
    pub model: Model,
}

/// What is in the prediction model; each is 1 (as it should be) or 0 (as in the paper).
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Model {
    /// The actuators' lag.
    pub lag: u8,
    /// The controller's limits on acceleration and jerk.
    pub limits: u8,
    /// The sender's last demand as the start of the jerk limit.
    pub last_demand: u8,
    /// The standstill distance.
    pub standstill: u8,
    /// Trapezoidal positions; otherwise forward Euler.
    pub trapezoid: u8,
    /// Read-out between steps; otherwise the nearest step.
    pub interpolate: u8,
    /// Samples are brought from their stamp to now by the model; otherwise by eqs 10 to 12.
    pub stamped: u8,
    /// A horizon never runs out; otherwise its last value is held.
    pub endless: u8,
    /// A horizon that the peer computed itself is used in preference.
    pub received: u8,
    /// After a silence the controller is led from the old estimate to the new one.
    pub smooth: u8,
}

/// What counts as a link.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// Period with which the own messages are sent, and a peer's until its own is measured; in us.
    pub period_us: u32,
    /// The link is off when no valid message came for a period and this; in us.
    pub tolerance_us: u32,
    /// Older stamps are refused; in us.
    pub stale_us: u32,
    /// Stamps further in the future are refused; in us.
    pub future_us: u32,
    /// Largest error between a sender's stamp and the own clock while synchronised; in us.
    pub clock_error_us: u32,
    /// A slot may be taken over by another station after this much silence; in us.
    pub slot_reuse_us: u32,
    /// Silence up to which a target's estimate is driven by; in us.
    pub holdover_us: u32,
    /// Age up to which the own motion is usable; in us.
    pub ego_timeout_us: u32,
    /// Age up to which the request of the driver holds, in us.
    pub request_timeout_us: u32,
    /// Age up to which a time synchronisation holds; in us.
    pub sync_timeout_us: u32,
    /// Delay assumed while there is no synchronisation; in us.
    pub assumed_delay_us: u32,
}

/// The limits of the last gate.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Envelope {
    /// 1: the gate is there; 0: it is not, and the rest is ignored.
    pub engaged: u8,
    /// Largest acceleration ever commanded in mm/s2.
    pub acceleration_mm_s2: u32,
    /// Hardest braking ever commanded in mm/s2.
    pub braking_mm_s2: u32,
    /// Fastest change ever commanded in mm/s3, that of emergency braking.
    pub jerk_mm_s3: u32,
    /// No acceleration at or beyond this speed in mm/s.
    pub speed_mm_s: u32,
    /// What is left between the bumpers when both have come to rest, in mm.
    pub margin_mm: u32,
    /// How long a command may stay in force beyond its period: the next one's way to the actuators, and ticks missed in a row; in us.
    pub delay_us: u32,
    /// Share of the lag by which the real one may be longer or shorter, in thousandths.
    pub lag_tolerance_milli: u32,
}
