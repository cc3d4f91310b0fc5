//! A namesake of the vehicle ahead is heard while the vehicle ahead is silent: the ego goes on minding the vehicle that it followed.

use crate::rig;
use crate::rig::plant::Body;
use crate::rig::road::{ALL_BUT_RANGE, Road, Senses};
use crate::rig::{TARGET, m_of};
use holdover::config::Envelope;
use holdover::wire::{Message, Said, Slot};

const DEAF: Senses = Senses { v2x: false, ..ALL_BUT_RANGE };

fn road() -> Road {
    let mut config = rig::config();
    config.envelope = Some(Envelope::CAR);
    let mut road = Road::new(&config, 15.0, 25.0);
    road.power_up();
    road.run(3.0);
    road
}

fn speak(road: &mut Road, namesake: &Body) {
    let now = road.now;
    let motion = road.rig.motion(TARGET, now, namesake.position, namesake.speed, 0.0, 0.0, Some((0.05, 0.02)));
    let _ = road.rig.put(now, &Message::Peer(Slot(3), Said::Motion(motion)));
}

/// The namesake speaks at 10 Hz from `begins` on; the target falls silent at 1 s, and brakes to a stand from then on. The least gap.
fn least_gap(begins: f64, apart: f64) -> f64 {
    let mut road = road();
    let mut namesake = Body { position: road.target.position + apart, speed: 15.0 };
    let mut least = road.gap();
    for period in 0..2_000u32 {
        let seconds = f64::from(period) / 100.0;
        if period == 100 {
            road.senses = DEAF;
            road.acceleration = -3.0;
        }
        if period % 10 == 0 && seconds >= begins {
            speak(&mut road, &namesake);
        }
        road.step();
        namesake = namesake.after(0.0, 0.01);
        least = least.min(road.gap());
    }
    least
}

#[test]
fn a_namesake_that_is_heard_all_the_time_is_not_taken_for_the_silent_vehicle_ahead() {
    for apart in [60.0, 200.0] {
        let least = least_gap(0.0, apart);
        assert!(least > 0.0, "{apart}: {least}");
    }
}

#[test]
fn a_namesake_that_begins_to_speak_does_not_end_what_is_certain_of_the_silent_vehicle_ahead() {
    for begins in [2.5, 3.5, 5.0] {
        let least = least_gap(begins, 120.0);
        assert!(least > 0.0, "{begins}: {least}");
    }
}

#[test]
fn a_station_that_moves_to_another_slot_is_followed_there() {
    let mut road = road();
    road.senses = DEAF;
    road.run(2.5);
    for period in 0..300 {
        let target = road.target;
        if period % 10 == 0 {
            speak(&mut road, &target);
        }
        road.step();
    }
    let estimate = road.step().answer.estimate.expect("there is a target");
    assert!((m_of(estimate.reading.position) - road.target.position).abs() < 1.0);
}

/// Another station's motion in the target's slot.
fn take_its_slot(road: &mut Road, place: f64) {
    let now = road.now;
    let motion = road.rig.motion(holdover::wire::StationHash(9), now, place, 15.0, 0.0, 0.0, Some((0.05, 0.02)));
    let _ = road.rig.target(now, Said::Motion(motion));
}

#[test]
fn a_namesake_does_not_stand_for_the_vehicle_ahead_that_has_lost_its_slot() {
    for apart in [60.0, 120.0] {
        let mut road = road();
        let mut namesake = Body { position: road.target.position + apart, speed: 15.0 };
        let mut other = road.target.position - 300.0;
        road.senses = DEAF;
        road.acceleration = -3.0;
        let mut least = road.gap();
        for period in 0..2_000u32 {
            if period % 10 == 0 {
                speak(&mut road, &namesake);
                if period > 250 {
                    take_its_slot(&mut road, other);
                }
            }
            road.step();
            namesake = namesake.after(0.0, 0.01);
            other += 0.15;
            least = least.min(road.gap());
        }
        assert!(least > 0.0, "{apart}: {least}");
    }
}
