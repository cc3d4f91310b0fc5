//! Two vehicles whose stations have the same 8-bit hash: both are known, each by its slot, and a name means the nearest vehicle ahead
//! that bears it.

use crate::rig;
use crate::rig::plant::Body;
use crate::rig::road::Road;
use crate::rig::{TARGET, m_of};
use holdover::controller::Mode;
use holdover::health::Cause;
use holdover::wire::{Message, Said, Slot, StationHash};

const OTHER: Slot = Slot(3);

/// The namesake speaks at 10 Hz from its place, this far ahead of the target; what became of its motions, without the two that an
/// identifier takes to be trusted.
fn drive(road: &mut Road, namesake: &mut Body, seconds: f64) -> Vec<Result<(), Cause>> {
    let mut verdicts = Vec::new();
    for period in 0..(seconds * 100.0) as u32 {
        if period % 10 == 0 {
            let now = road.now;
            let motion = road.rig.motion(TARGET, now, namesake.position, namesake.speed, 0.0, 0.0, Some((0.05, 0.02)));
            verdicts.push(road.rig.put(now, &Message::Peer(OTHER, Said::Motion(motion))));
        }
        road.step();
        *namesake = namesake.after(0.0, 0.01);
    }
    verdicts.drain(..2.min(verdicts.len()));
    verdicts
}

fn newest(road: &Road, slot: usize) -> f64 {
    m_of(road.rig.unit.peers().get(slot).and_then(|track| track.newest()).expect("it was heard").position)
}

#[test]
fn both_are_heard_wherever_they_are() {
    for apart in [-300.0, -40.0, 10.0, 60.0, 500.0] {
        let mut road = Road::new(&rig::config(), 15.0, 25.0);
        road.power_up();
        road.run(2.0);
        let mut namesake = Body { position: road.target.position + apart, speed: 15.0 };
        let verdicts = drive(&mut road, &mut namesake, 5.0);
        assert!(verdicts.iter().all(Result::is_ok), "{apart}: {verdicts:?}");
        assert!((newest(&road, 3) - namesake.position).abs() < 2.0, "{apart}");
        assert!((newest(&road, 2) - road.target.position).abs() < 2.0, "{apart}");
    }
}

#[test]
fn the_name_of_the_predecessor_means_the_nearest_ahead() {
    for apart in [-300.0, -40.0, 60.0, 500.0] {
        let mut road = Road::new(&rig::config(), 15.0, 25.0);
        road.power_up();
        road.run(2.0);
        let mut namesake = Body { position: road.target.position + apart, speed: 15.0 };
        drive(&mut road, &mut namesake, 3.0);
        let heard = road.step();
        let estimate = heard.answer.estimate.expect("there is a target");
        assert!((m_of(estimate.reading.position) - road.target.position).abs() < 1.0, "{apart}");
        road.acceleration = -3.0;
        let least = road.run_to_rest();
        assert!(least > 0.0, "{apart}: {least}");
    }
}

#[test]
fn a_motion_of_the_same_name_in_another_slot_and_the_same_place_is_a_conflict() {
    let mut road = Road::new(&rig::config(), 15.0, 25.0);
    road.power_up();
    road.run(2.0);
    let mut same = road.target;
    let verdicts = drive(&mut road, &mut same, 1.0);
    assert!(verdicts.iter().all(|verdict| *verdict == Err(Cause::StationConflict)), "{verdicts:?}");
}

#[test]
fn a_late_motion_in_another_slot_is_of_the_target_that_the_range_sensor_sees() {
    const LATE: i64 = 150_000; // µs; the target drives 2.25 m in this time, and the sensor says where it is to within less
    let mut road = Road::new(&rig::config(), 15.0, 25.0);
    road.senses.range = true;
    road.power_up();
    road.run(2.0);
    road.senses.v2x = false;
    road.run(3.0);
    let mut heard = road.step();
    for period in 0..200 {
        if period % 10 == 0 {
            let (now, then) = (road.now, road.now - LATE);
            let position = road.target.position - 15.0 * LATE as f64 / 1e6;
            let motion = road.rig.motion(TARGET, then, position, road.target.speed, 0.0, 0.0, Some((0.05, 0.02)));
            let _ = road.rig.put(now, &Message::Peer(OTHER, Said::Motion(motion)));
        }
        heard = road.step();
    }
    assert_eq!(heard.answer.mode, Mode::Cooperative);
    assert_eq!(road.rig.unit.peers().get(2).expect("a slot").station(), None, "the slot that it left is free");
}

#[test]
fn the_target_stays_minded_when_it_has_a_new_name_and_its_old_one_is_that_of_a_vehicle_far_ahead() {
    const NEW: StationHash = StationHash(9);
    let mut config = rig::config();
    config.envelope = Some(holdover::config::Envelope::CAR);
    let mut road = Road::new(&config, 15.0, 25.0);
    road.power_up();
    road.run(2.0);
    road.senses.v2x = false;
    let mut far = Body { position: road.target.position + 200.0, speed: 15.0 };
    for period in 0..300 {
        if period % 10 == 0 {
            let (now, target) = (road.now, road.target);
            let named = road.rig.motion(NEW, now, target.position, target.speed, 0.0, 0.0, Some((0.05, 0.02)));
            let _ = road.rig.put(now, &Message::Peer(Slot(2), Said::Motion(named)));
            let other = road.rig.motion(TARGET, now, far.position, far.speed, 0.0, 0.0, Some((0.05, 0.02)));
            let _ = road.rig.put(now, &Message::Peer(OTHER, Said::Motion(other)));
        }
        road.step();
        far = far.after(0.0, 0.01);
    }
    road.acceleration = -8.0;
    let least = road.run_to_rest();
    assert!(least > 0.0, "{least}");
}
