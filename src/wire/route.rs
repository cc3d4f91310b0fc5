//! `PeerRoute`, `OwnRoute`: where a vehicle is on its route towards an intersection, in two multiplexed frames.

use super::Predecessor;
use crate::time::Stamp;
use crate::units::Distance;

/// A vehicle's way to the next crossing point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Route {
    /// Ties the two frames; modulo 4.
    pub tag: u8,
    /// Number of the intersection in the route data; 0 to 255.
    pub intersection: u8,
    /// Leg by which it comes; 0 to 7.
    pub leg: u8,
    /// Way to the crossing point, negative beyond it; ±1048.575 m by 1 mm.
    pub distance: Distance,
    /// When `distance` was true; 0.1 ms.
    pub stamp: Stamp,
    /// When it entered the intersection's zone, which decides the order: GNSS time by 10 ms, modulo 2²⁰ (2.9 h).
    pub arrival: u32,
    /// Whom it takes to be ahead of it in the order.
    pub predecessor: Predecessor,
}
