//! The gate against the worst: every demand is full acceleration, the vehicle ahead brakes at its published worst, and what
//! starts safe never collides. The ego is a float64 plant with lagging actuators.

use crate::rig;
use crate::rig::plant::{Body, Plant};
use crate::rig::{metres, mps, mps2, mps2_of, place};
use holdover::config::Envelope;
use holdover::envelope::{self, Ego, Obstacle, Situation};
use holdover::model::bound::{AccelerationRange, Bound, Uncertainty};
use holdover::time::{Duration, Instant};
use holdover::units::{Acceleration, Distance, FineSeconds, Jerk};

const PERIOD: Duration = Duration::from_millis(10);
const H: f64 = 0.01;

fn gates() -> Vec<(Envelope, FineSeconds)> {
    let gentle = Envelope {
        acceleration: Acceleration::from_mm_per_s2(2_000),
        braking: Acceleration::from_mm_per_s2(4_000),
        jerk: Jerk::from_mm_per_s3(6_000),
        margin: Distance::from_mm(300),
        ..Envelope::CAR
    };
    let lags = [0, 120, 300, 700].map(FineSeconds::from_millis);
    lags.iter().flat_map(|lag| [(Envelope::CAR, *lag), (gentle, *lag)]).collect()
}

fn seen(plant: &Plant, last: Acceleration, lag: FineSeconds) -> Ego {
    // Rounded to the less safe side, as the unit's own accuracies are.
    let one = Distance::from_bits(1);
    Ego {
        position: place(plant.position).ahead(one),
        speed: mps(plant.speed),
        acceleration: mps2(plant.acceleration),
        last,
        lag,
    }
}

fn is_safe(limits: &Envelope, ego: &Ego, stop_before: f64) -> bool {
    envelope::is_safe(limits, ego, &Obstacle::standing(place(stop_before)), PERIOD)
}

/// The gate behind one obstacle.
fn gated(limits: &Envelope, ego: &Ego, obstacle: &Obstacle) -> Acceleration {
    let situation = Situation { is_fresh: true, spare: envelope::spare(limits, ego, obstacle) };
    envelope::gate(limits, Acceleration::MAX, ego, &situation, PERIOD, PERIOD)
}

/// The nearest point ahead, margin included, that is safe to have to stop before.
fn nearest_safe(limits: &Envelope, ego: &Ego) -> f64 {
    let (mut unsafe_at, mut safe_at) = (f64::from(limits.margin.to_bits()) / f64::from(1 << 20), 1500.0);
    while safe_at - unsafe_at > 1e-4 {
        let middle = 0.5 * (unsafe_at + safe_at);
        *(if is_safe(limits, ego, middle) { &mut safe_at } else { &mut unsafe_at }) = middle;
    }
    safe_at
}

/// States on a dense grid: speed, acceleration, command in force.
fn states(limits: &Envelope) -> Vec<(f64, f64, f64)> {
    let (b, a) = (-mps2_of(limits.braking), mps2_of(limits.acceleration));
    let speeds = [0.0, 0.3, 1.0, 2.5, 5.0, 8.0, 13.4, 20.0, 27.0, 33.0, 40.0, 50.0];
    let pairs = [(0.0, 0.0), (a, a), (b, b), (a, b), (b, a), (-1.0, 0.5)];
    speeds.iter().flat_map(|v| pairs.map(|(acceleration, last)| (*v, acceleration, last))).collect()
}

#[test]
fn full_acceleration_never_takes_the_ego_beyond_the_point_it_has_to_stop_before() {
    let mut closest = f64::MAX;
    for (limits, lag) in gates() {
        let margin = f64::from(limits.margin.to_bits()) / f64::from(1 << 20);
        for (speed, acceleration, last) in states(&limits) {
            let start = Plant { position: 0.0, speed, acceleration, lag: lag.get().to_num() };
            let nearest = nearest_safe(&limits, &seen(&start, mps2(last), lag));
            for further in [0.0, 1e-3, 0.02, 0.1, 0.5, 2.0, 7.0, 20.0, 60.0] {
                let point = nearest + further;
                let obstacle = Obstacle::standing(place(point));
                let (mut plant, mut last, mut still) = (start, mps2(last), 0);
                for _ in 0..6_000 {
                    let ego = seen(&plant, last, lag);
                    last = gated(&limits, &ego, &obstacle);
                    plant.drive(mps2_of(last), H);
                    assert!(
                        plant.position <= point - margin,
                        "{limits:?} {lag:?} from {speed} {acceleration}: {} beyond",
                        plant.position - point
                    );
                    still = if plant.speed == 0.0 && last <= Acceleration::ZERO { still + 1 } else { 0 };
                    if still > 20 {
                        break;
                    }
                }
                closest = closest.min(point - margin - plant.position);
            }
        }
    }
    // Not much is given away either: where the ego has to stop it does so near to the margin.
    assert!((0.0..0.3).contains(&closest), "{closest}");
}

/// A vehicle ahead as the unit knows it: what is certain of it, from samples at the uncertain end that is the worst.
struct Ahead {
    body: Body,
    bound: Bound,
}

const ACCURACY: (f64, f64) = (0.5, 0.2);
const CLOCK_ERROR: i64 = 500;
const BRAKING: f64 = 9.0;

fn at(time: f64) -> Instant {
    Instant::from_micros((1e9 + time * 1e6).round() as u64)
}

/// What is certain after a sample that says the vehicle is further ahead and faster than it is, by a clock that runs fast.
fn sampled(time: f64, body: &Body) -> Bound {
    let uncertainty = Uncertainty {
        position: metres(ACCURACY.0),
        speed: mps(ACCURACY.1),
        earlier: Duration::from_micros(CLOCK_ERROR),
        later: Duration::from_micros(CLOCK_ERROR),
    };
    let stamped = at(time).minus(Duration::from_micros(CLOCK_ERROR));
    Bound::around(stamped, place(body.position + ACCURACY.0), mps(body.speed + ACCURACY.1), &uncertainty, &reach())
}

fn reach() -> AccelerationRange {
    AccelerationRange { acceleration: mps2(2.5), braking: mps2(BRAKING) }
}

/// From the newest sample before a silence on: the target goes on for some time and then brakes at its worst.
fn no_collision(limits: &Envelope, lag: FineSeconds, speeds: (f64, f64), gap: f64, age: f64, brakes_at: f64) -> bool {
    let sampled_at = Body { position: 0.0, speed: speeds.1 };
    let ahead = Ahead { body: sampled_at, bound: sampled(-age, &sampled_at) };
    let length = metres(rig::LENGTH);
    let moved = |time: f64| {
        // On at its speed from its sample until it brakes.
        let before = (brakes_at.max(-age) + age).min(time + age);
        ahead.body.after(0.0, before).after(-BRAKING, time + age - before)
    };
    let front = moved(0.0).position - rig::LENGTH - gap;
    let mut plant = Plant { position: front, speed: speeds.0, acceleration: 0.0, lag: lag.get().to_num() };
    let rear = |time: f64| Obstacle::rear(&ahead.bound.after(at(time), &reach()), length, &reach());
    if !envelope::is_safe(limits, &seen(&plant, Acceleration::ZERO, lag), &rear(0.0), PERIOD) {
        return false;
    }
    let mut last = Acceleration::ZERO;
    for tick in 0..3_000 {
        last = gated(limits, &seen(&plant, last, lag), &rear(f64::from(tick) * H));
        plant.drive(mps2_of(last), H);
        assert!(
            plant.position < moved(f64::from(tick + 1) * H).position - rig::LENGTH,
            "{limits:?} {lag:?} {speeds:?} gap {gap} age {age} brakes at {brakes_at}: hit after {tick} ticks"
        );
        if plant.speed == 0.0 && last <= Acceleration::ZERO {
            break;
        }
    }
    true
}

#[test]
fn a_target_that_brakes_at_its_worst_at_any_moment_of_a_silence_is_never_hit() {
    let (mut safe, mut all) = (0, 0);
    for (limits, lag) in gates() {
        for own in [0.0, 2.0, 7.0, 13.4, 22.0, 31.0, 40.0] {
            for ahead in [0.0, 1.5, 6.0, 13.4, 21.0, 31.0, 42.0] {
                for gap in [0.6, 1.5, 3.0, 6.0, 12.0, 20.0, 35.0, 60.0, 120.0, 250.0] {
                    for age in [0.0, 0.05, 0.3, 1.0, 2.0, 5.0] {
                        for brakes_at in [-10.0, 0.0, 0.4, 1.7, 4.0, 9.0] {
                            all += 1;
                            safe += i32::from(no_collision(&limits, lag, (own, ahead), gap, age, brakes_at));
                        }
                    }
                }
            }
        }
    }
    assert!(safe > 20_000 && safe < all, "{safe} of {all} starts are safe");
}
