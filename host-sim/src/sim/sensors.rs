//! A vehicle's sensors: its true motion and that of the vehicle ahead enter, what they say leaves, with the accuracies that
//! they publish and errors within them.

use holdover::time::Duration;
use holdover::units::{Distance, Speed};
use holdover::wire::range_sensor::RangeSample;
use rand_chacha::ChaCha8Rng;

use crate::input::scenario::{Accuracy, RangeSensor, Vehicle};
use crate::sim::quantities::{distance, speed};
use crate::streams::{Purpose, stream, unit};

/// Cycle of the range sensor, in seconds.
pub const RANGE_EVERY_S: f64 = 0.02;

/// Farther away than this it sees nobody, in metres: a long-range radar.
const SEES_UP_TO_M: f64 = 200.0;

/// A vehicle as a sensor behind it sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ahead {
    /// Its rear bumper.
    pub rear_m: f64,
    /// Its speed.
    pub speed_mps: f64,
}

/// The sensors of one vehicle.
#[derive(Clone, Debug)]
pub struct Sensors {
    /// 95 % accuracy of its own position.
    pub position_accuracy: Distance,
    /// 95 % accuracy of its own speed.
    pub speed_accuracy: Speed,
    range: Option<(RangeSensor, ChaCha8Rng)>,
}

impl Sensors {
    /// Those that a scenario gives the vehicle with that index.
    #[must_use]
    pub fn new(described: &Vehicle, seed: u64, index: usize) -> Self {
        let generator = || stream(seed, Purpose::RangeSensor(index as u32));
        Self {
            position_accuracy: distance(described.accuracy.position_m),
            speed_accuracy: speed(described.accuracy.speed_mps),
            range: described.range_sensor.map(|sensor| (sensor, generator())),
        }
    }

    /// Those of a vehicle that knows its own motion so well, and sees nobody.
    #[must_use]
    pub fn blind(accuracy: Accuracy) -> Self {
        Self {
            position_accuracy: distance(accuracy.position_m),
            speed_accuracy: speed(accuracy.speed_mps),
            range: None,
        }
    }

    /// What the range sensor sees from a front bumper at that speed; `None` without one, and if nobody is within its range.
    pub fn look(&mut self, front_m: f64, speed_mps: f64, ahead: Ahead) -> Option<RangeSample> {
        let (sensor, generator) = self.range.as_mut()?;
        // Drawn whether or not anybody is there, so that nothing depends on how often somebody is.
        let mut within = |accuracy: f64| (2.0 * unit(generator) - 1.0) * accuracy;
        let (off_m, off_mps) = (within(sensor.distance_m), within(sensor.speed_mps));
        let gap_m = ahead.rear_m - front_m;
        (0.0..=SEES_UP_TO_M).contains(&gap_m).then(|| RangeSample {
            distance: distance((gap_m + off_m).max(0.0)),
            speed_difference: difference(ahead.speed_mps - speed_mps + off_mps),
            distance_accuracy: distance(sensor.distance_m),
            speed_accuracy: speed(sensor.speed_mps),
            age: Duration::ZERO,
        })
    }
}

/// To the core's format, to nearest, of either sign.
fn difference(mps: f64) -> Speed {
    if mps < 0.0 { Speed::ZERO.minus(speed(-mps)) } else { speed(mps) }
}
