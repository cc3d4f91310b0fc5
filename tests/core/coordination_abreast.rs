//! Vehicles whose ways do not conflict, at one intersection: they drive at once, and one that crosses both lets both pass.

use crate::rig::junction::{CROSSING, Driver, HALF, Junction};

const NORTH: usize = 0;
const EAST: usize = 1;
const WEST: usize = 3;
const SPEED: f64 = 12.0;

fn going(station: u8, way: usize, at: f64, envelope: bool) -> Driver {
    Driver::new(station, way, at, SPEED, envelope)
}

#[test]
fn two_whose_ways_do_not_conflict_do_not_slow_down_for_one_another() {
    for envelope in [false, true] {
        for behind in [0.0, 3.0, 15.0] {
            let mut junction =
                Junction::new(vec![going(2, EAST, 60.0, envelope), going(3, WEST, 60.0 - behind, envelope)]);
            let (mut slowest, mut were_inside_at_once) = (f64::MAX, false);
            junction.run(20.0, |junction| {
                slowest = junction.drivers.iter().map(|driver| driver.body.speed).fold(slowest, f64::min);
                were_inside_at_once |= junction.drivers.iter().all(Driver::is_inside);
                let follows = junction.drivers.iter().find_map(Driver::follows);
                assert_eq!(follows, None, "{envelope} {behind} m");
            });
            assert!(slowest > SPEED - 0.05, "{envelope} {behind} m: {slowest} m/s");
            assert_eq!(were_inside_at_once, behind < 2.0 * HALF, "{envelope} {behind} m");
        }
    }
}

#[test]
fn one_that_crosses_both_lets_both_pass_whichever_arrived_last() {
    // All arrive at once, so the ego, whose number is the largest, is the last. Where the two on the street across begin, and which of them
    // asks for more caution: the one that is farther behind.
    for (starts, asks_most) in [([100.0, 70.0], 3), ([70.0, 100.0], 2), ([85.0, 84.0], 3)] {
        for envelope in [false, true] {
            let [east, west] = starts;
            let mut junction = Junction::new(vec![
                going(9, NORTH, 60.0, envelope),
                going(2, EAST, east, envelope),
                going(3, WEST, west, envelope),
            ]);
            let mut followed = Vec::new();
            junction.run(30.0, |junction| {
                let [ego, others @ ..] = &junction.drivers[..] else { panic!("three") };
                let meets = ego.is_inside() && others.iter().any(Driver::is_inside);
                assert!(!meets, "{envelope} {starts:?}: at {:.2} s", junction.now as f64 * 1e-6);
                followed.extend(ego.follows().filter(|station| followed.last() != Some(station)));
            });
            assert_eq!(followed.last(), Some(&asks_most), "{envelope} {starts:?}: {followed:?}");
            let last = junction.drivers.iter().map(|driver| driver.body.position).fold(f64::MAX, f64::min);
            assert!(last > CROSSING + 40.0, "{envelope} {starts:?}: {last}");
        }
    }
}
