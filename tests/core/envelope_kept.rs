//! The predicate of the gate is kept by the gate: from states all over their range that it calls safe, one tick of the gate's
//! command, whatever was demanded and whatever the vehicle ahead does, leads to a state that it calls safe.

use crate::rig::chase::PERIOD;
use crate::rig::plant::{Body, Plant};
use crate::rig::random::Random;
use crate::rig::{mps, mps2, mps2_of, place};
use holdover::config::Envelope;
use holdover::envelope::{self, Ego, Obstacle, Situation};
use holdover::units::{Distance, FineSeconds, Fraction};

fn told(plant: &Plant, last: f64, less: f64) -> Ego {
    Ego {
        position: place(plant.position - less),
        speed: mps(plant.speed),
        acceleration: mps2(plant.acceleration),
        last: mps2(last),
        lag: FineSeconds::from_millis((plant.lag * 1e3).round() as i32),
    }
}

fn rear(ahead: &Body, braking: f64) -> Obstacle {
    Obstacle { position: place(ahead.position), speed: mps(ahead.speed), braking: mps2(braking) }
}

/// What words and micrometres round, in m: the speed's 1 µm/s over the seconds of the manoeuvre.
const ROUNDING: f64 = 5e-5;

#[test]
fn what_is_safe_is_safe_after_a_tick_of_the_gates_command() {
    let limits = Envelope { lag_tolerance: Fraction::ZERO, margin: Distance::from_mm(100), ..Envelope::CAR };
    let mut random = Random::new(33);
    let (mut judged, mut by_closing) = (0, 0);
    for _ in 0..400_000 {
        let lag = [0.0, 0.05, 0.3, 0.8][random.below(4) as usize];
        let braking = random.extreme(1.0, 12.0);
        let speed = if random.happens(0.3) { random.extreme(0.0, 2.0) } else { random.extreme(0.0, 50.0) };
        let mut acceleration = random.extreme(-8.0, 3.0);
        if speed == 0.0 {
            acceleration = acceleration.max(0.0);
        }
        let last = random.extreme(-8.0, 3.0);
        let mut plant = Plant { position: 0.0, speed, acceleration, lag };
        let other = if random.happens(0.3) { random.extreme(0.0, 3.0) } else { random.extreme(0.0, 50.0) };
        let mut ahead = Body { position: 0.0, speed: other };
        let is_safe =
            |ahead: &Body| envelope::is_safe(&limits, &told(&plant, last, 0.0), &rear(ahead, braking), PERIOD);
        let (mut low, mut high) = (0.0, 400.0);
        while high - low > 1e-4 {
            ahead.position = 0.5 * (low + high);
            *(if is_safe(&ahead) { &mut high } else { &mut low }) = ahead.position;
        }
        ahead.position = high + if random.happens(0.7) { 0.0 } else { random.between(0.0, 1.0) };
        if !is_safe(&ahead) {
            continue;
        }
        let ego = told(&plant, last, 0.0);
        let before = (plant, ahead);
        let situation = Situation { is_fresh: true, spare: envelope::spare(&limits, &ego, &rear(&ahead, braking)) };
        let command = envelope::gate(&limits, mps2(random.extreme(-10.0, 5.0)), &ego, &situation, PERIOD, PERIOD);
        for _ in 0..10 {
            plant.drive(mps2_of(command), 1e-3);
        }
        ahead = ahead.after(random.extreme(-braking, 2.5), 0.01);
        let after = told(&plant, mps2_of(command), ROUNDING);
        assert!(
            envelope::is_safe(&limits, &after, &rear(&ahead, braking), PERIOD),
            "lag {lag}, {braking} m/s², last {last}: {before:?}, {command:?}, {plant:?} {ahead:?}"
        );
        judged += 1;
        by_closing += u32::from(braking < 8.0);
    }
    assert!(judged > 300_000 && by_closing > 100_000, "{judged} {by_closing}");
}
