//! Whom a modem relays when more are heard than there are slots: a unit's way and what stations say of theirs enter; who is
//! decoded on the unit's bus leaves.

use holdover::coordination::{Intersection, Movement};
use holdover::time::{Instant, Stamp};
use holdover::units::{Acceleration, Distance, Speed};
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::route::Route;
use holdover::wire::{Identifiers, Message, Predecessor, Received, Receiver, Role, Said, StationHash};
use holdover_sim::sim::modem::{Ahead, Course, PEERS, REPEATED, Relay, SLOT_REUSE_S, V2xMessage};

/// Intersections 4, 5 and 6, 200 m apart, the first of them 180 m away.
static INTERSECTIONS: [Intersection; 3] = [intersection(4), intersection(5), intersection(6)];
const OWN_LEG: u8 = 1;

/// No way is on the map, so that every other leg crosses the own one.
const fn intersection(id: u8) -> Intersection {
    Intersection { id, half: Distance::ZERO, approaches: &[] }
}

fn way() -> Vec<Ahead> {
    let ahead = |(intersection, at_m)| Ahead { intersection, movement: Movement::straight(OWN_LEG), at_m };
    INTERSECTIONS.iter().zip([180.0, 380.0, 580.0]).map(ahead).collect()
}

fn route(intersection: u8, leg: u8, metres: i32) -> Route {
    let distance = Distance::from_mm(metres * 1000);
    let movement = Movement::straight(leg);
    let (stamp, predecessor) = (Stamp::from_raw(7), Predecessor::None);
    Route { tag: 0, intersection, movement, distance, stamp, arrival: 1, predecessor }
}

fn message(station: u8, route: Option<Route>) -> V2xMessage {
    let motion = Motion {
        tag: 0,
        position: WirePosition::from_mm(0),
        speed: Speed::ZERO,
        acceleration: Acceleration::ZERO,
        demand: Acceleration::ZERO,
        stamp: Stamp::from_raw(7),
        position_accuracy: None,
        speed_accuracy: None,
        station: StationHash(station),
    };
    V2xMessage { motion, parameters: None, horizon: None, route, pass: None, repeated: [None; REPEATED] }
}

/// A modem on the way to the first intersection, and what a unit makes of its frames.
struct Bus {
    relay: Relay,
    receiver: Receiver<PEERS>,
}

impl Bus {
    fn new() -> Self {
        let mut relay = Relay::new(Identifiers::DEFAULT);
        relay.set_out(Course::through(way()));
        relay.take(&Said::Route(route(4, OWN_LEG, 100)));
        // It has listened for long; this one names no intersection of the way.
        relay.hear(-10.0, &message(255, Some(route(9, 0, 50))), &mut Vec::new());
        Self { relay, receiver: Receiver::new(Identifiers::DEFAULT, Role::Unit) }
    }

    /// Whether a station's message gets onto the bus, and whether its route was there before its motion.
    fn hear(&mut self, at_s: f64, message: &V2xMessage) -> bool {
        self.slot(at_s, message).is_some()
    }

    /// The slot in which a station's message gets onto the bus.
    fn slot(&mut self, at_s: f64, message: &V2xMessage) -> Option<u8> {
        let mut frames = Vec::new();
        self.relay.hear(at_s, message, &mut frames);
        let (mut was_placed, mut in_slot) = (false, None);
        for frame in &frames {
            match self.receiver.receive(Instant::ZERO, frame) {
                Ok(Received::Whole(Message::Peer(_, Said::Route(_)))) => was_placed = true,
                Ok(Received::Whole(Message::Peer(slot, Said::Motion(_)))) => {
                    in_slot = Some(slot.0);
                    assert!(was_placed || message.route.is_none(), "the unit places a motion by the route before it");
                }
                _ => {}
            }
        }
        assert_eq!(in_slot.is_some(), !frames.is_empty());
        in_slot
    }
}

#[test]
fn a_station_that_names_no_intersection_of_the_way_is_not_relayed() {
    let mut bus = Bus::new();
    assert!(!bus.hear(0.0, &message(1, Some(route(9, 0, 50)))));
    assert!(!bus.hear(0.0, &message(2, None)));
    assert!(bus.hear(0.0, &message(3, Some(route(5, 0, 50)))));
    // It has long crossed, by another leg; on the own leg it is still the one ahead.
    assert!(!bus.hear(0.0, &message(4, Some(route(4, 0, -60)))));
    assert!(bus.hear(0.0, &message(5, Some(route(4, OWN_LEG, -60)))));
}

#[test]
fn an_intersection_that_has_been_crossed_does_not_matter_any_more() {
    let mut bus = Bus::new();
    bus.relay.take(&Said::Route(route(5, OWN_LEG, 150)));
    assert!(!bus.hear(0.0, &message(1, Some(route(4, 0, 50)))));
    assert!(bus.hear(0.0, &message(2, Some(route(6, 0, 50)))));
}

#[test]
fn a_more_relevant_station_is_heard_at_once_in_the_reserved_slot_and_a_less_relevant_one_never() {
    let mut bus = Bus::new();
    // All but the reserve go to stations at the next intersection but one.
    for station in 1..PEERS as u8 {
        assert!(bus.hear(0.0, &message(station, Some(route(5, 0, 10 * i32::from(station))))));
    }
    assert!(!bus.hear(0.0, &message(50, Some(route(6, 0, 20)))));
    assert_eq!(bus.relay.turned_away(), 1);
    assert!(bus.hear(0.1, &message(60, Some(route(4, 0, 80)))));
    let still_heard = (1..PEERS as u8)
        .filter(|station| bus.hear(0.2, &message(*station, Some(route(5, 0, 10 * i32::from(*station))))));
    assert_eq!(still_heard.count(), PEERS - 2);
    // The slot of the one that was put out rests before another one gets it.
    assert!(!bus.hear(0.3, &message(61, Some(route(4, 0, 70)))));
    assert!(bus.hear(SLOT_REUSE_S + 0.1, &message(61, Some(route(4, 0, 70)))));
}

#[test]
fn those_ahead_go_before_those_behind_and_the_nearest_first() {
    let mut bus = Bus::new();
    // Behind the own 100 m, at the same intersection.
    for station in 1..PEERS as u8 {
        assert!(bus.hear(0.0, &message(station, Some(route(4, 0, 110 + i32::from(station))))));
    }
    assert!(!bus.hear(0.1, &message(50, Some(route(4, 0, 170)))));
    assert!(bus.hear(0.1, &message(60, Some(route(4, 0, 20)))));
}

#[test]
fn after_a_pause_a_station_says_first_where_it_is() {
    let mut bus = Bus::new();
    assert!(bus.hear(0.0, &message(1, Some(route(4, 0, 50)))));
    assert!(bus.hear(0.1, &message(1, None)));
    assert!(!bus.hear(1.0, &message(1, None)));
    assert!(bus.hear(1.1, &message(1, Some(route(4, 0, 40)))));
}

#[test]
fn a_station_that_was_silent_while_it_left_is_heard_to_have_left() {
    let mut bus = Bus::new();
    assert!(bus.hear(0.0, &message(3, Some(route(4, 0, 20)))));
    // Then it was silent for 8 s. It has crossed by another leg, and turns to where the unit does not go.
    let heard: Vec<bool> = (0..8)
        .map(|tenths| bus.hear(8.0 + 0.1 * f64::from(tenths), &message(3, Some(route(4, 0, -60 - tenths)))))
        .collect();
    assert_eq!(heard, [true, true, true, true, false, false, false, false]);
    // It matters again, and then no more.
    assert!(bus.hear(9.0, &message(3, Some(route(5, 0, 150)))));
    assert!(bus.hear(9.1, &message(3, Some(route(9, 0, 150)))));
}

#[test]
fn the_two_just_ahead_on_the_own_leg_are_heard_wherever_they_are_and_however_long_they_are_silent() {
    let mut bus = Bus::new();
    // Every slot but the reserve goes to stations that arrive at the next intersection before the unit.
    for station in 1..PEERS as u8 {
        assert!(bus.hear(0.0, &message(station, Some(route(4, 0, 90 - i32::from(station))))));
    }
    // Beyond the next intersection, on the leg on which the unit comes to the one after it.
    assert!(bus.hear(0.1, &message(50, Some(route(5, OWN_LEG, 170)))));
    assert!(bus.hear(SLOT_REUSE_S + 0.2, &message(51, Some(route(5, OWN_LEG, 160)))));
    assert!(!bus.hear(2.0 * SLOT_REUSE_S + 0.3, &message(52, Some(route(5, OWN_LEG, 150)))));
    for station in 60..70 {
        bus.hear(2.0 * SLOT_REUSE_S + 0.4, &message(station, Some(route(4, 0, 95))));
    }
    assert!(bus.hear(2.0 * SLOT_REUSE_S + 0.5, &message(50, Some(route(5, OWN_LEG, 150)))));
}

#[test]
fn who_was_just_ahead_keeps_its_slot_when_the_unit_has_driven_past_where_it_was_heard_last() {
    let mut bus = Bus::new();
    let before = bus.slot(0.0, &message(1, Some(route(4, OWN_LEG, 80))));
    // It falls silent. The unit drives on, and more are heard than there are slots.
    for tenth in 1..=40 {
        let at_s = f64::from(tenth) * 0.1;
        bus.relay.take(&Said::Route(route(4, OWN_LEG, 100 - tenth)));
        for station in 2..40 {
            bus.hear(at_s, &message(station, Some(route(4, 2 + station % 2, 16 + i32::from(station)))));
        }
    }
    bus.relay.take(&Said::Route(route(4, OWN_LEG, 58)));
    let after = bus.slot(4.1, &message(1, Some(route(4, OWN_LEG, 40))));
    assert!(before.is_some() && after == before, "{before:?} {after:?}");
}

#[test]
fn who_was_put_out_of_its_slot_is_heard_to_have_left() {
    let mut bus = Bus::new();
    for station in 1..PEERS as u8 {
        assert!(bus.hear(0.0, &message(station, Some(route(5, 0, 10 * i32::from(station))))));
    }
    // The farthest one, of 190 m to go there, makes room.
    assert!(bus.hear(0.1, &message(60, Some(route(4, 0, 80)))));
    let out: Vec<u8> = (1..PEERS as u8)
        .filter(|station| !bus.hear(0.2, &message(*station, Some(route(5, 0, 10 * i32::from(*station))))))
        .collect();
    assert_eq!(out.len(), 1);
    let heard: Vec<bool> = (0..6)
        .map(|tenths| bus.hear(4.0 + 0.1 * f64::from(tenths), &message(out[0], Some(route(5, 0, -41)))))
        .collect();
    assert_eq!(heard, [true, true, true, true, false, false]);
}

/// The stations that are put out for 60 and 61, and the slots in which the unit has them. Station 60 has the slot that was in reserve, and the
/// slot of 61 rests.
fn put_out(bus: &mut Bus) -> Vec<(u8, u8)> {
    let at = |station: u8| message(station, Some(route(5, 0, 10 * i32::from(station))));
    let slots: Vec<(u8, u8)> =
        (1..PEERS as u8).map(|station| (station, bus.slot(0.0, &at(station)).unwrap())).collect();
    assert!(bus.hear(0.1, &message(60, Some(route(4, 0, 80)))));
    assert!(!bus.hear(0.2, &message(61, Some(route(4, 2, 80)))));
    slots.into_iter().filter(|(station, _)| !bus.hear(0.3, &at(*station))).collect()
}

/// The slots in which a station is relayed that has left, ten times a second from this time on.
fn heard_to_have_left(bus: &mut Bus, from_s: f64, station: u8) -> Vec<Option<u8>> {
    let at_s = |tenths| from_s + 0.1 * f64::from(tenths);
    (0..6).map(|tenths| bus.slot(at_s(tenths), &message(station, Some(route(5, 0, -41))))).collect()
}

#[test]
fn who_was_put_out_is_heard_to_have_left_if_the_next_station_falls_silent_before_it_is_relayed() {
    let mut bus = Bus::new();
    let out = put_out(&mut bus);
    assert_eq!(out.len(), 2, "{out:?}");
    for (from_s, (station, slot)) in [4.0, 6.0].into_iter().zip(out) {
        let (said, over) = (Some(slot), None);
        let heard = heard_to_have_left(&mut bus, from_s, station);
        assert_eq!(heard, [said, said, said, said, over, over], "{station}");
    }
    // The next station was put out for that, and has a slot again.
    assert!((0..30).any(|tenths| bus.hear(7.0 + 0.1 * f64::from(tenths), &message(61, Some(route(4, 2, 80))))));
}

#[test]
fn who_was_put_out_does_not_keep_the_next_station_from_its_slot_while_that_one_is_heard() {
    let mut bus = Bus::new();
    let out = put_out(&mut bus);
    let next = message(61, Some(route(4, 2, 80)));
    let rested = (0..30).map(|tenths| 0.4 + 0.1 * f64::from(tenths)).find_map(|at_s| {
        let others = out.iter().map(|(station, _)| message(*station, Some(route(5, 0, -41))));
        others.for_each(|other| _ = bus.slot(at_s, &other));
        Some((at_s, bus.slot(at_s, &next)?))
    });
    let (at_s, slot) = rested.unwrap();
    assert!(at_s <= SLOT_REUSE_S + 0.31 && out.iter().any(|(_, put_out)| *put_out == slot), "{at_s} s, {slot}");
}

#[test]
fn who_gets_another_slot_and_loses_it_before_it_is_relayed_is_heard_to_have_left_where_the_unit_has_it() {
    let mut bus = Bus::new();
    let (station, slot) = put_out(&mut bus)[0];
    // It comes near, gets a slot that rests, and turns off.
    assert!(!bus.hear(0.4, &message(station, Some(route(4, 3, 10)))));
    let heard = heard_to_have_left(&mut bus, 1.7, station);
    assert_eq!(heard[..4], [Some(slot); 4]);
}

#[test]
fn who_is_leaving_the_intersection_keeps_its_slot() {
    let mut bus = Bus::new();
    for station in 1..PEERS as u8 {
        assert!(bus.hear(0.0, &message(station, Some(route(4, 0, 20 - 4 * i32::from(station))))));
    }
    // Much nearer to the unit, which is 100 m before it. Of those who have not yet entered, the last one makes room.
    assert!(bus.hear(0.1, &message(60, Some(route(4, 0, 90)))));
    let still_heard = |station: &u8| bus.hear(0.2, &message(*station, Some(route(4, 0, 18 - 4 * i32::from(*station)))));
    let expected = (1..PEERS as u8).filter(|station| *station != 1);
    assert_eq!((1..PEERS as u8).filter(still_heard).collect::<Vec<_>>(), expected.collect::<Vec<_>>());
}

#[test]
fn who_fell_silent_before_the_intersection_keeps_its_slot_wherever_it_may_be_by_now() {
    let mut bus = Bus::new();
    let mut silent = message(1, Some(route(4, 0, 40)));
    silent.motion.speed = Speed::from_mm_per_s(12_000);
    assert!(bus.hear(0.0, &silent));
    // After 8 s it would be 56 m beyond; the others arrive at the same intersection.
    for round in 0..3 {
        for station in 10..30 {
            bus.hear(6.0 + f64::from(round), &message(station, Some(route(4, 0, 60 + i32::from(station)))));
        }
    }
    let mut frames = Vec::new();
    bus.relay.hear(8.1, &silent, &mut frames);
    assert!(!frames.is_empty());
}

#[test]
fn a_modem_listens_before_it_gives_a_slot_away_and_whoever_is_just_ahead_has_one_from_the_beginning() {
    let mut relay = Relay::new(Identifiers::DEFAULT);
    relay.set_out(Course::through(way()));
    let receiver = Receiver::new(Identifiers::DEFAULT, Role::Unit);
    let mut bus = Bus { relay, receiver };
    // Three times as many as there are slots, on all legs, and the one just ahead is the last to be heard.
    let others = (1..3 * PEERS as u8).map(|station| (station, route(4, station % 3 + 2, 2 * i32::from(station))));
    let all: Vec<(u8, Route)> = others.chain([(200, route(4, OWN_LEG, 150))]).collect();
    let mut round = |at_s: f64| -> Vec<u8> {
        let heard = all.iter().filter(|(station, route)| bus.hear(at_s, &message(*station, Some(*route))));
        heard.map(|(station, _)| *station).collect()
    };
    assert_eq!([0.0, 0.2, 0.4].map(|at_s| round(at_s).len()), [0; 3]);
    let heard = round(0.6);
    assert!(heard.contains(&200) && heard.len() == PEERS - 1, "{heard:?}");
    // Those in the conflict area (1, 2), the next one of every other leg (3, 4, 5) and, as it is there soon, the one behind it (6, 7, 8);
    // and of the others the nearest to the own 180 m.
    let far: Vec<u8> = heard.iter().copied().filter(|station| *station < 2 * PEERS as u8).collect();
    assert_eq!(far, [1, 2, 3, 4, 5, 6, 7, 8], "{heard:?}");
}

#[test]
fn the_first_on_every_other_leg_of_the_next_intersection_has_a_slot() {
    let mut bus = Bus::new();
    // All slots but the reserve go to stations nearer to the unit, which is 100 m before it, on one leg.
    for station in 1..PEERS as u8 {
        assert!(bus.hear(0.0, &message(station, Some(route(4, 0, 99 - i32::from(station))))));
    }
    assert!(bus.hear(0.1, &message(50, Some(route(4, 2, 20)))));
    assert!(!bus.hear(SLOT_REUSE_S + 0.2, &message(51, Some(route(4, 2, 30)))), "it comes after that one");
    assert!(bus.hear(SLOT_REUSE_S + 0.2, &message(52, Some(route(4, 3, 6)))));
    // When the first has left, the next one is the first.
    assert!(bus.hear(2.0 * SLOT_REUSE_S + 0.3, &message(50, Some(route(4, 2, -17)))));
    assert!(bus.hear(2.0 * SLOT_REUSE_S + 0.4, &message(51, Some(route(4, 2, 5)))));
}
