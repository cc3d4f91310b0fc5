//! Passes on the way: two vehicles cross, and the one that goes first falls silent before the crossing. It keeps its pass, so nobody who
//! sees the area has to wait for it.

use crate::rig::config;
use crate::rig::junction::{CROSSING, Driver, HALF, Junction};
use holdover::Config;
use holdover::wire::Message;

/// Where the ego is after half a minute, and how slow it was. It is silent for the other one too: that is deaf.
fn behind_a_silent_one(range_sensor: bool, keeps: [bool; 2]) -> (f64, f64) {
    let [ego, other] = keeps.map(|passes| Config { range_sensor, passes, ..config() });
    let mut ego = Driver::of(ego, 3, 0, 20.0, 10.0, true);
    ego.sees_across = range_sensor;
    // Both come at once, so the smaller station is ahead in the order.
    let other = Driver::of(other, 2, 1, 50.0, 10.0, true);
    let mut junction = Junction::new(vec![ego, other]);
    let mut slowest = f64::MAX;
    junction.run(30.0, |junction| {
        // Both know one another, and all claims are firm.
        let is_silent = junction.now > 12_000_000;
        junction.drivers[1].speaks = !is_silent;
        junction.drivers[1].hears = !is_silent;
        let [ego, other] = &junction.drivers[..] else { panic!("two") };
        assert!(!(ego.is_inside() && other.is_inside()), "{:.2} s", junction.now as f64 * 1e-6);
        slowest = slowest.min(ego.body.speed);
    });
    assert!(junction.drivers[1].body.position > CROSSING + HALF, "the silent one is through");
    (junction.drivers[0].body.position, slowest)
}

#[test]
fn who_has_a_range_sensor_does_not_wait_for_a_silent_vehicle_that_keeps_its_pass() {
    let (at, slowest) = behind_a_silent_one(true, [true, true]);
    assert!(at > CROSSING + 50.0 && slowest > 5.0, "at {at:.1} m, {slowest:.1} m/s");
}

#[test]
fn who_has_none_waits_until_the_silent_vehicle_has_left_for_certain() {
    let (at, slowest) = behind_a_silent_one(false, [true, true]);
    assert!(at < CROSSING - HALF && slowest < 0.1, "at {at:.1} m, {slowest:.1} m/s");
}

#[test]
fn where_one_of_the_two_keeps_no_passes_the_ego_waits_although_it_has_a_range_sensor() {
    for keeps in [[false, true], [true, false], [false, false]] {
        let (at, slowest) = behind_a_silent_one(true, keeps);
        assert!(at < CROSSING - HALF && slowest < 0.1, "{keeps:?}: at {at:.1} m, {slowest:.1} m/s");
    }
}

#[test]
fn who_keeps_no_passes_says_none() {
    for passes in [true, false] {
        let mut junction = Junction::new(vec![Driver::of(Config { passes, ..config() }, 2, 1, 50.0, 10.0, true)]);
        let mut says = false;
        junction.run(5.0, |junction| {
            let last = junction.drivers[0].last.as_ref();
            says |= last.is_some_and(|last| last.all.iter().any(|one| matches!(one, Message::OwnPass(_))));
        });
        assert_eq!(says, passes);
    }
}
