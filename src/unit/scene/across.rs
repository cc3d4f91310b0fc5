//! The vehicles that cross the ego's way at the next intersection: what is certain of them enters; where the ego has to be able to stop
//! for each of them leaves, and whether a view of the range sensor is of one of them.

use super::Scene;
use super::sight::Sight;
use crate::envelope;
use crate::model::Reading;
use crate::model::bound::Bound;
use crate::time::{Duration, Instant};
use crate::units::{Distance, Position};

/// So far before the area for certain nobody is seen who crosses or joins in it.
const WELL_BEFORE: Distance = Distance::from_mm(-1_000);

/// A peer that was heard no longer ago than this says where it is itself.
const JUST_NOW: Duration = Duration::from_millis(500);

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// Where the ego, whose front bumper is at `rearmost` or before that, has to be able to stop for a peer. It stops before the conflict
    /// area for every vehicle whose way crosses the ego's and which is ahead in the order, or in the area for certain. A vehicle that
    /// yielded when it could not stop any more is in the area all the same.
    pub fn stop_before_area(&self, index: usize, now: Instant, rearmost: Position) -> Option<Position> {
        let (approach, crossing) = (self.coordination.approach(index)?, self.coordination.crossing()?);
        let intersection = crossing.intersection;
        let area_begins = self.area_begins()?;
        if rearmost > area_begins || !intersection.conflict(crossing.movement, approach.movement) {
            return None;
        }
        let near_end = self.bound(index, now)?.lowest_position();
        let [begins, ends] = self.area_of(index)?;
        let is_inside = near_end >= begins && self.coordination.is_here(approach);
        if !is_inside && !self.coordination.choice().ahead.contains(index) {
            return None;
        }
        let length = self.peers.length_of(index);
        envelope::stop_before_conflict(area_begins, near_end, length, ends)
    }

    /// Where the next conflict area begins and ends for a peer, on the ego's axis.
    fn area_of(&self, index: usize) -> Option<[Position; 2]> {
        let shift = self.coordination.approach(index).map_or(Distance::ZERO, |approach| approach.shift);
        Some(self.next_area()?.map(|place| place.ahead(shift)))
    }

    /// Whether a peer that was heard just now is in the next conflict area, and may still be there at `then`.
    pub fn is_in_area_until(&self, index: usize, now: Instant, then: Instant) -> bool {
        let Some(([begins, ends], bound)) = self.area_of(index).zip(self.bound(index, now)) else { return false };
        let is_inside = bound.lowest_position() >= begins && self.was_heard(index, now);
        is_inside && self.near_rear(index, then).is_none_or(|(rear, _)| rear < ends)
    }

    /// Whether a peer that was heard just now explains that a vehicle is seen in the next conflict area: it is in there for certain. One
    /// that may be waiting at its line does not.
    pub fn is_crossing_heard(&self, now: Instant) -> bool {
        let is_inside = |index| {
            let area = self.area_of(index).zip(self.bound(index, now));
            area.is_some_and(|([begins, _], bound)| bound.lowest_position() >= begins)
        };
        (0..PEERS).any(|index| self.was_heard(index, now) && is_inside(index) && self.may_be_in_area(index, now))
    }

    /// Whether the ego's sensor sees that nobody is in the next conflict area.
    pub fn sees_empty_area(&self, now: Instant) -> bool {
        let ends = self.coordination.end_of(self.coordination.next());
        self.config.range_sensor && ends.is_some_and(|ends| self.ranging.is_free_up_to(ends, now))
    }

    /// Whether a peer whose way crosses the ego's is estimated to be in the next conflict area.
    #[cold] // only where a peer has been silent for longer than a holdover
    pub fn is_estimated_in_area(&self, index: usize, now: Instant) -> bool {
        let is_there = |([begins, ends], (reading, rear)): ([Position; 2], (Reading, Position))| {
            reading.position >= begins && rear <= ends
        };
        self.crosses_next(index) && self.area_of(index).zip(self.rear(index, now)).is_some_and(is_there)
    }

    /// Whether a peer is not in the area where it is estimated to be, and has not been heard since that was seen.
    pub fn is_missed(&self, index: usize, now: Instant) -> bool {
        self.coordination.choice().missed.contains(index) && !self.is_in_reach(index, now)
    }

    fn was_heard(&self, index: usize, now: Instant) -> bool {
        let silence = self.peers.get(index).and_then(|track| track.link().silence(now));
        silence.is_some_and(|silence| silence <= JUST_NOW)
    }

    /// Whether a peer whose way crosses the ego's may be in the next conflict area.
    fn may_be_in_area(&self, index: usize, at: Instant) -> bool {
        let is_there = |([begins, ends], (rear, bound)): ([Position; 2], (Position, Bound))| {
            rear <= ends && bound.highest_position() >= begins
        };
        self.crosses_next(index) && self.area_of(index).zip(self.near_rear(index, at)).is_some_and(is_there)
    }

    /// Whether a peer's way crosses the ego's at the next intersection.
    fn crosses_next(&self, index: usize) -> bool {
        self.coordination.approach(index).zip(self.coordination.crossing()).is_some_and(|(peer, own)| {
            self.coordination.is_here(peer) && own.intersection.conflict(own.movement, peer.movement)
        })
    }

    /// Whether a view may be of a vehicle that crosses the ego's way: its place is inside the conflict area, and the ego has to be able to
    /// stop before the area for a vehicle that it has heard. Such a view says nothing new, unless it [goes on](Self::is_on_leg) with those
    /// of the vehicle ahead on the own leg. It does not contradict what is heard of that one, which the crossing one hides. And it need not
    /// be remembered, because the crossing vehicle is minded until it has left the area for certain, by what was heard of it.
    /// *Alternative:* taken for a vehicle that stands in the way, each one that crosses would hold the ego for as long as one that stood is
    /// remembered.
    pub(super) fn is_of_one_that_crosses(&self, sight: &Sight, own_front: Position) -> bool {
        let is_in_area = self.next_area().is_some_and(|[begins, ends]| begins <= sight.rear && sight.rear <= ends);
        is_in_area
            && (0..PEERS).any(|index| {
                self.may_be_in_area(index, sight.at) || self.stop_before_area(index, sight.at, own_front).is_some()
            })
    }

    /// Whether a view is of a vehicle that was ahead on the ego's leg before the next conflict area: there for certain, or the view goes on
    /// with one of such a vehicle. Where some turn off, one in the area may have been hiding another that stands beyond it.
    pub(super) fn is_on_leg(&self, sight: &Sight) -> bool {
        let Some(([begins, ends], crossing)) = self.next_area().zip(self.coordination.crossing()) else { return false };
        let is_before = sight.bound.highest_position() < begins.ahead(WELL_BEFORE);
        let goes_on = || self.ranging.goes_on(sight) && crossing.intersection.has_one_way_from(crossing.movement.leg);
        is_before || sight.rear <= ends && goes_on()
    }

    /// Where the next conflict area begins and ends on the ego's way.
    fn next_area(&self) -> Option<[Position; 2]> {
        Some([self.area_begins()?, self.coordination.end_of(self.coordination.next())?])
    }
}
