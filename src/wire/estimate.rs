//! `TargetEstimate`: where the unit believes its target is now, in two frames every period.

use super::motion::WirePosition;
use crate::time::Duration;
use crate::units::{Distance, Speed};

/// The ends of the bound around an estimate, as distances from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ends {
    /// How far behind the estimate the target may be; 0 to 327.64 m by 0.02 m, rounded up.
    pub behind: Distance,
    /// How far ahead of it; likewise.
    pub ahead: Distance,
    /// How much slower it may be; 0 to 102 m/s by 0.2 m/s, rounded up.
    pub slower: Speed,
    /// How much faster; likewise.
    pub faster: Speed,
}

/// The estimate of one period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TargetEstimate {
    /// Ties the two frames; modulo 4.
    pub tag: u8,
    /// Front bumper of the target; 1 mm.
    pub position: WirePosition,
    /// 0 to 65.534 m/s by 2 mm/s.
    pub speed: Speed,
    /// Age of the newest sample it rests on; 0 to 16.38 s by 2 ms, saturating.
    pub age: Duration,
    /// The bound; `None`: not known.
    pub ends: Option<Ends>,
}
