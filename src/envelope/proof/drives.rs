//! Drives that start in the states of the lattice. The gate is asked for all that it gives, behind a near end that brakes at its hardest,
//! at once or later. Commands come late, ticks are missed, and lags are anywhere within the configured tolerances. The two never come
//! closer than the margin, at any moment until both stand. If they begin closer than the margin, they never come closer than at the
//! beginning.
//!
//! The plant is in float64, with the lag solved exactly in quarters of a tick. Its error is far below the micrometre that is allowed.

use super::lattice::{Case, cases};
use crate::envelope::*;
use crate::time::Duration;
use crate::units::{Acceleration, FineSeconds, Position, Speed};

/// The course of a drive.
#[derive(Clone, Copy, Debug)]
struct Course {
    lag: FineSeconds,
    /// By how much each command comes into force late; up to a period.
    late: f64,
    /// Ticks that are missed in a row, once in the ramp of an emergency braking.
    missed: u32,
    /// When the vehicle ahead begins to brake. Until then it keeps its speed.
    brakes_after: f64,
}

#[derive(Clone, Copy, Debug)]
struct World {
    way: f64,
    speed: f64,
    acceleration: f64,
    rear: f64,
    other: f64,
}

fn number(acceleration: Acceleration) -> f64 {
    acceleration.get().to_num()
}

impl World {
    /// Moves both on, the ego under this demand and the vehicle ahead with this braking.
    fn goes_on(&mut self, lag: f64, demand: f64, braking: f64, time: f64) {
        let kept = if lag > 0.0 { (-time / lag).exp() } else { 0.0 };
        let (off, fades) = (self.acceleration - demand, lag * (1.0 - kept));
        let speed = self.speed + demand * time + off * fades;
        self.way += self.speed * time + 0.5 * demand * time * time + lag * off * (time - fades);
        (self.speed, self.acceleration) = if speed > 0.0 { (speed, demand + off * kept) } else { (0.0, 0.0) };
        let moves = if braking > 0.0 { time.min(self.other / braking) } else { time };
        self.rear += self.other * moves - 0.5 * braking * moves * moves;
        self.other = (self.other - braking * time).max(0.0);
    }

    /// What the unit knows of it at best: in words, rounded to the less safe side.
    fn known(&self, case: &Case, last: Acceleration) -> (Ego, Obstacle) {
        let word = |x: f64, fraction: i32| x * 2f64.powi(fraction);
        let ego = Ego {
            position: Position::from_bits(word(self.way, 20).ceil() as i64),
            speed: Speed::from_bits(word(self.speed, 23).ceil() as i32),
            acceleration: Acceleration::from_bits(word(self.acceleration, 25).ceil() as i32),
            last,
            lag: case.ego.lag,
        };
        let obstacle = Obstacle {
            position: Position::from_bits(word(self.rear, 20).floor() as i64),
            speed: Speed::from_bits(word(self.other, 23).floor() as i32),
            braking: case.obstacle.braking,
        };
        (ego, obstacle)
    }
}

/// The least distance beyond the margin, or beyond the distance at the beginning where that is less.
fn drive(case: &Case, course: &Course) -> f64 {
    let period = case.period.as_micros() as f64 * 1e-6;
    let (lag, braking) = (course.lag.get().to_num::<f64>(), number(case.obstacle.braking));
    let margin = case.limits.margin.get().to_num::<f64>();
    let mut world = World {
        way: 0.0,
        speed: case.ego.speed.get().to_num(),
        acceleration: number(case.ego.acceleration),
        rear: case.obstacle.position.get().to_num(),
        other: case.obstacle.speed.get().to_num(),
    };
    let (mut last, mut since, mut least, mut now) = (case.ego.last, case.period, f64::MAX, 0.0);
    let margin = margin.min(world.rear);
    let ramp = (3.0 + number(case.limits.braking)) / case.limits.jerk.get().to_num::<f64>();
    let between = ((ramp + 1.0) / period) as u32;
    for tick in 0..6_000 {
        let (ego, obstacle) = world.known(case, last);
        let spare = spare(&case.limits, &ego, &obstacle);
        let situation = Situation { is_fresh: true, spare };
        let out = gate(&case.limits, Acceleration::MAX, &ego, &situation, case.period, since);
        let told = encodable(&case.limits, out);
        let missed = if tick % between == between / 2 { course.missed } else { 0 };
        let lasts = period * f64::from(1 + missed);
        for (demand, time) in [(last, course.late), (told, lasts - course.late)] {
            let parts = if time > 0.0 { 4 + 4 * missed } else { 0 };
            for _ in 0..parts {
                let part = time / f64::from(parts);
                let brakes = if now >= course.brakes_after { braking } else { 0.0 };
                world.goes_on(lag, number(demand), brakes, part);
                now += part;
                least = least.min(world.rear - world.way - margin);
            }
        }
        (last, since) = (told, case.period.times(i64::from(1 + missed)));
        if world.speed == 0.0 && world.other == 0.0 && told <= Acceleration::ZERO {
            break;
        }
    }
    least
}

#[test]
fn no_drive_comes_closer_than_the_margin_within_the_tolerances() {
    let (mut judged, mut tightest) = (0, f64::MAX);
    for (index, case) in cases(0..800).enumerate() {
        let late_at_most = case.limits.delay.min(case.period);
        let late = [Duration::ZERO, late_at_most][index % 2];
        let left = case.limits.delay.minus(late).as_micros() / case.period.as_micros();
        let lags = case.lags();
        let course = Course {
            lag: lags[index % lags.len()],
            late: late.as_micros() as f64 * 1e-6,
            missed: [left as u32, 0][index / 2 % 2],
            brakes_after: [0.0, 0.0, 0.7, 3.0][index / 4 % 4],
        };
        if !is_safe(&case.limits, &case.ego, &case.obstacle, case.period) {
            continue;
        }
        let least = drive(&case, &course);
        assert!(least > -1e-6, "{least}: {case:?} {course:?}");
        (judged, tightest) = (judged + 1, tightest.min(least));
    }
    assert!(judged > 1_000 && tightest < 0.1, "{judged}, {tightest}");
}
