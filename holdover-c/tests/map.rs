//! A way through intersections, and incidents, by the C interface: taken in as the core takes them, or refused by name.

use std::ffi::c_void;
use std::mem::MaybeUninit;
use std::ptr::null;

use holdover::coordination;
use holdover::units::{Distance, Position};
use holdover_c::*;

const fn mm(mm: i64) -> i64 {
    Position::from_mm(mm).to_bits()
}

/// 300 m to the north.
static SEGMENTS: [Segment; 1] = [Segment {
    begins: 0,
    length: mm(300_000),
    latitude: 377_840_000,
    longitude: -1_224_000_000,
    along: Scale { north: 762_734_094, east: 0 },
    across: Scale { north: 0, east: 605_335_109 },
    heading: 0,
}];

/// A way in C, with what it points to.
struct Way {
    path: Path,
    no_path: Path,
    approaches: Vec<Approach>,
    intersections: Vec<Intersection>,
    crossings: Vec<Crossing>,
}

impl Way {
    /// Over these intersections: number, half a conflict area and place.
    fn new(intersections: &[(u8, i64, i64)]) -> Box<Self> {
        let path = Path { segments: SEGMENTS.as_ptr(), segment_count: 1 };
        let no_path = Path { segments: null(), segment_count: 0 };
        let mut way = Box::new(Self { path, no_path, approaches: vec![], intersections: vec![], crossings: vec![] });
        let (crossing, path) = (mm(100_000), &raw const way.path);
        way.approaches.push(Approach { crossing, exits: 0, conflicts: 0b1, path, leg: 1, exit: 1 });
        let approaches = way.approaches.as_ptr();
        let build = |&(id, half, _): &(u8, i64, i64)| Intersection { half, approaches, approach_count: 1, id };
        way.intersections = intersections.iter().map(build).collect();
        let places = intersections.iter().zip(&way.intersections);
        way.crossings =
            places.map(|(&(_, _, at), intersection)| Crossing { at, intersection, leg: 0, exit: 0 }).collect();
        way
    }

    fn itinerary(&self) -> Itinerary {
        Itinerary {
            path: &raw const self.path,
            crossings: self.crossings.as_ptr(),
            crossing_count: self.crossings.len(),
        }
    }
}

/// Memory for a unit and two maps.
struct Memory {
    unit: Vec<u64>,
    maps: [Vec<u64>; 2],
}

/// For a way over two intersections.
const MAP: usize = 40 * 3 + 16 * 3 + 40 * 2 + 24 * 2 + 24 * 2 + 32;

impl Memory {
    fn new() -> Self {
        let mut memory = Self { unit: vec![0; HOLDOVER_UNIT_SIZE / 8], maps: [vec![0; 64], vec![0; 64]] };
        let mut config = MaybeUninit::uninit();
        // SAFETY: the memory is there and as large as said.
        unsafe {
            assert_eq!(holdover_default_config(config.as_mut_ptr()), Status::Ok);
            assert_eq!(holdover_init(memory.unit(), HOLDOVER_UNIT_SIZE, config.as_ptr()), Status::Ok);
        }
        memory
    }

    fn unit(&mut self) -> *mut c_void {
        self.unit.as_mut_ptr().cast()
    }

    fn set_out(&mut self, way: &Itinerary, map: usize, size: usize) -> Status {
        let map = self.maps[map].as_mut_ptr().cast();
        // SAFETY: as above, and the way is there with all that it points to, or wrong in a way that is checked.
        unsafe { holdover_set_out(self.unit(), way, map, size) }
    }

    fn note(&mut self, incident: i32, times: u32) -> Status {
        // SAFETY: as above.
        unsafe { holdover_note(self.unit(), incident, times) }
    }

    fn count(&mut self, cause: Status) -> u32 {
        let mut count = 0;
        // SAFETY: as above.
        assert_eq!(unsafe { holdover_count(self.unit(), cause as i32, &mut count) }, Status::Ok);
        count
    }
}

#[test]
fn a_way_is_taken_in_by_memory_of_the_promised_size() {
    let way = Way::new(&[(1, mm(3_500), mm(100_000)), (2, mm(3_500), mm(200_000))]);
    let mut memory = Memory::new();
    for size in 0..MAP - 40 {
        assert!(matches!(memory.set_out(&way.itinerary(), 0, size), Status::MapTooSmall), "{size}");
    }
    assert_eq!(memory.set_out(&way.itinerary(), 0, MAP), Status::Ok);
}

#[test]
fn a_way_that_cannot_be_driven_is_refused_by_the_core_s_name() {
    let far = mm(200_000);
    for (status, intersections) in [
        (Status::MapCrossings, vec![]),
        (Status::MapOrder, vec![(1, mm(3_500), far), (2, mm(3_500), far)]),
        (Status::MapArea, vec![(1, mm(5_116), far)]),
        (Status::MapArea, vec![(1, i64::MAX, far)]),
        (Status::MapArea, vec![(1, -1, far)]),
        (Status::MapClose, vec![(1, mm(3_500), far), (2, mm(3_500), far + mm(14_000))]),
    ] {
        let way = Way::new(&intersections);
        assert_eq!(Memory::new().set_out(&way.itinerary(), 0, 512), status, "{intersections:?}");
    }
    let mut way = Way::new(&[(1, mm(3_500), far)]);
    way.crossings[0].leg = 8;
    assert_eq!(Memory::new().set_out(&way.itinerary(), 0, 512), Status::MapLeg);
    let mut way = Way::new(&[(1, mm(3_500), far)]);
    way.approaches[0].exit = 8;
    assert_eq!(Memory::new().set_out(&way.itinerary(), 0, 512), Status::MapLeg);
    let mut way = Way::new(&[(1, mm(3_500), far)]);
    way.approaches[0].path = &raw const way.no_path;
    assert_eq!(Memory::new().set_out(&way.itinerary(), 0, 512), Status::MapPath);
    let mut way = Way::new(&[(1, mm(3_500), far)]);
    way.approaches[0].conflicts = u64::MAX;
    assert_eq!(Memory::new().set_out(&way.itinerary(), 0, 512), Status::MapConflicts);
}

#[test]
fn null_wherever_there_is_a_pointer_is_refused() {
    let way = Way::new(&[(1, mm(3_500), mm(200_000))]);
    let mut memory = Memory::new();
    for wrong in [Itinerary { path: null(), ..way.itinerary() }, Itinerary { crossings: null(), ..way.itinerary() }] {
        assert_eq!(memory.set_out(&wrong, 0, 512), Status::Null);
    }
    let null_pointers: [fn(&mut Way); 4] = [
        |way| way.crossings[0].intersection = null(),
        |way| way.intersections[0].approaches = null(),
        |way| way.approaches[0].path = null(),
        |way| way.path.segments = null(),
    ];
    for wrong in null_pointers {
        let mut way = Way::new(&[(1, mm(3_500), mm(200_000))]);
        wrong(&mut way);
        assert_eq!(memory.set_out(&way.itinerary(), 0, 512), Status::Null);
    }
    let unit = memory.unit();
    // SAFETY: null is checked for.
    unsafe {
        assert_eq!(holdover_set_out(unit, null(), memory.maps[0].as_mut_ptr().cast(), 512), Status::Null);
        assert_eq!(holdover_set_out(unit, &way.itinerary(), std::ptr::null_mut(), 512), Status::Null);
    }
}

#[test]
fn the_memory_of_the_present_map_is_not_taken_for_the_next_one() {
    let way = Way::new(&[(1, mm(3_500), mm(200_000))]);
    let mut memory = Memory::new();
    assert_eq!(memory.set_out(&way.itinerary(), 0, 512), Status::Ok);
    let before = memory.maps[0].clone();
    assert_eq!(memory.set_out(&way.itinerary(), 0, 512), Status::MapInUse);
    assert_eq!(memory.maps[0], before);
    assert_eq!(memory.set_out(&way.itinerary(), 1, 512), Status::Ok);
    assert_eq!(memory.set_out(&way.itinerary(), 0, 512), Status::Ok);
    // What is refused leaves the way that there was.
    let closed = Way::new(&[]);
    assert_eq!(memory.set_out(&closed.itinerary(), 1, 512), Status::MapCrossings);
    assert_eq!(memory.set_out(&way.itinerary(), 0, 512), Status::MapInUse);
}

#[test]
fn millimetres_are_the_core_s() {
    for (millimetres, bits) in [(0, 0), (1, 1049), (-1, -1049), (1_000, 1 << 20), (-2_500, -2_621_440)] {
        assert_eq!(Position::from_mm(millimetres).to_bits(), bits);
        assert_eq!(i64::from(Distance::from_mm(millimetres as i32).to_bits()), bits);
        // The macro of the header.
        let of_the_macro = (millimetres * 1_048_576 + if millimetres < 0 { -500 } else { 500 }) / 1000;
        assert_eq!(of_the_macro, bits);
    }
    assert!(size_of::<coordination::Segment>() <= 40);
}

#[test]
fn incidents_are_counted_under_their_causes_and_other_numbers_are_refused() {
    let mut memory = Memory::new();
    for (number, cause) in [
        (Incident::ReceiveOverflow, Status::RefusedReceiveOverflow),
        (Incident::Overrun, Status::RefusedOverrun),
        (Incident::TransmitOverflow, Status::RefusedTransmitOverflow),
        (Incident::BusOff, Status::RefusedBusOff),
        (Incident::Restart, Status::RefusedRestart),
        (Incident::MissedPeriod, Status::RefusedMissedPeriod),
        (Incident::ClockFailed, Status::RefusedClockFailed),
    ] {
        assert_eq!((memory.note(number as i32, 3), memory.note(number as i32, 2)), (Status::Ok, Status::Ok));
        assert_eq!(memory.count(cause), 5, "{cause:?}");
    }
    for number in [-1, 7, i32::MIN, i32::MAX] {
        assert_eq!(memory.note(number, 1), Status::NoIncident);
    }
    assert_eq!(memory.count(Status::RefusedClockFailed), 5);
}
