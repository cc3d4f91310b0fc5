//! The vehicles that cross the ego's way at the next intersection: what is certain of them enters; where the ego has to be able to stop
//! for each of them leaves, and whether a view of the range sensor is of one of them.

use super::Scene;
use crate::envelope;
use crate::time::Instant;
use crate::units::Position;

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// Where the ego, whose front bumper is at `rearmost` or before that, has to be able to stop for a peer. It stops before the conflict
    /// area for every vehicle whose way crosses the ego's and which is ahead in the order, or in the area for certain. A vehicle that
    /// yielded when it could not stop any more is in the area all the same.
    pub fn stop_before_area(&self, index: usize, now: Instant, rearmost: Position) -> Option<Position> {
        let (approach, crossing) = (self.coordination.approach(index)?, self.coordination.crossing()?);
        let intersection = crossing.intersection;
        let point = self.coordination.crossing_point(crossing)?;
        let area_begins = self.area_begins()?;
        if rearmost > area_begins || !intersection.conflict(crossing.leg, approach.leg) {
            return None;
        }
        let near_end = self.bound(index, now)?.lowest_position();
        let is_inside = near_end >= area_begins && self.coordination.is_here(approach);
        if !is_inside && !self.coordination.choice().ahead.contains(index) {
            return None;
        }
        let length = self.peers.length_of(index);
        envelope::stop_before_conflict(area_begins, near_end, length, point.ahead(intersection.half))
    }

    /// Whether a view is of a vehicle that crosses the ego's way: its place is inside the conflict area, and the ego has to be able to
    /// stop before the area for a vehicle that it has heard. Such a view says nothing new. It does not contradict what is heard of the
    /// vehicle ahead on the own leg, which the crossing one hides. And it need not be remembered, because the crossing vehicle is minded
    /// until it has left the area for certain, by what was heard of it. *Alternative:* taken for a vehicle that stands in the way, each
    /// one that crosses would hold the ego for as long as one that stood is remembered.
    pub(super) fn is_of_one_that_crosses(&self, at: Instant, own_front: Position, seen: Position) -> bool {
        let area = self.coordination.crossing().and_then(|crossing| {
            Some((self.area_begins()?, self.coordination.crossing_point(crossing)?.ahead(crossing.intersection.half)))
        });
        let is_in_area = area.is_some_and(|(begins, ends)| begins <= seen && seen <= ends);
        is_in_area && (0..PEERS).any(|index| self.stop_before_area(index, at, own_front).is_some())
    }
}
