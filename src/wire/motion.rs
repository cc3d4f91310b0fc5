//! `EgoMotion`, `PeerMotion`, `OwnMotion`: a vehicle's state in two frames tied by a tag.

use super::StationHash;
use super::bits::Payload;
use super::field::{Field, TAG, stamp, stamp_of};
use super::meaning::meaning;
use crate::time::Stamp;
use crate::units::{Acceleration, Distance, Position, Speed};

/// A position along the lane on the wire: millimetres modulo 2²⁵ (33.554 km), signed. The receiver takes the position
/// nearest to where it is itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WirePosition(i32);

impl WirePosition {
    /// Bits on the wire.
    pub const BITS: u32 = 25;
    const MODULUS_MM: i64 = 1 << Self::BITS;

    /// Of a position, rounded to nearest millimetre.
    #[must_use]
    pub const fn from_position(position: Position) -> Self {
        Self::from_mm(position.to_mm())
    }

    /// Of millimetres, modulo 2²⁵.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // truncation and sign extension are the modulo
    pub const fn from_mm(mm: i64) -> Self {
        Self((mm as i32).wrapping_shl(32 - Self::BITS).wrapping_shr(32 - Self::BITS))
    }

    /// The millimetres as they stand on the wire: -16,777,216 to 16,777,215.
    #[must_use]
    pub const fn mm(self) -> i32 {
        self.0
    }

    /// The position nearest to the reference whose millimetres are these modulo 2²⁵; of two that are equally near, the
    /// one behind. Exact to the millimetre while the two are less than 16.7 km apart.
    #[must_use]
    pub const fn nearest_to(self, reference: Position) -> Position {
        let reference = reference.to_mm();
        let ahead = Self::from_mm((self.0 as i64).wrapping_sub(reference)).0 as i64; // ±2²⁴: a tie is -2²⁴, behind
        Position::from_mm(reference.saturating_add(ahead))
    }

    /// The position that the wire spells out, for a receiver that has no reference yet: within ±16.8 km of the origin.
    #[must_use]
    pub const fn face_value(self) -> Position {
        Position::from_mm(self.0 as i64)
    }

    /// How far this position is ahead of the other, modulo 2²⁵ mm, to the nearer side.
    #[must_use]
    pub const fn mm_ahead_of(self, other: Self) -> i32 {
        Self::from_mm((self.0 as i64).wrapping_sub(other.0 as i64)).0
    }
}

const _: () = assert!(WirePosition::MODULUS_MM == 1 << 25);

/// A vehicle's state at its stamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Motion {
    #[doc = meaning!(tag)]
    ///
    /// Modulo 4.
    pub tag: u8,
    #[doc = meaning!(position)]
    ///
    /// 1 mm.
    pub position: WirePosition,
    #[doc = meaning!(speed)]
    ///
    /// 0 to 65.534 m/s by 2 mm/s.
    pub speed: Speed,
    #[doc = meaning!(acceleration)]
    ///
    /// ±20.46 m/s² by 0.02 m/s².
    pub acceleration: Acceleration,
    #[doc = meaning!(demand)]
    ///
    /// As `acceleration`.
    pub demand: Acceleration,
    #[doc = meaning!(stamp)]
    ///
    /// 0.1 ms.
    pub stamp: Stamp,
    #[doc = meaning!(position_accuracy)]
    ///
    /// 0 to 6.3 m by 0.05 m, rounded up; `None`: not published.
    pub position_accuracy: Option<Distance>,
    #[doc = meaning!(speed_accuracy)]
    ///
    /// 0 to 1.24 m/s by 0.02 m/s, rounded up; `None`: not published.
    pub speed_accuracy: Option<Speed>,
    #[doc = meaning!(station)]
    pub station: StationHash,
}

/// Lane position, shared by every message that has one.
pub(super) const fn position(start: u32) -> Field {
    Field::signed("Position", start, WirePosition::BITS).limits(-(1 << 24), (1 << 24) - 1).steps(1000, "m")
}

/// Speed of a vehicle, likewise.
pub(super) const fn speed(name: &'static str, start: u32) -> Field {
    Field::unsigned(name, start, 15).steps(500, "m/s")
}

/// Acceleration of a vehicle, likewise; -1024 is reserved.
pub(super) const fn acceleration(name: &'static str, start: u32) -> Field {
    Field::signed(name, start, 11).steps(50, "m/s2")
}

pub(super) fn position_of(payload: Payload, field: &Field) -> WirePosition {
    WirePosition::from_mm(field.raw(payload))
}

const POSITION: Field = position(14);
const STAMP: Field = stamp(39);
const STATION: Field = Field::unsigned("Station", 56, 8);
const SPEED: Field = speed("Speed", 14);
const ACCELERATION: Field = acceleration("Acceleration", 29);
const DEMAND: Field = acceleration("Demand", 40);
const POSITION_ACCURACY: Field =
    Field::unsigned("PositionAccuracy", 51, 7).steps(20, "m").or_none(&[(127, "not published")]);
const SPEED_ACCURACY: Field =
    Field::unsigned("SpeedAccuracy", 58, 6).steps(50, "m/s").or_none(&[(63, "not published")]);

/// The first frame.
pub const FIELDS_A: &[Field] = &[TAG, POSITION, STAMP, STATION];
/// The second frame.
pub const FIELDS_B: &[Field] = &[TAG, SPEED, ACCELERATION, DEMAND, POSITION_ACCURACY, SPEED_ACCURACY];

impl Motion {
    /// The two frames' payloads; what does not fit is limited to its field's range.
    #[must_use]
    pub fn encode(&self) -> [Payload; 2] {
        let a = TAG.with_raw(Payload::EMPTY, i64::from(self.tag & 3));
        let a = POSITION.with_raw(a, i64::from(self.position.mm()));
        let a = STAMP.with_raw(a, i64::from(self.stamp.raw()));
        let a = STATION.with_raw(a, i64::from(self.station.0));
        let b = TAG.with_raw(Payload::EMPTY, i64::from(self.tag & 3));
        let b = SPEED.with(b, self.speed);
        let b = ACCELERATION.with(b, self.acceleration);
        let b = DEMAND.with(b, self.demand);
        let b = POSITION_ACCURACY.with_bound(b, self.position_accuracy);
        let b = SPEED_ACCURACY.with_bound(b, self.speed_accuracy);
        [a, b]
    }

    /// From the two frames' payloads; every payload within the fields' limits is a motion.
    #[must_use]
    pub fn decode([a, b]: &[Payload; 2]) -> Self {
        Self {
            tag: TAG.byte(*a),
            position: position_of(*a, &POSITION),
            stamp: stamp_of(*a, &STAMP),
            station: StationHash(STATION.byte(*a)),
            speed: SPEED.get(*b),
            acceleration: ACCELERATION.get(*b),
            demand: DEMAND.get(*b),
            position_accuracy: POSITION_ACCURACY.get_known(*b),
            speed_accuracy: SPEED_ACCURACY.get_known(*b),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_comes_back_from_any_reference_within_half_the_modulus() {
        for mm in [-40_000_000_000i64, -16_777_216, -1, 0, 1, 33_554_431, 33_554_432, 700_000_000_123] {
            for away in [-16_777_215i64, -1_000_003, -1, 0, 1, 999, 16_777_216] {
                let wire = WirePosition::from_position(Position::from_mm(mm));
                assert_eq!(wire.nearest_to(Position::from_mm(mm + away)).to_mm(), mm, "{mm} seen from {away}");
            }
        }
    }

    #[test]
    fn of_two_equally_near_positions_the_one_behind_is_taken() {
        let reference = Position::from_mm(1_000_000);
        let wire = WirePosition::from_mm(1_000_000 + (1 << 24));
        assert_eq!(wire.nearest_to(reference).to_mm(), 1_000_000 - (1 << 24));
    }
}
