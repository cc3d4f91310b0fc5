//! What another station says in a slot before its first motion is not of whom the slot was before, and what was said there long
//! before a first motion is not of whom that names.

use crate::rig;
use crate::rig::road::Road;
use crate::rig::{LENGTH, SLOT, TARGET, instant, m_of, metres, parameters};
use holdover::Config;
use holdover::config::Envelope;
use holdover::health::Cause;
use holdover::wire::driving_parameters::DrivingParameters;
use holdover::wire::{Message, Said, StationHash};

/// What a lorry is longer than the rig's target.
const LONGER: f64 = 18.0 - LENGTH;
const ANOTHER: StationHash = StationHash(9);

fn careful() -> Config {
    let mut config = rig::config();
    config.envelope = Some(Envelope::CAR);
    config
}

/// Follows a lorry for 3 s, which then falls silent and brakes with all that it has.
fn behind_a_lorry() -> Road {
    let mut road = Road::new(&careful(), 20.0, 22.0);
    road.rig.wanted = 25.0;
    road.senses.v2x = false;
    road.engaged = false;
    for tick in 0..300 {
        road.engaged = tick >= 200;
        let now = road.now;
        if now % 100_000 == 0 {
            let (position, speed) = (road.target.position + LONGER, road.target.speed);
            let motion = road.rig.motion(TARGET, now, position, speed, 0.0, 0.0, Some((0.05, 0.02)));
            let _ = road.rig.target(now, Said::Motion(motion));
        }
        if now % 500_000 == 0 {
            let _ = road.rig.target(
                now,
                Said::DrivingParameters(DrivingParameters { length: metres(18.0), ..parameters(2.5, 8.0) }),
            );
        }
        road.step();
    }
    road.acceleration = -8.0;
    road.run(2.2);
    road
}

fn least_gap(road: &mut Road, seconds: f64) -> f64 {
    let ticks = (seconds * 100.0) as u64;
    (0..ticks).fold(road.gap(), |least, _| {
        road.step();
        least.min(road.gap())
    })
}

#[test]
fn the_next_stations_parameters_do_not_shorten_who_has_fallen_silent() {
    for is_named in [false, true] {
        let mut road = behind_a_lorry();
        let now = road.now;
        // Its slot is another one's now, of which the first motion is lost.
        let said = road.rig.put(now, &Message::Peer(SLOT, Said::DrivingParameters(parameters(2.5, 8.0))));
        assert_eq!(said, Err(Cause::StationConflict));
        if is_named {
            let place = road.target.position + 300.0;
            let motion = road.rig.motion(ANOTHER, now, place, 20.0, 0.0, 0.0, Some((0.05, 0.02)));
            road.rig.target(now, Said::Motion(motion)).unwrap();
            road.rig.target(now, Said::DrivingParameters(parameters(2.5, 8.0))).unwrap();
        }
        let least = least_gap(&mut road, 20.0);
        assert!(least > 0.0, "{is_named}: {least}");
    }
}

#[test]
fn it_may_say_again_what_it_said_when_its_motion_has_come() {
    let mut road = behind_a_lorry();
    let (now, place) = (road.now, road.target.position + LONGER);
    let motion = road.rig.motion(TARGET, now, place, road.target.speed, -8.0, -8.0, Some((0.05, 0.02)));
    road.rig.target(now, Said::Motion(motion)).unwrap();
    let longer = DrivingParameters { length: metres(20.0), ..parameters(2.5, 8.0) };
    assert_eq!(road.rig.target(now, Said::DrivingParameters(longer)), Ok(()));
    assert_eq!(road.rig.unit.peers().get(2).unwrap().parameters().unwrap().length, metres(20.0));
}

/// A slot in which somebody said how it drives and no more; after that silence another one, which says nothing of that, is followed
/// there.
fn after_parameters_of_nobody(said: &DrivingParameters, silence: f64) -> Road {
    let mut road = Road::new(&careful(), 20.0, 30.0);
    road.senses.v2x = false;
    road.engaged = false;
    road.run(1.0);
    for _ in 0..3 {
        let now = road.now;
        road.rig.target(now, Said::DrivingParameters(*said)).ok();
    }
    road.run(silence);
    for _ in 0..200 {
        if road.now % 100_000 == 0 {
            let (now, place, speed) = (road.now, road.target.position, road.target.speed);
            let motion = road.rig.motion(TARGET, now, place, speed, 0.0, 0.0, Some((0.05, 0.02)));
            let _ = road.rig.target(now, Said::Motion(motion));
        }
        road.step();
    }
    road
}

#[test]
fn what_was_said_in_a_slot_long_before_the_first_motion_is_not_that_ones() {
    let mut road = after_parameters_of_nobody(&DrivingParameters { length: metres(2.0), ..parameters(1.0, 2.0) }, 2.5);
    // It brakes with what is taken for the hardest where nothing was published.
    road.acceleration = -12.0;
    for _ in 0..200 {
        road.step();
        let bound = road.rig.unit.bound(2, instant(road.now)).unwrap();
        assert!(m_of(bound.lowest_position()) <= road.target.position);
    }
    assert_eq!(road.rig.unit.peers().get(2).unwrap().parameters(), None);
}

#[test]
fn what_was_sent_just_before_the_first_motion_is_of_its_station() {
    let said = parameters(1.0, 5.0);
    let road = after_parameters_of_nobody(&said, 1.5);
    assert_eq!(road.rig.unit.peers().get(2).unwrap().parameters(), Some(&said));
}

#[test]
fn a_length_that_was_said_long_before_counts_if_it_is_long() {
    let road = after_parameters_of_nobody(&DrivingParameters { length: metres(18.0), ..parameters(1.0, 2.0) }, 2.5);
    let track = road.rig.unit.peers().get(2).unwrap();
    assert_eq!(track.parameters().map(|parameters| parameters.length), Some(metres(18.0)));
    assert_eq!(track.reach(), holdover::model::bound::AccelerationRange::WORST);
}
