//! A vehicle makes an emergency stop in the conflict area, and its radio dies. The ego has a pass for later, and its range sensor sees the
//! vehicle: it does not go in, also if the sensor sees nothing for a moment then. A sensor that says nothing is not relied on.

use crate::rig::junction::{CROSSING, Driver, HALF, Junction, is_on_point};
use crate::rig::{LENGTH, config};
use holdover::Config;

fn sees(station: u8, way: usize, at: f64, speed: f64) -> Driver {
    let mut driver = Driver::of(Config { range_sensor: true, ..config() }, station, way, at, speed, true);
    driver.sees_across = true;
    driver
}

/// Stops the second vehicle on the crossing point, and silences it.
fn strand(junction: &mut Junction) {
    let stranded = &mut junction.drivers[1];
    if stranded.body.position > CROSSING - 1.0 {
        (stranded.speaks, stranded.hears) = (false, false);
    }
    if !stranded.speaks {
        let is_at_rest = stranded.body.speed <= 0.1 || stranded.body.position > CROSSING + 2.0;
        (stranded.body.speed, stranded.body.acceleration) =
            if is_at_rest { (0.0, 0.0) } else { (stranded.body.speed, -8.0) };
    }
}

#[test]
fn one_that_waits_at_its_line_and_is_heard_does_not_explain_a_view_of_another_one_in_the_area() {
    let mut waits = sees(4, 3, 195.0, 0.0);
    waits.accuracy = 0.5;
    let mut junction = Junction::new(vec![sees(3, 0, 30.0, 10.0), sees(2, 1, 60.0, 10.0), waits]);
    junction.run(40.0, |junction| {
        strand(junction);
        let [ego, stranded, _] = &junction.drivers[..] else { panic!("three") };
        assert!(!(is_on_point(&ego.body) && is_on_point(&stranded.body)), "{:.2} s", junction.now as f64 * 1e-6);
    });
}

/// Whether both were in the area, when the ego's position is noisy.
fn meets(noise: f64, speed: f64, seed: u64) -> bool {
    let mut ego = sees(3, 0, 30.0, speed);
    ego.body.position = (CROSSING - 17.0 * speed).max(-280.0);
    let mut junction = Junction::new(vec![ego, sees(2, 1, CROSSING - 140.0, 10.0)]);
    let (mut both, mut seed) = (false, seed);
    junction.run(40.0, |junction| {
        strand(junction);
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let ego = &mut junction.drivers[0];
        ego.off = noise * (((seed >> 33) % 2001) as f64 / 1000.0 - 1.0);
        ego.accuracy = 0.05_f64.max(noise / 2.0);
        both |= junction.drivers.iter().all(Driver::is_inside);
    });
    both
}

#[test]
fn the_ego_does_not_commit_itself_past_one_that_it_sees_in_the_area() {
    for speed in [8.0, 10.0, 13.0] {
        for noise in [0.0, 0.1, 0.2, 0.3] {
            for seed in 1..=5 {
                assert!(!meets(noise, speed, seed), "{speed} m/s, {noise} m, seed {seed}");
            }
        }
    }
}

/// Whether both were in the area, when the ego's sensor is blind for some time.
fn meets_when_blind(from: f64, seconds: f64) -> bool {
    let mut ego = sees(3, 0, 30.0, 10.0);
    ego.body.position = CROSSING - 170.0;
    let mut junction = Junction::new(vec![ego, sees(2, 1, CROSSING - 140.0, 10.0)]);
    let mut both = false;
    junction.run(40.0, |junction| {
        strand(junction);
        let now = junction.now as f64 * 1e-6;
        junction.drivers[0].is_blind = (from..from + seconds).contains(&now);
        both |= junction.drivers.iter().all(Driver::is_inside);
    });
    both
}

#[test]
fn a_time_without_views_does_not_let_the_ego_in() {
    for seconds in [0.5, 1.5, 20.0] {
        for tenths in 110..190 {
            let from = f64::from(tenths) * 0.1;
            assert!(!meets_when_blind(from, seconds), "blind from {from} s for {seconds} s");
        }
    }
}

/// How far the ego gets in 60 s behind one that has stopped before its line, with a dead radio, after its pass.
fn gets(is_blind: bool) -> f64 {
    let mut ego = sees(3, 0, 30.0, 10.0);
    ego.is_blind = is_blind;
    ego.body.position = CROSSING - 190.0;
    let mut junction = Junction::new(vec![ego, sees(2, 1, CROSSING - 140.0, 10.0)]);
    junction.run(60.0, |junction| {
        let stranded = &mut junction.drivers[1];
        if stranded.body.position > CROSSING - 20.0 {
            (stranded.speaks, stranded.hears) = (false, false);
        }
        if !stranded.speaks {
            let speed = stranded.body.speed;
            (stranded.body.speed, stranded.body.acceleration) = if speed <= 0.1 { (0.0, 0.0) } else { (speed, -8.0) };
        }
    });
    junction.drivers[0].body.position
}

#[test]
fn a_pass_of_another_is_trusted_only_while_the_own_sensor_says_something() {
    assert!(gets(false) > CROSSING + 50.0, "{}", gets(false));
    assert!(gets(true) < CROSSING, "{}", gets(true));
}

/// How far the ego gets in 60 s. Another vehicle stood in the area, without a word of how it would drive, when the modem gave its slot
/// away. It left 1 s later. Its passes are heard all the time. The ego's sensor shows that the area is empty, until it says nothing any more.
fn gets_past_one_without_slot(blind_from: f64, stood_at: f64, envelope: bool) -> f64 {
    let mut ego = Driver::of(Config { range_sensor: true, ..config() }, 3, 0, CROSSING - 190.0, 10.0, envelope);
    ego.sees_across = true;
    let mut other = sees(2, 1, CROSSING - 140.0, 10.0);
    other.says_plans = false;
    let (mut junction, mut ticks) = (Junction::new(vec![ego, other]), 0);
    junction.run(60.0, |junction| {
        let now = junction.now as f64 * 1e-6;
        let [ego, other] = &mut junction.drivers[..] else { panic!("two") };
        ticks += u32::from(other.body.position > stood_at);
        if (1..400).contains(&ticks) {
            (other.body.speed, other.body.acceleration) = (0.0, 0.0);
        }
        other.says_motion = ticks < 300;
        ego.is_blind = now > blind_from;
        assert!(!(ego.is_inside() && other.is_inside()));
    });
    junction.drivers[0].body.position
}

#[test]
fn an_old_estimate_in_the_area_holds_the_ego_only_while_it_does_not_see_that_the_area_is_empty() {
    for envelope in [true, false] {
        for stood_at in [CROSSING - 1.0, CROSSING + 1.0, CROSSING + 3.0, CROSSING + 5.0, CROSSING + 7.0] {
            let at = |blind_from| gets_past_one_without_slot(blind_from, stood_at, envelope);
            assert!(at(f64::INFINITY) > CROSSING + 50.0, "{envelope}, {stood_at}: {}", at(f64::INFINITY));
            // The estimate is as old as a holdover at 32 s, and some seconds later the ego goes in.
            let held = (CROSSING - HALF).max(stood_at - LENGTH);
            for blind_from in [25.0, 33.0, 34.0] {
                assert!(at(blind_from) < held, "{envelope}, {stood_at}, {blind_from}: {}", at(blind_from));
            }
        }
    }
}

/// The least speed of an ego at 10 m/s that comes to the area so far behind another vehicle of its leg. A third one, which crosses, was
/// there before them, and its radio dies there. It drives on.
fn slows_to(behind: f64) -> f64 {
    let ego = sees(3, 0, CROSSING - 170.0 - behind, 10.0);
    let ahead = sees(4, 0, CROSSING - 170.0, 10.0);
    let mut junction = Junction::new(vec![ego, ahead, sees(2, 1, CROSSING - 140.0, 10.0)]);
    let mut least = f64::MAX;
    junction.run(40.0, |junction| {
        let [ego, _, crossing] = &mut junction.drivers[..] else { panic!("three") };
        if crossing.body.position > CROSSING {
            (crossing.speaks, crossing.hears) = (false, false);
        }
        if ego.body.position < CROSSING {
            least = least.min(ego.body.speed);
        }
    });
    assert!(junction.drivers[0].body.position > CROSSING + 50.0);
    least
}

#[test]
fn one_ahead_on_the_own_leg_that_is_seen_to_drive_through_the_area_does_not_hold_the_ego() {
    for behind in (20..=40).step_by(2).map(f64::from) {
        let least = slows_to(behind);
        assert!(least > 7.0, "{behind} m behind: {least:.1} m/s");
    }
}
