//! Without the envelope too, the ego stays able to stop behind a vehicle that it sees brake, though nothing is heard.

use crate::rig;
use crate::rig::road::Road;
use holdover::Config;

/// Following at 15 m/s, this far behind, without the envelope; then a silence of the radio, in which the range sensor goes on.
fn silent(gap: f64) -> Road {
    let mut config = Config { envelope: None, ..rig::config() };
    config.law.time_gap = holdover::units::Seconds::from_millis(((gap - 2.0) / 15.0 * 1_000.0).round() as i32);
    let mut road = Road::steady(&config, 15.0, gap);
    road.senses.v2x = false;
    road.run(1.0);
    road
}

/// The smallest gap while the vehicle ahead brakes to a stop, and the ego behind it.
fn smallest_gap(road: &mut Road, braking: f64) -> f64 {
    road.acceleration = -braking;
    (0..1_000).fold(road.gap(), |smallest, _| {
        road.step();
        if road.target.speed <= 0.0 {
            road.acceleration = 0.0;
        }
        smallest.min(road.gap())
    })
}

#[test]
fn it_comes_to_rest_where_gap_and_speed_alone_would_tell_too_late() {
    // Lag and half of the ramp to 4 m/s² take 0.7 s, 10.5 m at 15 m/s. So behind 4 m/s² it has to know of the braking within 0.2 s. The law
    // alone needs gaps of 12, 12.5 and 14 m.
    for (gap, braking) in [(11.0, 3.0), (11.0, 3.5), (13.5, 4.0)] {
        let mut road = silent(gap);
        let smallest = smallest_gap(&mut road, braking);
        assert!(smallest > 0.0, "{gap} m behind {braking} m/s²: {smallest} m");
        assert!(road.ego.speed < 0.5, "{gap} m behind {braking} m/s²: {} m/s, {smallest} m", road.ego.speed);
    }
}

#[test]
fn it_follows_again_when_the_vehicle_ahead_drives_off() {
    let mut road = silent(17.0);
    smallest_gap(&mut road, 4.0);
    road.acceleration = 1.0;
    road.run(6.0);
    assert!(road.ego.speed > 3.0, "{} m/s", road.ego.speed);
}
