//! The section `[envelope]`: keys enter, the limits of every unit's envelope leave. The defaults are those of a car,
//! and the envelope is engaged, as in the core.

use super::Switch;
use super::keys::{Number, Section};
use crate::error::Error;
use holdover::units::{Acceleration, Distance, Jerk, Speed};

// The defaults are those of a car, as in the core. A vehicle publishes 8 m/s² as its hardest braking, and other
// vehicles base its bound on that. So the envelope cannot brake harder.
const ACCELERATION: Number = Number { key: "acceleration_mps2", unit: "m/s²", limits: 0.1..=20.46, default: 3.0 };
const BRAKING: Number = Number { key: "braking_mps2", unit: "m/s²", limits: 0.5..=8.0, default: 8.0 };
const JERK: Number = Number { key: "jerk_mps3", unit: "m/s³", limits: 1.0..=51.15, default: 25.0 };
const SPEED: Number = Number { key: "speed_mps", unit: "m/s", limits: 1.0..=65.534, default: 50.0 };
const MARGIN: Number = Number { key: "margin_m", unit: "metres", limits: 0.0..=10.0, default: 0.5 };

/// The envelope of every unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Envelope {
    /// Whether the envelope is engaged.
    pub engaged: bool,
    /// Largest commanded acceleration; 0.1 to 20.46 m/s².
    pub acceleration_mps2: f64,
    /// Hardest commanded braking, as a magnitude; 0.5 to 8 m/s².
    pub braking_mps2: f64,
    /// Fastest change of the command; 1 to 51.15 m/s³.
    pub jerk_mps3: f64,
    /// No acceleration at or beyond this speed; 1 to 65.534 m/s.
    pub speed_mps: f64,
    /// Distance that is left between the bumpers when both vehicles have stopped; 0 to 10 m.
    pub margin_m: f64,
}

/// Reads the section. What the command line says overrides it.
pub fn read(mut section: Section, said: Option<Switch>) -> Result<Envelope, Error> {
    let engaged = section.flag("engaged")?.is_none_or(|engaged| engaged.value);
    let envelope = Envelope {
        engaged: said.map_or(engaged, Switch::is_on),
        acceleration_mps2: section.number(&ACCELERATION)?.value,
        braking_mps2: section.number(&BRAKING)?.value,
        jerk_mps3: section.number(&JERK)?.value,
        speed_mps: section.number(&SPEED)?.value,
        margin_m: section.number(&MARGIN)?.value,
    };
    section.finish()?;
    Ok(envelope)
}

impl Envelope {
    /// The units' configuration, rounded to the nearest thousandth; `None` if the envelope is not engaged.
    #[must_use]
    pub fn limits(&self) -> Option<holdover::config::Envelope> {
        let milli = |value: f64| (value * 1e3).round() as i32;
        self.engaged.then(|| holdover::config::Envelope {
            acceleration: Acceleration::from_mm_per_s2(milli(self.acceleration_mps2)),
            braking: Acceleration::from_mm_per_s2(milli(self.braking_mps2)),
            jerk: Jerk::from_mm_per_s3(milli(self.jerk_mps3)),
            speed: Speed::from_mm_per_s(milli(self.speed_mps)),
            margin: Distance::from_mm(milli(self.margin_m)),
            ..holdover::config::Envelope::CAR
        })
    }
}
