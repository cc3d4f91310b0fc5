//! `PeerHorizon`, `OwnHorizon`: a vehicle's own horizon in a few knots, one multiplexed frame each.

use crate::units::{Acceleration, Distance, Speed};

/// Knots of a horizon on the wire.
pub const KNOTS: usize = 5;

/// One knot: the predicted state at a fixed share of the horizon's length after the motion's stamp.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Knot {
    /// Way from the position in the motion message with the same tag; 0 to 262.143 m by 1 mm.
    pub displacement: Distance,
    /// 0 to 65.534 m/s by 2 mm/s.
    pub speed: Speed,
    /// ±20.46 m/s² by 0.02 m/s².
    pub acceleration: Acceleration,
}

/// The knots of one horizon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Knots {
    /// The tag of the motion message that it starts from.
    pub tag: u8,
    /// In the order of time.
    pub knots: [Knot; KNOTS],
}
