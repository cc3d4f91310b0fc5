//! What a modem with too few slots reports of the stations without a slot, on two streets that cross.

use super::*;
use crate::sim::modem::{Ahead, Course, REPEATED, V2xMessage};
use holdover::coordination::{Approach, Intersection, Movement, Path};
use holdover::time::Stamp;
use holdover::units::{Acceleration, Position, Speed};
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::route::Route;
use holdover::wire::{Identifiers, Predecessor, Said, StationHash};

static PATH: Path = Path { segments: &[] };
/// Leg 1 crosses leg 0, and leg 2 does not.
static CORNER: Intersection = Intersection {
    id: 5,
    half: Distance::ZERO,
    approaches: &[
        Approach::straight(0, &PATH, Position::ZERO, 0b010),
        Approach::straight(1, &PATH, Position::ZERO, 0b001),
        Approach::straight(2, &PATH, Position::ZERO, 0),
    ],
};

/// The unit's own number, leg, distance to the crossing point, and arrival.
const OWN: (u8, u8, i32, u32) = (1, 0, 100, 1_000);

fn route((_, leg, metres, arrival): (u8, u8, i32, u32)) -> Route {
    Route {
        tag: 1,
        intersection: 5,
        movement: Movement::straight(leg),
        distance: Distance::from_mm(metres * 1_000),
        stamp: Stamp::from_raw(7),
        arrival,
        predecessor: Predecessor::None,
    }
}

fn message(said: (u8, u8, i32, u32)) -> V2xMessage {
    let motion = Motion {
        tag: 1,
        position: WirePosition::from_mm(0),
        speed: Speed::from_mm_per_s(0),
        acceleration: Acceleration::ZERO,
        demand: Acceleration::ZERO,
        stamp: Stamp::from_raw(7),
        position_accuracy: None,
        speed_accuracy: None,
        station: StationHash(said.0),
    };
    V2xMessage {
        motion,
        parameters: None,
        horizon: None,
        route: Some(route(said)),
        pass: None,
        repeated: [None; REPEATED],
    }
}

/// A modem with this many slots, one of them in reserve, that has heard those stations for a second. Each station has
/// its number, leg, distance to the crossing point and arrival.
fn heard(slots: usize, stations: &[(u8, u8, i32, u32)]) -> Relay {
    let mut relay = Relay::new(Identifiers::DEFAULT);
    relay.limit(slots);
    let movement = Movement::straight(0);
    relay.set_out(Course::through(vec![Ahead { intersection: &CORNER, movement, at_m: 200.0 }]));
    relay.take(&Said::Route(route(OWN)));
    for fifth in 0..6 {
        for station in stations {
            relay.hear(f64::from(fifth) * 0.2, &message(*station), &mut Vec::new());
        }
    }
    relay
}

fn told(slots: usize, stations: &[(u8, u8, i32, u32)]) -> (u8, Option<i32>, u8) {
    let unserved = heard(slots, stations).unserved(1.0).unwrap();
    assert_eq!(unserved.intersection, 5);
    (unserved.legs, unserved.ahead.map(|ahead| ahead.to_mm()), unserved.stations)
}

/// A station ahead on the unit's own leg, with a slot.
const AHEAD: (u8, u8, i32, u32) = (2, 0, 60, 900);

#[test]
fn with_a_slot_for_everybody_there_is_nobody_to_tell_of() {
    assert_eq!(told(4, &[AHEAD, (3, 1, 50, 950)]), (0, None, 0));
}

#[test]
fn the_next_one_of_a_crossing_leg_without_a_slot_is_told_by_its_leg() {
    assert_eq!(told(2, &[AHEAD, (3, 1, 50, 950)]), (0b10, None, 1));
    // One station in the conflict area, and one just behind that area.
    assert_eq!(told(2, &[AHEAD, (3, 1, 3, 950)]).0, 0b10);
    assert_eq!(told(2, &[AHEAD, (3, 1, -10, 950)]).0, 0b10);
}

#[test]
fn who_arrived_later_or_is_far_or_has_left_bars_no_leg() {
    for other in [(3, 1, 50, 1_050), (3, 1, 85, 950), (3, 1, -17, 950)] {
        assert_eq!(told(2, &[AHEAD, other]).0, 0, "{other:?}");
    }
    // A station behind one that has a slot and enters first.
    assert_eq!(told(3, &[AHEAD, (3, 1, 20, 950), (4, 1, 50, 960)]).0, 0);
}

#[test]
fn the_nearest_one_ahead_without_a_slot_is_told_by_its_rear_bumper() {
    // No station publishes its length, so it is taken as 20 m.
    assert_eq!(told(2, &[AHEAD, (3, 0, 30, 800), (4, 0, 10, 700)]), (0, Some(50_000), 2));
}

#[test]
fn all_that_come_to_the_intersection_without_a_slot_are_counted_also_who_arrived_later() {
    assert_eq!(told(2, &[AHEAD, (3, 1, 50, 1_050), (4, 1, 70, 1_060)]), (0, None, 2));
}

#[test]
fn off_the_route_there_is_nothing_to_tell() {
    assert_eq!(Relay::new(Identifiers::DEFAULT).unserved(1.0), None);
}

#[test]
fn the_next_one_of_a_leg_gets_the_slot_of_those_behind_it() {
    let relay = heard(3, &[AHEAD, (3, 1, 50, 950), (4, 1, 20, 940)]);
    let has_slot = |station| relay.slots.iter().flatten().any(|tenant| tenant.station == StationHash(station));
    assert_eq!([2, 3, 4].map(has_slot), [true, false, true]);
}
