//! Limits that change: vehicles publish harder ones before they use them, and softer ones when they no longer use the others,
//! while their messages are late, lost, overtaken and silent for seconds. The truth, in float64, never leaves the bound, and no
//! honest sample is refused.

use crate::rig;
use crate::rig::plant::{Body, TOP};
use crate::rig::random::Random;
use crate::rig::{Rig, TARGET, instant, m_of, mps_of};
use holdover::health::Cause;
use holdover::wire::Said;

const STEP: i64 = 10_000;
/// Harder limits are published so long before they are used.
const ANNOUNCED: i64 = 10_000_000;
const ACCURACY: (f64, f64) = (0.5, 0.2);

/// What a vehicle publishes from each time on: acceleration and braking.
struct Published(Vec<(i64, f64, f64)>);

impl Published {
    fn random(random: &mut Random, lasts: i64) -> Self {
        let (mut at, mut all) = (-30_000_000, Vec::new());
        while at < lasts {
            let fiftieths = |a: f64| (a * 50.0).round() / 50.0;
            all.push((at, fiftieths(random.extreme(0.5, 5.0)), fiftieths(random.extreme(1.0, 11.0))));
            at += random.between(4e5, 3e7) as i64;
        }
        Self(all)
    }

    fn at(&self, at: i64) -> (f64, f64) {
        let (_, acceleration, braking) = self.0[self.0.partition_point(|(from, ..)| *from <= at) - 1];
        (acceleration, braking)
    }

    /// What it uses at the most: the softest that it has published for so long.
    fn used(&self, at: i64) -> (f64, f64) {
        let changes = self.0.iter().filter(|(from, ..)| (at - ANNOUNCED..=at).contains(from));
        let first = self.at(at - ANNOUNCED);
        changes.fold(first, |(a, b), (_, acceleration, braking)| (a.min(*acceleration), b.min(*braking)))
    }
}

/// One drive; the number of ticks that were checked.
fn drive(seed: u64) -> u32 {
    let mut random = Random::new(seed);
    let lasts = 60_000_000;
    let published = Published::random(&mut random, lasts);
    let mut rig = Rig::new(&rig::config());
    rig.power_up(true, 0);
    let mut body = Body { position: random.between(-1_000.0, 1_000.0), speed: random.extreme(0.0, TOP / 2.0) };
    let (mut pedal, mut holds) = (0.0, 0);
    let (mut silent_from, mut silent_to) = (-1, -1);
    let delays = [0.0, 1e5, 1.9e6][random.below(3) as usize];
    let mut under_way: Vec<(i64, Said)> = Vec::new();
    let mut checked = 0;
    for now in (0..lasts).step_by(STEP as usize) {
        if now % 500_000 == 0 {
            rig.synchronise(now, 0);
        }
        if now > silent_to && random.happens(0.002) {
            (silent_from, silent_to) = (now, now + random.between(2e5, 6e6) as i64);
        }
        let is_silent = (silent_from..silent_to).contains(&now);
        if now % 500_000 == 200_000 && !is_silent {
            let (acceleration, braking) = published.at(now);
            let arrives = now + random.between(0.0, delays) as i64;
            under_way.push((arrives, Said::DrivingParameters(rig::parameters(acceleration, braking))));
        }
        if now % 100_000 == 0 {
            let position = body.position + random.extreme(-ACCURACY.0, ACCURACY.0);
            let speed = (body.speed + random.extreme(-ACCURACY.1, ACCURACY.1)).clamp(0.0, TOP);
            let motion = rig.motion(TARGET, now, position, speed, 0.0, 0.0, Some(ACCURACY));
            if !is_silent && !random.happens(0.1) {
                under_way.push((now + random.between(0.0, delays) as i64, Said::Motion(motion)));
            }
        }
        under_way.sort_by_key(|(arrives, _)| *arrives);
        while under_way.first().is_some_and(|(arrives, _)| *arrives <= now) {
            let (_, said) = under_way.remove(0);
            let taken = rig.target(now, said);
            // After 2 s of silence the slot may be another one's, until a motion says whose it is.
            let is_parameters = matches!(said, Said::DrivingParameters(_));
            let is_harmless = |cause| match cause {
                Cause::NotYetTrusted | Cause::Torn | Cause::OutOfOrder => true,
                Cause::StationConflict => is_parameters,
                _ => false,
            };
            assert!(taken.is_ok() || is_harmless(taken.unwrap_err()), "seed {seed} at {now}: {taken:?} {said:?}");
        }
        if let Some(bound) = rig.unit.bound(2, instant(now)) {
            let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
            let (slow, fast) = (mps_of(bound.lowest_speed()), mps_of(bound.highest_speed()));
            let rounding = 1e-6; // of some hundred thousand steps of the truth in float64
            assert!(
                low <= body.position + rounding && body.position <= high + rounding,
                "seed {seed} at {now}: {} in {low}..{high}",
                body.position
            );
            assert!(
                slow <= body.speed + rounding && body.speed <= fast + rounding,
                "seed {seed} at {now}: {} in {slow}..{fast}",
                body.speed
            );
            checked += 1;
        }
        if now >= holds {
            pedal = random.extreme(-1.0, 1.0);
            holds = now + random.between(2e5, 5e6) as i64;
        }
        let (acceleration, braking) = published.used(now);
        body = body.after(if pedal < 0.0 { pedal * braking } else { pedal * acceleration }, STEP as f64 * 1e-6);
    }
    checked
}

#[test]
fn the_truth_is_inside_the_bound_while_limits_change() {
    let checked: u32 = (0..100).map(drive).sum();
    assert!(checked > 400_000, "{checked}");
}

#[test]
fn a_vehicle_that_brakes_as_hard_as_it_published_and_then_publishes_less_is_inside_its_bound() {
    let mut rig = Rig::new(&rig::config());
    rig.power_up(true, 0);
    for at in [-60_000, -50_000, -40_000] {
        let _ = rig.target(at, Said::DrivingParameters(rig::parameters(2.0, 8.0)));
    }
    let mut body = Body { position: 500.0, speed: 25.0 };
    for n in 0..=100 {
        let now = n * 10_000;
        if n < 20 && n % 10 == 0 {
            let motion = rig.motion(TARGET, now, body.position, body.speed, 0.0, 0.0, Some((0.05, 0.02)));
            let _ = rig.target(now, Said::Motion(motion));
        }
        if n == 60 {
            assert_eq!(rig.target(now, Said::DrivingParameters(rig::parameters(2.0, 2.0))), Ok(()));
        }
        if let Some(bound) = rig.unit.bound(2, instant(now)) {
            assert!(m_of(bound.lowest_position()) <= body.position, "{n}");
            assert!(mps_of(bound.lowest_speed()) <= body.speed, "{n}");
        }
        body = body.after(if n < 60 { -8.0 } else { -2.0 }, 0.01);
    }
}
