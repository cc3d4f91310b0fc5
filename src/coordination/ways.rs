//! How a peer's way lies to the ego's at a crossing of both: its approach enters; whether it shares the ego's lane leaves.

use super::{Coordination, Crossing, PeerApproach, map};
use crate::units::Position;

impl<const PEERS: usize> Coordination<PEERS> {
    /// Whether a peer with this approach is on the ego's lane: until it has left the conflict area if it comes by the ego's leg, and from
    /// then on if it takes the ego's exit.
    #[must_use]
    pub(crate) fn is_on_lane(&self, approach: &PeerApproach, has_left: bool) -> bool {
        let crossing = self.itinerary.and_then(|itinerary| itinerary.crossings.get(approach.crossing));
        crossing.is_some_and(|Crossing { movement, .. }| match has_left {
            false => movement.leg == approach.movement.leg,
            true => movement.exit == approach.movement.exit,
        })
    }

    /// Whether the way of a peer with this approach conflicts with the ego's at the crossing of both. One that does not tell its route may
    /// take any way from its leg.
    pub(crate) fn conflicts(&self, approach: &PeerApproach) -> bool {
        let crossing = self.itinerary.and_then(|itinerary| itinerary.crossings.get(approach.crossing));
        crossing.is_some_and(|Crossing { intersection, movement, .. }| match approach.arrival {
            Some(_) => intersection.conflict(*movement, approach.movement),
            None => intersection.crosses(*movement, approach.movement.leg),
        })
    }

    /// Whether a peer with this approach comes by another leg and takes the ego's exit.
    pub(crate) fn joins(&self, approach: &PeerApproach) -> bool {
        let crossing = self.itinerary.and_then(|itinerary| itinerary.crossings.get(approach.crossing));
        crossing.is_some_and(|crossing| map::join(crossing.movement, approach.movement))
    }

    /// Whether a peer with this approach, and with its rear bumper at `rear`, has left the conflict area.
    pub(crate) fn has_left(&self, approach: &PeerApproach, rear: Position) -> bool {
        self.end_of(approach.crossing).is_some_and(|end| rear >= end.ahead(approach.shift))
    }

    /// Where a peer with this approach comes to the conflict area that it leaves by another exit than the ego.
    pub(crate) fn turns_off_at(&self, approach: &PeerApproach) -> Option<Position> {
        let crossing = self.itinerary?.crossings.get(approach.crossing)?;
        let begins = self.crossing_point(crossing)?.ahead(crossing.intersection.half.negated());
        (crossing.movement.exit != approach.movement.exit).then_some(begins)
    }

    /// Whether a peer with this approach is at the crossing that is next for the ego.
    #[must_use]
    pub(crate) const fn is_here(&self, approach: &PeerApproach) -> bool {
        approach.crossing == self.current
    }
}
