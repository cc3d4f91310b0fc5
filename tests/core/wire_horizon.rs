//! How well a horizon is rebuilt from its knots as they stand on the wire: leaders and followers of every kind, stops
//! and restarts included, against the path that was predicted.

use holdover::time::Duration;
use holdover::units::{Acceleration, Distance, Speed};
use holdover::wire::curve::{Curve, Segment};
use holdover::wire::horizon::{Knot, Knots};

const STEP: f64 = 0.01;

/// SplitMix64: the same numbers on every machine.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    /// Roughly normal.
    fn around(&mut self, deviation: f64) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>().mul_add(deviation, -6.0 * deviation)
    }
}

/// A predicted path, a state every [`STEP`].
#[derive(Default)]
struct Path {
    way: Vec<f64>,
    speed: Vec<f64>,
    acceleration: Vec<f64>,
}

impl Path {
    fn push(&mut self, way: f64, speed: f64, acceleration: f64) {
        self.way.push(way);
        self.speed.push(speed);
        self.acceleration.push(acceleration);
    }

    fn at(&self, seconds: f64) -> (f64, f64, f64) {
        let place = (seconds / STEP + 1e-9).min((self.way.len() - 1) as f64);
        let (i, part) = (place as usize, place.fract());
        let j = (i + 1).min(self.way.len() - 1);
        let mix = |of: &[f64]| of[i] + part * (of[j] - of[i]);
        let speed = mix(&self.speed);
        (self.way[i] + part * STEP * (self.speed[i] + speed) / 2.0, speed, mix(&self.acceleration))
    }
}

/// The vehicle that a demand moves: jerk limit, actuator lag, no driving backwards.
struct Vehicle {
    way: f64,
    speed: f64,
    acceleration: f64,
    demand: f64,
    lag: f64,
    jerk: f64,
}

impl Vehicle {
    fn step(&mut self, wanted: f64) {
        self.demand += (wanted - self.demand).clamp(-self.jerk * STEP, self.jerk * STEP);
        self.acceleration = self.demand + (self.acceleration - self.demand) * (-STEP / self.lag).exp();
        let speed = (self.speed + self.acceleration * STEP).max(0.0);
        if speed == 0.0 {
            self.acceleration = 0.0;
        }
        self.way += (self.speed + speed) / 2.0 * STEP;
        self.speed = speed;
    }
}

fn start_speed(random: &mut Random) -> f64 {
    if random.chance(0.15) { random.between(0.0, 3.0) } else { random.between(0.0, 35.0) }
}

/// Algorithm 2 as a vehicle drives it.
fn leader(random: &mut Random, steps: usize) -> Path {
    let speed = start_speed(random);
    let target = if random.chance(0.5) { (speed + random.around(4.0)).max(3.0) } else { random.between(3.0, 35.0) };
    let comfort = random.between(0.5, 2.0);
    let law = |speed: f64| (0.73 * (1.0 - (speed / target).powi(4))).max(-comfort);
    let (lag, jerk) = (random.between(0.1, 0.8), random.between(2.0, 10.0));
    let demand = if random.chance(0.5) { law(speed) } else { random.around(1.5).clamp(-6.0, 2.5) };
    let acceleration = demand + random.around(0.5).clamp(-jerk * lag, jerk * lag);
    let mut vehicle = Vehicle { way: 0.0, speed, acceleration, demand, lag, jerk };
    let mut path = Path::default();
    path.push(0.0, speed, acceleration);
    for _ in 0..steps {
        vehicle.step(law(vehicle.speed));
        path.push(vehicle.way, vehicle.speed, vehicle.acceleration);
    }
    path
}

/// A vehicle ahead that brakes, accelerates, stops and moves off at random.
fn erratic(random: &mut Random, speed: f64, steps: usize) -> Path {
    let demands = [random.between(-6.0, 2.5) * f64::from(u8::from(random.chance(0.6))), random.between(-6.0, 2.5)];
    let change = random.between(0.0, steps as f64) as usize;
    let acceleration = random.around(1.0).clamp(-5.0, 2.5);
    let (lag, jerk) = (random.between(0.1, 0.8), random.between(2.0, 10.0));
    let mut vehicle = Vehicle { way: 0.0, speed, acceleration, demand: acceleration, lag, jerk };
    let mut path = Path::default();
    path.push(0.0, speed, acceleration);
    for step in 0..steps {
        vehicle.step(demands[usize::from(step >= change)]);
        path.push(vehicle.way, vehicle.speed, vehicle.acceleration);
    }
    path
}

/// Algorithm 4 as a vehicle drives it, behind a leader or behind anything.
fn follower(random: &mut Random, steps: usize) -> Path {
    let ahead = if random.chance(0.4) {
        leader(random, steps)
    } else {
        let speed = start_speed(random);
        erratic(random, speed, steps)
    };
    let (gain, damping, gap) = (random.between(0.05, 1.0), random.between(0.5, 3.0), random.between(0.6, 2.0));
    let (lag, jerk) = (random.between(0.1, 0.8), random.between(2.0, 10.0));
    let (most, least) = (random.between(0.7, 2.5), -random.between(2.0, 6.0));
    let speed = (ahead.speed[0] + random.around(1.5)).max(0.0);
    let first = -(2.0 + speed * gap + 4.8) + random.around(4.0);
    let kappa = gain * STEP;
    let law = |way: f64, speed: f64, step: usize| {
        let (lead, lead_speed) = (ahead.way[step], ahead.speed[step]);
        let next = first + way + speed * STEP;
        let wanted =
            (speed - kappa * (next - lead + 4.8 + 2.0 - damping * lead_speed)) / (1.0 + kappa * (gap + damping));
        ((wanted - speed) / STEP).clamp(least, most)
    };
    let demand = if random.chance(0.7) { law(0.0, speed, 0) } else { random.around(1.2).clamp(least, most) };
    let acceleration = random.around(1.2).clamp(demand - jerk * lag, demand + jerk * lag).clamp(-6.0, 2.5);
    let mut vehicle = Vehicle { way: 0.0, speed, acceleration, demand, lag, jerk };
    let mut path = Path::default();
    path.push(0.0, speed, acceleration);
    for step in 0..steps {
        vehicle.step(law(vehicle.way, vehicle.speed, step + 1));
        path.push(vehicle.way, vehicle.speed, vehicle.acceleration);
    }
    path
}

fn knot((way, speed, acceleration): (f64, f64, f64)) -> Knot {
    Knot {
        displacement: Distance::from_bits((way * f64::from(1 << 20)).round() as i32),
        speed: Speed::from_bits((speed * f64::from(1 << 23)).round() as i32),
        acceleration: Acceleration::from_bits((acceleration * f64::from(1 << 25)).round() as i32),
        bow: Distance::ZERO,
    }
}

/// The knots of a path.
fn through(start: Knot, length: Duration, path: &Path) -> Knots {
    let at = |after: Duration| knot(path.at(after.as_micros() as f64 / 1e6));
    let place = |after| {
        let Knot { displacement, speed, .. } = at(after);
        (displacement, speed)
    };
    Knots::through(1, start, length, place, |after| at(after).acceleration)
}

fn metres(distance: Distance) -> f64 {
    f64::from(distance.to_bits()) / f64::from(1 << 20)
}

fn metres_per_s(speed: Speed) -> f64 {
    f64::from(speed.to_bits()) / f64::from(1 << 23)
}

fn start_of(path: &Path) -> Knot {
    knot(path.at(0.0)).rounded()
}

/// Largest errors of way and speed on the grid, through encoder and decoder.
fn rebuild_errors(path: &Path) -> (f64, f64) {
    let length = Duration::from_micros(((path.way.len() - 1) as f64 * STEP * 1e6).round() as i64);
    let start = start_of(path);
    let sent = through(start, length, path);
    let heard = Knots::decode(&sent.encode());
    assert_eq!(sent, heard);
    let curve = Curve::new(start, &heard, length);
    let grid: Vec<_> = curve.walk(Duration::ZERO, Duration::from_millis(10)).collect();
    assert_eq!(grid.len(), path.way.len());
    grid.iter().zip(path.way.iter().zip(&path.speed)).fold((0.0, 0.0), |(way, speed), ((d, v), (x, w))| {
        (f64::max(way, (metres(*d) - x).abs()), f64::max(speed, (metres_per_s(*v) - w).abs()))
    })
}

fn sorted_errors(seed: u64, seconds: usize, count: usize) -> Vec<f64> {
    let mut random = Random(seed);
    let steps = seconds * 100;
    let mut errors: Vec<_> = (0..count)
        .map(|n| {
            let path = if n % 2 == 0 { follower(&mut random, steps) } else { leader(&mut random, steps) };
            rebuild_errors(&path).0
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    let of = |share: f64| errors[((count - 1) as f64 * share) as usize] * 1000.0;
    println!("{seconds} s: 50 % {:.2} mm, 99 % {:.2} mm, all {:.2} mm", of(0.5), of(0.99), of(1.0));
    errors
}

const PATHS: usize = 10_000;

#[test]
fn a_horizon_of_up_to_four_seconds_is_rebuilt_to_within_a_centimetre() {
    for seconds in [2, 4] {
        let errors = sorted_errors(11, seconds, PATHS);
        assert!(errors[PATHS - 1] <= 0.010, "{seconds} s: {} m", errors[PATHS - 1]);
        assert!(errors[PATHS / 2] <= 0.001, "{seconds} s: {} m", errors[PATHS / 2]);
    }
}

#[test]
fn a_horizon_of_six_seconds_is_rebuilt_to_within_a_centimetre_99_times_of_100() {
    let errors = sorted_errors(12, 6, PATHS);
    assert!(errors[PATHS * 99 / 100] <= 0.010, "{} m", errors[PATHS * 99 / 100]);
    assert!(errors[PATHS - 1] <= 0.060, "{} m", errors[PATHS - 1]);
}

#[test]
fn a_quintic_in_fixed_point_is_the_quintic_in_floating_point() {
    let mut random = Random(13);
    let (mut worst_way, mut worst_speed, mut worst_acceleration) = (0.0f64, 0.0f64, 0.0f64);
    for _ in 0..2000 {
        let h = random.between(0.05, 2.0);
        let (v0, a0, a1) = (random.between(10.0, 60.0), random.between(0.01, 3.0), random.between(-3.0, 3.0));
        let v1 = v0 + (a0 + a1) / 2.0 * h + random.around(0.3) * h;
        let way = (v0 + v1) / 2.0 * h + (a0 - a1) * h * h / 12.0 + random.around(0.1) * h * h;
        let from = knot((3.0, v0, a0));
        let to = knot((3.0 + way, v1, a1));
        let micros = (h * 1e6).round();
        let h = micros / 1e6;
        let segment = Segment::new(&from, &to, Duration::from_micros(micros as i64));
        let d = way - v0 * h - a0 * h * h / 2.0;
        let e = (v1 - v0) * h - a0 * h * h;
        let f = (a1 - a0) * h * h;
        let c = [
            3.0,
            v0 * h,
            a0 * h * h / 2.0,
            10.0 * d - 4.0 * e + f / 2.0,
            -15.0 * d + 7.0 * e - f,
            6.0 * d - 3.0 * e + f / 2.0,
        ];
        for part in 0..=50 {
            let after = (micros * f64::from(part) / 50.0).round();
            let s = after / micros;
            let sum = |times: &dyn Fn(usize) -> f64, lowered: usize| -> f64 {
                (lowered..6).map(|k| c[k] * times(k) * s.powi((k - lowered) as i32)).sum()
            };
            let got = segment.at(Duration::from_micros(after as i64));
            let speed = sum(&|k| k as f64, 1) / h;
            if speed < 0.0 {
                continue;
            }
            worst_way = worst_way.max((metres(got.displacement) - sum(&|_| 1.0, 0)).abs());
            worst_speed = worst_speed.max((metres_per_s(got.speed) - speed).abs());
            let acceleration = f64::from(got.acceleration.to_bits()) / f64::from(1 << 25);
            worst_acceleration =
                worst_acceleration.max((acceleration - sum(&|k| (k * (k - 1)) as f64, 2) / (h * h)).abs());
        }
    }
    println!("way {worst_way:.2e} m, speed {worst_speed:.2e} m/s, acceleration {worst_acceleration:.2e} m/s²");
    assert!(worst_way < 1e-4 && worst_speed < 1e-3 && worst_acceleration < 0.05);
}

#[test]
fn a_grid_and_single_readings_agree_from_any_start_with_any_step() {
    let mut random = Random(14);
    for _ in 0..300 {
        let path = follower(&mut random, 400);
        let start = start_of(&path);
        let length = Duration::from_millis(4000);
        let knots = through(start, length, &path);
        let curve = Curve::new(start, &knots, length);
        let first = Duration::from_micros(random.between(0.0, 4.2e6) as i64);
        let step = Duration::from_micros(random.between(1e3, 1e6) as i64);
        let mut at = first;
        for (way, speed) in curve.walk(first, step) {
            let single = curve.at(at);
            assert!((metres(way) - metres(single.displacement)).abs() < 5e-5);
            assert!((metres_per_s(speed) - metres_per_s(single.speed)).abs() < 2e-3, "{speed:?} {single:?}");
            at = at.plus(step);
        }
        assert!(at > length, "the grid ends with the horizon");
    }
}

#[test]
fn no_knots_whatever_overflow_or_drive_backwards_in_time() {
    let mut random = Random(15);
    for _ in 0..3000 {
        let mut any = || {
            let way = random.between(0.0, 262.0);
            let speed = if random.chance(0.3) { 0.0 } else { random.between(0.0, 65.0) };
            Knot {
                bow: Distance::from_mm(random.between(-20.0, 15.0) as i32),
                ..knot((way, speed, random.between(-20.0, 20.0)))
            }
        };
        let (from, to) = (any(), any());
        let length = random.between(1.0, 12e6) as i64;
        let segment = Segment::new(&from, &to, Duration::from_micros(length));
        for part in 0..=20 {
            let state = segment.at(Duration::from_micros(length * part / 20));
            assert!(state.speed >= Speed::ZERO);
        }
        assert_eq!(segment.at(Duration::ZERO).displacement.to_mm(), from.displacement.to_mm());
    }
}
