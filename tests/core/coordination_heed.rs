//! Whom a unit on its way through intersections heeds, frames in and frames out: neither one that got out of its reach, nor, where
//! it cannot stop any more, one that overlooks it.

use crate::rig;
use crate::rig::junction::{CROSSING, Driver, HALF, Junction};
use crate::rig::plant;
use holdover::health::Cause;

/// Whether the ego follows a silent one, which is so far ahead when it is heard last and has this speed, where it is
/// estimated to be when the ego comes near after 16 s of standing.
fn is_caught_up(ahead: f64, speed: f64) -> bool {
    let mut junction =
        Junction::new(vec![Driver::new(1, 0, 5.0, 11.0, false), Driver::new(2, 0, 5.0 + ahead, speed, false)]);
    junction.run(1.0, |_| {});
    junction.drivers[1].speaks = false;
    let stand = |junction: &mut Junction| {
        let lag = junction.drivers[0].body.lag;
        junction.drivers[0].body = plant::Plant { position: 5.0, speed: 0.0, acceleration: 0.0, lag };
    };
    junction.run(16.0, stand);
    let mut is_followed = false;
    junction.run(42.0, |junction| {
        is_followed |= junction.drivers[0].rig.unit.coordination().choice().target.is_some();
    });
    is_followed
}

#[test]
fn who_got_out_of_reach_driving_on_is_not_followed_any_more_and_who_was_near_is() {
    assert!(!is_caught_up(285.0, 1.0));
    assert!(is_caught_up(150.0, 1.0));
}

/// Whether the ego, there on its street at 11 m/s, makes way for one on the other street that does not hear it.
fn gives_way(at: f64) -> bool {
    let mut junction = Junction::new(vec![Driver::new(1, 0, at, 11.0, false), Driver::new(2, 1, at - 5.0, 0.0, false)]);
    junction.drivers[1].hears = false;
    junction.run(3.0, |junction| {
        for (driver, (position, speed)) in junction.drivers.iter_mut().zip([(at, 11.0), (at - 5.0, 0.0)]) {
            driver.body = plant::Plant { position, speed, acceleration: 0.0, ..driver.body };
        }
    });
    junction.drivers[0].rig.unit.health().of(Cause::Overlooked) > 0
}

#[test]
fn who_cannot_stop_before_the_conflict_area_any_more_makes_way_for_nobody() {
    let limits = rig::config().limits;
    let (braking, jerk) =
        (f64::from(limits.braking.to_mm_per_s2()) * 1e-3, f64::from(limits.jerk.to_mm_per_s3()) * 1e-3);
    // Half of the ramp, the lag, and the braking itself.
    let reaction = braking / jerk / 2.0 + 0.3;
    let stops = CROSSING - HALF - 11.0 * reaction - 11.0 * 11.0 / (2.0 * braking);
    for metres in [0.3, 1.0, 3.0] {
        assert!(gives_way(stops - metres) && !gives_way(stops + metres), "{metres}");
    }
}
