//! `PeerDrivingParameters`, `OwnDrivingParameters`: the parameters of the law that a vehicle drives by, in three multiplexed frames.

use super::Predecessor;
use super::bits::Payload;
use super::field::{Field, TAG};
use super::meaning::meaning;
use super::motion::speed;
use super::predecessor;
use crate::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};

/// What a vehicle can and will do to its acceleration; all magnitudes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits {
    #[doc = meaning!(acceleration_limit)]
    ///
    /// 0.1 to 20.46 m/s² by 0.02 m/s², rounded up.
    pub acceleration: Acceleration,
    #[doc = meaning!(braking_limit)]
    ///
    /// 0.02 m/s².
    pub braking: Acceleration,
    #[doc = meaning!(jerk_limit)]
    ///
    /// 0.05 to 51.15 m/s³ by 0.05 m/s³.
    pub jerk: Jerk,
    #[doc = meaning!(emergency_braking)]
    ///
    /// 0.1 to 20.46 m/s² by 0.02 m/s², rounded up.
    pub emergency_braking: Acceleration,
}

/// How a vehicle will drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DrivingParameters {
    #[doc = meaning!(length)]
    ///
    /// 0.5 to 40.95 m by 1 cm.
    pub length: Distance,
    #[doc = meaning!(standstill)]
    ///
    /// `s_0`; 0 to 10.23 m by 1 cm.
    pub standstill: Distance,
    #[doc = meaning!(predecessor_kind)]
    pub predecessor: Predecessor,
    #[doc = meaning!(target_speed)]
    ///
    /// `v_∞`; 0 to 65.534 m/s by 2 mm/s.
    pub target_speed: Speed,
    #[doc = meaning!(catch_up)]
    ///
    /// 0 to 0.75 by 0.05.
    pub catch_up: Fraction,
    #[doc = meaning!(time_gap)]
    ///
    /// `t_g`; 0.1 to 3.995 s by 5 ms.
    pub time_gap: Seconds,
    #[doc = meaning!(gain)]
    ///
    /// `k`, with the adjacency `α` = 1; 0 to 3.999 /s² by 0.001.
    pub gain: Gain,
    #[doc = meaning!(damping)]
    ///
    /// `γ`; 0 to 3.999 s by 0.001 s.
    pub damping: Seconds,
    #[doc = meaning!(feed_forward)]
    ///
    /// `φ`; 0 or 0.5.
    pub feed_forward: Fraction,
    #[doc = meaning!(lag)]
    ///
    /// `T`; 0 to 1.998 s by 2 ms.
    pub lag: FineSeconds,
    /// Its limits.
    pub limits: Limits,
    #[doc = meaning!(horizon_length)]
    ///
    /// 0 to 25.5 s by 0.1 s, in tenths of a second.
    pub horizon_tenths: u8,
}

const PART: Field = Field::selector("Part", 14, 2, 3);
const LENGTH: Field = Field::unsigned("Length", 16, 12).limits(50, 4095).initially_largest().steps(100, "m").part(0);
const STANDSTILL: Field = Field::unsigned("Standstill", 28, 10).steps(100, "m").part(0);
const PREDECESSOR: predecessor::Fields = predecessor::fields(38).part(0);
const TARGET_SPEED: Field = speed("TargetSpeed", 48).part(0);
const FEED_FORWARD: Field = Field::unsigned("FeedForward", 63, 1).steps(2, "").part(0);
const TIME_GAP: Field = time_gap(16).part(1);
const GAIN: Field = Field::unsigned("Gain", 26, 12).limits(0, 3999).steps(1000, "1/s2").part(1);
const DAMPING: Field = Field::unsigned("Damping", 38, 12).limits(0, 3999).steps(1000, "s").part(1);
const LAG: Field = Field::unsigned("Lag", 50, 10).limits(0, 999).steps(500, "s").part(1);
const CATCH_UP: Field = Field::unsigned("CatchUp", 60, 4).steps(20, "").part(1);
const ACCELERATION: Field = certain("AccelerationLimit", 16);
const BRAKING: Field = Field::unsigned("BrakingLimit", 26, 10).steps(50, "m/s2").part(2);
const JERK: Field = Field::unsigned("JerkLimit", 36, 10).limits(1, 1023).steps(20, "m/s3").part(2);
const EMERGENCY: Field = certain("EmergencyBraking", 46);
const HORIZON: Field = Field::unsigned("HorizonLength", 56, 8).steps(10, "s").part(2);

/// A limit from which receivers conclude where the vehicle is for certain; below 0.1 m/s² is reserved, and with it the 0 of a stack that
/// was not set up.
const fn certain(name: &'static str, start: u32) -> Field {
    Field::unsigned(name, start, 10).limits(5, 1023).initially_largest().steps(50, "m/s2").part(2)
}

/// Desired time gap, shared with `DriverRequest`; below 0.1 s, and 800 and above, are reserved.
pub(super) const fn time_gap(start: u32) -> Field {
    Field::unsigned("TimeGap", start, 10).limits(20, 799).steps(200, "s")
}

/// The three parts.
pub const FIELDS: &[Field] = &[
    TAG,
    PART,
    LENGTH,
    STANDSTILL,
    PREDECESSOR.kind(),
    PREDECESSOR.station(),
    TARGET_SPEED,
    FEED_FORWARD,
    TIME_GAP,
    GAIN,
    DAMPING,
    LAG,
    CATCH_UP,
    ACCELERATION,
    BRAKING,
    JERK,
    EMERGENCY,
    HORIZON,
];

impl DrivingParameters {
    /// The three parts' payloads under this tag (modulo 4); what does not fit is limited to its field's range.
    #[must_use]
    pub fn encode(&self, tag: u8) -> [Payload; 3] {
        let begin = |part| PART.with_raw(TAG.with_raw(Payload::EMPTY, i64::from(tag & 3)), part);
        let a = LENGTH.with(begin(0), self.length);
        let a = STANDSTILL.with(a, self.standstill);
        let a = PREDECESSOR.with(a, self.predecessor);
        let a = TARGET_SPEED.with(a, self.target_speed);
        let a = FEED_FORWARD.with(a, self.feed_forward);
        let b = TIME_GAP.with(begin(1), self.time_gap);
        let b = GAIN.with(b, self.gain);
        let b = DAMPING.with(b, self.damping);
        let b = LAG.with(b, self.lag);
        let b = CATCH_UP.with(b, self.catch_up);
        let c = ACCELERATION.with_up(begin(2), self.limits.acceleration);
        let c = BRAKING.with(c, self.limits.braking);
        let c = JERK.with(c, self.limits.jerk);
        let c = EMERGENCY.with_up(c, self.limits.emergency_braking);
        let c = HORIZON.with_raw(c, i64::from(self.horizon_tenths));
        [a, b, c]
    }

    /// From the three parts' payloads; every payload within the fields' limits is driving parameters.
    #[must_use]
    pub fn decode([a, b, c]: &[Payload; 3]) -> Self {
        Self {
            length: LENGTH.get(*a),
            standstill: STANDSTILL.get(*a),
            predecessor: PREDECESSOR.get(*a),
            target_speed: TARGET_SPEED.get(*a),
            feed_forward: FEED_FORWARD.get(*a),
            catch_up: CATCH_UP.get(*b),
            time_gap: TIME_GAP.get(*b),
            gain: GAIN.get(*b),
            damping: DAMPING.get(*b),
            lag: LAG.get(*b),
            limits: Limits {
                acceleration: ACCELERATION.get(*c),
                braking: BRAKING.get(*c),
                jerk: JERK.get(*c),
                emergency_braking: EMERGENCY.get(*c),
            },
            horizon_tenths: HORIZON.byte(*c),
        }
    }
}
