//! `EgoIntent`: what the driver or the planner wants of the unit, in one frame.

use super::Predecessor;
use crate::units::{Seconds, Speed};

/// The vehicle's wish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EgoIntent {
    /// Whether the unit shall drive.
    pub engaged: bool,
    /// Whom it shall follow.
    pub predecessor: Predecessor,
    /// Speed wanted on a free road, `v_∞`; 0 to 65.534 m/s by 2 mm/s.
    pub target_speed: Speed,
    /// Desired time gap, `t_g`; 0 to 3.995 s by 5 ms; `None`: the configured one.
    pub time_gap: Option<Seconds>,
}
