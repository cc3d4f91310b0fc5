//! The horizon that the unit holds of its target: silence enters, and the estimate goes on by the model, or is held where
//! the paper holds it; news enters, and it starts anew.

use crate::traffic;
use crate::traffic::{EGO, TARGET, Unit, receive_all, settled, settled_with};
use holdover::Config;
use holdover::config::{Model, Prediction};
use holdover::controller::{FallbackCause, Mode};
use holdover::time::Duration;
use holdover::units::Speed;
use holdover::wire::Said;

fn held(unit: &Unit) -> usize {
    unit.estimator().horizon(0).expect("a slot").len()
}

#[test]
fn a_minute_of_silence_never_runs_out_of_horizon() {
    let (mut unit, mut traffic) = settled();
    let full = held(&unit);
    traffic.target = false;
    for period in 1..=6_000 {
        let estimate = traffic.step(&mut unit).estimate.expect("the target is estimated still");
        let at = traffic.now().minus(traffic::PERIOD);
        let error = estimate.reading.position.get().to_num::<f64>() - traffic.target_at(at);
        assert!(error.abs() < 0.01, "{period}: {error} m");
        assert_eq!((held(&unit), estimate.link_on), (full, period <= 16), "{period}");
    }
    assert!(matches!(unit.mode(), Mode::Fallback { cause: FallbackCause::Silent, .. }), "{:?}", unit.mode());
    traffic.target = true;
    assert_eq!(traffic.run(&mut unit, 40).mode, Mode::Cooperative); // heard for 0.3 s
}

#[test]
fn in_paper_mode_the_last_value_is_held_past_the_end() {
    let mut config = Config::car(EGO);
    config.prediction =
        Prediction { step: traffic::PERIOD, horizon: Duration::from_millis(3_900), model: Model::PAPER };
    config.envelope = None;
    let (mut unit, mut traffic) = settled_with(&config);
    traffic.target = false;
    let start = traffic.now().minus(Duration::from_millis(100)); // when it spoke last
    let mut end = None;
    for period in 0..1_000 {
        let reading = traffic.step(&mut unit).estimate.expect("the target is estimated still").reading;
        let at = traffic.now().minus(traffic::PERIOD);
        // 392 steps from the sample on are held, the first of which is the sample.
        if at.since(start) <= Duration::from_millis(3_910) {
            let error = reading.position.get().to_num::<f64>() - traffic.target_at(at);
            assert!(error.abs() < 1e-3, "{period}: {error} m");
            end = Some(reading);
        } else {
            assert_eq!(Some(reading), end, "{period}");
        }
    }
}

#[test]
fn news_starts_the_horizon_anew_even_against_all_expectation() {
    let (mut unit, mut traffic) = settled();
    traffic.target = false;
    traffic.run(&mut unit, 400);
    let now = traffic.now();
    let mut motion = traffic.motion(TARGET, 9_000, now); // 8 m behind what everybody must have thought
    motion.speed = Speed::from_mm_per_s(6_000);
    let frames = traffic.peer(0, Said::Motion(motion));
    receive_all(&mut unit, now, &frames);
    let reading = traffic.step(&mut unit).estimate.expect("the target is estimated").reading;
    assert!((reading.position.get().to_num::<f64>() - (traffic.target_at(now) - 8.0)).abs() < 1e-3, "{reading:?}");
    assert_eq!(reading.speed.to_mm_per_s(), 6_000);
}

#[test]
fn after_a_silence_the_command_does_not_jump_to_the_new_estimate() {
    let command = |smooth: bool| {
        let mut config = Config::car(EGO);
        config.prediction.model.smooth = smooth;
        config.envelope = None; // its own limit would hide the jump too
        config.limits.jerk = holdover::units::Jerk::from_mm_per_s3(51_150); // or else it would hide the jump
        let (mut unit, mut traffic) = settled_with(&config);
        traffic.target = false;
        let before = traffic.run(&mut unit, 400).command.acceleration;
        let now = traffic.now();
        let motion = traffic.motion(TARGET, 16_000, now);
        let frames = traffic.peer(0, Said::Motion(motion));
        receive_all(&mut unit, now, &frames);
        let after = traffic.step(&mut unit);
        assert_eq!(after.mode, Mode::Cooperative);
        after.command.acceleration.minus(before).magnitude().to_mm_per_s2()
    };
    // A metre at a gain of 0.5 /s² is nearly 0.5 m/s² at once; smoothly, a 30th of that per period.
    let (smooth, sudden) = (command(true), command(false));
    assert!(sudden > 400 && smooth < 40, "{smooth} {sudden} mm/s²");
}
