//! What the envelope tolerates, each at its edge and all together, in the gate alone and in the whole unit; and that beyond
//! it the edge is one: what an assumption is worth that does not hold is counted.

use crate::rig;
use crate::rig::chase::Chase;
use crate::rig::random::Random;
use crate::rig::road::Road;
use holdover::Config;
use holdover::config::Envelope;
use holdover::units::Seconds;

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

/// Drives behind a target that brakes at its worst from some moment on: how many collided, of how many.
fn chases(off: &Off, drives: u32) -> (u32, u32) {
    let (mut random, mut hits, mut all) = (Random::new(7), 0, 0);
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
        all += 1;
    }
    (hits, all)
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

/// Each at its edge, and together.
const TOLERATED: [(&str, Off); 10] = [
    ("nothing", NOTHING),
    ("a lag that is a quarter longer", Off { lag: 1.25, ..NOTHING }),
    ("a lag that is a quarter shorter", Off { lag: 0.75, ..NOTHING }),
    ("three ticks late", Off { late: 3, ..NOTHING }),
    ("three ticks missed", Off { missed: 3, ..NOTHING }),
    ("an acceleration told 1 m/s² too low", Off { acceleration: -1.0, ..NOTHING }),
    ("an acceleration told 1 m/s² too high", Off { acceleration: 1.0, ..NOTHING }),
    ("half a second without the ego's motion", Off { gap: 0.5, ..NOTHING }),
    ("all, and a longer lag", Off { lag: 1.25, missed: 3, acceleration: -1.0, gap: 0.5, ..NOTHING }),
    ("all, and a shorter lag", Off { lag: 0.75, late: 3, acceleration: -1.0, gap: 0.5, ..NOTHING }),
];

/// Drives of the gate alone, as documented.
const DRIVES: u32 = 600;

#[test]
fn nothing_that_is_tolerated_makes_the_gate_collide() {
    for (name, off) in TOLERATED {
        assert_eq!(chases(&off, DRIVES).0, 0, "{name}");
    }
}

#[test]
fn nothing_that_is_tolerated_makes_a_unit_collide() {
    for (name, off) in TOLERATED {
        assert_eq!(roads(&off).0, 0, "{name}");
    }
}

#[test]
fn beyond_what_is_tolerated_as_many_collide_as_documented() {
    // "What breaks beyond" of docs/SAFETY.md: of the 600 drives of the gate alone, and of the 72 of whole units.
    let documented = [
        ("half the lag more", Off { lag: 1.5, ..NOTHING }, 0, 0),
        ("twice the lag", Off { lag: 2.0, ..NOTHING }, 416, 4),
        ("a quarter of the lag", Off { lag: 0.25, ..NOTHING }, 0, 0),
        ("ten ticks late", Off { late: 10, ..NOTHING }, 0, 0),
        ("twelve ticks missed", Off { missed: 12, ..NOTHING }, 0, 0),
        ("an acceleration told 2 m/s² too low", Off { acceleration: -2.0, ..NOTHING }, 51, 0),
        ("an acceleration told 3 m/s² too low", Off { acceleration: -3.0, ..NOTHING }, 330, 3),
        ("5 % less grip", Off { grip: 0.95, ..NOTHING }, 42, 0),
        ("10 % less grip", Off { grip: 0.9, ..NOTHING }, 240, 3),
        ("20 % less grip", Off { grip: 0.8, ..NOTHING }, 444, 6),
        ("two seconds without the ego's motion", Off { gap: 2.0, ..NOTHING }, 0, 0),
    ];
    for (name, off, gates, units) in documented {
        let (of_gates, of_units) = (chases(&off, DRIVES), roads(&off));
        // The same numbers on every machine, but for a drive that just touches where another `exp` rounds otherwise.
        assert!(
            of_gates.0.abs_diff(gates) <= 2 && of_units.0.abs_diff(units) <= 1,
            "{name}: {of_gates:?} {of_units:?}"
        );
        assert_eq!(of_units.1, 72);
    }
}

/// The vehicle accelerates when its motion is not heard any more, and one stands ahead: what the unit goes on to believe
/// of itself must not fall behind the truth.
#[test]
fn the_gate_believes_in_no_room_that_is_gone_while_the_egos_motion_is_missing() {
    for speed in [10.0, 20.0, 30.0] {
        for gap in [0.1, 0.2, 0.3, 0.4, 0.5] {
            for room in (0..40).map(|n| speed * speed / 16.0 + speed * 0.4 + 0.5 * f64::from(n)) {
                let mut road = Road::new(&guarded(1.0), speed, room + speed * 2.5);
                road.target.speed = 0.0;
                road.power_up();
                road.run(0.3);
                road.senses.ego = false;
                road.run(gap);
                road.senses.ego = true;
                let least = road.run_to_rest();
                assert!(least > 0.0, "{speed} m/s, {gap} s, {room} m: {least}");
            }
        }
    }
}
