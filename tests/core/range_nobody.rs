//! The range sensor sees that no vehicle is near: the near ends of silent vehicles are not nearer than that, what was seen there has
//! gone, and a target that would have to be there is not where it is held to be.

use crate::rig::road::Road;
use crate::rig::{LENGTH, config, instant, m_of};
use holdover::config::Envelope;
use holdover::{Config, health::Cause};

/// How far ahead the sensor sees nobody.
const FREE: f64 = 80.0;

/// Following at 12 m/s; then the target falls silent for good, and leaves the path after three seconds. The ego's sensor sees it until
/// then, and then nothing; or that nobody is there.
fn left_behind(says_nobody: bool) -> Road {
    let mut road = Road::new(&Config { range_sensor: true, envelope: Some(Envelope::CAR), ..config() }, 12.0, 25.0);
    road.wants = 12.0;
    road.senses.range = true;
    road.power_up();
    road.run(1.01);
    (road.senses.v2x, road.senses.range) = (false, true);
    road.run(3.0);
    road.senses.range = false;
    for step in 0..1_000 {
        if says_nobody && step % 2 == 0 {
            let _ = road.rig.nobody(road.now, FREE, 0);
        }
        road.step();
    }
    road
}

#[test]
fn one_that_fell_silent_and_left_the_path_does_not_stop_the_ego_that_sees_nobody() {
    let (sees, does_not) = (left_behind(true), left_behind(false));
    assert!(sees.ego.speed > 8.0, "{}", sees.ego.speed);
    assert!(does_not.ego.speed < 1.0, "{}", does_not.ego.speed);
}

#[test]
fn what_is_certain_of_a_silent_vehicle_is_beyond_what_is_free_and_the_truth_stays_inside() {
    let mut road = Road::new(&config(), 12.0, 90.0);
    road.senses.range = true;
    road.power_up();
    road.run(1.01);
    (road.senses.v2x, road.senses.range) = (false, false);
    road.acceleration = 1.0;
    for step in 0..400 {
        let seen = road.gap() - 0.2;
        let free = road.ego.position + seen;
        if step % 2 == 0 {
            let _ = road.rig.nobody(road.now, seen, 0);
        }
        road.step();
        let bound = road.rig.unit.bound(2, instant(road.now)).unwrap();
        let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
        assert!((low..=high).contains(&road.target.position), "{step}: {} in {low}..{high}", road.target.position);
        // Three times the accuracy of 0.2 m, 0.15 m of the ego's own, and its way in 3 ms.
        assert!(step % 2 == 1 || low > free + LENGTH - 1.0, "{step}: {low}, free up to {free}");
    }
}

#[test]
fn a_target_that_would_have_to_be_in_what_is_free_is_a_contradiction() {
    let mut road = Road::new(&config(), 12.0, 25.0);
    road.senses.range = true;
    road.power_up();
    road.run(1.01);
    road.senses.range = false;
    for views in 1..=3 {
        let _ = road.rig.nobody(road.now, FREE, 0);
        road.run(0.02);
        assert_eq!(road.rig.unit.health().of(Cause::RangeDisagrees), u32::from(views == 3), "{views}");
    }
}
