//! The driver's speed is a cap: a vehicle that catches up stays below it, unless it is configured to exceed it, and says so.

use crate::rig;
use crate::rig::road::{Road, Senses};
use holdover::units::Fraction;
use holdover::wire::{Message, Said};

const WANTED: f64 = 13.4;
/// What the lag of the actuators makes of an approach to the cap.
const OVERSHOOT: f64 = 0.05;

/// The fastest that the ego gets in a minute behind a target that drives at this speed, 120 m ahead at first.
fn fastest(catch_up_milli: i32, target: f64, senses: Senses) -> f64 {
    let mut config = rig::config();
    config.law.catch_up = Fraction::from_milli(catch_up_milli);
    let mut road = Road::new(&config, 10.0, 120.0);
    road.rig.wanted = WANTED;
    road.target.speed = target;
    road.wants = target;
    road.power_up();
    road.senses = senses;
    let mut fastest = 0.0f64;
    for _ in 0..6_000 {
        road.step();
        fastest = fastest.max(road.ego.speed);
    }
    fastest
}

#[test]
fn the_ego_never_exceeds_the_drivers_speed_to_catch_up() {
    for target in [9.0, 13.0, 13.4, 16.0, 30.0] {
        let fastest = fastest(0, target, rig::road::ALL_BUT_RANGE);
        assert!(fastest < WANTED + OVERSHOOT, "{fastest} m/s behind {target} m/s");
    }
}

#[test]
fn the_ego_exceeds_it_by_the_share_that_is_configured_and_no_more() {
    for (share, target) in [(200, 16.0), (100, 16.0), (750, 30.0)] {
        let cap = WANTED * (1.0 + f64::from(share) / 1e3);
        let fastest = fastest(share, target, rig::road::ALL_BUT_RANGE);
        assert!(fastest < cap + OVERSHOOT && fastest > cap - 0.5, "{fastest} m/s of {cap} m/s");
    }
}

#[test]
fn the_share_is_published() {
    for share in [0, 50, 200, 750] {
        let mut config = rig::config();
        config.law.catch_up = Fraction::from_milli(share);
        let mut road = Road::new(&config, 10.0, 60.0);
        road.power_up();
        let mut told = None;
        for _ in 0..200 {
            for message in road.step().all {
                if let Message::Own(Said::DrivingParameters(parameters)) = message {
                    told = Some(parameters.catch_up);
                }
            }
        }
        assert_eq!(told, Some(Fraction::from_milli(share)));
    }
}
