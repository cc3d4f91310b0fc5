//! `OwnPass`, `PeerPass`: the windows of time in which a vehicle may be in a conflict area, in four multiplexed frames. The rules are
//! those of [`crate::passes`].

use super::bits::Payload;
use super::field::{Field, TAG};
use super::meaning::meaning;
use super::movement::{self, Movement};
use crate::time::{Duration, GnssTime};

/// A time of a pass: GNSS time by 10 ms, modulo 2¹⁶ (655.36 s).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PassTime(pub u16);

/// The resolution of a [`PassTime`].
pub const STEP: Duration = Duration::from_millis(10);
/// The same in microseconds.
const STEP_MICROS: u64 = 10_000;
/// Times come round after this many steps.
const PERIOD: u64 = 1 << 16;
/// The longest window on the wire, in steps.
pub const LONGEST: u16 = (1 << 12) - 1;

impl PassTime {
    /// A GNSS time, rounded down.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // modulo
    pub const fn down(time: GnssTime) -> Self {
        Self((time.as_micros() / STEP_MICROS) as u16)
    }

    /// The GNSS time that is meant, within half of the range before and after `now`.
    #[must_use]
    pub const fn near(self, now: GnssTime) -> GnssTime {
        let steps = now.as_micros() / STEP_MICROS;
        let begins = steps.saturating_sub(PERIOD / 2);
        let further = (self.0 as u64).wrapping_sub(begins) % PERIOD;
        GnssTime::from_micros(begins.saturating_add(further).saturating_mul(STEP_MICROS))
    }
}

/// A claimed window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Claimed {
    #[doc = meaning!(claimed)]
    pub at: PassTime,
    #[doc = meaning!(entry)]
    pub entry: PassTime,
    #[doc = meaning!(pass_length)]
    ///
    /// In steps of 10 ms: 1 to 4095.
    pub length: u16,
}

/// What a vehicle says of its passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pass {
    /// Ties the four frames; modulo 4.
    pub tag: u8,
    #[doc = meaning!(station_id)]
    pub station_id: u32,
    #[doc = meaning!(intersection)]
    ///
    /// 0 to 255.
    pub intersection: u8,
    /// The way through it.
    pub movement: Movement,
    #[doc = meaning!(left)]
    pub left: Option<u8>,
    #[doc = meaning!(zone)]
    pub is_before_zone: bool,
    #[doc = meaning!(by_hand)]
    pub is_by_hand: bool,
    #[doc = meaning!(pass_stamp)]
    pub stamp: PassTime,
    #[doc = meaning!(arrival)]
    ///
    /// By 10 ms, modulo 2²⁰ (2.9 h).
    pub arrival: u32,
    /// The windows, at most two. A window may be longer than one piece, and then follow it.
    pub claims: [Option<Claimed>; 2],
}

const PART: Field = Field::selector("Part", 14, 2, 4);
const STATION_ID: Field = Field::unsigned("StationId", 16, 32).part(0);
const INTERSECTION: Field = Field::unsigned("Intersection", 48, 8).part(0);
const MOVEMENT: movement::Fields = movement::fields((56, 0), (59, 0));
const STAMP: Field = time("PassStamp", 16).part(1);
const ARRIVAL: Field = Field::unsigned("Arrival", 32, 20).steps(100, "s").part(1);
const LEFT: Field = Field::unsigned("Left", 52, 9).or_none(&[(511, "none")]).limits(0, 255).part(1);
const ZONE: Field = Field::unsigned("Zone", 61, 1).named(&[(0, "in the zone"), (1, "before the zone")]).part(1);
const BY_HAND: Field = Field::unsigned("ByHand", 62, 1).named(&[(0, "no"), (1, "yes")]).part(1);
const CLAIMED: [Field; 2] = [time("Claimed1", 16).part(2), time("Claimed2", 16).part(3)];
const ENTRY: [Field; 2] = [time("Entry1", 32).part(2), time("Entry2", 32).part(3)];
const LENGTH: [Field; 2] = [length("Length1").part(2), length("Length2").part(3)];

const fn time(name: &'static str, start: u32) -> Field {
    Field::unsigned(name, start, 16).steps(100, "s")
}

const fn length(name: &'static str) -> Field {
    Field { values: &[(0, "no window")], ..Field::unsigned(name, 48, 12).steps(100, "s") }
}

/// The four parts.
pub const FIELDS: &[Field] = &[
    TAG,
    PART,
    STATION_ID,
    INTERSECTION,
    MOVEMENT.leg(),
    MOVEMENT.turn(),
    STAMP,
    ARRIVAL,
    LEFT,
    CLAIMED[0],
    ENTRY[0],
    LENGTH[0],
    CLAIMED[1],
    ENTRY[1],
    LENGTH[1],
    ZONE,
    BY_HAND,
];

impl Pass {
    /// The four parts' payloads; what does not fit is limited to its field's range.
    #[must_use]
    pub fn encode(&self) -> [Payload; 4] {
        let begin = |part| PART.with_raw(TAG.with_raw(Payload::EMPTY, i64::from(self.tag & 3)), part);
        let a = STATION_ID.with_raw(begin(0), i64::from(self.station_id));
        let a = MOVEMENT.with_leg(INTERSECTION.with_raw(a, i64::from(self.intersection)), self.movement);
        let a = MOVEMENT.with_turn(a, self.movement);
        let b = STAMP.with_raw(begin(1), i64::from(self.stamp.0));
        let b = ARRIVAL.with_raw(b, i64::from(self.arrival & 0xF_FFFF));
        let b = LEFT.with_steps(b, self.left.map(i64::from));
        let b = ZONE.with_raw(b, i64::from(self.is_before_zone));
        let b = BY_HAND.with_raw(b, i64::from(self.is_by_hand));
        let [first, second] = self.claims;
        [a, b, Self::window(begin(2), 0, first), Self::window(begin(3), 1, second)]
    }

    fn window(payload: Payload, piece: usize, claimed: Option<Claimed>) -> Payload {
        let (Some(claimed), Some([at, entry, length])) = (claimed, fields(piece)) else { return payload };
        let payload = at.with_raw(payload, i64::from(claimed.at.0));
        length.with_raw(entry.with_raw(payload, i64::from(claimed.entry.0)), i64::from(claimed.length))
    }

    /// From the four parts' payloads; every payload within the fields' limits is a pass.
    #[must_use]
    pub fn decode([a, b, c, d]: &[Payload; 4]) -> Self {
        let left = LEFT.raw(*b);
        Self {
            tag: TAG.byte(*a),
            station_id: STATION_ID.word(*a),
            intersection: INTERSECTION.byte(*a),
            movement: MOVEMENT.get(*a, *a),
            left: u8::try_from(left).ok(),
            is_before_zone: ZONE.raw(*b) == 1,
            is_by_hand: BY_HAND.raw(*b) == 1,
            stamp: time_of(*b, &STAMP),
            arrival: ARRIVAL.word(*b),
            claims: [claimed(*c, 0), claimed(*d, 1)],
        }
    }
}

fn fields(piece: usize) -> Option<[&'static Field; 3]> {
    Some([CLAIMED_FIELDS.get(piece)?, ENTRY_FIELDS.get(piece)?, LENGTH_FIELDS.get(piece)?])
}

static CLAIMED_FIELDS: [Field; 2] = CLAIMED;
static ENTRY_FIELDS: [Field; 2] = ENTRY;
static LENGTH_FIELDS: [Field; 2] = LENGTH;

fn claimed(payload: Payload, piece: usize) -> Option<Claimed> {
    let [at, entry, length] = fields(piece)?;
    #[allow(clippy::cast_possible_truncation)] // 12 bits
    let length = length.word(payload) as u16;
    (length > 0).then(|| Claimed { at: time_of(payload, at), entry: time_of(payload, entry), length })
}

#[allow(clippy::cast_possible_truncation)] // 16 bits
fn time_of(payload: Payload, field: &Field) -> PassTime {
    PassTime(field.word(payload) as u16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_found_again_within_half_of_the_range() {
        let step = |steps: u64| GnssTime::from_micros(steps * STEP_MICROS);
        for now in [0u64, 5, 32_768, 40_000, 65_535, 65_536, 1_000_000_007] {
            for meant in [now.saturating_sub(32_768), now.saturating_sub(1), now, now + 1, now + 32_767] {
                assert_eq!(PassTime::down(step(meant)).near(step(now)), step(meant), "{meant} at {now}");
            }
        }
        assert_eq!(PassTime::down(GnssTime::from_micros(19_999)), PassTime(1));
    }
}
