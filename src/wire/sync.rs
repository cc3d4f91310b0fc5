//! `Sync`, `FollowUp`: two-step time synchronisation on the bus, in one frame each.

use crate::time::GnssTime;

/// First step: its *reception* is the mark that the follow-up dates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sync {
    /// Ties the two steps; modulo 16.
    pub sequence: u8,
    /// Whole seconds of the GNSS time of sending, as far as the sender knew it beforehand.
    pub seconds: u32,
}

/// Second step: when the sync message with this sequence was really on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FollowUp {
    /// As in the sync message.
    pub sequence: u8,
    /// What to add to the sync message's `seconds`, in microseconds; 0 to 4,294,967,295.
    pub micros: u32,
}

impl FollowUp {
    /// The GNSS time at which the sync message was sent.
    #[must_use]
    pub const fn time_of(&self, sync: &Sync) -> GnssTime {
        GnssTime::from_micros((sync.seconds as u64).saturating_mul(1_000_000).saturating_add(self.micros as u64))
    }
}
