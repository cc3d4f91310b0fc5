//! The name of a message by its offset in the catalogue, as it stands in the DBC. It is a number until it is shown, so that an ECU's
//! image holds no names.

use core::fmt::{Display, Formatter, Result};

use super::Slot;
use super::catalogue::{self, Line};

/// The name of a message of the catalogue, with its slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MessageName {
    offset: u16,
}

impl MessageName {
    /// Of the message at this offset.
    #[must_use]
    pub const fn at(offset: u16) -> Self {
        Self { offset }
    }

    /// Of a line in a slot (any where there are none).
    #[must_use]
    pub const fn of(line: &Line, slot: Slot) -> Self {
        Self { offset: line.offset_for(slot) }
    }
}

impl Display for MessageName {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let Some((_, line, slot)) = catalogue::find(self.offset) else { return write!(f, "offset {:#x}", self.offset) };
        Name(line.name, slot).fmt(f)
    }
}

/// A name of the catalogue with its slot, if it has one.
pub(super) struct Name(pub &'static str, pub Slot);

impl Display for Name {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self.0.split_once("{slot}") {
            Some((before, after)) => write!(f, "{before}{}{after}", self.1.0),
            None => f.write_str(self.0),
        }
    }
}
