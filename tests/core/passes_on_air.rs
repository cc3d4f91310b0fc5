//! When a unit is on air: who was silent, who was given another way and who comes to another intersection uses nothing before all can have
//! heard its claims. In an outage of the radio for everybody nobody takes anybody for gone.

use crate::rig::junction::{CROSSING, Driver, HALF, Junction, NORTHWARD};
use crate::rig::{LENGTH, config};
use holdover::Config;
use holdover::coordination::{Approach, Crossing, Intersection, Itinerary, Movement};
use holdover::units::{Distance, Position};

/// The time that has to pass on air before a claim may count: assumption A16.
const SILENCE_US: i64 = 4_500_000;

fn sees(station: u8, way: usize, at: f64, speed: f64) -> Driver {
    let mut driver = Driver::of(Config { range_sensor: true, ..config() }, station, way, at, speed, true);
    driver.sees_across = true;
    driver
}

fn are_both_inside(junction: &Junction) -> bool {
    junction.drivers.iter().filter(|driver| driver.is_inside()).count() > 1
}

#[test]
fn a_unit_that_was_silent_for_long_is_on_air_only_from_then_on() {
    const BACK: i64 = 20_000_000;
    // The first one is on air for a second, then its own motion is missing until `BACK`. It stands near the area.
    let mut first = sees(2, 1, 193.5, 0.0);
    first.target_speed = 10.0;
    let mut junction = Junction::new(vec![first, sees(3, 0, 60.0, 10.0)]);
    junction.run(40.0, |junction| {
        let now = junction.now;
        junction.drivers[0].is_measured = !(1_000_000..BACK).contains(&now);
        // The second one comes on air at 14 s.
        let is_here = now >= 14_000_000;
        let second = &mut junction.drivers[1];
        (second.is_measured, second.speaks) = (is_here, is_here);
        if !is_here {
            (second.body.position, second.body.speed) = (121.0, 10.0);
        }
        // They hear one another just before they have to.
        for driver in &mut junction.drivers {
            driver.hears = now > BACK + SILENCE_US - 100_000;
        }
        assert!(!are_both_inside(junction), "{:.2} s", now as f64 * 1e-6);
    });
}

#[test]
fn an_outage_of_the_radio_for_everybody_lets_nobody_in_together() {
    for (range_sensor, lasts) in [(false, 40_000_000), (true, 25_000_000), (true, 40_000_000)] {
        let of = |station, way| {
            let mut driver = Driver::of(Config { range_sensor, ..config() }, station, way, 60.0, 10.0, true);
            driver.sees_across = range_sensor;
            driver
        };
        let mut junction = Junction::new(vec![of(2, 0), of(3, 1)]);
        junction.run(50.0, |junction| {
            let is_out = (4_200_000..4_200_000 + lasts).contains(&junction.now);
            for driver in &mut junction.drivers {
                (driver.speaks, driver.hears) = (!is_out, !is_out);
            }
            assert!(!are_both_inside(junction), "{range_sensor} {:.2} s", junction.now as f64 * 1e-6);
        });
    }
}

const POINT: Position = Position::from_mm(200_000);
/// Leg 3 turns off before the crossing point and crosses nobody's way; leg 0 goes straight on.
static FORK: Intersection = Intersection {
    id: 5,
    half: Distance::from_mm(4_000),
    approaches: &[Approach::straight(0, &NORTHWARD, POINT, 0b0010), Approach::straight(3, &NORTHWARD, POINT, 0)],
};
static TURNS: Itinerary = Itinerary {
    path: &NORTHWARD,
    crossings: &[Crossing { intersection: &FORK, movement: Movement::straight(3), at: POINT }],
};
static STRAIGHT_ON: Itinerary = Itinerary {
    path: &NORTHWARD,
    crossings: &[Crossing { intersection: &FORK, movement: Movement::straight(0), at: POINT }],
};

#[test]
fn on_another_way_nothing_is_firm_at_once() {
    const SET_OUT: i64 = 11_000_000;
    let mut ego = Driver::of(config(), 3, 0, 60.0, 10.0, true);
    ego.rig.unit.set_out(&TURNS).unwrap();
    let mut junction = Junction::new(vec![ego]);
    let mut entered = None;
    junction.run(30.0, |junction| {
        if junction.now == SET_OUT {
            junction.drivers[0].rig.unit.set_out(&STRAIGHT_ON).unwrap();
        }
        if junction.drivers[0].is_inside() {
            entered.get_or_insert(junction.now);
        }
    });
    let after = entered.expect("it drives on") - SET_OUT;
    assert!(after > SILENCE_US, "in the area {:.1} s after it set out", after as f64 * 1e-6);
}

/// Through two conflict areas that are so far apart.
fn through_two(gap: f64) -> &'static Itinerary {
    let at = |metres: f64| Position::from_mm((metres * 1e3) as i64);
    let of = |id, point| {
        let leg = Approach::straight(0, &NORTHWARD, point, 0b10);
        let approaches: &'static [Approach] = Box::leak(Box::new([leg]));
        &*Box::leak(Box::new(Intersection { id, half: Distance::from_mm(4_000), approaches }))
    };
    let [first, second] = [at(CROSSING), at(CROSSING + HALF + gap + HALF)];
    let crossings: &'static [Crossing] = Box::leak(Box::new([
        Crossing { intersection: of(5, first), movement: Movement::straight(0), at: first },
        Crossing { intersection: of(6, second), movement: Movement::straight(0), at: second },
    ]));
    Box::leak(Box::new(Itinerary { path: &NORTHWARD, crossings }))
}

#[test]
fn a_pass_of_one_intersection_is_not_used_at_the_next_one() {
    let mut through = 0;
    for gap in [8.0, 10.0, 15.0, 30.0] {
        for speed in [5.0, 10.0, 15.0] {
            for noise in [0.0, 0.1, 0.3] {
                let mut ego = Driver::of(config(), 3, 0, 60.0, speed, true);
                ego.rig.unit.set_out(through_two(gap)).unwrap();
                let mut junction = Junction::new(vec![ego]);
                let (mut seed, mut left, mut entered) = (7_u64, None, None);
                junction.run(45.0, |junction| {
                    seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    let now = junction.now;
                    let driver = &mut junction.drivers[0];
                    driver.off = noise * (((seed >> 33) % 2001) as f64 / 1000.0 - 1.0);
                    driver.accuracy = 0.05_f64.max(noise / 2.0);
                    if driver.body.position - LENGTH > CROSSING + HALF {
                        left.get_or_insert(now);
                    }
                    if driver.body.position > CROSSING + HALF + gap {
                        entered.get_or_insert(now);
                    }
                });
                let Some((left, entered)) = left.zip(entered) else { continue };
                through += 1;
                // By its measured position it may have left a tenth of a second before.
                assert!(entered - left > SILENCE_US - 100_000, "{gap} m, {speed} m/s, {noise} m");
            }
        }
    }
    assert!(through > 30, "{through} of 36");
}
