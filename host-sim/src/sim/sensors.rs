//! A vehicle's sensors: its true motion and that of the vehicle ahead enter; the measurements leave, with their
//! published accuracies and errors within these. The faults of a range sensor are in [`faults`].

pub mod faults;

use std::collections::VecDeque;

use holdover::time::Duration;
use holdover::units::{Distance, Speed};
use holdover::wire::range_sensor::RangeSample;
use rand_chacha::ChaCha8Rng;

use crate::input::scenario::{Accuracy, RangeSensor, Vehicle};
use crate::sim::quantities::{distance, speed};
use crate::streams::{Purpose, stream, unit};
use faults::{Faulty, Shows};

/// Cycle of the range sensor, in seconds.
pub const RANGE_EVERY_S: f64 = 0.02;

/// So many views in a row have to show nobody before the sensor says so. Three that are missing by chance are rare, and
/// the first of them is no older than a view may be.
pub const EMPTY: usize = 4;

/// A vehicle as a sensor behind it sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ahead {
    /// Position of its rear bumper on the own way; of one that crosses that way, where its body begins.
    pub rear_m: f64,
    /// Its speed along the own way.
    pub speed_mps: f64,
}

impl Ahead {
    /// Nobody is ahead, however far the sensor sees.
    pub const NOBODY: Self = Self { rear_m: f64::INFINITY, speed_mps: 0.0 };
}

/// The sensors of one vehicle.
#[derive(Clone, Debug)]
pub struct Sensors {
    /// Published accuracy (95 %) of the own position.
    pub position_accuracy: Distance,
    /// Published accuracy (95 %) of the own speed.
    pub speed_accuracy: Speed,
    range: Option<Range>,
}

/// A range sensor at work.
#[derive(Clone, Debug)]
struct Range {
    sensor: RangeSensor,
    errors: ChaCha8Rng,
    faults: Faulty,
    /// The last views in a row that showed nobody: when they were.
    empty: VecDeque<f64>,
}

impl Sensors {
    /// The sensors that a scenario gives to the vehicle with this index.
    #[must_use]
    pub fn new(described: &Vehicle, seed: u64, index: usize) -> Self {
        Self::with(described.accuracy, described.range_sensor, seed, index)
    }

    /// The sensors of a vehicle with this index that measures its own motion with these accuracies, and the vehicle
    /// ahead with this range sensor, if it has one.
    #[must_use]
    pub fn with(accuracy: Accuracy, sensor: Option<RangeSensor>, seed: u64, index: usize) -> Self {
        let index = index as u32;
        let range = |sensor: RangeSensor| Range {
            sensor,
            errors: stream(seed, Purpose::RangeSensor(index)),
            faults: Faulty::new(sensor.faults, seed, index),
            empty: VecDeque::new(),
        };
        Self {
            position_accuracy: distance(accuracy.position_m),
            speed_accuracy: speed(accuracy.speed_mps),
            range: sensor.map(range),
        }
    }

    /// The measurement of the range sensor at a time, a front bumper and a speed. `None` without a sensor, and if it sees
    /// nothing. When [`EMPTY`] views in a row have shown nobody, it says so of the first of these.
    pub fn look(&mut self, at_s: f64, front_m: f64, speed_mps: f64, ahead: Ahead) -> Option<RangeSample> {
        let Range { sensor, errors, faults, empty } = self.range.as_mut()?;
        // Drawn whether or not a vehicle is there, so that later draws do not depend on how often there is one.
        let mut within = |accuracy: f64| (2.0 * unit(errors) - 1.0) * accuracy;
        let (off_m, off_mps) = (within(sensor.distance_m), within(sensor.speed_mps));
        let nearest = Some(ahead).filter(|ahead| (0.0..=sensor.sees_up_to_m).contains(&(ahead.rear_m - front_m)));
        let shown = match faults.at(at_s) {
            Shows::What => nearest,
            Shows::Nothing => None,
            Shows::Blind => {
                empty.clear();
                return None;
            }
            // On the way before all that is there, or within the range.
            Shows::Ghost(share) => {
                let free_m = nearest.map_or(sensor.sees_up_to_m, |ahead| ahead.rear_m - front_m);
                Some(Ahead { rear_m: front_m + share * free_m, speed_mps: 0.0 })
            }
        };
        let sample = RangeSample {
            distance: distance(sensor.sees_up_to_m),
            speed_difference: Speed::ZERO,
            distance_accuracy: distance(sensor.distance_m),
            speed_accuracy: speed(sensor.speed_mps),
            age: Duration::ZERO,
            nobody: true,
        };
        let Some(shown) = shown else {
            if empty.back().is_some_and(|last_s| at_s > last_s + 1.5 * RANGE_EVERY_S) {
                empty.clear();
            }
            empty.push_back(at_s);
            if empty.len() < EMPTY {
                return None;
            }
            let first_s = empty.pop_front()?;
            let age = Duration::from_micros(((at_s - first_s) * 1e6).round() as i64);
            return Some(RangeSample { age, ..sample });
        };
        empty.clear();
        Some(RangeSample {
            distance: distance((shown.rear_m - front_m + off_m).max(0.0)),
            speed_difference: difference(shown.speed_mps - speed_mps + off_mps),
            nobody: false,
            ..sample
        })
    }
}

/// The value in the core's format, rounded to nearest, of either sign.
fn difference(mps: f64) -> Speed {
    if mps < 0.0 { Speed::ZERO.minus(speed(-mps)) } else { speed(mps) }
}
