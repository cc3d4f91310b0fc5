//! The envelope in the whole unit, frames in and command out: it never lets the ego collide, and in normal following it
//! does nothing.

use crate::rig;
use crate::rig::road::Road;
use holdover::Config;
use holdover::config::Envelope;
use holdover::units::Seconds;
use holdover::wire::command::ModeCode;

fn guarded() -> Config {
    Config { envelope: Some(Envelope::CAR), ..rig::config() }
}

/// The gap of steady following, a little over the law's.
fn steady(speed: f64, time_gap: f64) -> f64 {
    2.0 + speed * time_gap + 0.05
}

#[test]
fn a_target_that_brakes_at_its_worst_in_a_silence_is_not_hit() {
    for speed in [3.0, 8.0, 14.0, 22.0, 35.0] {
        for time_gap in [0.5, 1.0, 2.0] {
            for (silent_for, then) in [(0.0, 0.0), (0.3, 0.0), (1.0, 2.5), (4.0, 0.0), (18.0, -0.5)] {
                let mut road = Road::new(&guarded(), speed, steady(speed, time_gap));
                road.power_up();
                road.run(1.0);
                road.senses.v2x = false;
                road.acceleration = then;
                if silent_for > 0.0 {
                    road.run(silent_for);
                }
                road.acceleration = -road.braking;
                let least = road.run_to_rest();
                assert!(least > 0.0, "{speed} m/s, {time_gap} s, silent for {silent_for} s: {least}");
            }
        }
    }
}

#[test]
fn a_target_that_brakes_at_its_worst_while_it_is_heard_is_not_hit() {
    for speed in [3.0, 14.0, 35.0] {
        for time_gap in [0.5, 1.0, 2.0] {
            let mut road = Road::new(&guarded(), speed, steady(speed, time_gap));
            road.power_up();
            road.run(1.0);
            road.acceleration = -road.braking;
            let least = road.run_to_rest();
            assert!(least > 0.0, "{speed} m/s, {time_gap} s: {least}");
        }
    }
}

#[test]
fn a_standing_vehicle_is_not_hit_by_a_unit_that_is_engaged_at_speed_far_behind_it() {
    for speed in [10.0, 20.0, 30.0] {
        let mut road = Road::new(&guarded(), speed, 400.0);
        road.target.speed = 0.0;
        let least = road.run_to_rest();
        assert!(least > 0.0, "{speed} m/s: {least}");
    }
}

/// `ρ` of the envelope's documentation.
fn reaction(limits: &Envelope, lag: f64) -> f64 {
    let (b, j, h) = (f64::from(limits.braking.to_mm_per_s2()) / 1e3, f64::from(limits.jerk.to_mm_per_s3()) / 1e3, 0.04);
    let longest = 1.25 * lag;
    // The acceleration may be 1 m/s² more than was measured.
    longest + longest * 1.0 / b + (b + j * h).powi(2) / (2.0 * j * b)
}

#[test]
fn in_steady_following_nothing_is_changed_until_the_age_is_the_time_gap_less_the_reaction() {
    let rho = reaction(&Envelope::CAR, 0.3);
    assert!((rho - 0.6244).abs() < 1e-3, "{rho}");
    // A time gap that leaves less than a period of messages, 0.1 s, is limited between two of them.
    for time_gap in [730, 760, 800, 1000, 1400, 2000] {
        for speed in [1.0, 5.0, 13.4, 20.0, 30.0, 40.0] {
            let mut config = guarded();
            config.law.time_gap = Seconds::from_millis(time_gap);
            let t_g = f64::from(time_gap) / 1e3;
            let mut road = Road::new(&config, speed, 2.0 + speed * t_g);
            road.wants = speed;
            // The sample at 3.0 s is the last one: after this step its age is 0 and the next tick's is 10 ms.
            road.power_up();
            road.run(1.01);
            assert!((road.gap() - 2.0 - speed * t_g).abs() < 0.1 && !road.commands.iter().any(|u| u.abs() > 0.1));
            road.senses.v2x = false;
            let mut age = 0.0;
            while age + 0.01 <= t_g - rho {
                age += 0.01;
                let heard = road.step();
                assert!(!heard.command.limited, "{time_gap} ms at {speed} m/s: limited at an age of {age}");
                assert!(heard.command.mode == ModeCode::Cooperative || heard.command.mode == ModeCode::Holdover);
            }
            // The rule is not empty: some time later it does act.
            road.run(8.0);
            assert!(road.ego.speed < speed - 0.1 || speed <= 1.0, "{time_gap} ms at {speed} m/s never became careful");
        }
    }
}

#[test]
fn a_long_silence_is_braked_for_without_a_jump_and_without_wavering() {
    let mut road = Road::new(&guarded(), 25.0, steady(25.0, 1.0));
    road.power_up();
    road.run(1.01);
    road.senses.v2x = false;
    road.commands.clear();
    road.run(2.0);
    let (down, up) = road.steepest();
    // The jerk of emergency braking, and a step of the wire.
    assert!(down >= -25.3 && up <= 25.3, "{down} {up}");
    // The cap is of a lag and a delay that are longer than the real ones, so that the last part of it builds up slowly.
    let begins = road.commands.iter().position(|u| *u < -0.5).unwrap();
    let hard = road.commands.iter().position(|u| *u <= -6.0).unwrap();
    let builds_up = &road.commands[begins..hard];
    assert!(builds_up.windows(2).all(|pair| pair[1] <= pair[0]), "{builds_up:?}");
    // When it is hard the roundings of the wire, 1 mm and 1 mm/s of the ego's own motion, are all that moves it.
    let held = &road.commands[hard..];
    assert!(held.windows(2).all(|pair| pair[1] <= pair[0] + 0.15), "{held:?}");
    assert!(held.iter().all(|u| *u <= -6.0) && *held.last().unwrap() <= -7.5, "{held:?}");
    // It builds up over most of half a second, as the theory says: (b + j h)/j.
    assert!(hard - begins >= 25, "{begins} {hard}");
}
