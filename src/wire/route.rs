//! `PeerRoute`, `OwnRoute`: where a vehicle is on its route towards an intersection, in two multiplexed frames.

use super::Predecessor;
use super::bits::Payload;
use super::field::{Field, TAG, stamp, stamp_of};
use super::meaning::meaning;
use super::movement::{self, Movement};
use super::predecessor;
use crate::time::Stamp;
use crate::units::Distance;

/// A vehicle's way to the next crossing point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Route {
    /// Ties the two frames; modulo 4.
    pub tag: u8,
    #[doc = meaning!(intersection)]
    ///
    /// 0 to 255.
    pub intersection: u8,
    /// The way through it.
    pub movement: Movement,
    #[doc = meaning!(route_distance)]
    ///
    /// ±1048.575 m by 1 mm.
    pub distance: Distance,
    #[doc = meaning!(stamp)]
    ///
    /// 0.1 ms.
    pub stamp: Stamp,
    #[doc = meaning!(arrival)]
    ///
    /// By 10 ms, modulo 2²⁰ (2.9 h).
    pub arrival: u32,
    #[doc = meaning!(claim_kind)]
    pub predecessor: Predecessor,
}

const PART: Field = Field::selector("Part", 14, 1, 2);
const DISTANCE: Field = Field::signed("Distance", 15, 21).steps(1000, "m").part(0);
const STAMP: Field = stamp(36).part(0);
const MOVEMENT: movement::Fields = movement::fields((53, 0), (45, 1));
const INTERSECTION: Field = Field::unsigned("Intersection", 56, 8).part(0);
const ARRIVAL: Field = Field::unsigned("Arrival", 15, 20).steps(100, "s").part(1);
const PREDECESSOR: predecessor::Fields = predecessor::fields(35).part(1);

/// The two parts.
pub const FIELDS: &[Field] = &[
    TAG,
    PART,
    DISTANCE,
    STAMP,
    MOVEMENT.leg(),
    INTERSECTION,
    ARRIVAL,
    PREDECESSOR.kind(),
    PREDECESSOR.station(),
    MOVEMENT.turn(),
];

impl Route {
    /// The two parts' payloads; what does not fit is limited to its field's range, but the arrival is taken modulo 2²⁰.
    #[must_use]
    pub fn encode(&self) -> [Payload; 2] {
        let begin = |part| PART.with_raw(TAG.with_raw(Payload::EMPTY, i64::from(self.tag & 3)), part);
        let a = DISTANCE.with(begin(0), self.distance);
        let a = STAMP.with_raw(a, i64::from(self.stamp.raw()));
        let a = MOVEMENT.with_leg(a, self.movement);
        let a = INTERSECTION.with_raw(a, i64::from(self.intersection));
        let b = ARRIVAL.with_raw(begin(1), i64::from(self.arrival & 0xF_FFFF));
        [a, MOVEMENT.with_turn(PREDECESSOR.with(b, self.predecessor), self.movement)]
    }

    /// From the two parts' payloads; every payload within the fields' limits is a route.
    #[must_use]
    pub fn decode([a, b]: &[Payload; 2]) -> Self {
        Self {
            tag: TAG.byte(*a),
            intersection: INTERSECTION.byte(*a),
            movement: MOVEMENT.get(*a, *b),
            distance: DISTANCE.get(*a),
            stamp: stamp_of(*a, &STAMP),
            arrival: ARRIVAL.word(*b),
            predecessor: PREDECESSOR.get(*b),
        }
    }
}
