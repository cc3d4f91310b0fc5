//! A set speed that is lowered is reached and then kept, in every mode, with and without a range sensor, and on a way through
//! intersections.

use crate::rig;
use crate::rig::junction::{Driver, Junction};
use crate::rig::road::{ALL_BUT_RANGE, Road, Senses};
use holdover::config::Envelope;
use holdover::units::Seconds;

const OVERSHOOT: f64 = 0.05;

#[test]
fn a_lowered_speed_is_kept_in_every_mode() {
    for gap in [400, 1_000, 2_000] {
        for (v2x, range) in [(true, false), (true, true), (false, true), (false, false)] {
            for envelope in [false, true] {
                let mut config = rig::config();
                config.law.time_gap = Seconds::from_millis(gap);
                config.envelope = envelope.then_some(Envelope::CAR);
                let mut road = Road::new(&config, 20.0, 60.0);
                road.power_up();
                road.run(3.0);
                road.senses = Senses { v2x, range, ..ALL_BUT_RANGE };
                road.acceleration = 0.5;
                road.rig.wanted = 10.0;
                road.run(45.0);
                let mut fastest = 0.0f64;
                for _ in 0..2_000 {
                    road.step();
                    fastest = fastest.max(road.ego.speed);
                }
                assert!(fastest < 10.0 + OVERSHOOT, "{gap} {v2x} {range} {envelope}: {fastest}");
                road.rig.wanted = 14.0;
                let mut fastest = 0.0f64;
                for _ in 0..3_000 {
                    road.step();
                    fastest = fastest.max(road.ego.speed);
                }
                assert!(fastest < 14.0 + OVERSHOOT, "{gap} {v2x} {range} {envelope}: {fastest} of 14");
            }
        }
    }
}

#[test]
fn no_vehicle_exceeds_its_speed_through_intersections() {
    for envelope in [false, true] {
        let mut drivers = vec![
            Driver::new(0, 0, 60.0, 14.0, envelope),
            Driver::new(1, 0, 30.0, 12.0, envelope),
            Driver::new(2, 1, 50.0, 13.0, envelope),
            Driver::new(3, 1, 20.0, 11.0, envelope),
        ];
        drivers[1].body.speed = 10.0;
        let mut junction = Junction::new(drivers);
        let mut fastest = [0.0f64; 4];
        junction.run(60.0, |junction| {
            for (driver, fastest) in junction.drivers.iter().zip(&mut fastest) {
                *fastest = fastest.max(driver.body.speed - driver.target_speed);
            }
        });
        assert!(fastest.iter().all(|over| *over < OVERSHOOT), "{fastest:?}");
    }
}
