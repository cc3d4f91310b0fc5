//! A road with its intersections, and its way through each of them.

use holdover::coordination::Movement;

use crate::sim::road::Road;

/// Two ways whose directions differ by less than this, in degrees, do not cross: they share their pavement, or are the
/// two directions of one street.
const LEAST_ANGLE_DEG: f64 = 20.0;

/// Width of the widest vehicle, a bus, in metres. The way of every vehicle is as wide.
pub const WIDTH_M: f64 = 2.5;

/// An intersection on a road.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// The intersection.
    pub intersection: usize,
    /// The road's number among the ways through the intersection.
    pub leg: usize,
    /// Distance along the road to the crossing point.
    pub at_m: f64,
}

/// A road with its intersections.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    /// Its geometry.
    pub road: Road,
    /// Its intersections in the order of travel; at least one.
    pub stops: Vec<Stop>,
    /// Distance along it to the place where vehicles appear.
    pub entry_m: f64,
    /// Distance along it to the place where their way ends.
    pub exit_m: f64,
}

/// The way of a road through an intersection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// The road.
    pub road: usize,
    /// Distance along that road to the crossing point.
    pub at_m: f64,
    /// Direction of travel at the crossing point, degrees clockwise from north.
    pub heading_deg: f64,
    /// By how much it turns to the right there, in degrees.
    pub turn_deg: f64,
    /// The way from the crossing point to where the middle of the intersection is beside the lane of the exit.
    pub exits_m: f64,
    /// The leg by which it comes and the exit by which it leaves.
    pub movement: Movement,
}

/// Whether two ways with these directions, in degrees, cross. Otherwise they run side by side, or on one another.
#[must_use]
pub fn cross(a_deg: f64, b_deg: f64) -> bool {
    (LEAST_ANGLE_DEG..=180.0 - LEAST_ANGLE_DEG).contains(&(a_deg - b_deg).rem_euclid(180.0))
}

impl Leg {
    /// Whether it goes straight on.
    #[must_use]
    pub fn is_straight(&self) -> bool {
        self.turn_deg == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_cross_at_20_degrees_and_more() {
        assert!(cross(0.0, 20.0) && cross(350.0, 10.0) && cross(0.0, 160.0) && cross(90.0, 270.0 - 20.0));
        assert!(!cross(0.0, 19.9) && !cross(0.0, 160.1) && !cross(359.0, 1.0) && !cross(10.0, 190.0));
    }
}
