//! A path over ground: a position on the globe enters, the way along the path and the distance from it leave.
//!
//! A path is a chain of straight segments, prepared off line. Each segment holds what a step of 1e-7° to the north and to the east is
//! worth along it and across it, in metres with 36 fraction bits. So a projection is integer products of coordinate differences. The unit
//! needs no angle function; in single precision these would be off by metres over a few kilometres. The scales are those at the middle
//! latitude of the segment. For segments of up to 500 m the error of that is below a millimetre, up to 60° of latitude.

use crate::fixed::saturate_i32;
use crate::units::{Distance, Position};
use crate::wire::geo::GeoPosition;

/// What a step of 1e-7° is worth in some direction, in metres with 36 fraction bits: at most 0.0112 m, which is below 2³⁰.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Scale {
    /// A step to the north.
    pub north: i32,
    /// A step to the east.
    pub east: i32,
}

impl Scale {
    /// The way of these steps, rounded to nearest, saturating.
    fn way(self, north: i64, east: i64) -> Distance {
        // Differences of coordinates are below 2³² and scales below 2³⁰: the sum of the two products is below 2⁶³.
        let way = north.saturating_mul(self.north.into()).saturating_add(east.saturating_mul(self.east.into()));
        Distance::from_bits(saturate_i32(way.saturating_add(1 << 15) >> 16))
    }
}

/// A straight piece of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Segment {
    /// Latitude of its beginning, degrees north in steps of 1e-7.
    pub latitude: i32,
    /// Longitude of its beginning, degrees east in steps of 1e-7.
    pub longitude: i32,
    /// The way along the path up to its beginning.
    pub begins: Position,
    /// Its length; up to 500 m.
    pub length: Distance,
    /// What a step is worth along it.
    pub along: Scale,
    /// What a step is worth across it, positive to the right.
    pub across: Scale,
    /// Its direction, degrees clockwise from north in steps of 0.0125; 0 to 28,799.
    pub heading: u16,
}

/// A path: segments, each beginning where the one before it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Path {
    /// The segments in the direction of travel.
    pub segments: &'static [Segment],
}

/// Where a vehicle is on a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Place {
    /// The way along the path.
    pub along: Position,
    /// How far to the right of it; at most [`ASIDE`].
    pub across: Distance,
}

/// A vehicle that is farther than this beside a path, or beyond its ends, is not on the path.
pub const ASIDE: Distance = Distance::from_mm(10_000);

/// A vehicle that is turned away from a segment by more than 60° does not drive along it.
const TURNED: u16 = 4_800;
/// A full turn.
const TURN: u16 = 28_800;

impl Path {
    /// Where a vehicle is on the path: on the nearest segment that it drives along. `None` if it is on no segment.
    #[must_use]
    pub fn place(&self, geo: &GeoPosition) -> Option<Place> {
        let mut nearest: Option<(Distance, Place)> = None;
        for segment in self.segments.iter().filter(|segment| turn(segment.heading, geo.heading) <= TURNED) {
            let north = i64::from(geo.latitude).saturating_sub(segment.latitude.into());
            let east = i64::from(geo.longitude).saturating_sub(segment.longitude.into());
            let (along, across) = (segment.along.way(north, east), segment.across.way(north, east));
            let beyond = along.negated().max(along.minus(segment.length)).max(Distance::ZERO);
            let off = across.magnitude().plus(beyond);
            if off <= ASIDE && nearest.is_none_or(|(least, _)| off < least) {
                nearest = Some((off, Place { along: segment.begins.ahead(along), across }));
            }
        }
        nearest.map(|(_, place)| place)
    }
}

/// The angle between two directions.
fn turn(a: u16, b: u16) -> u16 {
    let apart = a.abs_diff(b).min(TURN);
    apart.min(TURN.saturating_sub(apart))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::Stamp;

    /// 400 m to the north, then 400 m to the east, on a globe where a step is a centimetre.
    const CM: i32 = 687_194_767; // 0.01 · 2³⁶
    static BEND: [Segment; 2] = [
        Segment {
            latitude: 0,
            longitude: 0,
            begins: Position::ZERO,
            length: Distance::from_mm(400_000),
            along: Scale { north: CM, east: 0 },
            across: Scale { north: 0, east: CM },
            heading: 0,
        },
        Segment {
            latitude: 40_000,
            longitude: 0,
            begins: Position::from_mm(400_000),
            length: Distance::from_mm(400_000),
            along: Scale { north: 0, east: CM },
            across: Scale { north: -CM, east: 0 },
            heading: 7_200,
        },
    ];
    const PATH: Path = Path { segments: &BEND };

    fn at(latitude: i32, longitude: i32, heading: u16) -> Option<(i64, i32)> {
        let geo = GeoPosition { tag: 0, latitude, longitude, heading, stamp: Stamp::from_raw(0) };
        PATH.place(&geo).map(|place| (place.along.to_mm(), place.across.to_mm()))
    }

    #[test]
    fn the_way_goes_on_around_a_bend() {
        assert_eq!(at(20_000, 0, 0), Some((200_000, 0)));
        assert_eq!(at(20_000, 500, 28_799), Some((200_000, 5_000)));
        assert_eq!(at(40_000, 10_000, 7_200), Some((500_000, 0)));
        assert_eq!(at(39_600, 10_000, 7_200), Some((500_000, 4_000)));
    }

    #[test]
    fn a_vehicle_beside_the_path_or_turned_away_is_not_on_it() {
        assert_eq!(at(20_000, 1_000, 0), Some((200_000, 10_000)));
        assert_eq!(at(20_000, 1_001, 0), None);
        assert_eq!(at(-1_000, 0, 0), Some((-10_000, 0)));
        assert_eq!(at(-1_001, 0, 0), None);
        assert_eq!(at(20_000, 0, 4_800), Some((200_000, 0)));
        assert_eq!(at(20_000, 0, 4_801), None);
        assert_eq!(at(20_000, 0, 24_000), Some((200_000, 0)));
        assert_eq!(at(20_000, 0, 23_999), None);
    }

    #[test]
    fn coordinates_from_anywhere_on_the_globe_are_refused_and_nothing_overflows() {
        for latitude in [-900_000_000, 0, 900_000_000] {
            for longitude in [-1_800_000_000, 1_800_000_000] {
                assert_eq!(at(latitude, longitude, 0), None);
            }
        }
    }
}
