//! Coordination at intersections without signals: the map, the ego's place on the globe and what the peers say of theirs enter;
//! whom the ego follows leaves.
//!
//! Theory of operation:
//!
//! * *Where:* the ego's position on the globe ties its own axis to the path of its itinerary ([`path`]). With the map it then
//!   knows where on its axis every crossing point lies. A peer says how far it is from a crossing point (`PeerRoute`), or where
//!   it is on the globe (`PeerPosition`); either ties its axis to the ego's, and from then on it is translated where it comes
//!   in ([`axis`]). So estimator, controller and envelope know of one lane only, the virtual one.
//! * *Who:* whoever names the same intersection is in its order ([`order`]); the last one ahead is the *order predecessor*. The
//!   nearest one ahead on the ego's own leg, at this intersection or another, is the *lane predecessor*. Of the two the ego
//!   follows the one that asks for more caution. Where the choice changes, both ask for the same, so that it costs no jump.
//! * *Until when:* a vehicle is at an intersection until its rear has left the conflict area, and arrives at the next one then.
//!   Beyond the last one it is in no order any more, but goes on saying where it is. Of a peer that is silent, its estimate tells. What is heard or left is reviewed ten times a second.

pub mod axis;
mod choice;
mod comfort_braking;
mod lane;
pub mod map;
pub mod order;
pub mod path;
mod present;
mod review;
mod yield_timer;

pub use axis::{Axis, PeerApproach};
pub use choice::{Choice, Slots};
pub use comfort_braking::ComfortBraking;
pub use map::{Approach, Crossing, Intersection, Itinerary, MapError};
pub use order::{Arrival, Entry, Regard};
pub use path::{Path, Place, Scale, Segment};
pub(crate) use present::{Present, Side};

use lane::Lane;
use yield_timer::YieldTimer;

use crate::held::Held;
use crate::time::{Duration, Instant};
use crate::units::{Distance, Position, Speed};
use crate::wire::{Predecessor, StationHash};

/// Behind a vehicle that comes by a crossing leg the standstill distance is the length of the conflict area, if that is longer:
/// then at whatever speed the two pass, the one's rear has left the area when the other's front enters it.
#[must_use]
pub fn standstill_behind(law: Distance, crossing: &Crossing, leg: u8) -> Distance {
    let intersection = crossing.intersection;
    if intersection.conflict(crossing.leg, leg) { law.max(intersection.half.plus(intersection.half)) } else { law }
}

/// Time from one review to the next.
pub(crate) const REVIEW: Duration = Duration::from_millis(100);

/// The ego follows one that comes by another leg only so long after it has heard of it, if it still can stop gently then, and
/// its own horizon says so from the beginning: as long as the longest silence that nobody is to be surprised by, and until
/// the next message is heard.
pub(crate) const ANNOUNCED: Duration = Duration::from_millis(4_500);

/// Fixes that differ from the tie by more than this are another place; others are averaged over 16, which takes the rounding
/// of a position on the globe (11 mm) out.
const RELOCATED: Distance = Distance::from_mm(5_000);
const AVERAGED: i64 = 16;

/// The ego at its next crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Registration {
    /// When it arrived, as it tells the others.
    pub arrival: Arrival,
    /// When it arrived, by the unit's own clock.
    pub since: Instant,
}

/// The unit's coordination.
#[derive(Clone, Debug)]
pub struct Coordination<const PEERS: usize> {
    itinerary: Option<&'static Itinerary>,
    /// Where the path begins on the ego's axis.
    tie: Held<Position>,
    /// Which crossing is next; as many as there are: none.
    current: usize,
    registration: Held<Registration>,
    axes: [Axis; PEERS],
    /// With those that do not heed the ego.
    yield_timer: [YieldTimer; PEERS],
    lane: Lane<PEERS>,
    claim: Held<StationHash>,
    choice: Choice,
    /// When the next review is due: others have been told what will be found then.
    due: Held<Instant>,
    /// Whether there is one before that.
    at_once: bool,
}

impl<const PEERS: usize> Coordination<PEERS> {
    /// No itinerary: all zero.
    pub(crate) const fn idle() -> Self {
        Self {
            itinerary: None,
            tie: Held::Nothing,
            current: 0,
            registration: Held::Nothing,
            axes: [Axis::UNKNOWN; PEERS],
            yield_timer: [YieldTimer::FULL; PEERS],
            lane: Lane::UNKNOWN,
            claim: Held::Nothing,
            choice: Choice::NONE,
            due: Held::Nothing,
            at_once: false,
        }
    }

    /// Sets out on a way, from its beginning.
    ///
    /// # Errors
    /// What is wrong with the map; nothing is changed then.
    pub(crate) fn set_out(&mut self, itinerary: &'static Itinerary) -> Result<(), MapError> {
        itinerary.check()?;
        self.reset();
        self.itinerary = Some(itinerary);
        Ok(())
    }

    pub(crate) fn reset(&mut self) {
        self.itinerary = None;
        self.tie.clear();
        self.current = 0;
        self.registration.clear();
        self.axes = [Axis::UNKNOWN; PEERS];
        self.yield_timer = [YieldTimer::FULL; PEERS];
        self.lane = Lane::UNKNOWN;
        self.claim.clear();
        self.choice = Choice::NONE;
        self.due.clear();
        self.at_once = false;
    }

    /// The ego's way, if it has one.
    #[must_use]
    pub const fn itinerary(&self) -> Option<&'static Itinerary> {
        self.itinerary
    }

    /// The crossing that the ego is at or comes to next.
    #[must_use]
    pub fn crossing(&self) -> Option<&'static Crossing> {
        self.itinerary?.crossings.get(self.current)
    }

    /// Its place on the way; as many as there are: none.
    #[must_use]
    pub(crate) const fn next(&self) -> usize {
        self.current
    }

    /// The place of the crossing that is next with the ego's front bumper there, if it was that one before.
    #[must_use]
    pub(crate) fn next_of(&self, before: usize, front: Position, length: Distance) -> usize {
        let rear = front.ahead(length.negated());
        let mut next = before;
        while self.end_of(next).is_some_and(|end| rear >= end) {
            next = next.saturating_add(1);
        }
        next
    }

    /// Where the conflict area of that crossing ends on the ego's axis.
    pub(crate) fn end_of(&self, place: usize) -> Option<Position> {
        let crossing = self.itinerary?.crossings.get(place)?;
        Some(self.crossing_point(crossing)?.ahead(crossing.intersection.half))
    }

    /// The crossing that the ego tells the others of: the next one, or the last one for as long as it has not set out anew.
    #[must_use]
    pub fn named(&self) -> Option<&'static Crossing> {
        self.crossing().or_else(|| self.itinerary?.crossings.last())
    }

    /// When the ego arrived there.
    #[must_use]
    pub fn registration(&self) -> Option<Registration> {
        self.registration.get()
    }

    /// Whom the ego has to mind.
    #[must_use]
    pub const fn choice(&self) -> &Choice {
        &self.choice
    }

    /// What a peer says of its place.
    #[must_use]
    pub fn standing(&self, index: usize) -> Option<&PeerApproach> {
        self.axes.get(index)?.standing()
    }

    /// Whom the ego takes to be just ahead of it in the order; unknown before it has arrived.
    #[must_use]
    pub fn claim(&self) -> Predecessor {
        match (self.registration.as_ref(), self.claim.get()) {
            (None, _) => Predecessor::Unknown,
            (Some(_), None) => Predecessor::None,
            (Some(_), Some(station)) => Predecessor::Station(station),
        }
    }

    /// Where a crossing point of the ego's way lies on its own axis.
    #[must_use]
    pub fn crossing_point(&self, crossing: &Crossing) -> Option<Position> {
        let tie = self.tie.get()?;
        Some(Position::from_bits(tie.to_bits().saturating_add(crossing.at.to_bits())))
    }

    /// Whether the ego and a station that stands there come by the same leg.
    #[must_use]
    pub(crate) fn is_on_lane(&self, standing: &PeerApproach) -> bool {
        let crossing = self.itinerary.and_then(|itinerary| itinerary.crossings.get(standing.crossing));
        crossing.is_some_and(|crossing| crossing.leg == standing.leg)
    }

    /// Whether a station is at the crossing that is next for the ego.
    #[must_use]
    pub(crate) const fn is_here(&self, standing: &PeerApproach) -> bool {
        standing.crossing == self.current
    }

    /// The axis of a slot.
    pub(crate) fn axis(&self, index: usize) -> Option<&Axis> {
        self.axes.get(index)
    }

    /// The axis of a slot, to be changed.
    pub(crate) fn axis_mut(&mut self, index: usize) -> Option<&mut Axis> {
        self.axes.get_mut(index)
    }

    /// Ties the ego's axis to the path: it was there on both at the same time.
    pub(crate) fn locate(&mut self, on_axis: Position, along: Position) {
        let tie = Position::from_bits(on_axis.to_bits().saturating_sub(along.to_bits()));
        let Some(held) = self.tie.get() else { return self.tie.set(tie) };
        let off = tie.to_bits().saturating_sub(held.to_bits());
        let is_elsewhere = off.unsigned_abs() > i64::from(RELOCATED.to_bits()).unsigned_abs();
        let step = if is_elsewhere { off } else { off / AVERAGED };
        self.tie.set(Position::from_bits(held.to_bits().saturating_add(step)));
    }

    /// Whether a review is due.
    pub(crate) fn is_due(&self, now: Instant) -> bool {
        self.itinerary.is_some() && (self.at_once || self.due.get().is_none_or(|due| now >= due))
    }

    /// When the next review is due.
    pub(crate) fn next_review(&self) -> Option<Instant> {
        self.itinerary?;
        self.due.get()
    }

    /// What was found at the last review does not hold any more: there is one more before the next.
    pub(crate) fn review_at_once(&mut self) {
        self.at_once = true;
    }

    /// Brings the ego on to the crossing that its front bumper at this position, and its length, make the next one.
    pub(crate) fn advance(&mut self, front: Position, length: Distance, now: Instant, arrival: Arrival) {
        if self.tie.get().is_none() {
            return;
        }
        let next = self.next_of(self.current, front, length);
        if next != self.current {
            self.current = next;
            if self.crossing().is_some() {
                self.registration.clear();
            }
        }
        if self.registration.as_ref().is_none() {
            self.registration.set(Registration { arrival, since: now });
            self.claim.clear();
            self.yield_timer = [YieldTimer::FULL; PEERS];
        }
    }

    /// Another station has this slot now: what was decided of the one before it does not hold for it.
    pub(crate) fn vacate(&mut self, index: usize) {
        self.choice.vacate(index);
        if let Some(yield_timer) = self.yield_timer.get_mut(index) {
            *yield_timer = YieldTimer::FULL;
        }
        self.forget_lane(index);
    }

    /// Nothing is known any more of who is behind that one on the ego's leg, and of whom it is behind.
    pub(crate) fn forget_lane(&mut self, index: usize) {
        self.lane.forget(index);
    }

    /// Chooses whom to follow, and how gently to brake for it, and takes note of who is ahead on the lane.
    pub(crate) fn choose(&mut self, target: Option<usize>, comfort: ComfortBraking, lane: Option<usize>) {
        let slot = |index: Option<usize>| index.and_then(|index| u8::try_from(index).ok());
        (self.choice.target, self.choice.comfort, self.choice.lane) = (slot(target), comfort, slot(lane));
    }

    /// Takes note of who is ahead on the same leg, and who of them is beyond the radio's reach.
    pub(crate) fn note_leading(&mut self, leading: Slots, beyond: Slots) {
        (self.choice.leading, self.choice.beyond) = (leading, beyond);
    }

    /// Takes note that the one is ahead of the other on the same leg, for certain. Nobody passes there: it remains so.
    pub(crate) fn note_behind(&mut self, ahead: usize, behind: usize) {
        self.lane.note_behind(ahead, behind);
    }

    /// Takes note that one on the same leg has come there at least: everyone ahead of it has.
    pub(crate) fn note_passed(&mut self, index: usize, near: Position) {
        self.lane.note_passed(index, near);
    }

    /// How far the rear bumper of one that was ahead of somebody else has come at least, by where that one is.
    pub(crate) fn passed(&self, index: usize) -> Option<Position> {
        self.lane.passed(index)
    }

    /// Takes note of who got out of reach.
    pub(crate) fn note_lost(&mut self, lost: Slots) {
        self.choice.lost = lost;
    }

    /// How gently the ego, with its front bumper there, at this speed and with that crossing next, may brake for one that stands
    /// there: if that one comes by another leg, the more so the farther the conflict area is.
    pub(crate) fn comfort(
        &self,
        standing: &PeerApproach,
        next: usize,
        front: Position,
        speed: Speed,
    ) -> ComfortBraking {
        let crossing = self.itinerary.and_then(|itinerary| itinerary.crossings.get(next));
        let shared = crossing.filter(|crossing| standing.crossing == next && standing.leg != crossing.leg);
        let Some((crossing, point)) = shared.and_then(|crossing| Some((crossing, self.crossing_point(crossing)?)))
        else {
            return ComfortBraking::NONE;
        };
        ComfortBraking::within(point.ahead_of(front).minus(crossing.intersection.half), speed)
    }

    /// Whether the ego, with its front bumper there, at this speed and with that crossing next, follows one that stands there: who
    /// comes by another leg is followed when the others have been told for long enough, or else only where the ego could not
    /// stop gently any more.
    pub(crate) fn is_announced(
        &self,
        standing: &PeerApproach,
        at: Instant,
        next: usize,
        front: Position,
        speed: Speed,
    ) -> bool {
        at.since(standing.since) >= ANNOUNCED || self.comfort(standing, next, front, speed) == ComfortBraking::NONE
    }
}

#[cfg(test)]
mod tests;
