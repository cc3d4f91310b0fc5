//! The key `driver` of a vehicle: a word enters; who drives leaves.

use super::keys::{Document, Section};
use crate::error::Error;

/// Who drives a vehicle, and what others hear of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Driver {
    /// Its unit.
    #[default]
    Unit,
    /// A person. The vehicle tells its states, and nothing of what it is about to do.
    Person,
    /// A person, in a vehicle without a unit: it is heard by nobody, and hears nobody.
    Unequipped,
}

/// Reads the word; the unit by default. Nobody drives the leader by it.
pub fn driver(document: &Document, section: &mut Section, follows: bool) -> Result<Driver, Error> {
    const KEY: &str = "driver";
    let Some(value) = section.value(KEY) else { return Ok(Driver::default()) };
    if !follows {
        let cause = "the leader (vehicle 0) has a `driver`, and nobody is ahead of it";
        return Err(document.error_at(
            section.line_of(value),
            cause,
            "give it a recorded `motion` in [leader], or remove it",
        ));
    }
    match value.get_ref().as_str() {
        Some("unit") => Ok(Driver::Unit),
        Some("person") => Ok(Driver::Person),
        Some("unequipped") => Ok(Driver::Unequipped),
        _ => Err(section.mismatch(KEY, value, "\"unit\", \"person\" or \"unequipped\"")),
    }
}
