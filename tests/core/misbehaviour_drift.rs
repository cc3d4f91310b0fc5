//! Positions that drift away from the speeds are found, as slow a drift as the published accuracies tell from an honest one; and
//! who is honest is never refused, wherever in its accuracies it is.

use crate::rig;
use crate::rig::plant::{Body, TOP};
use crate::rig::random::Random;
use crate::rig::{Rig, TARGET};
use holdover::health::Cause;
use holdover::wire::Said;

/// Seconds until a drift of so many metres a second is found in a vehicle at 15 m/s that publishes these accuracies.
fn found_after(drift: f64, accuracy: (f64, f64), lasts: i64) -> Option<f64> {
    let mut rig = Rig::new(&rig::config());
    rig.power_up(true, 0);
    for at in [-60_000, -50_000, -40_000] {
        let _ = rig.target(at, Said::DrivingParameters(rig::parameters(2.5, 8.0)));
    }
    for n in 0..lasts * 10 {
        let now = n * 100_000;
        if n % 5 == 0 {
            rig.synchronise(now, 0);
        }
        let position = (15.0 + drift) * now as f64 * 1e-6;
        let motion = rig.motion(TARGET, now, position, 15.0, 0.0, 0.0, Some(accuracy));
        match rig.target(now, Said::Motion(motion)) {
            Ok(()) | Err(Cause::NotYetTrusted) => {}
            Err(Cause::Implausible | Cause::Jump) => return Some(now as f64 * 1e-6),
            Err(other) => panic!("{other:?}"),
        }
    }
    None
}

#[test]
fn a_drift_is_found_when_it_has_made_up_what_the_accuracies_leave() {
    // Told to 0.2 m/s, a car may be 0.295 m/s faster by the positions than by the speeds, what its braking hides among it.
    let hidden = |speed: f64| speed + 2.5 * 8.0 / 10.5 * 0.1 / 2.0;
    for (drift, accuracy) in [
        (0.32, (0.05, 0.2)),
        (-0.32, (0.05, 0.2)),
        (0.4, (0.5, 0.2)),
        (-0.4, (0.5, 0.2)),
        (1.0, (0.5, 0.2)),
        (0.3, (0.5, 0.1)),
        (-0.3, (0.5, 0.1)),
        (0.3, (0.05, 0.02)),
    ] {
        let after = f64::abs(drift) - hidden(accuracy.1);
        // Twice the largest error of the position, and at either end half a millisecond at 15 m/s and 0.3 s of the speed's accuracy.
        let expected = 2.0 * (3.0 * accuracy.0 + 0.5e-3 * 15.5 + 0.3 * accuracy.1) / after;
        let found = found_after(drift, accuracy, 120).unwrap_or_else(|| panic!("{drift} {accuracy:?}"));
        assert!(found <= 1.3 * expected + 0.3, "{drift} {accuracy:?}: {found} s, not {expected} s");
        assert_eq!(found_after(drift.signum() * 0.95 * accuracy.1, accuracy, 120), None, "{accuracy:?}");
    }
}

/// An honest vehicle, with errors at the ends of its accuracies more often than not; how many samples it sent.
fn honest(seed: u64) -> u32 {
    let mut random = Random::new(seed);
    let mut rig = Rig::new(&rig::config());
    rig.power_up(true, 0);
    let fiftieths = |a: f64| (a * 50.0).round() / 50.0;
    let limits = (fiftieths(random.extreme(0.2, 6.0)), fiftieths(random.extreme(0.2, 12.0)));
    let published = (f64::from(random.below(40) as u32) * 0.05, f64::from(random.below(40) as u32) * 0.02);
    let accuracy = random.happens(0.9).then_some(published);
    let errors = accuracy.unwrap_or((5.0, 1.5));
    for at in [-60_000, -50_000, -40_000] {
        let _ = rig.target(at, Said::DrivingParameters(rig::parameters(limits.0, limits.1)));
    }
    let mut body = Body { position: random.between(-9e3, 9e3), speed: random.extreme(0.0, TOP) };
    // Clocks that are off, all of the time to one side or by turns.
    let clocks = 440.0 / 2.0;
    let (mut pedal, mut holds, mut bias, mut sent) = (0.0, 0, (0.0, 0.0, 0.0), 0);
    for n in 0..6_000i64 {
        let now = n * 50_000;
        if n % 10 == 0 {
            rig.synchronise(now, 0);
        }
        if n % 2 == 0 && !random.happens(0.1) {
            let turns = random.happens(0.3);
            let mut end = |held: f64, end: f64| if turns { random.extreme(-end, end) } else { held * end };
            let position = body.position + end(bias.0, errors.0);
            let speed = (body.speed + end(bias.1, errors.1)).clamp(0.0, TOP);
            let clock = end(bias.2, clocks) as i64;
            let motion = rig.motion(TARGET, now + clock, position, speed, 0.0, 0.0, accuracy);
            let taken = rig.target(now + 1_000, Said::Motion(motion));
            assert!(matches!(taken, Ok(()) | Err(Cause::NotYetTrusted)), "seed {seed} at {now}: {taken:?}");
            sent += 1;
        }
        if now >= holds {
            pedal = random.extreme(-1.0, 1.0);
            holds = now + random.between(5e4, 6e6) as i64;
            let sign = |random: &mut Random| [-1.0, 1.0][random.below(2) as usize];
            if random.happens(0.2) {
                bias = (sign(&mut random), sign(&mut random), sign(&mut random));
            }
        }
        body = body.after(if pedal < 0.0 { pedal * limits.1 } else { pedal * limits.0 }, 0.05);
    }
    sent
}

#[test]
fn who_is_honest_is_never_refused_wherever_in_its_accuracies_it_is() {
    let sent: u32 = (0..60).map(honest).sum();
    assert!(sent > 150_000, "{sent}");
}
