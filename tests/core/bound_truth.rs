//! The truth never leaves the bound: random vehicles within their published limits, samples anywhere within their
//! accuracies, silences, delays, losses and clock errors, through real frames and the unit's two doors. And none of them
//! is ever taken for a liar.

use crate::rig;
use crate::rig::plant::{Body, TOP};
use crate::rig::random::Random;
use crate::rig::{Rig, TARGET, instant, m_of, mps_of};
use holdover::Config;
use holdover::model::bound::Bound;
use holdover::time::Duration;
use holdover::wire::motion::WirePosition;
use holdover::wire::{Predecessor, Said};

/// How one vehicle drives: an acceleration from each moment on, within its limits, and its state at that moment.
struct Truth {
    pieces: Vec<(i64, f64, Body)>,
}

impl Truth {
    fn random(random: &mut Random, (acceleration, braking): (f64, f64), until: i64) -> Self {
        let mut body = Body { position: random.between(-6_000.0, 6_000.0), speed: random.extreme(0.0, TOP) };
        let (mut at, mut pieces) = (-1_000_000, Vec::new());
        while at < until {
            let a = match random.below(6) {
                0 => 0.0,
                1 => -braking,
                2 => acceleration,
                3 => random.between(-0.5, 0.5).clamp(-braking, acceleration),
                _ => random.between(-braking, acceleration),
            };
            pieces.push((at, a, body));
            let lasts = match random.below(3) {
                0 => random.between(1e4, 3e5),
                1 => random.between(3e5, 4e6),
                _ => random.between(1e6, 2e7),
            } as i64;
            body = body.after(a, lasts as f64 * 1e-6);
            at += lasts;
        }
        Self { pieces }
    }

    fn at(&self, at: i64) -> Body {
        let index = self.pieces.partition_point(|(from, _, _)| *from <= at) - 1;
        let (from, a, body) = self.pieces[index];
        body.after(a, (at - from) as f64 * 1e-6)
    }
}

/// What differs from case to case.
#[derive(Debug)]
struct Case {
    synchronised: bool,
    limits: (f64, f64),
    is_published: bool,
    accuracy: Option<(f64, f64)>,
    clock_error: i64,
    delays: u64,
    loss: f64,
    lasts: i64,
}

impl Case {
    fn random(random: &mut Random, lasts: i64) -> Self {
        let is_published = random.happens(0.7);
        let fiftieths = |a: f64| (a * 50.0).round() / 50.0;
        let limits = if is_published {
            (fiftieths(random.extreme(0.1, 8.0)), fiftieths(random.extreme(0.1, 14.0)))
        } else {
            (6.0, 12.0)
        };
        let published = (random.below(127) as f64 * 0.05, random.below(63) as f64 * 0.02);
        Self {
            synchronised: random.happens(0.6),
            limits,
            is_published,
            accuracy: random.happens(0.85).then_some(published),
            clock_error: [60, 500, 5_000][random.below(3) as usize],
            delays: random.below(3),
            loss: [0.0, 0.1, 0.6][random.below(3) as usize],
            lasts,
        }
    }

    /// From a message's stamp to its arrival, in microseconds.
    fn delay(&self, random: &mut Random) -> i64 {
        match self.delays {
            0 => 0,
            1 => random.between(0.0, 100_000.0) as i64,
            _ => random.extreme(0.0, 1_999_900.0) as i64,
        }
    }
}

/// A message under way.
struct Sent {
    arrives: i64,
    motion: Said,
}

/// 95 % of the errors are within what is published, and none is more than three times as large. Where nothing is published, none is
/// larger than what is taken then.
fn error(random: &mut Random, published: Option<f64>, otherwise: f64) -> f64 {
    let Some(accuracy) = published else { return random.extreme(-otherwise, otherwise) };
    let largest = if random.happens(0.05) { 3.0 * accuracy } else { accuracy };
    random.extreme(-largest, largest)
}

/// All messages of a case in the order of their arrival.
fn messages(random: &mut Random, rig: &mut Rig, case: &Case, truth: &Truth) -> Vec<Sent> {
    // Both clocks together keep to the limit, and the stamp's rounding takes its half step of it.
    let (mut at, mut sent) = (0, Vec::new());
    while at < case.lasts {
        let body = truth.at(at);
        let clock = random.extreme(-(case.clock_error as f64 - 52.0) / 2.0, (case.clock_error as f64 - 52.0) / 2.0);
        let speed = (body.speed + error(random, case.accuracy.map(|(_, speed)| speed), 1.5)).clamp(0.0, TOP);
        let position = body.position + error(random, case.accuracy.map(|(way, _)| way), 5.0);
        let mut motion = rig.motion(TARGET, at + clock as i64, position, speed, 0.0, 0.0, case.accuracy);
        motion.acceleration = rig::mps2(random.between(-1.0, 1.0) * case.limits.1);
        if !random.happens(case.loss) {
            sent.push(Sent { arrives: at + case.delay(random), motion: Said::Motion(motion) });
        }
        at += if random.happens(0.01) { random.between(1e6, 1.5e8) as i64 } else { 100_000 };
    }
    sent.sort_by_key(|sent| sent.arrives);
    sent
}

fn assert_inside(bound: &Bound, body: Body, context: &str) {
    let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
    assert!(low <= body.position && body.position <= high, "{context}: {} in {low}..{high}", body.position);
    let (low, high) = (mps_of(bound.lowest_speed()), mps_of(bound.highest_speed()));
    assert!(low <= body.speed && body.speed <= high, "{context}: {} in {low}..{high}", body.speed);
}

fn config(case: &Case) -> Config {
    let mut config = rig::config();
    config.link.clock_error = Duration::from_micros(case.clock_error);
    config
}

/// Runs a case; how many instants were checked, and how many of them on the wire.
fn run(seed: u64, lasts: i64, step: i64, ticks_every: i64) -> (u64, u64) {
    let mut random = Random::new(seed);
    let case = Case::random(&mut random, lasts);
    let truth = Truth::random(&mut random, case.limits, lasts + 60_000_000);
    let mut rig = Rig::new(&config(&case));
    let off = random.extreme(-(case.clock_error as f64 - 52.0) / 2.0, (case.clock_error as f64 - 52.0) / 2.0) as i64;
    if case.synchronised {
        rig.power_up(true, off);
    }
    let _ = rig.request(-20_000, false, Predecessor::Station(TARGET));
    let _ = rig.request(-10_000, false, Predecessor::Station(TARGET));
    for at in [-60_000, -50_000, -40_000] {
        if case.is_published {
            let _ = rig.target(at, Said::DrivingParameters(rig::parameters(case.limits.0, case.limits.1)));
        }
    }
    let sent = messages(&mut random, &mut rig, &case, &truth);
    let (mut sent, mut checked, mut told) = (sent.iter().peekable(), 0, 0);
    let mut first = true;
    for now in (0..lasts).step_by(step as usize) {
        let before = now - step;
        if case.synchronised && now % 500_000 < step {
            rig.synchronise(before.max(-50_000), off);
        }
        while let Some(message) = sent.next_if(|message| message.arrives <= now) {
            let taken = rig.target(message.arrives, message.motion);
            use holdover::health::Cause::{Duplicate, NotYetTrusted, OutOfOrder, Torn};
            // The first frames of an identifier are not trusted, and a lost sample may have torn the next one.
            let harmless = matches!(taken, Ok(()) | Err(OutOfOrder | Duplicate)) || first;
            assert!(harmless || matches!(taken, Err(NotYetTrusted | Torn)), "seed {seed} at {now}: {taken:?}");
            first = taken.is_err() && first;
        }
        let Some(bound) = rig.unit.bound(2, instant(now)) else { continue };
        assert_inside(&bound, truth.at(now), &format!("seed {seed} at {now}"));
        let later = now + random.below(30_000_000) as i64;
        let horizon = rig.unit.bound(2, instant(later)).unwrap();
        assert_inside(&horizon, truth.at(later), &format!("seed {seed} from {now} at {later}"));
        checked += 1;
        if ticks_every > 0 && now % ticks_every == 0 {
            told += u64::from(is_told(&mut rig, now, truth.at(now), seed));
        }
    }
    (checked, told)
}

/// Whether a bound stands on the wire; then the truth is inside it, in the wire's own decimals.
fn is_told(rig: &mut Rig, now: i64, truth: Body, seed: u64) -> bool {
    let heard = rig.tick(now);
    let Some((estimate, ends)) = heard.estimate.and_then(|estimate| Some((estimate, estimate.ends?))) else {
        return false;
    };
    let from = WirePosition::from_mm((truth.position * 1e3).round() as i64);
    let position = (truth.position * 1e3).round() / 1e3 - f64::from(from.mm_ahead_of(estimate.position)) / 1e3;
    let decimal =
        |word: i32, fraction: u32, step: f64| (f64::from(word) / 2f64.powi(fraction as i32) / step).round() * step;
    let (behind, ahead) = (decimal(ends.behind.to_bits(), 20, 0.02), decimal(ends.ahead.to_bits(), 20, 0.02));
    let (slower, faster) = (decimal(ends.slower.to_bits(), 23, 0.2), decimal(ends.faster.to_bits(), 23, 0.2));
    let speed = decimal(estimate.speed.to_bits(), 23, 0.002);
    let rounding = 1e-10; // of float64 itself
    assert!(position - behind <= truth.position + rounding, "seed {seed} at {now}: {position} - {behind}");
    assert!(position + ahead >= truth.position - rounding, "seed {seed} at {now}: {position} + {ahead}");
    assert!(speed - slower <= truth.speed + rounding, "seed {seed} at {now}: {speed} - {slower} {}", truth.speed);
    assert!(speed + faster >= truth.speed - rounding, "seed {seed} at {now}: {speed} + {faster} {}", truth.speed);
    true
}

#[test]
fn the_truth_is_inside_the_bound_at_every_one_of_a_million_ticks() {
    let checked: u64 = (0..120).map(|seed| run(seed, 100_000_000, 10_000, 0).0).sum();
    assert!(checked > 1_000_000, "{checked}");
}

#[test]
fn the_truth_is_inside_the_bound_on_the_wire() {
    let told: u64 = (1000..1060).map(|seed| run(seed, 20_000_000, 7_000, 70_000).1).sum();
    assert!(told > 5_000, "{told}");
}
