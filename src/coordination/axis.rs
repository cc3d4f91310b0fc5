//! The axis of one peer. The peer's position on its own lane and its distance from a crossing point enter; the same motion on the ego's
//! axis leaves.
//!
//! Every vehicle counts its position on an axis of its own. All legs of an intersection are laid on one virtual lane, with their crossing
//! points on one another: a peer that is 80 m from the crossing point is at the place where the ego is 80 m from it. So a single number
//! ties the peer's axis to the ego's, for as long as the peer approaches this intersection. The number is known as soon as a message of
//! the peer's motion and a message of its route have the same stamp.

use crate::coordination::order::Arrival;
use crate::held::Held;
use crate::time::{Instant, Stamp};
use crate::units::{Distance, Position};
use crate::wire::motion::{Motion, WirePosition};
use crate::wire::{Movement, Predecessor, StationHash};

/// What a peer says of its approach to an intersection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PeerApproach {
    /// The index of the intersection on the ego's way.
    pub crossing: usize,
    /// The peer's way through it.
    pub movement: Movement,
    /// How far ahead of the ego's crossing point the peer's lies on the ego's axis.
    pub shift: Distance,
    /// When the peer arrived, if it says so.
    pub arrival: Option<Arrival>,
    /// The vehicle that the peer takes to be just ahead of it in the order, of those that conflict with it or are ahead on its leg.
    pub claim: Predecessor,
    /// When the peer said so.
    pub heard: Instant,
    /// When the peer said for the first time that it comes to this intersection.
    pub since: Instant,
}

/// What ties the two axes: the place of the peer on the ego's axis at the stamp, and its approach then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Tie {
    stamp: Stamp,
    place: WirePosition,
    approach: PeerApproach,
}

/// A peer's axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Axis {
    newest: Held<(StationHash, Stamp, WirePosition)>,
    tie: Held<Tie>,
    approach: Held<PeerApproach>,
    /// What is added to the peer's positions, in millimetres modulo 2²⁵.
    offset: Held<i32>,
}

/// Two ties that differ by no more than this are taken as the same. The difference is the rounding of two positions on the globe and what
/// their filtering leaves. It is better that an axis does not move than that it is right to the millimetre.
const SAME_TIE_MM: i32 = 25;

impl Axis {
    /// Not known.
    pub const UNKNOWN: Self =
        Self { newest: Held::Nothing, tie: Held::Nothing, approach: Held::Nothing, offset: Held::Nothing };

    /// What the peer says of its approach, once its axis is known.
    #[must_use]
    pub fn approach(&self) -> Option<&PeerApproach> {
        self.offset.as_ref().and(self.approach.as_ref())
    }

    /// Takes in a place: at `stamp` the peer was `distance` before the crossing point, which lies at `crossing` on the ego's axis.
    /// Returns how far the peer's axis moved by that; `None` if the axis is new. The place holds from the peer's motion with the same
    /// stamp on, for two reasons: only the motion names the station, and the positions held before it are not at this place.
    pub fn place(
        &mut self,
        stamp: Stamp,
        crossing: Position,
        distance: Distance,
        approach: PeerApproach,
    ) -> Option<Distance> {
        let place = WirePosition::from_position(crossing.ahead(distance.negated()));
        self.tie.set(Tie { stamp, place, approach });
        self.retie()
    }

    /// Notes that the peer is at no intersection of the ego's way.
    pub fn leave(&mut self) {
        (self.tie, self.approach, self.offset) = (Held::Nothing, Held::Nothing, Held::Nothing);
    }

    /// Notes that another station was refused in this slot. A place that was said since this peer's last motion is then not this peer's.
    pub fn dispute(&mut self) {
        let stamp = self.newest.get().map(|(_, stamp, _)| stamp);
        if self.tie.as_ref().is_some_and(|tie| Some(tie.stamp) != stamp) {
            self.tie.clear();
        }
    }

    /// Takes in a motion. Returns the same motion on the ego's axis, if the axis is known, and how far the axis moved.
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
        let held = self.approach().filter(|held| held.crossing == tie.approach.crossing);
        let since = held.map_or(tie.approach.since, |held| held.since);
        self.approach.set(PeerApproach { since, ..tie.approach });
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
        movement: Movement::straight(1),
        shift: Distance::ZERO,
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
            // Later motions need no route. The positions on the wire wrap around meanwhile.
            assert_eq!(translated(&mut axis, &motion(3, 8, -16_778_000)), Some(419_000), "{is_route_first}");
            assert!(axis.approach().is_some());
        }
    }

    #[test]
    fn a_route_of_another_stamp_ties_nothing() {
        let mut axis = Axis::UNKNOWN;
        place(&mut axis, 6, 500_000, 80_000);
        assert_eq!(translated(&mut axis, &motion(3, 7, 1_000)), None);
        assert_eq!(axis.approach(), None);
    }

    #[test]
    fn what_a_peer_says_of_its_place_holds_from_its_motion_of_the_same_stamp_on() {
        let mut axis = Axis::UNKNOWN;
        translated(&mut axis, &motion(3, 7, 1_000));
        place(&mut axis, 7, 500_000, 80_000);
        let crossing = |axis: &Axis| axis.approach().map(|approach| approach.crossing);
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
