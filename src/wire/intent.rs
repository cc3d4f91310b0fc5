//! `PeerIntent`, `OwnIntent`: the parameters of the law that a vehicle drives by, in three multiplexed frames.

use super::Predecessor;
use crate::units::{Acceleration, Distance, FineSeconds, Gain, Jerk, Seconds, Speed};

/// What a vehicle can and will do to its acceleration; all magnitudes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits {
    /// Largest acceleration that its controller demands; 0.02 m/s².
    pub acceleration: Acceleration,
    /// Hardest braking that its controller demands in normal driving; 0.02 m/s².
    pub braking: Acceleration,
    /// Fastest change of the demand in normal driving; 0.05 m/s³.
    pub jerk: Jerk,
    /// Hardest braking that it is capable of; 0.02 m/s².
    pub emergency_braking: Acceleration,
}

/// How a vehicle will drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Intent {
    /// Bumper to bumper, `l`; 0 to 40.95 m by 1 cm.
    pub length: Distance,
    /// Distance kept at standstill, `s_0`; 0 to 10.23 m by 1 cm.
    pub standstill: Distance,
    /// Whom it follows.
    pub predecessor: Predecessor,
    /// Speed that it wants on a free road, `v_∞`; 0 to 65.534 m/s by 2 mm/s.
    pub target_speed: Speed,
    /// Desired time gap, `t_g`; 0 to 3.995 s by 5 ms.
    pub time_gap: Seconds,
    /// Gain `k` (with the adjacency `α` = 1); 0 to 3.999 /s² by 0.001.
    pub gain: Gain,
    /// Damping `γ`; 0 to 3.999 s by 0.001 s.
    pub damping: Seconds,
    /// Time constant of its actuators, `T`; 0 to 1.998 s by 2 ms.
    pub lag: FineSeconds,
    /// Its limits.
    pub limits: Limits,
    /// How far its horizon reaches; 0 to 25.5 s by 0.1 s, in tenths of a second.
    pub horizon_tenths: u8,
}
