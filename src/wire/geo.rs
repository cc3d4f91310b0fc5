//! `EgoPosition`, `PeerPosition`: where a vehicle is on the globe, in two multiplexed frames.

use super::bits::Payload;
use super::field::{Field, TAG, stamp, stamp_of};
use super::meaning::meaning;
use crate::time::Stamp;

/// A position on the globe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GeoPosition {
    /// Ties the two frames; modulo 4.
    pub tag: u8,
    #[doc = meaning!(latitude)]
    ///
    /// By 1e-7; ±900,000,000.
    pub latitude: i32,
    #[doc = meaning!(longitude)]
    ///
    /// By 1e-7; ±1,800,000,000.
    pub longitude: i32,
    #[doc = meaning!(heading)]
    ///
    /// By 0.0125; 0 to 28,799.
    pub heading: u16,
    #[doc = meaning!(stamp)]
    ///
    /// 0.1 ms.
    pub stamp: Stamp,
}

const PART: Field = Field::selector("Part", 14, 1, 2);
const LATITUDE: Field =
    Field::signed("Latitude", 15, 31).limits(-900_000_000, 900_000_000).steps(10_000_000, "deg").part(0);
const STAMP: Field = stamp(46).part(0);
const LONGITUDE: Field =
    Field::signed("Longitude", 15, 32).limits(-1_800_000_000, 1_800_000_000).steps(10_000_000, "deg").part(1);
const HEADING: Field = Field::unsigned("Heading", 47, 15).limits(0, 28_799).steps(80, "deg").part(1);

/// The two parts.
pub const FIELDS: &[Field] = &[TAG, PART, LATITUDE, STAMP, LONGITUDE, HEADING];

impl GeoPosition {
    /// The two parts' payloads; what does not fit is limited to its field's range.
    #[must_use]
    pub fn encode(&self) -> [Payload; 2] {
        let begin = |part| PART.with_raw(TAG.with_raw(Payload::EMPTY, i64::from(self.tag & 3)), part);
        let a = LATITUDE.with_raw(begin(0), i64::from(self.latitude));
        let a = STAMP.with_raw(a, i64::from(self.stamp.raw()));
        let b = LONGITUDE.with_raw(begin(1), i64::from(self.longitude));
        [a, HEADING.with_raw(b, i64::from(self.heading))]
    }

    /// From the two parts' payloads; every payload within the fields' limits is a position.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // fields of at most 32 bits, and a heading has no sign
    pub fn decode([a, b]: &[Payload; 2]) -> Self {
        Self {
            tag: TAG.byte(*a),
            latitude: LATITUDE.raw(*a) as i32,
            longitude: LONGITUDE.raw(*b) as i32,
            heading: HEADING.raw(*b) as u16,
            stamp: stamp_of(*a, &STAMP),
        }
    }
}
