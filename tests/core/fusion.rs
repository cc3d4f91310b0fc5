//! The fused track of the vehicle ahead against a Kalman filter in float64. That filter takes all measurements in the order of when they
//! were taken; the core gets each message late, after views that were taken since its stamp.

use std::cmp::Ordering;

use holdover::fusion::{Fusion, Measured, Motion};
use holdover::peers::Sample;
use holdover::time::{Duration, Instant};
use holdover::units::{Acceleration, Distance, Position, Speed};

/// The errors of a radar in the simulator: uniform within ±0.25 m and ±0.1 m/s.
const VIEW_ERRORS: [f64; 2] = [0.25, 0.1];

/// A linear congruential generator, so that the test is the same everywhere.
struct Draws(u64);

impl Draws {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, largest: f64) -> f64 {
        (2.0 * self.unit() - 1.0) * largest
    }
}

/// The filter in float64: state, covariances, and the last step.
#[derive(Clone)]
struct Reference {
    at: f64,
    x: [f64; 3],
    p: [[f64; 3]; 3],
    step: f64,
}

type Square = [[f64; 3]; 3];

fn times(a: &Square, b: &Square) -> Square {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn transposed(a: &Square) -> Square {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

impl Reference {
    fn begin(at: f64, x: [f64; 3], deviations: [f64; 3]) -> Self {
        let p = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { deviations[i].powi(2) } else { 0.0 }));
        Self { at, x, p, step: 0.0 }
    }

    fn predict(&mut self, at: f64) {
        self.step = 0.0;
        while at - self.at > 1e-9 {
            let h = (at - self.at).min(0.25);
            let f = [[1.0, h, h * h / 2.0], [0.0, 1.0, h], [0.0, 0.0, 1.0 - h / 2.0]];
            let q = 1.0 / 1_024.0 + (self.x[2] * self.x[2] / 32.0).min(0.5);
            self.x = std::array::from_fn(|i| (0..3).map(|k| f[i][k] * self.x[k]).sum());
            self.p = times(&times(&f, &self.p), &transposed(&f));
            let noise = [
                [h.powi(5) / 20.0, h.powi(4) / 8.0, h.powi(3) / 6.0],
                [h.powi(4) / 8.0, h.powi(3) / 3.0, h.powi(2) / 2.0],
                [h.powi(3) / 6.0, h.powi(2) / 2.0, h],
            ];
            for (row, added) in self.p.iter_mut().zip(noise) {
                row.iter_mut().zip(added).for_each(|(p, n)| *p += q * n);
            }
            self.at += h;
            self.step = h;
        }
    }

    fn take_in(&mut self, place: usize, value: f64, deviation: f64) {
        let spread = self.p[place][place] + deviation * deviation;
        let gain: [f64; 3] = std::array::from_fn(|i| self.p[i][place] / spread);
        let off = value - self.x[place];
        let row = self.p[place];
        for ((x, of_x), gain) in self.x.iter_mut().zip(&mut self.p).zip(gain) {
            *x += gain * off;
            of_x.iter_mut().zip(row).for_each(|(p, with)| *p -= gain * with);
        }
        self.x[1] = self.x[1].max(0.0);
    }

    fn measure(&mut self, at: f64, position: f64, speed: f64, deviations: [f64; 2]) {
        self.predict(at);
        let off = speed - self.x[1];
        if off * off > 9.0 * (self.p[1][1] + deviations[1].powi(2)) && self.p[2][2] < 25.0 {
            self.p[1][1] += 25.0 * self.step.powi(2) / 3.0;
            self.p[1][2] += 25.0 * self.step / 2.0;
            self.p[2][1] += 25.0 * self.step / 2.0;
            self.p[2][2] += 25.0;
        }
        self.take_in(0, position, deviations[0]);
        self.take_in(1, speed, deviations[1]);
    }
}

/// A drive that brakes, stands and goes on: position, speed and acceleration at a time.
fn truth(profile: &[(f64, f64)], at: f64) -> [f64; 3] {
    let (mut x, mut v, mut from) = (1_000.0, 20.0f64, 0.0);
    for (index, (begins, a)) in profile.iter().enumerate() {
        assert!(*begins >= from);
        let ends = profile.get(index + 1).map_or(f64::INFINITY, |next| next.0).min(at);
        let lasts = ends - begins;
        let stops = if *a < 0.0 { (v / -a).min(lasts) } else { lasts };
        x += v * stops + a * stops * stops / 2.0;
        v += a * stops;
        from = *begins;
        if ends >= at {
            return [x, v, if stops < lasts { 0.0 } else { *a }];
        }
    }
    [x, v, 0.0]
}

fn instant(at: f64) -> Instant {
    Instant::from_micros(0).plus(Duration::from_micros((at * 1e6).round() as i64))
}

fn position(m: f64) -> Position {
    Position::from_bits((m * f64::from(1 << 20)).round() as i64)
}

fn speed(mps: f64) -> Speed {
    Speed::from_bits((mps * f64::from(1 << 23)).round() as i32)
}

fn distance(m: f64) -> Distance {
    Distance::from_bits((m * f64::from(1 << 20)).round() as i32)
}

fn message(at: f64, [x, v, a]: [f64; 3]) -> Sample {
    Sample {
        at: instant(at),
        position: position(x),
        speed: speed(v),
        acceleration: Acceleration::from_bits((a * f64::from(1 << 25)).round() as i32),
        position_accuracy: Some(distance(0.05)),
        speed_accuracy: Some(speed(0.02)),
        ..Sample::UNKNOWN
    }
}

/// By how much the core is off the reference, at most: position, speed and acceleration.
fn largest_off(largest: [f64; 3], motion: &Motion, reference: &Reference) -> [f64; 3] {
    let (_, v, a) = (0, motion.speed.to_bits(), motion.acceleration.to_bits());
    let own = [
        motion.position.to_bits() as f64 / f64::from(1 << 20),
        f64::from(v) / f64::from(1 << 23),
        f64::from(a) / f64::from(1 << 25),
    ];
    std::array::from_fn(|i| largest[i].max((own[i] - reference.x[i]).abs()))
}

const DRIVE: &[(f64, f64)] = &[
    (0.0, 0.0),
    (6.0, -2.0),
    (7.0, 0.0),
    (10.0, -8.0),
    (11.5, 0.0),
    (14.0, 1.5),
    (18.0, 0.0),
    (20.0, -5.0),
    (26.0, 1.0),
];

/// Drives 30 s with views at 50 Hz and messages at 10 Hz, which are late by so much, and a share of which is lost. Returns by how much
/// the core is off the reference at most, and the reference off the truth in the speed, rms.
fn drive(seed: u64, late_s: f64, loss: f64) -> ([f64; 3], f64) {
    let mut draws = Draws(seed);
    let mut fusion = Fusion::new();
    let first = message(0.0, truth(DRIVE, 0.0));
    let mut newest = first;
    let mut on_the_way: Vec<(f64, f64)> = Vec::new();
    // The measurements that have arrived, and what older ones made of the reference.
    let mut taken: Vec<Taken> = Vec::new();
    let mut before = Reference::begin(0.0, truth(DRIVE, 0.0), [0.025, 0.01, 0.5]);
    let (mut largest, mut squares, mut count) = ([0.0; 3], 0.0, 0.0);
    for tick in 1..1_500 {
        let now = f64::from(tick) * 0.02;
        let [x, v, _] = truth(DRIVE, now);
        if tick % 5 == 2 && draws.unit() >= loss {
            let stamp = now - 0.007;
            on_the_way.push((stamp, now + late_s));
        }
        if let Some(place) = on_the_way.iter().position(|(_, due)| *due <= now) {
            let (stamp, _) = on_the_way.remove(place);
            newest = message(stamp, truth(DRIVE, stamp));
            fusion.hear(instant(now), &newest);
            taken.push((stamp, true, truth(DRIVE, stamp)));
        }
        let (seen, seen_mps) = (x + draws.within(VIEW_ERRORS[0]), (v + draws.within(VIEW_ERRORS[1])).max(0.0));
        let view = Measured {
            at: instant(now),
            position: position(seen),
            speed: speed(seen_mps),
            position_error: distance(0.15),
            speed_error: speed(0.06),
        };
        fusion.see(&view, &newest);
        let motion = fusion.update().unwrap();
        taken.push((now, false, [seen, seen_mps, 0.0]));
        // The reference takes all of them in anew, in their order.
        taken.sort_by(|a, b| a.0.partial_cmp(&b.0).unwrap_or(Ordering::Equal));
        // Nothing that is older than 1 s comes any more.
        while taken.first().is_some_and(|first| first.0 < now - 1.0) {
            take(&mut before, &taken.remove(0));
        }
        let mut reference = before.clone();
        taken.iter().for_each(|one| take(&mut reference, one));
        largest = largest_off(largest, &motion, &reference);
        squares += (reference.x[1] - v).powi(2);
        count += 1.0;
    }
    (largest, f64::sqrt(squares / count))
}

/// A measurement: its time, whether it is a message, and what it says.
type Taken = (f64, bool, [f64; 3]);

fn take(reference: &mut Reference, (at, is_message, [x, v, a]): &Taken) {
    reference.measure(*at, *x, *v, if *is_message { [0.025, 0.01] } else { [0.15, 0.06] });
    if *is_message {
        reference.take_in(2, *a, 0.5);
    }
}

#[test]
fn the_track_is_that_of_a_kalman_filter_in_float64_that_hears_everything_in_time() {
    for (late_s, loss) in [(0.0, 0.0), (0.1, 0.1), (0.2, 0.4), (0.28, 0.6)] {
        for seed in 1..4 {
            let (off, rms) = drive(seed, late_s, loss);
            assert!(off[0] < 0.002 && off[1] < 0.004 && off[2] < 0.05, "late {late_s} s, loss {loss}: {off:?}");
            assert!(rms < 0.06, "late {late_s} s, loss {loss}: {rms} m/s");
        }
    }
}

#[test]
fn an_unannounced_braking_is_followed_within_0_1_s_though_nothing_is_heard() {
    for (seed, braking) in [(1, 2.0), (2, 5.0), (3, 8.0), (4, 8.0)] {
        let profile = [(0.0, 0.0), (4.0, -braking)];
        let mut draws = Draws(seed);
        let mut fusion = Fusion::new();
        let heard = message(0.0, truth(&profile, 0.0));
        for tick in 1..=220 {
            let now = f64::from(tick) * 0.02;
            let [x, v, _] = truth(&profile, now);
            let view = Measured {
                at: instant(now),
                position: position(x + draws.within(VIEW_ERRORS[0])),
                speed: speed(v + draws.within(VIEW_ERRORS[1])),
                position_error: distance(0.15),
                speed_error: speed(0.06),
            };
            fusion.see(&view, &heard);
            let off = (f64::from(fusion.update().unwrap().speed.to_bits()) / f64::from(1 << 23) - v).abs();
            // Before, and from 0.1 s after the braking began.
            let least = if (4.0..4.1).contains(&now) { 1.0 } else { 0.15 };
            assert!(off < least, "braking by {braking} m/s², {now:.2} s: {off} m/s");
        }
    }
}
