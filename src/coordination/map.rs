//! The map, which the caller provides as constants: the intersections with the legs that lead to them, and the ego's way through some of
//! them.

use super::path::Path;
use crate::units::{Distance, Position};

/// Legs that an intersection can have.
pub const LEGS: u8 = 8;

/// An ego that waits between two conflict areas needs so much more room than its length.
const ROOM: Distance = Distance::from_mm(3_000);

/// A leg of an intersection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Approach {
    /// Its number in messages; below [`LEGS`].
    pub leg: u8,
    /// The path of the vehicles that come by this leg.
    pub path: &'static Path,
    /// Where the crossing point lies on that path.
    pub crossing: Position,
    /// The legs that this leg's way crosses, one bit each.
    pub conflicts: u8,
}

/// What is wrong with a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MapError {
    /// The itinerary has no crossing, or more than 65,535.
    Crossings,
    /// An intersection is met twice, or the crossings are not in the order in which they are met.
    Order,
    /// A leg is numbered [`LEGS`] or more.
    Leg,
    /// Half a conflict area is negative, or longer than 5.115 m. Twice that has to fit into the standstill distance of
    /// `DrivingParameters`.
    Area,
    /// A path has no segment.
    Path,
    /// Between two conflict areas there is no room for the ego, which waits before each of them.
    Close,
}

/// An intersection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Intersection {
    /// Its number in messages.
    pub id: u8,
    /// The conflict area on every leg is this far before and behind the crossing point.
    pub half: Distance,
    /// The legs.
    pub approaches: &'static [Approach],
}

impl Intersection {
    /// Whether the ways of two legs cross. A leg that is not on the map crosses all legs.
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
    /// Where the crossing point lies on the ego's path.
    pub at: Position,
}

/// The ego's way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Itinerary {
    /// Its path.
    pub path: &'static Path,
    /// The intersections on it, in the order in which they are met: at least one, and no intersection twice.
    pub crossings: &'static [Crossing],
}

impl Itinerary {
    /// Checks that an ego of this length can drive by it.
    ///
    /// # Errors
    /// The first thing that is wrong with it.
    pub fn check(&self, length: Distance) -> Result<(), MapError> {
        const AREA_MAX: Distance = Distance::from_mm(5_115);
        if self.crossings.is_empty() || u16::try_from(self.crossings.len()).is_err() {
            return Err(MapError::Crossings);
        }
        if self.path.segments.is_empty() {
            return Err(MapError::Path);
        }
        for (place, crossing) in self.crossings.iter().enumerate() {
            let Intersection { id, half, approaches } = crossing.intersection;
            if crossing.leg >= LEGS || approaches.iter().any(|approach| approach.leg >= LEGS) {
                return Err(MapError::Leg);
            }
            if *half < Distance::ZERO || *half > AREA_MAX {
                return Err(MapError::Area);
            }
            if approaches.iter().any(|approach| approach.path.segments.is_empty()) {
                return Err(MapError::Path);
            }
            let is_last = |other: &Crossing| other.intersection.id != *id && other.at > crossing.at;
            if !self.crossings.iter().skip(place.saturating_add(1)).all(is_last) {
                return Err(MapError::Order);
            }
            if let Some(next) = self.crossings.get(place.saturating_add(1)) {
                let apart = next.at.ahead_of(crossing.at).minus(*half).minus(next.intersection.half);
                if apart < length.plus(ROOM) {
                    return Err(MapError::Close);
                }
            }
        }
        Ok(())
    }

    /// The crossing of this intersection, and its index on the way.
    #[must_use]
    pub fn find(&self, intersection: u8) -> Option<(usize, &'static Crossing)> {
        self.crossings.iter().enumerate().find(|(_, crossing)| crossing.intersection.id == intersection)
    }
}

#[cfg(test)]
mod tests {
    use super::super::path::{Scale, Segment};
    use super::*;

    static SEGMENTS: [Segment; 1] = [Segment {
        latitude: 0,
        longitude: 0,
        begins: Position::ZERO,
        length: Distance::from_mm(1_000),
        along: Scale { north: 1, east: 0 },
        across: Scale { north: 0, east: 1 },
        heading: 0,
    }];
    static PATH: Path = Path { segments: &SEGMENTS };
    static NO_PATH: Path = Path { segments: &[] };

    const fn intersection(id: u8, half_mm: i32, approaches: &'static [Approach]) -> Intersection {
        Intersection { id, half: Distance::from_mm(half_mm), approaches }
    }

    const fn crossing(intersection: &'static Intersection, leg: u8, at_mm: i64) -> Crossing {
        Crossing { intersection, leg, at: Position::from_mm(at_mm) }
    }

    #[test]
    fn a_map_that_cannot_be_driven_by_is_refused_by_name() {
        static GOOD: Intersection = intersection(1, 5_115, &[]);
        static OTHER: Intersection = intersection(2, 0, &[]);
        static WIDE: Intersection = intersection(1, 5_116, &[]);
        static LEGLESS: Intersection =
            intersection(1, 4_000, &[Approach { leg: 8, path: &PATH, crossing: Position::ZERO, conflicts: 0 }]);
        static PATHLESS: Intersection =
            intersection(1, 4_000, &[Approach { leg: 7, path: &NO_PATH, crossing: Position::ZERO, conflicts: 0 }]);
        let check =
            |crossings: &'static [Crossing]| Itinerary { path: &PATH, crossings }.check(Distance::from_mm(4_500));
        assert_eq!(check(&[const { crossing(&GOOD, 7, 0) }, const { crossing(&OTHER, 0, 12_615) }]), Ok(()));
        let close = check(&[const { crossing(&GOOD, 7, 0) }, const { crossing(&OTHER, 0, 12_614) }]);
        assert_eq!(close, Err(MapError::Close));
        assert_eq!(check(&[]), Err(MapError::Crossings));
        assert_eq!(check(&[const { crossing(&GOOD, 8, 5) }]), Err(MapError::Leg));
        assert_eq!(check(&[const { crossing(&LEGLESS, 0, 5) }]), Err(MapError::Leg));
        assert_eq!(check(&[const { crossing(&WIDE, 0, 5) }]), Err(MapError::Area));
        assert_eq!(check(&[const { crossing(&PATHLESS, 0, 5) }]), Err(MapError::Path));
        assert_eq!(check(&[const { crossing(&GOOD, 0, 5) }, const { crossing(&GOOD, 0, 6) }]), Err(MapError::Order));
        assert_eq!(check(&[const { crossing(&GOOD, 0, 5) }, const { crossing(&OTHER, 0, 5) }]), Err(MapError::Order));
        let lost = Itinerary { path: &NO_PATH, crossings: &[const { crossing(&GOOD, 0, 5) }] };
        assert_eq!(lost.check(Distance::ZERO), Err(MapError::Path));
    }

    #[test]
    fn legs_conflict_as_the_map_says_and_an_unknown_leg_with_every_other() {
        static APPROACHES: [Approach; 2] = [
            Approach { leg: 0, path: &PATH, crossing: Position::ZERO, conflicts: 0b100 },
            Approach { leg: 2, path: &PATH, crossing: Position::ZERO, conflicts: 0b001 },
        ];
        let intersection = intersection(1, 4_000, &APPROACHES);
        assert!(intersection.conflict(0, 2) && intersection.conflict(2, 0));
        assert!(!intersection.conflict(0, 0));
        assert!(intersection.conflict(0, 3) && intersection.conflict(3, 0));
        assert!(!intersection.conflict(3, 3));
    }
}
