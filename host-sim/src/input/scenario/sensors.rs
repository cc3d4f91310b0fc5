//! The sensors of a vehicle: keys of `[[vehicle]]` enter; the accuracies of its own motion and of its range sensor
//! leave.

use super::keys::{Document, Number, Section};
use crate::error::Error;

// The upper limits are those of the messages.
const POSITION: Number = Number { key: "position_accuracy_m", unit: "metres", limits: 0.0..=6.3, default: 0.05 };
const SPEED: Number = Number { key: "speed_accuracy_mps", unit: "m/s", limits: 0.0..=1.24, default: 0.02 };
const RANGE: Number = Number { key: "range_accuracy_m", unit: "metres", limits: 0.0..=1.55, default: 0.25 };
const RANGE_SPEED: Number = Number { key: "range_speed_accuracy_mps", unit: "m/s", limits: 0.0..=1.5, default: 0.1 };

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

/// The range sensor of a vehicle, if it has one.
pub fn range_sensor(document: &Document, section: &mut Section, follows: bool) -> Result<Option<RangeSensor>, Error> {
    let fitted = section.flag("range_sensor")?;
    let (distance, speed) = (section.number(&RANGE)?, section.number(&RANGE_SPEED)?);
    match fitted {
        Some(fitted) if fitted.value && !follows => {
            let cause = "the leader (vehicle 0) has a `range_sensor`, and nobody is ahead of it";
            Err(document.error_at(fitted.line, cause, "remove it"))
        }
        Some(fitted) if fitted.value => Ok(Some(RangeSensor { distance_m: distance.value, speed_mps: speed.value })),
        _ => match distance.line.or(speed.line) {
            None => Ok(None),
            line => {
                let cause = "a vehicle without a range sensor has an accuracy of it";
                Err(document.error_at(line, cause, "give it `range_sensor = true`, or remove its accuracies"))
            }
        },
    }
}
