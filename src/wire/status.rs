//! `Health`: one refusal count in each frame, cause after cause, with the mode and the state of the time base.

use super::command::ModeCode;
use crate::health::Refusal;

/// One page of the unit's state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Status {
    /// The cause that this page counts.
    pub cause: Refusal,
    /// How often it was met since start; 0 to 16,777,215, saturating.
    pub count: u32,
    /// The mode.
    pub mode: ModeCode,
    /// Detail of the mode, 0 to 31: the cause of a fallback or a fault.
    pub detail: u8,
    /// Whether GNSS time is known.
    pub synchronised: bool,
    /// Peers whose link is on.
    pub links_on: u8,
}
