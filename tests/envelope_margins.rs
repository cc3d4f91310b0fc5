//! What the envelope tolerates, each at its edge and all together, in the gate alone and in the whole unit; and that beyond
//! it the edge is one: what an assumption is worth that does not hold is counted.

mod rig;

use holdover::Config;
use holdover::config::Envelope;
use holdover::units::Seconds;
use rig::chase::Chase;
use rig::random::Random;
use rig::road::Road;

/// What is not as configured.
#[derive(Clone, Copy, Debug)]
struct Off {
    lag: f64,
    late: usize,
    missed: usize,
    acceleration: f64,
    grip: f64,
    /// Seconds without `EgoMotion`, from when the target begins to brake.
    gap: f64,
}

const NOTHING: Off = Off { lag: 1.0, late: 0, missed: 0, acceleration: 0.0, grip: 1.0, gap: 0.0 };

/// Drives behind a target that brakes at its worst from some moment on: how many collided, and how hard at most.
fn chases(off: &Off, drives: u32) -> (u32, f64) {
    let (mut random, mut hits, mut worst) = (Random::new(7), 0, 0.0f64);
    for _ in 0..drives {
        let braking = [3.0, 5.0, 8.0, 9.0][random.below(4) as usize];
        let mut chase =
            Chase::new(&Envelope::CAR, 0.3, random.between(3.0, 40.0), (random.between(0.0, 40.0), braking));
        chase.acceleration_off = 1.0; // the tolerance that the unit adds
        let Some(nearest) = chase.nearest_safe() else { continue };
        (chase.lag_factor, chase.late, chase.grip) = (off.lag, off.late, off.grip);
        chase.missed = (random.below(200) as usize, off.missed);
        chase.acceleration_off += off.acceleration;
        if random.happens(0.5) {
            chase.profile = chase.random_profile(&mut random);
        }
        let least = chase.run(nearest + random.between(0.0, 10.0));
        hits += u32::from(least < 0.0);
        worst = worst.min(least);
    }
    (hits, worst)
}

fn guarded(time_gap: f64) -> Config {
    let mut config = Config { envelope: Some(Envelope::CAR), ..rig::config() };
    config.law.time_gap = Seconds::from_millis((time_gap * 1e3) as i32);
    config
}

/// The same in whole units behind a target that is heard, and brakes at its worst after a second.
fn roads(off: &Off) -> (u32, u32) {
    let (mut hits, mut all) = (0, 0);
    for braking in [4.0, 8.0] {
        for speed in [8.0, 14.0, 22.0, 32.0] {
            for time_gap in [0.5, 0.8, 1.2] {
                for silent_for in [0.0, 0.4, 1.5] {
                    let mut road = Road::new(&guarded(time_gap), speed, 2.0 + speed * time_gap);
                    (road.braking, road.wants, road.grip) = (braking, speed, off.grip);
                    (road.ego.lag, road.late, road.acceleration_off) = (0.3 * off.lag, off.late, off.acceleration);
                    road.power_up();
                    road.run(1.0);
                    road.senses.v2x = silent_for == 0.0;
                    road.run(0.01 + silent_for);
                    road.acceleration = -braking;
                    road.senses.ego = off.gap == 0.0;
                    for _ in 0..off.missed {
                        road.miss();
                    }
                    road.run(0.01 + off.gap);
                    road.senses.ego = true;
                    hits += u32::from(road.run_to_rest() < 0.0);
                    all += 1;
                }
            }
        }
    }
    (hits, all)
}

#[test]
fn table() {
    let rows = [
        ("nothing", NOTHING),
        ("lag +25%", Off { lag: 1.25, ..NOTHING }),
        ("lag +50%", Off { lag: 1.5, ..NOTHING }),
        ("lag +100%", Off { lag: 2.0, ..NOTHING }),
        ("lag -25%", Off { lag: 0.75, ..NOTHING }),
        ("lag -75%", Off { lag: 0.25, ..NOTHING }),
        ("late 3", Off { late: 3, ..NOTHING }),
        ("late 6", Off { late: 6, ..NOTHING }),
        ("late 10", Off { late: 10, ..NOTHING }),
        ("missed 3", Off { missed: 3, ..NOTHING }),
        ("missed 6", Off { missed: 6, ..NOTHING }),
        ("missed 12", Off { missed: 12, ..NOTHING }),
        ("a -1", Off { acceleration: -1.0, ..NOTHING }),
        ("a -2", Off { acceleration: -2.0, ..NOTHING }),
        ("a -3", Off { acceleration: -3.0, ..NOTHING }),
        ("a +1", Off { acceleration: 1.0, ..NOTHING }),
        ("grip .95", Off { grip: 0.95, ..NOTHING }),
        ("grip .9", Off { grip: 0.9, ..NOTHING }),
        ("grip .8", Off { grip: 0.8, ..NOTHING }),
        ("gap .2", Off { gap: 0.2, ..NOTHING }),
        ("gap .5", Off { gap: 0.5, ..NOTHING }),
        ("gap 1", Off { gap: 1.0, ..NOTHING }),
        ("gap 2", Off { gap: 2.0, ..NOTHING }),
        ("all", Off { lag: 1.25, missed: 3, acceleration: -1.0, gap: 0.5, ..NOTHING }),
        ("all late", Off { lag: 1.25, late: 3, acceleration: -1.0, gap: 0.5, ..NOTHING }),
        ("all short", Off { lag: 0.75, late: 3, acceleration: -1.0, gap: 0.5, ..NOTHING }),
    ];
    for (name, off) in rows {
        println!("{name:<12} gate {:?} of 600, units {:?}", chases(&off, 600), roads(&off));
    }
}
