//! One peer's axis: where it says it is on its own lane, and how far that is from a crossing point, enter; the same motion on
//! the ego's axis leaves.
//!
//! Every vehicle counts its position on an axis of its own. All legs of an intersection are laid on one virtual lane with their
//! crossing points on one another: a peer that is 80 m from the crossing point is where the ego will be 80 m from it. So one
//! number ties a peer's axis to the ego's for as long as that peer approaches this intersection, and it is known as soon as
//! one message of the peer's motion and one of its route have the same stamp.

use crate::coordination::order::Arrival;
use crate::held::Held;
use crate::time::{Instant, Stamp};
use crate::units::{Distance, Position};
use crate::wire::motion::{Motion, WirePosition};
use crate::wire::{Predecessor, StationHash};

/// What a peer says of its place at an intersection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PeerApproach {
    /// The intersection's place on the ego's way.
    pub crossing: usize,
    /// Leg by which it comes.
    pub leg: u8,
    /// When it arrived, if it says so.
    pub arrival: Option<Arrival>,
    /// Whom it takes to be just ahead.
    pub claim: Predecessor,
    /// When it said so.
    pub heard: Instant,
    /// When it said for the first time that it comes to this intersection.
    pub since: Instant,
}

/// What ties the two axes: at the stamp the peer was at this place of the ego's axis, and stood there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Tie {
    stamp: Stamp,
    place: WirePosition,
    standing: PeerApproach,
}

/// A peer's axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Axis {
    newest: Held<(StationHash, Stamp, WirePosition)>,
    tie: Held<Tie>,
    standing: Held<PeerApproach>,
    /// What is added to its positions, in millimetres modulo 2²⁵.
    offset: Held<i32>,
}

/// Ties that differ by no more than this are the same: the roundings of two positions on the globe and what is left of
/// their filtering. An axis that does not move costs less than one that is right to the millimetre.
const SAME_TIE_MM: i32 = 25;

impl Axis {
    /// Not known.
    pub const UNKNOWN: Self =
        Self { newest: Held::Nothing, tie: Held::Nothing, standing: Held::Nothing, offset: Held::Nothing };

    /// What the peer says, once its axis is known.
    #[must_use]
    pub fn standing(&self) -> Option<&PeerApproach> {
        self.offset.as_ref().and(self.standing.as_ref())
    }

    /// Takes in a place: at `stamp` the peer was `distance` before the crossing point, which lies at `crossing` on the ego's
    /// axis. Gives how far the peer's axis moved by that, unless it is new. All of it holds from the peer's motion of the same
    /// stamp on: only that says who speaks, and before it the positions that are held are not of this place.
    pub fn place(
        &mut self,
        stamp: Stamp,
        crossing: Position,
        distance: Distance,
        standing: PeerApproach,
    ) -> Option<Distance> {
        let place = WirePosition::from_position(crossing.ahead(distance.negated()));
        self.tie.set(Tie { stamp, place, standing });
        self.retie()
    }

    /// Takes note that the peer is at no intersection of the ego's way.
    pub fn leave(&mut self) {
        (self.tie, self.standing, self.offset) = (Held::Nothing, Held::Nothing, Held::Nothing);
    }

    /// Takes note that another station was refused in the slot: the place that was said since this one's last motion is not this
    /// one's.
    pub fn dispute(&mut self) {
        let stamp = self.newest.get().map(|(_, stamp, _)| stamp);
        if self.tie.as_ref().is_some_and(|tie| Some(tie.stamp) != stamp) {
            self.tie.clear();
        }
    }

    /// Takes in a motion: the same on the ego's axis, if that is known, and how far the axis moved.
    pub fn translate(&mut self, motion: &Motion) -> (Option<Motion>, Option<Distance>) {
        if self.newest.get().is_some_and(|(station, ..)| station != motion.station) {
            self.offset.clear();
        }
        self.newest.set((motion.station, motion.stamp, motion.position));
        let moved = self.retie();
        let translated = self.offset.get().map(|offset| {
            let position = WirePosition::from_mm(i64::from(motion.position.mm()).saturating_add(offset.into()));
            Motion { position, ..*motion }
        });
        (translated, moved)
    }

    fn retie(&mut self) -> Option<Distance> {
        let (_, stamp, position) = self.newest.get()?;
        let tie = self.tie.get().filter(|tie| tie.stamp == stamp)?;
        let held = self.standing().filter(|held| held.crossing == tie.standing.crossing);
        let since = held.map_or(tie.standing.since, |held| held.since);
        self.standing.set(PeerApproach { since, ..tie.standing });
        let offset = tie.place.mm_ahead_of(position);
        let Some(before) = self.offset.get() else {
            self.offset.set(offset);
            return None;
        };
        let moved = WirePosition::from_mm(offset.into()).mm_ahead_of(WirePosition::from_mm(before.into()));
        if moved.unsigned_abs() <= SAME_TIE_MM.unsigned_abs() {
            return None;
        }
        self.offset.set(offset);
        Some(Distance::from_mm(moved))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::{Acceleration, Speed};

    fn motion(station: u8, stamp: u32, mm: i64) -> Motion {
        Motion {
            tag: 0,
            position: WirePosition::from_mm(mm),
            speed: Speed::ZERO,
            acceleration: Acceleration::ZERO,
            demand: Acceleration::ZERO,
            stamp: Stamp::from_raw(stamp),
            position_accuracy: None,
            speed_accuracy: None,
            station: StationHash(station),
        }
    }

    const STANDING: PeerApproach = PeerApproach {
        crossing: 0,
        leg: 1,
        arrival: None,
        claim: Predecessor::None,
        heard: Instant::ZERO,
        since: Instant::ZERO,
    };

    fn place(axis: &mut Axis, stamp: u32, crossing_mm: i64, before_mm: i32) -> Option<i32> {
        let (stamp, distance) = (Stamp::from_raw(stamp), Distance::from_mm(before_mm));
        axis.place(stamp, Position::from_mm(crossing_mm), distance, STANDING).map(Distance::to_mm)
    }

    fn translated(axis: &mut Axis, motion: &Motion) -> Option<i32> {
        axis.translate(motion).0.map(|motion| motion.position.mm())
    }

    #[test]
    fn a_peer_is_as_far_from_the_crossing_point_on_the_virtual_lane_as_it_is_on_its_own() {
        for is_route_first in [true, false] {
            let mut axis = Axis::UNKNOWN;
            if is_route_first {
                place(&mut axis, 7, 500_000, 80_000);
            }
            let first = translated(&mut axis, &motion(3, 7, -16_777_000));
            assert_eq!(first, is_route_first.then_some(420_000));
            place(&mut axis, 7, 500_000, 80_000);
            // Later motions need no route; the wire's positions come round meanwhile.
            assert_eq!(translated(&mut axis, &motion(3, 8, -16_778_000)), Some(419_000), "{is_route_first}");
            assert!(axis.standing().is_some());
        }
    }

    #[test]
    fn a_route_of_another_stamp_ties_nothing() {
        let mut axis = Axis::UNKNOWN;
        place(&mut axis, 6, 500_000, 80_000);
        assert_eq!(translated(&mut axis, &motion(3, 7, 1_000)), None);
        assert_eq!(axis.standing(), None);
    }

    #[test]
    fn what_a_peer_says_of_its_place_holds_from_its_motion_of_the_same_stamp_on() {
        let mut axis = Axis::UNKNOWN;
        translated(&mut axis, &motion(3, 7, 1_000));
        place(&mut axis, 7, 500_000, 80_000);
        let crossing = |axis: &Axis| axis.standing().map(|standing| standing.crossing);
        let next = PeerApproach { crossing: 1, ..STANDING };
        assert_eq!(axis.place(Stamp::from_raw(8), Position::from_mm(700_000), Distance::from_mm(280_000), next), None);
        assert_eq!(crossing(&axis), Some(0));
        assert_eq!(translated(&mut axis, &motion(3, 8, 2_000)), Some(420_000));
        assert_eq!(crossing(&axis), Some(1));
    }

    #[test]
    fn an_axis_moves_only_by_more_than_roundings() {
        let mut axis = Axis::UNKNOWN;
        translated(&mut axis, &motion(3, 7, 1_000));
        assert_eq!(place(&mut axis, 7, 500_000, 80_000), None);
        assert_eq!(place(&mut axis, 7, 500_025, 80_000), None);
        assert_eq!(place(&mut axis, 7, 499_975, 80_000), None);
        assert_eq!(translated(&mut axis, &motion(3, 8, 1_000)), Some(420_000));
        assert_eq!(place(&mut axis, 8, 500_026, 80_000), Some(26));
        assert_eq!(place(&mut axis, 8, 700_000, 80_000), Some(199_974));
        assert_eq!(translated(&mut axis, &motion(3, 9, 1_000)), Some(620_000));
    }

    #[test]
    fn another_station_in_the_slot_has_an_axis_of_its_own() {
        let mut axis = Axis::UNKNOWN;
        translated(&mut axis, &motion(3, 7, 1_000));
        place(&mut axis, 7, 500_000, 80_000);
        assert_eq!(translated(&mut axis, &motion(4, 8, 1_000)), None);
    }

    #[test]
    fn a_peer_that_left_is_on_no_axis() {
        let mut axis = Axis::UNKNOWN;
        translated(&mut axis, &motion(3, 7, 1_000));
        place(&mut axis, 7, 500_000, 80_000);
        axis.leave();
        assert_eq!(translated(&mut axis, &motion(3, 7, 1_000)), None);
    }
}
