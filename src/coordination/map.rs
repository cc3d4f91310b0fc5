//! The map that the caller provides as constants: intersections with the legs that feed them, and the way of the ego through
//! some of them. Nothing enters; constants leave.

use super::path::Path;
use crate::units::{Distance, Position};

/// Legs that an intersection can have.
pub const LEGS: u8 = 8;

/// A leg that feeds an intersection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Approach {
    /// Its number in messages; below [`LEGS`].
    pub leg: u8,
    /// The path of those who come by it.
    pub path: &'static Path,
    /// Where the crossing point lies on that path.
    pub crossing: Position,
    /// The legs that its way crosses, a bit each.
    pub conflicts: u8,
}

/// An intersection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Intersection {
    /// Its number in messages.
    pub id: u8,
    /// The conflict area reaches from so far before the crossing point to so far behind it, on every leg.
    pub half: Distance,
    /// The legs.
    pub approaches: &'static [Approach],
}

impl Intersection {
    /// Whether two legs' ways cross. A leg that is not on the map crosses all.
    #[must_use]
    pub fn conflict(&self, a: u8, b: u8) -> bool {
        let approach = |leg| self.approaches.iter().find(|approach| approach.leg == leg);
        match (approach(a), approach(b)) {
            (Some(a), Some(_)) => a.conflicts & 1u8.checked_shl(b.into()).unwrap_or(0) != 0,
            _ => a != b,
        }
    }
}

/// An intersection on the ego's way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Crossing {
    /// The intersection.
    pub intersection: &'static Intersection,
    /// The leg by which the ego comes.
    pub leg: u8,
    /// Where its crossing point lies on the ego's path.
    pub at: Position,
}

/// The ego's way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Itinerary {
    /// Its path.
    pub path: &'static Path,
    /// The intersections on it, in the order in which they are met; at least one, no intersection twice.
    pub crossings: &'static [Crossing],
}

impl Itinerary {
    /// The crossing of this intersection, and its place on the way.
    #[must_use]
    pub fn find(&self, intersection: u8) -> Option<(usize, &'static Crossing)> {
        self.crossings.iter().enumerate().find(|(_, crossing)| crossing.intersection.id == intersection)
    }
}
