//! The vehicle ahead on the own leg falls silent near the conflict area, and nobody sees it. The ego goes into the area only if it is
//! certain to get out behind that vehicle.

use crate::rig::config;
use crate::rig::junction::{CROSSING, Driver, HALF, Junction};
use holdover::Config;

/// How much way the ego needs from when the other one's radio dies, at 10 m/s: 0.5 s until it takes the link to be off, and the braking.
const REACTS: f64 = 20.0;

/// Where and how fast the ego is after a minute, behind a vehicle that is so far ahead, and whose radio dies when its front is so far
/// beyond the crossing point. Then that vehicle drives on, or brakes at its hardest. `None` if the ego is too near to stop then.
fn ends(range_sensor: bool, headway: f64, dies: f64, brakes: bool) -> Option<Driver> {
    if CROSSING + dies - headway > CROSSING - HALF - REACTS {
        return None;
    }
    let with = Config { range_sensor, ..config() };
    let mut ego = Driver::of(with, 3, 0, 30.0, 10.0, true);
    (ego.sees_across, ego.is_blind) = (range_sensor, true);
    let ahead = Driver::of(with, 2, 0, 30.0 + headway, 10.0, true);
    let mut junction = Junction::new(vec![ego, ahead]);
    junction.run(60.0, |junction| {
        let ahead = &mut junction.drivers[1];
        if ahead.body.position > CROSSING + dies {
            (ahead.speaks, ahead.hears) = (false, false);
            ahead.by_hand = brakes.then_some(-8.0);
        }
    });
    Some(junction.drivers.swap_remove(0))
}

#[test]
fn the_ego_does_not_stand_in_the_area_behind_one_that_it_does_not_hear_or_see() {
    for range_sensor in [false, true] {
        for headway in [18.0, 22.0, 26.0, 30.0, 35.0, 40.0] {
            for dies in (-14..=30).step_by(2).map(f64::from) {
                for brakes in [false, true] {
                    let Some(ego) = ends(range_sensor, headway, dies, brakes) else { continue };
                    let what = format!("sensor {range_sensor}, {headway} m, {dies} m, brakes {brakes}");
                    assert!(!(ego.is_inside() && ego.body.speed < 0.1), "{what}: at {:.1} m", ego.body.position);
                }
            }
        }
    }
}
