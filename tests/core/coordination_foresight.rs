//! What a unit says of the time to come knows whom it will follow, and how gently it makes way for whom it follows now.

use crate::rig::junction::{CROSSING, Driver, HALF, Junction};
use crate::rig::{instant, m_of};
use holdover::time::Duration;
use holdover::wire::{Predecessor, StationHash};

/// A vehicle whose unit looks 3.1 s ahead, in the steps that it has room for.
fn driver(station: u8, way: usize, at: f64) -> Driver {
    let mut driver = Driver::new(station, way, at, 11.0, false);
    let mut config = *driver.rig.unit.config();
    (config.prediction.step, config.prediction.horizon) = (Duration::from_millis(50), Duration::from_millis(3_100));
    let way = driver.rig.unit.coordination().itinerary().expect("it has set out");
    driver.rig.unit.start(&config).expect("the configuration is sound");
    driver.rig.unit.set_out(way).expect("so is the map");
    driver.rig.power_up(true, 0);
    driver
}

/// The earlier one is station 2, on leg 1; the later one station 1, on leg 0, so many metres further from the crossing.
fn two(at: f64, behind: f64) -> Junction {
    let mut junction = Junction::new(vec![driver(2, 1, at)]);
    junction.run(0.3, |junction| junction.drivers[0].body.position = at);
    let mut second = driver(1, 0, at - behind);
    second.rig.synchronise(junction.now - 1, 0);
    junction.drivers.push(second);
    junction
}

/// Where the vehicle's own horizon says that it will be after so long, along its street.
fn foreseen(junction: &Junction, index: usize, seconds: f64) -> f64 {
    let driver = &junction.drivers[index];
    let at = instant(junction.now + (seconds * 1e6) as i64);
    let reading = driver.rig.unit.estimator().read_own(at).expect("it has a horizon");
    m_of(reading.position) - driver.axis
}

#[test]
fn the_own_horizon_knows_that_the_one_ahead_will_have_left_and_is_not_followed_any_more() {
    let mut junction = two(40.0, 8.0);
    // Once nobody is ahead it will drive faster.
    junction.drivers[1].target_speed = 15.0;
    while junction.drivers[0].body.position < CROSSING + HALF + 4.8 - 15.0 {
        junction.run(0.1, |_| {});
    }
    assert_eq!(junction.drivers[1].follows(), Some(2));
    // From here on it hears nothing.
    junction.drivers[1].hears = false;
    let at: Vec<f64> = (1..=3).map(|seconds| foreseen(&junction, 1, f64::from(seconds))).collect();
    for (second, foreseen) in at.iter().enumerate() {
        junction.run(1.0, |_| {});
        let truth = junction.drivers[1].body.position;
        assert!((foreseen - truth).abs() < 0.05, "after {} s: {foreseen} instead of {truth}", second + 1);
    }
    assert_eq!(junction.drivers[1].follows(), None);
}

#[test]
fn the_own_horizon_knows_who_has_come_to_the_next_intersection_after_the_one_ahead_on_the_road() {
    let mut junction = Junction::new(vec![driver(2, 0, 230.0)]);
    // The one on the crossing road comes to the second intersection later, and will be 15 m ahead of the ego on its way there.
    for (station, way, at) in [(3, 2, 155.0), (1, 0, 136.0)] {
        junction.run(0.5, |_| {});
        let mut driver = driver(station, way, at);
        driver.rig.synchronise(junction.now - 1, 0);
        junction.drivers.push(driver);
    }
    while junction.drivers[2].body.position < CROSSING {
        junction.run(0.1, |_| {});
    }
    assert_eq!(junction.drivers[2].follows(), None, "there is nobody at the first one");
    let foreseen = foreseen(&junction, 2, 3.0);
    let free = junction.drivers[2].body.position + 33.0;
    junction.run(3.0, |_| {});
    let truth = junction.drivers[2].body.position;
    assert_eq!(junction.drivers[2].follows(), Some(3));
    assert!(
        truth < free - 0.3 && (foreseen - truth).abs() < 0.1,
        "{foreseen} instead of {truth}, on a free road {free}"
    );
}

#[test]
fn whom_it_makes_way_for_is_followed_only_when_the_others_have_long_been_told() {
    let mut junction = two(20.0, 1.0);
    let mut hardest: f64 = 0.0;
    junction.run(3.0, |junction| hardest = hardest.min(junction.drivers[1].command()));
    let at: Vec<f64> = (1..=3).map(|seconds| foreseen(&junction, 1, f64::from(seconds))).collect();
    junction.run(1.3, |junction| hardest = hardest.min(junction.drivers[1].command()));
    assert!(junction.drivers[1].follows().is_none() && hardest > -0.05, "{hardest}");
    let claim = junction.drivers[1].rig.unit.coordination().claim();
    assert_eq!(claim, Predecessor::Station(StationHash(2)), "but it knows its place in the order");
    junction.run(0.7, |_| {});
    assert_eq!(junction.drivers[1].follows(), Some(2));
    junction.run(1.0, |_| {});
    let truth = junction.drivers[1].body.position;
    assert!((at[2] - truth).abs() < 0.1, "{} instead of {truth}", at[2]);
    // What it would be if it drove on.
    assert!(truth < 19.0 + 6.0 * 11.0 - 0.2, "{truth}");
}

#[test]
fn far_from_the_crossing_it_makes_way_gently_and_is_out_of_the_way_all_the_same() {
    let mut junction = two(5.0, 1.0);
    let (mut hardest, mut far_hardest, mut both): (f64, f64, bool) = (0.0, 0.0, false);
    junction.run(20.0, |junction| {
        let command = junction.drivers[1].command();
        hardest = hardest.min(command);
        if junction.drivers[1].body.position < CROSSING - HALF - 130.0 {
            far_hardest = far_hardest.min(command);
        }
        both |= junction.drivers.iter().all(Driver::is_inside);
    });
    // 0.6 m/s², and the command's resolution; the law alone would ask for the 4 m/s² that are the limit.
    assert!(far_hardest > -0.62 && far_hardest < -0.5, "{far_hardest}");
    assert!(hardest > -1.52, "{hardest}");
    assert!(!both);
}

#[test]
fn near_the_crossing_it_brakes_as_hard_as_it_has_to() {
    let mut junction = two(CROSSING - HALF - 40.0, 1.0);
    let (mut hardest, mut both): (f64, bool) = (0.0, false);
    junction.run(20.0, |junction| {
        hardest = hardest.min(junction.drivers[1].command());
        both |= junction.drivers.iter().all(Driver::is_inside);
    });
    assert!(hardest < -2.0 && !both, "{hardest}");
}
