//! `RangeSensor`: an on-board sensor's view of the vehicle ahead, in one frame.

use crate::time::Duration;
use crate::units::{Distance, Speed};

/// One measurement of the vehicle ahead on the same lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RangeSample {
    /// Own front bumper to its rear bumper; 0 to 262.143 m by 1 mm.
    pub distance: Distance,
    /// Its speed less our own; ±65.534 m/s by 2 mm/s.
    pub speed_difference: Speed,
    /// 95 % of distance errors are below this: 0 to 1.55 m by 0.05 m.
    pub distance_accuracy: Distance,
    /// 95 % of speed errors are below this: 0 to 1.5 m/s by 0.1 m/s.
    pub speed_accuracy: Speed,
    /// How old the measurement was when the frame was sent; 0 to 63 ms.
    pub age: Duration,
}
