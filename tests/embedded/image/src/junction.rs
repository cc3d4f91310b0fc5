//! A street to the north and one to the east that cross, on a flat globe where a step of 1e-7° is a centimetre: which street a vehicle is
//! on and how far along enter; its place on the globe, its route and its passes leave. 190 m after the first intersection the street to the
//! north has a second one.

use holdover::coordination::{Approach, Arrival, Crossing, Intersection, Itinerary, Movement, Path, Scale, Segment};
use holdover::time::{GnssTime, Stamp};
use holdover::units::{Distance, Position};
use holdover::wire::geo::GeoPosition;
use holdover::wire::pass::{Claimed, Pass, PassTime};
use holdover::wire::route::Route;
use holdover::wire::{Predecessor, StationHash};

const CM: i32 = 687_194_767; // 0.01 · 2³⁶

static NORTH: [Segment; 1] = [Segment {
    latitude: -20_000,
    longitude: 0,
    begins: Position::from_mm(-200_000),
    length: Distance::from_mm(700_000),
    along: Scale { north: CM, east: 0 },
    across: Scale { north: 0, east: CM },
    heading: 0,
}];
static EAST: [Segment; 1] = [Segment {
    latitude: 20_000,
    longitude: -40_000,
    along: Scale { north: 0, east: CM },
    across: Scale { north: -CM, east: 0 },
    heading: 7_200,
    ..NORTH[0]
}];
static NORTHWARD: Path = Path { segments: &NORTH };
static EASTWARD: Path = Path { segments: &EAST };

/// Where the crossing points lie along the street to the north; the first one lies as far along the street to the east.
const AT: [i64; 2] = [200_000, 390_000];
/// Half of a conflict area, and a vehicle's length.
const LEFT_AFTER: i64 = 4_000 + 4_800;

static FIRST: Intersection = Intersection {
    id: 5,
    half: Distance::from_mm(4_000),
    approaches: &[
        Approach::straight(0, &NORTHWARD, Position::from_mm(AT[0]), 0b10),
        Approach::straight(1, &EASTWARD, Position::from_mm(AT[0]), 0b01),
    ],
};
static SECOND: Intersection = Intersection {
    id: 6,
    half: Distance::from_mm(4_000),
    approaches: &[Approach::straight(0, &NORTHWARD, Position::from_mm(AT[1]), 0b10)],
};

/// The ego's way, to the north.
pub static WAY: Itinerary = Itinerary {
    path: &NORTHWARD,
    crossings: &[
        Crossing { intersection: &FIRST, movement: Movement::straight(0), at: Position::from_mm(AT[0]) },
        Crossing { intersection: &SECOND, movement: Movement::straight(0), at: Position::from_mm(AT[1]) },
    ],
};

/// A vehicle on one of the streets.
#[derive(Clone, Copy)]
pub struct Place {
    /// Its leg at the first intersection: 0 to the north, 1 to the east.
    pub leg: u8,
    /// Its front bumper, in millimetres along its street.
    pub along: i64,
}

impl Place {
    /// Where it is on the globe.
    pub fn on_globe(&self, tag: u8, stamp: Stamp) -> GeoPosition {
        let cm = (self.along / 10) as i32;
        match self.leg {
            0 => GeoPosition { tag, latitude: cm, longitude: 0, heading: 0, stamp },
            _ => GeoPosition { tag, latitude: 20_000, longitude: cm - 20_000, heading: 7_200, stamp },
        }
    }

    /// The intersection that it comes to, and where that lies along its street.
    fn next(&self) -> (u8, i64) {
        let has_left = self.leg == 0 && self.along > AT[0] + LEFT_AFTER;
        if has_left { (SECOND.id, AT[1]) } else { (FIRST.id, AT[0]) }
    }

    /// Its route, with the order in which it arrived.
    pub fn route(&self, tag: u8, stamp: Stamp, arrival: Arrival, ahead: Option<u8>) -> Route {
        let (intersection, at) = self.next();
        Route {
            tag,
            intersection,
            movement: Movement::straight(self.leg),
            distance: Distance::from_mm((at - self.along) as i32),
            stamp,
            arrival: arrival.0,
            predecessor: ahead.map_or(Predecessor::None, |ahead| Predecessor::Station(StationHash(ahead))),
        }
    }

    /// What a vehicle there claims: two windows, one after the other.
    pub fn pass(&self, tag: u8, station: u32, now: GnssTime, arrival: Arrival) -> Pass {
        let (intersection, at) = self.next();
        let stamp = PassTime::down(now);
        // At 11 m/s, in hundredths of a second.
        let until = ((at - self.along).max(0) / 110) as u16;
        let claim =
            |after: u16| Claimed { at: stamp, entry: PassTime(stamp.0.wrapping_add(until + after)), length: 150 };
        Pass {
            tag,
            station_id: station,
            intersection,
            movement: Movement::straight(self.leg),
            left: (self.leg == 0 && intersection == SECOND.id).then_some(FIRST.id),
            is_before_zone: false,
            is_by_hand: false,
            stamp,
            arrival: arrival.0,
            claims: [Some(claim(0)), Some(claim(400))],
        }
    }
}
