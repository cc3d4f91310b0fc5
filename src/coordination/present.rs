//! A station at the ego's next crossing, as the review finds it and as the order is decided by it.

use super::Entry;
use crate::time::Instant;
use crate::units::Distance;

/// A station at the ego's next crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Present {
    /// Its slot.
    pub index: usize,
    /// What it says of itself.
    pub entry: Entry,
    /// When it said so.
    pub heard: Instant,
    /// Whether its rear is estimated to have left the conflict area. No vehicle follows it then. Only the bound makes it certain.
    pub has_left: bool,
    /// Whether the ego is so far ahead that it has left the conflict area before this station is there, or whether the ego cannot stop
    /// before the area any more.
    pub is_far_behind: bool,
    /// Whether its way conflicts with the ego's.
    pub conflicts: bool,
    /// By how much it is ahead of the ego on the virtual lane.
    pub way: Distance,
    /// Whether the ego may follow it.
    pub is_announced: bool,
    /// Whether it is ahead of the ego or behind it, if it comes by the ego's own leg.
    pub lane: Option<Side>,
}

/// A side of the ego on its own leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) enum Side {
    /// Ahead of the ego.
    Ahead,
    /// Behind the ego.
    Behind,
}
