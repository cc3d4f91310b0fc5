//! The modem alone: messages enter, and what a unit decodes from the relayed frames is checked against the rules.

use super::*;
use holdover::time::{Instant, Stamp};
use holdover::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};
use holdover::wire::driving_parameters::Limits;
use holdover::wire::horizon::Knots;
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::{Predecessor, Received, Receiver, Role};

fn message(station: u8, parameters: Option<DrivingParameters>) -> V2xMessage {
    let motion = Motion {
        tag: 1,
        position: WirePosition::from_mm(i64::from(station) * 1000),
        speed: Speed::from_mm_per_s(10_000),
        acceleration: Acceleration::ZERO,
        demand: Acceleration::ZERO,
        stamp: Stamp::from_raw(7),
        position_accuracy: None,
        speed_accuracy: None,
        station: StationHash(station),
    };
    V2xMessage { motion, parameters, horizon: None, route: None, pass: None, repeated: [None; REPEATED] }
}

fn parameters(target_speed: i32) -> DrivingParameters {
    DrivingParameters {
        length: Distance::from_mm(4800),
        standstill: Distance::from_mm(2000),
        predecessor: Predecessor::None,
        target_speed: Speed::from_mm_per_s(target_speed),
        catch_up: Fraction::from_milli(200),
        time_gap: Seconds::from_millis(1000),
        gain: Gain::from_milli(500),
        damping: Seconds::from_millis(2000),
        feed_forward: Fraction::ZERO,
        lag: FineSeconds::from_millis(300),
        limits: Limits {
            acceleration: Acceleration::from_mm_per_s2(2000),
            braking: Acceleration::from_mm_per_s2(4000),
            jerk: Jerk::from_mm_per_s3(5000),
            emergency_braking: Acceleration::from_mm_per_s2(8000),
        },
        horizon_tenths: 39,
    }
}

/// What a unit decodes from the relayed frames: slot and station of each motion, and the number of driving parameters.
struct Unit {
    relay: Relay,
    receiver: Receiver<PEERS>,
}

impl Unit {
    fn new() -> Self {
        let identifiers = Identifiers::DEFAULT;
        let mut unit = Self { relay: Relay::new(identifiers), receiver: Receiver::new(identifiers, Role::Unit) };
        // The receiver trusts an identifier from its second frame on.
        for station in 1..=PEERS as u8 {
            unit.hear(-10.0, &message(station, Some(parameters(1))));
            unit.hear(-10.0, &message(station, Some(parameters(2))));
        }
        unit
    }

    fn hear(&mut self, at_s: f64, message: &V2xMessage) -> (Vec<(u8, u8)>, usize) {
        let mut frames = Vec::new();
        self.relay.hear(at_s, message, &mut frames);
        let (mut motions, mut parameter_messages) = (Vec::new(), 0);
        for frame in &frames {
            match self.receiver.receive(Instant::ZERO, frame) {
                Ok(Received::Whole(Message::Peer(slot, Said::Motion(motion)))) => {
                    motions.push((slot.0, motion.station.0));
                }
                Ok(Received::Whole(Message::Peer(_, Said::DrivingParameters(_)))) => parameter_messages += 1,
                _ => {}
            }
        }
        (motions, parameter_messages)
    }
}

#[test]
fn a_station_keeps_its_slot_and_a_ninth_is_turned_away_while_all_are_heard() {
    let mut unit = Unit::new();
    for round in 0..5 {
        let at_s = f64::from(round) * 0.1;
        for station in 1..=PEERS as u8 {
            assert_eq!(unit.hear(at_s, &message(station, None)).0, [(station - 1, station)]);
        }
        assert_eq!(unit.hear(at_s, &message(99, None)).0, []);
    }
    assert_eq!(unit.relay.turned_away(), 5);
}

#[test]
fn the_station_silent_for_longest_makes_room_when_it_has_been_for_two_seconds() {
    let mut unit = Unit::new();
    for station in 1..=PEERS as u8 {
        unit.hear(f64::from(station) * 0.01, &message(station, None));
    }
    assert_eq!(unit.hear(2.009, &message(99, None)).0, []);
    assert_eq!(unit.hear(2.01, &message(99, None)).0, [(0, 99)]);
    // The station that lost its slot counts as a new station now.
    assert_eq!(unit.hear(2.02, &message(1, None)).0, [(1, 1)]);
}

#[test]
fn whom_the_driver_told_it_to_follow_has_a_slot_kept_while_the_unit_names_nobody() {
    let mut relay = Relay::new(Identifiers::DEFAULT);
    relay.set_out(Course::behind(StationHash(99)));
    relay.take(&Said::DrivingParameters(DrivingParameters { predecessor: Predecessor::Unknown, ..parameters(1) }));
    for station in (1..=PEERS as u8).chain([99]) {
        let mut frames = Vec::new();
        relay.hear(0.0, &message(station, None), &mut frames);
        assert_eq!(frames.is_empty(), usize::from(station) == PEERS, "{station}");
    }
}

#[test]
fn driving_parameters_are_relayed_when_they_change_and_otherwise_twice_a_second() {
    let mut unit = Unit::new();
    assert_eq!(unit.hear(0.0, &message(3, Some(parameters(11_000)))).1, 1);
    for tenth in 1..5 {
        assert_eq!(unit.hear(f64::from(tenth) * 0.1, &message(3, Some(parameters(11_000)))).1, 0);
    }
    assert_eq!(unit.hear(0.5, &message(3, Some(parameters(11_000)))).1, 1);
    assert_eq!(unit.hear(0.6, &message(3, Some(parameters(12_000)))).1, 1);
}

#[test]
fn a_horizon_is_broadcast_only_with_the_motion_it_was_computed_from() {
    let knots = |tag| Knots { tag, ..Knots { tag: 0, knots: Default::default() } };
    let mut transmitter = Transmitter::default();
    transmitter.take(&Said::Horizon(knots(1)));
    assert_eq!(transmitter.broadcast(|| [None; REPEATED]), None);
    transmitter.take(&Said::Motion(message(1, None).motion));
    transmitter.take(&Said::Horizon(knots(2)));
    assert_eq!(transmitter.broadcast(|| [None; REPEATED]).unwrap().horizon, None);
    transmitter.take(&Said::Motion(message(1, None).motion));
    transmitter.take(&Said::Horizon(knots(1)));
    assert_eq!(transmitter.broadcast(|| [None; REPEATED]).unwrap().horizon, Some(knots(1)));
    assert_eq!(transmitter.broadcast(|| [None; REPEATED]), None);
}
