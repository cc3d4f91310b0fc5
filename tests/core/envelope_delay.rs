//! Ticks that are missed again and again, never more in a row than the envelope is told, do not keep the vehicle from
//! emergency braking.

use crate::rig;
use crate::rig::road::Road;
use holdover::config::Envelope;
use holdover::units::Seconds;

/// The least gap behind a target that brakes with all that it has, when of every four ticks so many are missed.
fn least_gap(missed: u64, speed: f64, time_gap: i32, phase: u64) -> f64 {
    let mut config = rig::config();
    config.envelope = Some(Envelope::CAR);
    config.law.time_gap = Seconds::from_millis(time_gap);
    let mut road = Road::new(&config, speed, speed * f64::from(time_gap) * 1e-3 + 4.0);
    road.power_up();
    let mut least = road.gap();
    for tick in 0..3_000 {
        if tick == 1_000 + phase {
            road.acceleration = -8.0;
        }
        if tick % 4 < missed {
            road.miss()
        } else {
            drop(road.step())
        }
        least = least.min(road.gap());
    }
    least
}

#[test]
fn three_of_every_four_ticks_may_be_missed() {
    for missed in [0, 3] {
        for (speed, time_gap) in [(10.0, 300), (20.0, 300), (30.0, 300), (20.0, 600), (30.0, 600), (30.0, 1_000)] {
            for phase in 0..10 {
                let least = least_gap(missed, speed, time_gap, phase);
                assert!(least > 0.0, "{missed} of 4 at {speed} m/s and {time_gap} ms: {least}");
            }
        }
    }
}
