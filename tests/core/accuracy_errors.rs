//! An accuracy on the wire says that 95 % of the errors are below it. What is certain holds the truth for normal errors, for biases
//! and for errors that drift, and seldom fails for errors with heavy tails; and honest samples are believed.

use crate::rig;
use crate::rig::plant::Body;
use crate::rig::random::Random;
use crate::rig::{Rig, TARGET, instant, m_of, mps_of};
use holdover::wire::Said;

/// Published, m and m/s.
const ACCURACY: (f64, f64) = (0.5, 0.2);
/// Of normal errors, 95 % are within so many standard deviations.
const NORMAL: f64 = 1.959_964;

/// Standard normal, by Box and Muller.
fn normal(random: &mut Random) -> f64 {
    let (u, v) = (random.between(1e-300, 1.0), random.between(0.0, std::f64::consts::TAU));
    (-2.0 * u.ln()).sqrt() * v.cos()
}

/// Laplace, with 95 % of its magnitudes below 1.
fn heavy(random: &mut Random) -> f64 {
    let magnitude = -random.between(1e-300, 1.0).ln() / 20f64.ln();
    if random.happens(0.5) { magnitude } else { -magnitude }
}

/// Samples at 10 Hz for so many seconds with errors as shares of the accuracy: instants at which the truth was outside, instants,
/// and samples refused.
fn outside(seconds: i64, mut error: impl FnMut() -> (f64, f64)) -> (u32, u32, u32) {
    let mut rig = Rig::new(&rig::config());
    rig.power_up(true, 0);
    for at in [-60_000, -40_000, -20_000] {
        let _ = rig.target(at, Said::DrivingParameters(rig::parameters(2.5, 8.0)));
    }
    let (mut outside, mut instants, mut refused) = (0, 0, 0);
    let mut body = Body { position: 0.0, speed: 20.0 };
    for tenth in 0..10 * seconds {
        let now = tenth * 100_000;
        rig.synchronise(now, 0);
        let a = (tenth as f64 / 40.0).sin();
        let (off, faster) = error();
        let said = (body.position + off * ACCURACY.0, body.speed + faster * ACCURACY.1);
        let motion = rig.motion(TARGET, now, said.0, said.1, a, a, Some(ACCURACY));
        let is_refused = rig.target(now, Said::Motion(motion)).is_err();
        refused += u32::from(is_refused && tenth > 2);
        for hundredth in 0..10 {
            let at = now + 10_000 * hundredth;
            if let Some(bound) = rig.unit.bound(2, instant(at)) {
                let is_inside = m_of(bound.lowest_position()) <= body.position
                    && body.position <= m_of(bound.highest_position())
                    && mps_of(bound.lowest_speed()) <= body.speed
                    && body.speed <= mps_of(bound.highest_speed());
                instants += 1;
                outside += u32::from(!is_inside);
            }
            body = body.after(a, 0.01);
        }
    }
    (outside, instants, refused)
}

#[test]
fn normal_errors_are_inside_and_believed() {
    for seed in 0..6 {
        let mut random = Random::new(seed);
        let (outside, instants, refused) =
            outside(600, || (normal(&mut random) / NORMAL, normal(&mut random) / NORMAL));
        assert!(instants > 50_000);
        assert_eq!((outside, refused), (0, 0), "seed {seed}, of {instants}");
    }
}

#[test]
fn a_bias_of_three_times_the_accuracy_is_inside_however_often_it_is_repeated() {
    for bias in [(2.9, 2.9), (-2.9, -2.9), (2.9, -2.9), (-1.0, 1.0), (0.0, 2.9)] {
        let (outside, instants, _) = outside(120, || bias);
        assert_eq!(outside, 0, "{bias:?}, of {instants}");
    }
}

#[test]
fn normal_errors_that_drift_are_inside_and_believed() {
    for (seed, keep) in [(1, 0.5f64), (2, 0.9), (3, 0.99)] {
        let mut random = Random::new(seed);
        let mut state = (0.0, 0.0);
        let fresh = (1.0 - keep * keep).sqrt();
        let (outside, instants, refused) = outside(600, || {
            state = (keep * state.0 + fresh * normal(&mut random), keep * state.1 + fresh * normal(&mut random));
            (state.0 / NORMAL, state.1 / NORMAL)
        });
        assert_eq!((outside, refused), (0, 0), "{keep}, of {instants}");
    }
}

/// Of Laplace's errors one in 8,000 is larger than three times what 95 % are below: nothing is certain with those, as the manual says.
#[test]
fn errors_with_heavy_tails_are_seldom_outside() {
    let (mut all, mut ever, mut refused) = (0, 0, 0);
    for seed in 0..6 {
        let mut random = Random::new(100 + seed);
        let (outside, instants, not_believed) = outside(600, || (heavy(&mut random), heavy(&mut random)));
        all += instants;
        ever += outside;
        refused += not_believed;
    }
    assert!(f64::from(ever) < 1e-3 * f64::from(all), "{ever} of {all}, {refused} samples refused");
}
