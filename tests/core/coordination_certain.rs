//! Whom the gate minds at intersections, frames in and frames out: it goes by what is certain, however long nothing has been heard
//! and wherever anybody is estimated to be. The world is in float64 and knows the unit by its frames alone.

use crate::rig::junction::{Driver, HALF, Junction};
use crate::rig::plant::Plant;
use crate::rig::random::Random;
use holdover::controller::Mode;

const LENGTH: f64 = 4.8;

#[test]
fn who_is_deaf_for_half_a_minute_does_not_run_into_one_that_came_to_a_stand_meanwhile() {
    let (ego, ahead) = (Driver::new(1, 0, 5.0, 3.0, true), Driver::new(2, 0, 100.0, 11.0, false));
    let mut junction = Junction::new(vec![ego, ahead]);
    junction.run(1.0, |_| {});
    junction.drivers[0].hears = false;
    let (mut gap, mut is_alone, mut brakes) = (f64::MAX, false, None::<Plant>);
    junction.run(60.0, |junction| {
        let seconds = junction.now / 1_000_000;
        let [ego, ahead] = &mut junction.drivers[..] else { panic!("two") };
        ego.target_speed = if seconds < 20 { 3.0 } else { 11.0 };
        // With 6 m/s² from there on, whatever its unit wants.
        if ahead.body.position > 225.0 || brakes.is_some() {
            let Plant { position, speed, lag, .. } = brakes.unwrap_or(ahead.body);
            let slower = (speed - 0.06).max(0.0);
            ahead.body = Plant { position: position + slower * 0.01, speed: slower, acceleration: 0.0, lag };
            brakes = Some(ahead.body);
        }
        gap = gap.min(ahead.body.position - LENGTH - ego.body.position);
        is_alone |= ego.rig.unit.mode() == Mode::Cooperative && ego.follows().is_none();
    });
    assert!(is_alone, "it follows nobody, as who is silent for so long is estimated to be far away");
    assert!(gap > 0.0, "{gap}");
    // It stands where the other one might have come to a stand at once.
    assert!(junction.drivers[0].body.speed < 0.05 && junction.drivers[0].body.position > 80.0);
}

/// Where the ego is in the end if the first of three is not heard any more from 120 m on, and the second drives on behind that one, if
/// it is there.
fn comes_to(has_second: bool) -> f64 {
    let mut drivers = vec![Driver::new(1, 0, 20.0, 11.0, true), Driver::new(2, 0, 90.0, 11.0, false)];
    if has_second {
        drivers.push(Driver::new(3, 0, 60.0, 11.0, false));
    }
    let mut junction = Junction::new(drivers);
    junction.run(40.0, |junction| {
        let first = &mut junction.drivers[1];
        first.speaks &= first.body.position < 120.0;
    });
    junction.drivers[0].body.position
}

#[test]
fn who_is_silent_has_come_as_far_as_anybody_behind_it() {
    // 120 m, and 7.6 m of braking.
    let alone = comes_to(false);
    assert!((100.0..127.6 - LENGTH).contains(&alone), "{alone}");
    assert!(comes_to(true) > 300.0, "{}", comes_to(true));
}

#[test]
fn who_was_beyond_the_radio_s_reach_when_it_was_heard_last_is_not_waited_for() {
    let comes_to = |ahead: f64| {
        let mut junction =
            Junction::new(vec![Driver::new(1, 0, 5.0, 11.0, true), Driver::new(2, 0, 5.0 + ahead, 11.0, false)]);
        junction.run(45.0, |junction| {
            let seconds = junction.now / 1_000_000;
            junction.drivers[1].speaks &= seconds < 2;
        });
        junction.drivers[0].body.position
    };
    assert!(comes_to(310.0) > 400.0, "{}", comes_to(310.0));
    assert!(comes_to(280.0) < 330.0, "{}", comes_to(280.0));
}

/// Whether two bodies met, on a leg or in the conflict area of the first crossing.
fn met(drivers: &[Driver]) -> bool {
    let pairs =
        drivers.iter().enumerate().flat_map(|(at, one)| drivers[at + 1..].iter().map(move |other| (one, other)));
    let apart = |one: &Driver, other: &Driver| (one.body.position - other.body.position).abs();
    pairs.into_iter().any(|(one, other)| {
        if one.way == other.way { apart(one, other) < LENGTH } else { one.is_inside() && other.is_inside() }
    })
}

#[test]
fn however_deaf_they_are_for_however_long_nobody_who_has_heard_of_the_others_meets_one() {
    for seed in 0..12 {
        let mut random = Random::new(seed);
        let drivers = [(1, 0, 60.0), (2, 1, 45.0), (3, 0, 20.0), (4, 1, 5.0)];
        let drive = |(station, way, at)| Driver::new(station, way, at, 9.0, true);
        let mut junction = Junction::new(drivers.map(drive).into());
        junction.run(1.5, |_| {});
        let mut hears_from = [0_i64; 4];
        let mut is_deaf_from = [0_i64; 4];
        for from in &mut is_deaf_from {
            *from = 1_500_000 + (random.between(0.0, 12e6)) as i64;
        }
        let mut wants = [9.0; 4];
        junction.run(75.0, |junction| {
            let now = junction.now;
            for (index, driver) in junction.drivers.iter_mut().enumerate() {
                if now >= is_deaf_from[index] {
                    hears_from[index] = now + random.between(2e6, 35e6) as i64;
                    is_deaf_from[index] = hears_from[index] + random.between(0.5e6, 6e6) as i64;
                }
                driver.hears = now >= hears_from[index];
                if now % 4_000_000 == 0 {
                    wants[index] = random.between(1.0, 12.0);
                }
                driver.target_speed = wants[index];
            }
            assert!(!met(&junction.drivers), "seed {seed} at {:.2} s", now as f64 * 1e-6);
        });
    }
}

#[test]
fn who_comes_to_a_crossing_without_the_time_waits_for_it() {
    // The ego is on its way to the second crossing, where another one comes that has never heard of it there.
    let (ego, other) = (Driver::new(1, 0, 20.0, 11.0, true), Driver::new(2, 2, 30.0, 11.0, true));
    let mut junction = Junction::new(vec![ego, other]);
    let in_area = |at: f64, crossing: f64| (crossing - HALF..crossing + HALF + LENGTH).contains(&at);
    junction.run(75.0, |junction| {
        let now = junction.now;
        junction.drivers[0].is_timed = !(11_000_000..45_000_000).contains(&now);
        let [ego, other] = &junction.drivers[..] else { panic!("two") };
        let (ego, other) = (ego.body.position, other.body.position);
        assert!(!(in_area(ego, 390.0) && in_area(other, 400.0)), "{:.2} s: {ego:.1} {other:.1}", now as f64 * 1e-6);
        // It goes by its own clock for 5 s after the last synchronisation, and cannot stop before the first crossing any more by then.
        assert!(now > 45_000_000 || ego < 390.0 - HALF, "{ego}");
    });
    assert!(junction.drivers[0].body.position > 450.0, "{}", junction.drivers[0].body.position);
}
