//! `EgoPosition`, `PeerPosition`: where a vehicle is on the globe, in two multiplexed frames.

use crate::time::Stamp;

/// A position on the globe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GeoPosition {
    /// Ties the two frames; modulo 4.
    pub tag: u8,
    /// Degrees north by 1e-7; ±900,000,000.
    pub latitude: i32,
    /// Degrees east by 1e-7; ±1,800,000,000.
    pub longitude: i32,
    /// Degrees clockwise from north by 0.0125; 0 to 28,799.
    pub heading: u16,
    /// When it was there; 0.1 ms.
    pub stamp: Stamp,
}
