//! The map, which the caller provides as constants: the intersections with the ways that lead through them, and the ego's way through
//! some of them.
//!
//! A way in by a leg and out by an exit is a *movement*. Two movements of one leg are one lane until they have left the conflict area, and
//! two movements to one exit are one lane from there on. Whether two movements conflict is a relation between them that the map states.

use super::path::Path;
use crate::units::{Distance, Position};
use crate::wire::Movement;
pub use crate::wire::movement::LEGS;

/// An ego that waits between two conflict areas needs so much more room than its length.
const ROOM: Distance = Distance::from_mm(3_000);

/// A set of movements: bit `8 leg + exit` is set for each of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Movements(pub u64);

impl Movements {
    /// The empty set.
    pub const NONE: Self = Self(0);

    /// The movements straight on from these legs: bit `n` is leg `n`.
    #[must_use]
    pub const fn straight(legs: u8) -> Self {
        let (mut set, mut leg) = (Self::NONE, 0);
        while leg < LEGS {
            if legs & (1 << leg) != 0 {
                set = set.with(Movement::straight(leg));
            }
            leg = leg.wrapping_add(1);
        }
        set
    }

    /// The same with one more.
    #[must_use]
    pub const fn with(self, movement: Movement) -> Self {
        Self(self.0 | Self::bit(movement))
    }

    /// Whether it is one of them.
    #[must_use]
    pub const fn contains(self, movement: Movement) -> bool {
        self.0 & Self::bit(movement) != 0
    }

    const fn bit(Movement { leg, exit }: Movement) -> u64 {
        if leg < LEGS && exit < LEGS { 1 << ((leg << 3) | exit) } else { 0 }
    }
}

/// A way through an intersection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Approach {
    /// Its leg and exit, by their numbers in messages.
    pub movement: Movement,
    /// The path of the vehicles that go this way.
    pub path: &'static Path,
    /// Where the crossing point lies on that path. For all movements of a leg it is the same way beyond a place that all of them pass.
    pub crossing: Position,
    /// The way from there to a place that all movements of the exit have in common. It is used only where movements join.
    pub exits: Distance,
    /// The movements that it conflicts with. Those of its own leg are not among them, and all of other legs to its exit are. Of two
    /// movements on the map, each names the other or neither does.
    pub conflicts: Movements,
}

impl Approach {
    /// The way straight on from a leg of an intersection where nobody turns. `conflicts` are the legs that it crosses: bit `n` is leg `n`.
    #[must_use]
    pub const fn straight(leg: u8, path: &'static Path, crossing: Position, conflicts: u8) -> Self {
        let (movement, conflicts) = (Movement::straight(leg), Movements::straight(conflicts));
        Self { movement, path, crossing, exits: Distance::ZERO, conflicts }
    }
}

/// What is wrong with a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MapError {
    /// The itinerary has no crossing, or more than 65,535.
    Crossings,
    /// An intersection is met twice, or the crossings are not in the order in which they are met.
    Order,
    /// A leg or an exit is numbered [`LEGS`] or more.
    Leg,
    /// Half a conflict area is negative, or longer than 5.115 m. Twice that has to fit into the standstill distance of
    /// `DrivingParameters`.
    Area,
    /// A path has no segment.
    Path,
    /// Between two conflict areas there is no room for the ego, which waits before each of them.
    Close,
    /// Of two movements only one conflicts with the other, two of one leg conflict, or two to one exit do not.
    Conflicts,
}

/// An intersection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Intersection {
    /// Its number in messages.
    pub id: u8,
    /// The conflict area on every way is this far before and behind the crossing point.
    pub half: Distance,
    /// The ways through it.
    pub approaches: &'static [Approach],
}

impl Intersection {
    /// Whether its movements conflict as movements can.
    fn is_consistent(&self) -> bool {
        self.approaches.iter().all(|a| {
            self.approaches.iter().all(|b| {
                let [of_a, of_b] = [a.conflicts.contains(b.movement), b.conflicts.contains(a.movement)];
                let (share_leg, join) = (a.movement.leg == b.movement.leg, join(a.movement, b.movement));
                of_a == of_b && !(share_leg && of_a) && (of_a || !join)
            })
        })
    }

    fn approach(&self, movement: Movement) -> Option<&Approach> {
        self.approaches.iter().find(|approach| approach.movement == movement)
    }

    /// Whether two movements conflict. One that is not on the map conflicts with all of other legs.
    #[must_use]
    pub fn conflict(&self, a: Movement, b: Movement) -> bool {
        match (self.approach(a), self.approach(b)) {
            (Some(a), Some(_)) => a.conflicts.contains(b),
            _ => a.leg != b.leg,
        }
    }

    /// Whether all vehicles that come by a leg go the same way.
    #[must_use]
    pub fn has_one_way_from(&self, leg: u8) -> bool {
        self.approaches.iter().filter(|approach| approach.movement.leg == leg).count() <= 1
    }

    /// Whether a movement conflicts with one that begins on a leg. A leg that is not on the map crosses all others.
    #[must_use]
    pub fn crosses(&self, movement: Movement, leg: u8) -> bool {
        let mut of_leg =
            self.approaches.iter().map(|approach| approach.movement).filter(|other| other.leg == leg).peekable();
        let is_unknown = of_leg.peek().is_none();
        is_unknown && movement.leg != leg || of_leg.any(|other| self.conflict(movement, other))
    }

    /// How far ahead of the own crossing point that of another movement lies on the own axis. It is zero unless the two join. If they do,
    /// it brings the places together that both pass on their common way out.
    #[must_use]
    pub fn shift(&self, own: Movement, other: Movement) -> Distance {
        match (self.approach(own), self.approach(other)) {
            (Some(own), Some(other)) if join(own.movement, other.movement) => own.exits.minus(other.exits),
            _ => Distance::ZERO,
        }
    }
}

/// Whether two movements come by different legs, and are one lane beyond the conflict area.
#[must_use]
pub(super) fn join(a: Movement, b: Movement) -> bool {
    a.leg != b.leg && a.exit == b.exit
}

/// An intersection on the ego's way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Crossing {
    /// The intersection.
    pub intersection: &'static Intersection,
    /// The ego's way through it.
    pub movement: Movement,
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
            let is_numbered = |movement: Movement| movement.leg < LEGS && movement.exit < LEGS;
            if !is_numbered(crossing.movement) || !approaches.iter().all(|approach| is_numbered(approach.movement)) {
                return Err(MapError::Leg);
            }
            if !crossing.intersection.is_consistent() {
                return Err(MapError::Conflicts);
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
        Crossing { intersection, movement: Movement::straight(leg), at: Position::from_mm(at_mm) }
    }

    #[test]
    fn a_map_that_cannot_be_driven_by_is_refused_by_name() {
        static GOOD: Intersection = intersection(1, 5_115, &[]);
        static OTHER: Intersection = intersection(2, 0, &[]);
        static WIDE: Intersection = intersection(1, 5_116, &[]);
        static LEGLESS: Intersection = intersection(1, 4_000, &[Approach::straight(8, &PATH, Position::ZERO, 0)]);
        static PATHLESS: Intersection = intersection(1, 4_000, &[Approach::straight(7, &NO_PATH, Position::ZERO, 0)]);
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
    fn movements_that_conflict_one_way_only_are_refused() {
        const fn way(leg: u8, exit: u8, conflicts: &[(u8, u8)]) -> Approach {
            let (mut set, mut place) = (Movements::NONE, 0);
            while place < conflicts.len() {
                let (leg, exit) = conflicts[place];
                (set, place) = (set.with(Movement { leg, exit }), place + 1);
            }
            let (crossing, exits) = (Position::ZERO, Distance::ZERO);
            Approach { movement: Movement { leg, exit }, path: &PATH, crossing, exits, conflicts: set }
        }
        let check = |approaches: &[Approach]| {
            let approaches: &'static [Approach] = Box::leak(Box::from(approaches));
            let intersection = Box::leak(Box::new(intersection(1, 4_000, approaches)));
            let crossings = Box::leak(Box::new([crossing(intersection, 0, 5)]));
            Itinerary { path: &PATH, crossings }.check(Distance::ZERO)
        };
        assert_eq!(check(&[way(0, 0, &[(1, 1)]), way(1, 1, &[(0, 0)])]), Ok(()));
        assert_eq!(check(&[way(0, 0, &[(1, 1)]), way(1, 1, &[])]), Err(MapError::Conflicts));
        assert_eq!(check(&[way(0, 0, &[]), way(1, 1, &[(0, 0)])]), Err(MapError::Conflicts));
        assert_eq!(check(&[way(0, 0, &[(7, 7)])]), Ok(()), "7 is not on the map");
        assert_eq!(check(&[way(0, 0, &[(0, 0)])]), Err(MapError::Conflicts));
        assert_eq!(check(&[way(0, 0, &[(0, 1)]), way(0, 1, &[(0, 0)])]), Err(MapError::Conflicts));
        assert_eq!(check(&[way(0, 1, &[(1, 1)]), way(1, 1, &[(0, 1)])]), Ok(()));
        assert_eq!(check(&[way(0, 1, &[]), way(1, 1, &[])]), Err(MapError::Conflicts), "they join");
    }

    #[test]
    fn legs_conflict_as_the_map_says_and_an_unknown_leg_with_every_other() {
        static APPROACHES: [Approach; 2] =
            [Approach::straight(0, &PATH, Position::ZERO, 0b100), Approach::straight(2, &PATH, Position::ZERO, 0b001)];
        let intersection = intersection(1, 4_000, &APPROACHES);
        let conflict = |a, b| {
            let (a, b) = (Movement::straight(a), Movement::straight(b));
            let conflict = intersection.conflict(a, b);
            assert_eq!(intersection.crosses(a, b.leg), conflict);
            conflict
        };
        assert!(conflict(0, 2) && conflict(2, 0));
        assert!(!conflict(0, 0));
        assert!(conflict(0, 3) && conflict(3, 0));
        assert!(!conflict(3, 3));
    }

    #[test]
    fn movements_of_one_leg_conflict_each_with_its_own_and_two_to_one_exit_meet_where_it_begins() {
        const THROUGH: Movement = Movement::straight(0);
        const RIGHT: Movement = Movement { leg: 0, exit: 1 };
        const ACROSS: Movement = Movement::straight(1);
        const ONCOMING: Movement = Movement::straight(2);
        const fn way(movement: Movement, exits_mm: i32, conflicts: Movements) -> Approach {
            let exits = Distance::from_mm(exits_mm);
            Approach { movement, path: &PATH, crossing: Position::ZERO, exits, conflicts }
        }
        static APPROACHES: [Approach; 4] = [
            way(THROUGH, 0, Movements::NONE.with(ACROSS)),
            way(RIGHT, -2_500, Movements::NONE.with(ACROSS)),
            way(ACROSS, 1_000, Movements::NONE.with(THROUGH).with(RIGHT)),
            way(ONCOMING, 0, Movements::NONE),
        ];
        let intersection = intersection(1, 4_000, &APPROACHES);
        for (a, b, conflict) in
            [(THROUGH, ACROSS, true), (RIGHT, ACROSS, true), (RIGHT, THROUGH, false), (RIGHT, ONCOMING, false)]
        {
            assert_eq!((intersection.conflict(a, b), intersection.conflict(b, a)), (conflict, conflict), "{a:?} {b:?}");
        }
        assert!(intersection.crosses(ACROSS, 0) && !intersection.crosses(ONCOMING, 0));
        assert!(intersection.conflict(Movement { leg: 0, exit: 7 }, ONCOMING), "nobody knows where that leads");
        assert_eq!(intersection.shift(RIGHT, ACROSS), Distance::from_mm(-3_500));
        assert_eq!(intersection.shift(ACROSS, RIGHT), Distance::from_mm(3_500));
        assert_eq!(
            (intersection.shift(THROUGH, ACROSS), intersection.shift(THROUGH, RIGHT)),
            (Distance::ZERO, Distance::ZERO)
        );
    }
}
