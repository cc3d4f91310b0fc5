//! Two vehicles that never hear one another, and a third that hears both and repeats their passes: the two keep out of each other's way.
//! If nobody repeats anything, they are in the conflict area together.

use crate::rig::config;
use crate::rig::junction::{Driver, Junction};

/// Whether the two were in the area together, and how many of them have passed it at the end.
fn crossed(repeats: bool) -> (bool, usize) {
    let of = |station, way, at, deaf_to| {
        let mut driver = Driver::of(config(), station, way, at, 10.0, true);
        driver.deaf_to = deaf_to;
        driver
    };
    let mut third = of(4, 0, 0.0, None);
    third.repeats = repeats;
    let mut junction = Junction::new(vec![of(2, 0, 60.0, Some(1)), of(3, 1, 60.0, Some(0)), third]);
    let mut together = false;
    junction.run(60.0, |junction| {
        let is_inside = |index: usize| junction.drivers[index].is_inside();
        together |= is_inside(0) && is_inside(1);
    });
    let has_passed = |driver: &&Driver| driver.body.position > 220.0;
    (together, junction.drivers[..2].iter().filter(has_passed).count())
}

#[test]
fn who_does_not_hear_another_one_knows_its_claims_and_that_it_was_heard_by_who_hears_both() {
    assert_eq!(crossed(true), (false, 2));
}

#[test]
fn who_does_not_hear_another_one_and_is_told_nothing_meets_it() {
    assert_eq!(crossed(false), (true, 2));
}
