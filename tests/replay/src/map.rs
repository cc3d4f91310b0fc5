//! The map in a head. It is written as a tree, with each path wherever it is named, and read into a room that lives as long as the
//! program, because a unit takes its map as constants.

use core::mem;

use holdover::coordination::{Approach, Crossing, Intersection, Itinerary, Movement, Movements, Path, Scale, Segment};
use holdover::units::{Distance, Position};

use crate::words::{Put, Take, number};

/// Room for a map. Four intersections with four legs each take 20 paths, and none of these more than four segments.
pub struct Room {
    segments: [Segment; 80],
    paths: [Path; 20],
    approaches: [Approach; 16],
    intersections: [Intersection; 4],
    crossings: [Crossing; 4],
    itinerary: Itinerary,
}

const SEGMENT: Segment = Segment {
    latitude: 0,
    longitude: 0,
    begins: Position::ZERO,
    length: Distance::ZERO,
    along: Scale { north: 0, east: 0 },
    across: Scale { north: 0, east: 0 },
    heading: 0,
};
static PATH: Path = Path { segments: &[] };
static INTERSECTION: Intersection = Intersection { id: 0, half: Distance::ZERO, approaches: &[] };

impl Room {
    /// An empty one.
    pub const fn new() -> Self {
        Self {
            segments: [SEGMENT; 80],
            paths: [PATH; 20],
            approaches: [Approach::straight(0, &PATH, Position::ZERO, 0); 16],
            intersections: [INTERSECTION; 4],
            crossings: [Crossing { intersection: &INTERSECTION, movement: Movement::straight(0), at: Position::ZERO };
                4],
            itinerary: Itinerary { path: &PATH, crossings: &[] },
        }
    }
}

impl Default for Room {
    fn default() -> Self {
        Self::new()
    }
}

pub fn put(itinerary: &Itinerary, put: Put) {
    put_path(itinerary.path, put);
    put(itinerary.crossings.len() as i64);
    for crossing in itinerary.crossings {
        put_movement(crossing.movement, put);
        put(crossing.at.to_bits());
        put(crossing.intersection.id.into());
        put(crossing.intersection.half.to_bits().into());
        put(crossing.intersection.approaches.len() as i64);
        for approach in crossing.intersection.approaches {
            put_movement(approach.movement, put);
            put_path(approach.path, put);
            put(approach.crossing.to_bits());
            put(approach.exits.to_bits().into());
            put(approach.conflicts.0 as i64);
        }
    }
}

fn put_movement(movement: Movement, put: Put) {
    put(movement.leg.into());
    put(movement.exit.into());
}

fn put_path(path: &Path, put: Put) {
    put(path.segments.len() as i64);
    for segment in path.segments {
        put(segment.latitude.into());
        put(segment.longitude.into());
        put(segment.begins.to_bits());
        put(segment.length.to_bits().into());
        for scale in [segment.along, segment.across] {
            put(scale.north.into());
            put(scale.east.into());
        }
        put(segment.heading.into());
    }
}

pub fn take(take: Take, room: &'static mut Room) -> Option<&'static Itinerary> {
    let Room { segments, paths, approaches, intersections, crossings, itinerary } = room;
    let mut left = Left { segments, paths, approaches, intersections };
    let path = left.path(take)?;
    let crossings = part(&mut &mut crossings[..], number(take)?)?;
    for place in &mut *crossings {
        *place = left.crossing(take)?;
    }
    *itinerary = Itinerary { path, crossings };
    Some(itinerary)
}

/// What is left of a room.
struct Left {
    segments: &'static mut [Segment],
    paths: &'static mut [Path],
    approaches: &'static mut [Approach],
    intersections: &'static mut [Intersection],
}

/// So many places of what is left. `None`: there are fewer.
fn part<T>(left: &mut &'static mut [T], places: usize) -> Option<&'static mut [T]> {
    let (part, rest) = mem::take(left).split_at_mut_checked(places)?;
    *left = rest;
    Some(part)
}

/// A place of what is left, with this in it.
fn kept<T>(left: &mut &'static mut [T], value: T) -> Option<&'static T> {
    let place = part(left, 1)?.first_mut()?;
    *place = value;
    Some(place)
}

impl Left {
    fn crossing(&mut self, take: Take) -> Option<Crossing> {
        let (movement, at) = (movement_of(take)?, Position::from_bits(take()?));
        let (id, half) = (number(take)?, Distance::from_bits(number(take)?));
        let approaches = part(&mut self.approaches, number(take)?)?;
        for place in &mut *approaches {
            let (movement, path) = (movement_of(take)?, self.path(take)?);
            let (crossing, exits) = (Position::from_bits(take()?), Distance::from_bits(number(take)?));
            let conflicts = Movements(take()? as u64);
            *place = Approach { movement, path, crossing, exits, conflicts };
        }
        let intersection = kept(&mut self.intersections, Intersection { id, half, approaches })?;
        Some(Crossing { intersection, movement, at })
    }

    fn path(&mut self, take: Take) -> Option<&'static Path> {
        let segments = part(&mut self.segments, number(take)?)?;
        for place in &mut *segments {
            *place = segment(take)?;
        }
        kept(&mut self.paths, Path { segments })
    }
}

fn movement_of(take: Take) -> Option<Movement> {
    Some(Movement { leg: number(take)?, exit: number(take)? })
}

fn segment(take: Take) -> Option<Segment> {
    Some(Segment {
        latitude: number(take)?,
        longitude: number(take)?,
        begins: Position::from_bits(take()?),
        length: Distance::from_bits(number(take)?),
        along: scale(take)?,
        across: scale(take)?,
        heading: number(take)?,
    })
}

fn scale(take: Take) -> Option<Scale> {
    Some(Scale { north: number(take)?, east: number(take)? })
}
