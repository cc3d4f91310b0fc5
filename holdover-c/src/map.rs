//! A way through intersections: C's structs enter, and the core's, in memory of the caller, leave.

use holdover::coordination::{self, Movement, Movements};
use holdover::fixed::saturate_i32;
use holdover::units::{Distance, Position};

use crate::pointer;
use crate::room::Room;
use crate::status::Status;

/// What a step of 1e-7 degrees is worth in some direction, in units of 2^-36 m.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// A step to the north.
    pub north: i32,
    /// A step to the east.
    pub east: i32,
}

/// A straight piece of a path.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// The way along the path up to its beginning, in units of 2^-20 m.
    pub begins: i64,
    /// Its length in units of 2^-20 m; up to 500 m.
    pub length: i64,
    /// Latitude of its beginning, degrees north in steps of 1e-7.
    pub latitude: i32,
    /// Longitude of its beginning, degrees east in steps of 1e-7.
    pub longitude: i32,
    /// What a step is worth along it.
    pub along: Scale,
    /// What a step is worth across it, positive to the right.
    pub across: Scale,
    /// Its direction, degrees clockwise from north in steps of 0.0125; 0 to 28,799.
    pub heading: u16,
}

/// A path: segments, each beginning where the one before it ends.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Path {
    /// The segments in the direction of travel.
    pub segments: *const Segment,
    /// How many there are.
    pub segment_count: usize,
}

/// A way through an intersection.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    /// Where the crossing point lies on the path, in units of 2^-20 m. For all ways of a leg it is the same distance beyond a place that
    /// all of them pass.
    pub crossing: i64,
    /// The distance from there to a place that all ways of the exit have in common, in units of 2^-20 m; 0 where ways do not join.
    pub exits: i64,
    /// The ways that it conflicts with: bit `8 leg + exit`. Those of its own leg are not among them.
    pub conflicts: u64,
    /// The path of the vehicles that go this way.
    pub path: *const Path,
    /// The number of its leg in messages; 0 to 7.
    pub leg: u8,
    /// The number of its exit; 0 to 7. The exit straight on has the number of the leg.
    pub exit: u8,
}

/// An intersection.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Intersection {
    /// The conflict area on every way is this far before and behind the crossing point, in units of 2^-20 m; up to 5.115 m.
    pub half: i64,
    /// The ways through it.
    pub approaches: *const Approach,
    /// How many there are.
    pub approach_count: usize,
    /// Its number in messages.
    pub id: u8,
}

/// An intersection on the ego's way.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// Where the crossing point lies on the ego's path, in units of 2^-20 m.
    pub at: i64,
    /// The intersection.
    pub intersection: *const Intersection,
    /// The leg by which the ego comes.
    pub leg: u8,
    /// The exit by which it leaves.
    pub exit: u8,
}

/// The ego's way.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Itinerary {
    /// Its path.
    pub path: *const Path,
    /// The intersections on it, in the order in which they are met: at least one, and no intersection twice.
    pub crossings: *const Crossing,
    /// How many there are.
    pub crossing_count: usize,
}

/// Bytes of a map in `HOLDOVER_MAP_SIZE`, on every target.
const _: () = assert!(
    size_of::<coordination::Segment>() <= 40
        && size_of::<coordination::Path>() <= 16
        && size_of::<coordination::Approach>() <= 40
        && size_of::<coordination::Intersection>() <= 24
        && size_of::<coordination::Crossing>() <= 24
        && size_of::<coordination::Itinerary>() <= 24
);

/// Copies a way into the room.
///
/// # Errors
/// [`Status::Null`], [`Status::Misaligned`], [`Status::MapTooSmall`].
///
/// # Safety
/// Everything that it points to has to be there, as many as it says.
pub unsafe fn take(way: &Itinerary, room: &mut Room) -> Result<&'static coordination::Itinerary, Status> {
    // SAFETY: as the caller vouches, here and below.
    let (path, crossings) =
        unsafe { (self::path(way.path, room)?, pointer::read_all(way.crossings, way.crossing_count)?) };
    let crossings = room.keep(crossings.len(), |room, number| {
        let Crossing { at, intersection, leg, exit } = *crossings.get(number).ok_or(Status::MapTooSmall)?;
        // SAFETY: as above.
        let intersection = unsafe { self::intersection(intersection, room)? };
        let movement = Movement { leg, exit };
        Ok(coordination::Crossing { intersection, movement, at: Position::from_bits(at) })
    })?;
    room.keep_one(coordination::Itinerary { path, crossings })
}

/// # Safety
/// As [`take`].
unsafe fn intersection(
    intersection: *const Intersection,
    room: &mut Room,
) -> Result<&'static coordination::Intersection, Status> {
    // SAFETY: as the caller vouches.
    let Intersection { half, approaches, approach_count, id } = unsafe { *pointer::read(intersection)? };
    // SAFETY: as above.
    let approaches = unsafe { pointer::read_all(approaches, approach_count)? };
    let approaches = room.keep(approaches.len(), |room, number| {
        let Approach { crossing, exits, conflicts, path, leg, exit } =
            *approaches.get(number).ok_or(Status::MapTooSmall)?;
        // SAFETY: as above.
        let path = unsafe { self::path(path, room)? };
        Ok(coordination::Approach {
            movement: Movement { leg, exit },
            path,
            crossing: Position::from_bits(crossing),
            exits: distance(exits),
            conflicts: Movements(conflicts),
        })
    })?;
    room.keep_one(coordination::Intersection { id, half: distance(half), approaches })
}

/// # Safety
/// As [`take`].
unsafe fn path(path: *const Path, room: &mut Room) -> Result<&'static coordination::Path, Status> {
    // SAFETY: as the caller vouches.
    let Path { segments, segment_count } = unsafe { *pointer::read(path)? };
    // SAFETY: as above.
    let segments = unsafe { pointer::read_all(segments, segment_count)? };
    let segments =
        room.keep(segments.len(), |_, number| segments.get(number).map(segment).ok_or(Status::MapTooSmall))?;
    room.keep_one(coordination::Path { segments })
}

fn segment(plain: &Segment) -> coordination::Segment {
    let Segment { begins, length, latitude, longitude, along, across, heading } = *plain;
    let scale = |Scale { north, east }| coordination::Scale { north, east };
    coordination::Segment {
        latitude,
        longitude,
        begins: Position::from_bits(begins),
        length: distance(length),
        along: scale(along),
        across: scale(across),
        heading,
    }
}

/// What is longer than the core's format saturates.
fn distance(bits: i64) -> Distance {
    Distance::from_bits(saturate_i32(bits))
}
