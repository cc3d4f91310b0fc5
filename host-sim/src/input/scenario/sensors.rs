//! The sensors of a vehicle: keys of `[[vehicle]]` enter; the accuracies of its own motion and of its range sensor
//! leave. Of a corridor: the table `[sensors]` enters; the share of vehicles that have a range sensor leaves, and what
//! it sees.

use super::SensorShare;
use super::keys::{Document, Number, Section};
use crate::error::Error;
use serde::Serialize;

// The upper limits are those of the messages.
const POSITION: Number = Number { key: "position_accuracy_m", unit: "metres", limits: 0.0..=6.3, default: 0.05 };
const SPEED: Number = Number { key: "speed_accuracy_mps", unit: "m/s", limits: 0.0..=1.24, default: 0.02 };
const RANGE: Number = Number { key: "range_accuracy_m", unit: "metres", limits: 0.0..=1.55, default: 0.25 };
const RANGE_SPEED: Number = Number { key: "range_speed_accuracy_mps", unit: "m/s", limits: 0.0..=1.5, default: 0.1 };

// The defaults of a corridor. Range and faults are those of a mid-range radar as its tracked objects are published. A
// view that is missing is of nothing, so misses and dropouts keep assumption A12; a ghost is of no vehicle and does not.
const SHARE: Number = Number { key: "share", unit: "a share", limits: 0.0..=1.0, default: 1.0 };
const SEES: Number = Number { key: "range_m", unit: "metres", limits: 1.0..=250.0, default: 100.0 };
const MISSES: Number = Number { key: "misses", unit: "a share", limits: 0.0..=1.0, default: 0.02 };
const DROPOUTS: Number =
    Number { key: "dropouts_per_min", unit: "dropouts a minute", limits: 0.0..=60.0, default: 1.0 };
const DROPOUT: Number = Number { key: "dropout_s", unit: "seconds", limits: 0.0..=60.0, default: 0.5 };
const GHOSTS: Number = Number { key: "ghosts_per_min", unit: "ghosts a minute", limits: 0.0..=60.0, default: 0.0 };

/// Range of the sensor in a string of vehicles, in metres: a long-range radar.
const STRING_SEES_UP_TO_M: f64 = 200.0;

/// Accuracy of a recorded drive, which is limited by the recording: positions along a path jitter by decimetres, and
/// the recorded speed need not be their slope.
const RECORDED: Accuracy = Accuracy { position_m: 0.5, speed_mps: 0.3 };

/// Accuracy of a vehicle's own motion, as it publishes it. The published motion is the true one, to the message's
/// resolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Accuracy of the position; 0 to 6.3 m.
    pub position_m: f64,
    /// Accuracy of the speed; 0 to 1.24 m/s.
    pub speed_mps: f64,
}

/// A range sensor for the vehicle ahead on the same lane. Its errors are uniform within its accuracies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeSensor {
    /// Largest error of the distance; 0 to 1.55 m.
    pub distance_m: f64,
    /// Largest error of the speed difference; 0 to 1.5 m/s.
    pub speed_mps: f64,
    /// Range, from the own front bumper; 1 to 250 m.
    pub sees_up_to_m: f64,
    /// Its faults.
    pub faults: Faults,
}

/// The faults of a range sensor. Gaps between dropouts, and between ghosts, are without memory.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Faults {
    /// Probability that a single view is missing; 0 to 1.
    pub misses: f64,
    /// Dropouts per minute in which the sensor works; 0 to 60.
    pub dropouts_per_min: f64,
    /// Length of a dropout, in which the sensor sees nothing; 0 to 60 s.
    pub dropout_s: f64,
    /// Ghosts per minute in which the sensor works; 0 to 60. A ghost is a vehicle that is not there.
    pub ghosts_per_min: f64,
}

impl Faults {
    /// A sensor that always works.
    pub const NONE: Self = Self { misses: 0.0, dropouts_per_min: 0.0, dropout_s: 0.0, ghosts_per_min: 0.0 };
}

/// The range sensors of a corridor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitted {
    /// Share of the vehicles that have one, 0 to 1.
    pub share: f64,
    /// The sensor.
    pub sensor: RangeSensor,
}

/// The accuracies that a vehicle publishes.
pub fn accuracy(section: &mut Section, is_recorded: bool) -> Result<Accuracy, Error> {
    let Accuracy { position_m, speed_mps } =
        if is_recorded { RECORDED } else { Accuracy { position_m: POSITION.default, speed_mps: SPEED.default } };
    Ok(Accuracy {
        position_m: section.number(&Number { default: position_m, ..POSITION })?.value,
        speed_mps: section.number(&Number { default: speed_mps, ..SPEED })?.value,
    })
}

/// The range sensor of a vehicle, if it has one. A vehicle that follows another has one unless the file or the command line says
/// otherwise.
pub fn range_sensor(
    document: &Document,
    section: &mut Section,
    follows: bool,
    said: Option<bool>,
) -> Result<Option<RangeSensor>, Error> {
    let fitted = section.flag("range_sensor")?;
    let (distance, speed) = (section.number(&RANGE)?, section.number(&RANGE_SPEED)?);
    match fitted {
        Some(fitted) if fitted.value && !follows => {
            let cause = "the leader (vehicle 0) has a `range_sensor`, and nobody is ahead of it";
            Err(document.error_at(fitted.line, cause, "remove it"))
        }
        Some(fitted) if !fitted.value && distance.line.or(speed.line).is_some() => {
            let cause = "a vehicle without a range sensor has an accuracy of it";
            let remedy = "give it `range_sensor = true`, or remove its accuracies";
            Err(document.error_at(distance.line.or(speed.line), cause, remedy))
        }
        _ => {
            let is_fitted = said.unwrap_or(fitted.is_none_or(|fitted| fitted.value));
            Ok((follows && is_fitted).then_some(RangeSensor {
                distance_m: distance.value,
                speed_mps: speed.value,
                sees_up_to_m: STRING_SEES_UP_TO_M,
                faults: Faults::NONE,
            }))
        }
    }
}

/// The range sensors of a corridor: the table `[sensors]`. What the command line says overrides its share.
pub fn fitted(mut section: Section, said: Option<SensorShare>) -> Result<Fitted, Error> {
    let share = section.number(&SHARE)?.value;
    let (dropouts, dropout) = (section.number(&DROPOUTS)?, section.number(&DROPOUT)?);
    let sensor = RangeSensor {
        distance_m: section.number(&RANGE)?.value,
        speed_mps: section.number(&RANGE_SPEED)?.value,
        sees_up_to_m: section.number(&SEES)?.value,
        faults: Faults {
            misses: section.number(&MISSES)?.value,
            dropouts_per_min: dropouts.value,
            dropout_s: dropout.value,
            ghosts_per_min: section.number(&GHOSTS)?.value,
        },
    };
    section.finish()?;
    let share = said.map_or(share, SensorShare::share);
    Ok(Fitted { share, sensor })
}
