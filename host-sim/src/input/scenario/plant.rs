//! The keys of a vehicle's body, `kind` and `[vehicle.plant]`: keys enter; the kind leaves, and the differences of the
//! real vehicle from what its unit assumes.

use super::keys::{Number, Section};
use crate::error::Error;
use crate::input::kind::{Difference, Kind};

const MASS: Number = Number { key: "mass_scale", unit: "a factor", limits: 0.5..=2.0, default: 1.0 };
const GRADE: Number = Number { key: "grade", unit: "a share", limits: -0.15..=0.15, default: 0.0 };
const WIND: Number = Number { key: "headwind_mps", unit: "m/s", limits: -30.0..=30.0, default: 0.0 };
const THROTTLE: Number = Number { key: "throttle", unit: "a share", limits: 0.05..=1.0, default: 1.0 };

/// Reads the kind; a car by default.
pub fn kind(section: &mut Section) -> Result<Kind, Error> {
    const KEY: &str = "kind";
    let Some(value) = section.value(KEY) else { return Ok(Kind::default()) };
    let named = value.get_ref().as_str().and_then(Kind::named);
    named.ok_or_else(|| section.mismatch(KEY, value, "\"car\", \"van\" or \"bus\""))
}

/// Reads the section; no difference by default.
pub fn difference(mut section: Section) -> Result<Difference, Error> {
    let difference = Difference {
        mass_scale: section.number(&MASS)?.value,
        grade: section.number(&GRADE)?.value,
        headwind_mps: section.number(&WIND)?.value,
        throttle: section.number(&THROTTLE)?.value,
    };
    section.finish()?;
    Ok(difference)
}
