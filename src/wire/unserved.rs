//! `PeersUnserved`: stations that the modem hears and has no slot for, in one frame.

use super::bits::Payload;
use super::field::Field;
use super::meaning::meaning;
use crate::units::Distance;

/// Whom the unit cannot know of at the intersection that it comes to next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Unserved {
    #[doc = meaning!(intersection)]
    ///
    /// 0 to 255.
    pub intersection: u8,
    #[doc = meaning!(legs)]
    pub legs: u8,
    #[doc = meaning!(unserved_ahead)]
    ///
    /// ±1048.574 m by 1 mm; `None`: there is nobody.
    pub ahead: Option<Distance>,
    #[doc = meaning!(stations)]
    ///
    /// 0 to 63, saturating.
    pub stations: u8,
}

const INTERSECTION: Field = Field::unsigned("Intersection", 56, 8);
const LEGS: Field = Field::unsigned("Legs", 48, 8);
const AHEAD: Field = Field::signed("Ahead", 27, 21).steps(1000, "m").or_none(&[(1_048_575, "nobody")]);
const STATIONS: Field = Field::unsigned("Stations", 21, 6);

/// The frame.
pub const FIELDS: &[Field] = &[STATIONS, AHEAD, LEGS, INTERSECTION];

impl Unserved {
    /// The frame's payload; what does not fit is limited to its field's range.
    #[must_use]
    pub fn encode(&self) -> [Payload; 1] {
        let a = INTERSECTION.with_raw(Payload::EMPTY, i64::from(self.intersection));
        let a = LEGS.with_raw(a, i64::from(self.legs));
        let a = AHEAD.with_known(a, self.ahead);
        [STATIONS.with_raw(a, i64::from(self.stations))]
    }

    /// From the frame's payload; every payload within the fields' limits is a value.
    #[must_use]
    pub fn decode([a]: &[Payload; 1]) -> Self {
        Self {
            intersection: INTERSECTION.byte(*a),
            legs: LEGS.byte(*a),
            ahead: AHEAD.get_known(*a),
            stations: STATIONS.byte(*a),
        }
    }
}
