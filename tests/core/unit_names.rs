//! Whom the driver has put ahead is minded through changes of its name and of its slot: frames of one vehicle under other
//! names and in other slots enter, the ego's plant is float64.

use crate::rig;
use crate::rig::road::Road;
use crate::rig::{TARGET, config, metres, parameters};
use holdover::config::Envelope;
use holdover::health::Cause;
use holdover::units::Distance;
use holdover::wire::command::ModeCode;
use holdover::wire::driving_parameters::DrivingParameters;
use holdover::wire::{Message, Predecessor, Said, Slot, StationHash};

const NEW_NAME: StationHash = StationHash(77);
const OTHER: StationHash = StationHash(78);
const SPEED: f64 = 19.0;

/// Behind a vehicle at its speed, with the envelope.
fn road() -> Road {
    let mut road = Road::new(&holdover::Config { envelope: Some(Envelope::CAR), ..config() }, SPEED, 30.0);
    road.wants = SPEED;
    road.power_up();
    road.run(3.0);
    road
}

/// A motion of the vehicle ahead by this name in this slot, so far from where it is.
fn say(road: &mut Road, station: StationHash, slot: Slot, off: f64, accuracy: f64) -> Result<(), Cause> {
    let (now, body, a) = (road.now, road.target, road.acceleration);
    let motion = road.rig.motion(station, now, body.position + off, body.speed, a, a, Some((accuracy, 0.02)));
    road.rig.put(now, &Message::Peer(slot, Said::Motion(motion)))
}

/// The vehicle ahead brakes to a stand, and does not speak by its old name any more; `speaks` says what is heard at 10 Hz.
fn least_gap(road: &mut Road, mut speaks: impl FnMut(&mut Road)) -> f64 {
    road.senses.v2x = false;
    road.acceleration = -8.0;
    let mut least = road.gap();
    for period in 0..1_500 {
        if period % 10 == 0 {
            speaks(road);
        }
        road.step();
        least = least.min(road.gap());
    }
    assert!(road.ego.speed < 0.1, "it stands in the end");
    least
}

#[test]
fn a_new_name_that_follows_on_is_the_same_vehicle() {
    let mut road = road();
    road.predecessor = Predecessor::Station(NEW_NAME);
    let mut refused = 0;
    let least = least_gap(&mut road, |road| {
        refused += u32::from(say(road, NEW_NAME, rig::SLOT, 0.0, 0.05).is_err());
    });
    assert_eq!(refused, 0);
    assert_eq!(road.rig.unit.peers().named(NEW_NAME).next(), Some(2));
    assert!(road.rig.unit.peers().get(2).is_some_and(|track| track.parameters().is_some()), "what it said holds");
    assert!(least > 0.3, "{least}");
}

#[test]
fn a_new_name_where_another_vehicle_could_be_is_a_conflict() {
    for (off, accuracy) in [(1.5, 0.05), (-6.0, 0.05), (0.0, 0.75)] {
        let mut road = road();
        road.senses.v2x = false;
        road.run(0.1);
        assert_eq!(say(&mut road, NEW_NAME, rig::SLOT, off, accuracy), Err(Cause::StationConflict), "{off} {accuracy}");
        assert_eq!(road.rig.unit.peers().get(2).and_then(|track| track.station()), Some(TARGET));
    }
}

#[test]
fn a_name_that_nobody_was_heard_by_does_not_end_what_is_certain_of_the_vehicle_ahead() {
    let mut road = road();
    road.predecessor = Predecessor::Station(OTHER);
    let least = least_gap(&mut road, |_| ());
    assert!(least > 0.3, "{least}");
}

#[test]
fn a_driver_who_says_that_nobody_is_ahead_is_believed() {
    let mut road = road();
    road.senses.v2x = false;
    road.predecessor = Predecessor::None;
    road.run(12.0);
    assert!(road.ego.speed > SPEED, "{}", road.ego.speed);
}

#[test]
fn the_vehicle_ahead_is_minded_when_its_slot_is_given_to_another_one() {
    let mut road = road();
    road.senses.v2x = false;
    let mut least = f64::MAX;
    for period in 0..2_500 {
        if period == 150 {
            road.acceleration = -8.0;
        }
        // The other one comes after two seconds of silence, and is far ahead.
        if period >= 210 && period % 10 == 0 {
            let _ = say(&mut road, OTHER, rig::SLOT, 150.0, 0.05);
        }
        road.step();
        least = least.min(road.gap());
    }
    assert_eq!(road.rig.unit.peers().get(2).and_then(|track| track.station()), Some(OTHER));
    assert!(least > 0.3, "{least}");
}

#[test]
fn what_a_station_said_of_itself_holds_in_its_next_slot() {
    let mut road = road();
    let long = DrivingParameters { length: metres(18.0), ..parameters(2.5, 8.0) };
    road.senses.v2x = false;
    for _ in 0..2 {
        let _ = road.rig.target(road.now, Said::DrivingParameters(long));
    }
    road.run(2.2);
    for _ in 0..3 {
        let _ = say(&mut road, TARGET, Slot(0), 0.0, 0.05);
        road.run(0.1);
    }
    let track = road.rig.unit.peers().get(0).unwrap();
    assert_eq!(track.station(), Some(TARGET));
    let length = track.parameters().map(|parameters| parameters.length);
    assert!(length.is_some_and(|length| length.minus(metres(18.0)).magnitude() < Distance::from_mm(10)), "{length:?}");
}

#[test]
fn a_view_as_old_as_the_sensor_can_say_is_taken() {
    for age_ms in [0, 40, 55, 63] {
        let mut road = road();
        let (now, gap) = (road.now, road.gap());
        let _ = road.rig.range(now, gap, 0.0, age_ms);
        assert_eq!(road.rig.range(now, gap, 0.0, age_ms), Ok(()), "{age_ms} ms");
    }
}

/// The commands of 4 s, in which the vehicle ahead speaks by this name. The driver names it so only after 2 s.
fn commands_behind(name: StationHash) -> Vec<f64> {
    let mut road = road();
    road.senses.v2x = false;
    for tick in 0..400 {
        if tick == 200 {
            road.predecessor = Predecessor::Station(name);
        }
        if tick % 10 == 0 {
            say(&mut road, name, rig::SLOT, 0.0, 0.05).unwrap();
        }
        let heard = road.step();
        assert_eq!((heard.command.mode, heard.estimate.is_some()), (ModeCode::Cooperative, true), "tick {tick}");
        for message in heard.all {
            if let Message::Own(Said::DrivingParameters(own)) = message {
                assert_eq!(own.predecessor, Predecessor::Station(name), "others know it by that name only");
            }
        }
    }
    road.commands
}

#[test]
fn a_vehicle_that_has_taken_a_new_name_is_followed_before_the_driver_names_it_anew() {
    // The horizon starts anew at the change, 100 ms before it would have.
    let both = commands_behind(NEW_NAME).into_iter().zip(commands_behind(TARGET));
    let apart = both.map(|(new, old)| (new - old).abs()).fold(0.0, f64::max);
    assert!(apart < 0.03, "{apart} m/s²");
}

#[test]
fn a_vehicle_with_a_new_name_is_not_followed_when_the_driver_names_another_one() {
    let mut road = road();
    road.senses.v2x = false;
    for tick in 0..200 {
        if tick == 100 {
            road.predecessor = Predecessor::Station(OTHER);
        }
        if tick % 10 == 0 {
            say(&mut road, NEW_NAME, rig::SLOT, 0.0, 0.05).unwrap();
        }
        let mode = road.step().command.mode;
        assert_eq!(mode == ModeCode::Fallback, tick >= 100, "tick {tick}: {mode:?}");
    }
}
