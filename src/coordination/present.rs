//! Who is at the ego's next crossing: what a review finds of a station enters; what the order is decided by leaves.

use super::Entry;
use crate::time::Instant;

/// A station at the ego's next crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Present {
    /// Its slot.
    pub index: usize,
    /// What it says.
    pub entry: Entry,
    /// When it said so.
    pub heard: Instant,
    /// Whether its rear is estimated to have left the conflict area. Nobody follows it then; it is certain only by the bound.
    pub has_left: bool,
    /// Whether the ego is so far ahead that it is out of the conflict area before this one is there, or cannot keep out of it.
    pub is_far_behind: bool,
    /// Whether the ego may follow it.
    pub is_announced: bool,
    /// Whether it comes by the ego's own leg: ahead of the ego, or behind it.
    pub lane: Option<Side>,
}

/// Which side of the ego on its own leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) enum Side {
    /// It is ahead.
    Ahead,
    /// It is behind.
    Behind,
}
