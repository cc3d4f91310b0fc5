//! A vehicle's sensors: its true motion and that of the vehicle ahead enter; the measurements leave, with their
//! published accuracies and errors within these.

use holdover::time::Duration;
use holdover::units::{Distance, Speed};
use holdover::wire::range_sensor::RangeSample;
use rand_chacha::ChaCha8Rng;

use crate::input::scenario::{Accuracy, RangeSensor, Vehicle};
use crate::sim::quantities::{distance, speed};
use crate::streams::{Purpose, stream, unit};

/// Cycle of the range sensor, in seconds.
pub const RANGE_EVERY_S: f64 = 0.02;

/// Range of the sensor, in metres: a long-range radar.
const SEES_UP_TO_M: f64 = 200.0;

/// A vehicle as a sensor behind it sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ahead {
    /// Position of its rear bumper.
    pub rear_m: f64,
    /// Its speed.
    pub speed_mps: f64,
}

/// The sensors of one vehicle.
#[derive(Clone, Debug)]
pub struct Sensors {
    /// Published accuracy (95 %) of the own position.
    pub position_accuracy: Distance,
    /// Published accuracy (95 %) of the own speed.
    pub speed_accuracy: Speed,
    range: Option<(RangeSensor, ChaCha8Rng)>,
}

impl Sensors {
    /// The sensors that a scenario gives to the vehicle with this index.
    #[must_use]
    pub fn new(described: &Vehicle, seed: u64, index: usize) -> Self {
        let generator = || stream(seed, Purpose::RangeSensor(index as u32));
        Self {
            position_accuracy: distance(described.accuracy.position_m),
            speed_accuracy: speed(described.accuracy.speed_mps),
            range: described.range_sensor.map(|sensor| (sensor, generator())),
        }
    }

    /// The sensors of a vehicle that measures its own motion with these accuracies and has no range sensor.
    #[must_use]
    pub fn blind(accuracy: Accuracy) -> Self {
        Self {
            position_accuracy: distance(accuracy.position_m),
            speed_accuracy: speed(accuracy.speed_mps),
            range: None,
        }
    }

    /// The measurement of the range sensor, at a front bumper and a speed. `None` without a sensor, and if no vehicle
    /// is in its range.
    pub fn look(&mut self, front_m: f64, speed_mps: f64, ahead: Ahead) -> Option<RangeSample> {
        let (sensor, generator) = self.range.as_mut()?;
        // Drawn whether or not a vehicle is there, so that later draws do not depend on how often there is one.
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

/// The value in the core's format, rounded to nearest, of either sign.
fn difference(mps: f64) -> Speed {
    if mps < 0.0 { Speed::ZERO.minus(speed(-mps)) } else { speed(mps) }
}
