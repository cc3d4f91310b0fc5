//! The ego's pass begins a little later than the ego may be at the area. It brakes gently for that before it would have to brake hard.

use crate::passes_cut::other;
use crate::rig::config;
use crate::rig::junction::{CROSSING, Driver, HALF, Junction};
use holdover::Config;
use holdover::config::Law;
use holdover::units::Fraction;
use holdover::wire::Message;

/// How hard the ego's unit makes it brake at most, how slow the ego gets, and when it is in the area, in seconds.
fn comes(speed: f64, start: f64, exit: i64) -> (f64, f64, Option<f64>) {
    let config = config();
    // It may drive faster by a fifth to catch up, so it could be there early though it comes in time.
    let law = Law { catch_up: Fraction::from_milli(200), ..config.law };
    let mut ego = Driver::of(Config { range_sensor: true, law, ..config }, 3, 0, start, speed, true);
    ego.sees_across = true;
    let (mut hardest, mut slowest, mut entered) = (0.0_f64, f64::MAX, None);
    Junction::new(vec![ego]).run(50.0, |junction| {
        let (now, ego) = (junction.now, &mut junction.drivers[0]);
        if now % 200_000 == 0 && now < exit {
            let to = (exit - now) as f64 * 1e-6;
            let _ = ego.rig.put(now, &Message::PeerPass(other(now, to - 12.0, to)));
        }
        if entered.is_none() {
            (hardest, slowest) = (hardest.min(ego.body.acceleration), slowest.min(ego.body.speed));
        }
        if ego.body.position > CROSSING - HALF && entered.is_none() {
            entered = Some(now as f64 * 1e-6);
        }
    });
    (hardest, slowest, entered)
}

/// Speeds, and where an ego begins that comes to the area with each.
const COMERS: [(f64, f64); 3] = [(14.0, -250.0), (10.0, -100.0), (6.0, 0.0)];

#[test]
fn one_that_would_be_early_brakes_gently_and_goes_in_when_its_pass_begins() {
    for (speed, start) in COMERS {
        let comes_at = (CROSSING - HALF - start) / speed;
        for late in (0..20).map(|tenths| f64::from(tenths) * 0.1) {
            // Windows are 0.2 s apart.
            let begins = comes_at + late;
            let (hardest, slowest, entered) = comes(speed, start, ((begins - 0.2) * 1e6) as i64);
            let entered = entered.unwrap_or(f64::MAX);
            let what = format!(
                "{speed} m/s, {begins:.2} s: {hardest:.2} m/s2, {slowest:.2} m/s, in the area at {entered:.2} s"
            );
            assert!(hardest > -1.5 && slowest > 0.6 * speed, "{what}");
            assert!((begins..begins + 0.4).contains(&entered), "{what}");
        }
    }
}

#[test]
fn one_that_comes_well_within_its_pass_is_not_slowed() {
    for (speed, start) in COMERS {
        let comes_at = (CROSSING - HALF - start) / speed;
        for early in (3..12).map(|tenths| f64::from(tenths) * 0.1) {
            let (_, slowest, entered) = comes(speed, start, ((comes_at - 0.2 - early) * 1e6) as i64);
            assert!(slowest > speed - 0.1 && entered.is_some(), "{speed} m/s, {early} s: {slowest:.2} m/s");
        }
    }
}

#[test]
fn one_that_is_much_too_early_goes_on_slowly_and_goes_in_when_its_pass_begins() {
    for (speed, start) in COMERS {
        for late in [4.0, 8.0] {
            let begins = (CROSSING - HALF - start) / speed + late;
            let (hardest, slowest, entered) = comes(speed, start, ((begins - 0.2) * 1e6) as i64);
            let entered = entered.unwrap_or(f64::MAX);
            let what = format!(
                "{speed} m/s, {begins:.2} s: {hardest:.2} m/s2, {slowest:.2} m/s, in the area at {entered:.2} s"
            );
            assert!((begins..begins + 1.5).contains(&entered), "{what}");
            assert!(hardest > -2.0 && slowest > 1.5 || late > 4.0, "{what}");
        }
    }
}
