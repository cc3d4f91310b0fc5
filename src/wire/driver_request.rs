//! `DriverRequest`: what the driver or the planner wants of the unit, in one frame.

use super::Predecessor;
use super::bits::Payload;
use super::field::Field;
use super::meaning::meaning;
use super::motion::speed;
use super::predecessor;
use crate::units::{Seconds, Speed};

/// The vehicle's desired.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DriverRequest {
    #[doc = meaning!(engaged)]
    pub engaged: bool,
    #[doc = meaning!(predecessor_kind)]
    pub predecessor: Predecessor,
    #[doc = meaning!(request_target_speed)]
    ///
    /// `v_∞`; 0 to 65.534 m/s by 2 mm/s.
    pub target_speed: Speed,
    #[doc = meaning!(request_time_gap)]
    ///
    /// `t_g`; 0.1 to 3.995 s by 5 ms; `None`: the configured one.
    pub time_gap: Option<Seconds>,
}

const ENGAGED: Field = Field::unsigned("Engaged", 12, 1).named(&[(0, "off"), (1, "drive")]);
const PREDECESSOR: predecessor::Fields = predecessor::fields(13);
const TARGET_SPEED: Field = speed("TargetSpeed", 23);
const TIME_GAP: Field = {
    let field = super::driving_parameters::time_gap(38);
    Field { none: Some(1023), values: &[(1023, "as configured")], ..field }
};

/// The frame.
pub const FIELDS: &[Field] = &[ENGAGED, PREDECESSOR.kind(), PREDECESSOR.station(), TARGET_SPEED, TIME_GAP];

impl DriverRequest {
    /// The frame's payload; what does not fit is limited to its field's range.
    #[must_use]
    pub fn encode(&self) -> [Payload; 1] {
        let a = ENGAGED.with_raw(Payload::EMPTY, i64::from(self.engaged));
        let a = PREDECESSOR.with(a, self.predecessor);
        let a = TARGET_SPEED.with(a, self.target_speed);
        [TIME_GAP.with_known(a, self.time_gap)]
    }

    /// From the frame's payload; every payload within the fields' limits is a request.
    #[must_use]
    pub fn decode([a]: &[Payload; 1]) -> Self {
        Self {
            engaged: ENGAGED.raw(*a) != 0,
            predecessor: PREDECESSOR.get(*a),
            target_speed: TARGET_SPEED.get(*a),
            time_gap: TIME_GAP.get_known(*a),
        }
    }
}
