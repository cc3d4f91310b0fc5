//! `EgoMotion`, `PeerMotion`, `OwnMotion`: a vehicle's state in two frames tied by a tag.

use super::StationHash;
use crate::time::Stamp;
use crate::units::{Acceleration, Distance, Speed};

/// A position along the lane on the wire: millimetres modulo 2²⁵ (33.554 km), signed. The receiver takes the position
/// nearest to where it is itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WirePosition(i32);

/// A vehicle's state at its stamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Motion {
    /// Ties the two frames of one sample, and the horizon that was computed from it; modulo 4.
    pub tag: u8,
    /// Front bumper along the lane; 1 mm.
    pub position: WirePosition,
    /// 0 to 65.534 m/s by 2 mm/s.
    pub speed: Speed,
    /// ±20.46 m/s² by 0.02 m/s².
    pub acceleration: Acceleration,
    /// The acceleration last demanded of the actuators, in force up to the stamp; as `acceleration`.
    pub demand: Acceleration,
    /// When all of this was true; 0.1 ms.
    pub stamp: Stamp,
    /// 95 % of position errors are below this: 0 to 6.3 m by 0.05 m, rounded up; `None`: not published.
    pub position_accuracy: Option<Distance>,
    /// 95 % of speed errors are below this: 0 to 1.24 m/s by 0.02 m/s, rounded up; `None`: not published.
    pub speed_accuracy: Option<Speed>,
    /// Whose state it is.
    pub station: StationHash,
}
