//! Coordination at intersections without signals. The map, the ego's place on the globe and what the peers say of theirs enter; the
//! vehicle that the ego follows leaves.
//!
//! Theory of operation:
//!
//! * *Where:* the ego's position on the globe ties its own axis to the path of its itinerary ([`path`]). With the map, the ego then knows
//!   where every crossing point lies on its axis. A peer says how far it is from a crossing point (`PeerRoute`), or where it is on the
//!   globe (`PeerPosition`). Either ties the peer's axis to the ego's. From then on the peer's positions are translated on reception
//!   ([`axis`]). So estimator, controller and envelope know of one lane only, the virtual lane.
//! * *Which vehicle:* every station that names the same intersection is in its order ([`order`]). The ego lets pass first the stations
//!   ahead of it in the order whose ways conflict with its own. Of these and the nearest vehicle ahead on its own leg, at this
//!   intersection or another, it follows the one that asks for the most caution. Where the choice changes, both ask for the same
//!   acceleration, so that the change costs no jump.
//! * *Until when:* a vehicle is at an intersection until its rear has left the conflict area. Then it arrives at the next intersection.
//!   Beyond the last intersection the vehicle is in no order any more, but still says where it is. For a silent peer, its estimate tells
//!   all this. The order is reviewed ten times a second.

pub mod axis;
mod choice;
mod comfort_braking;
mod lane;
pub mod map;
pub mod order;
pub mod path;
mod present;
mod review;
mod ways;
mod yield_timer;

pub use axis::{Axis, PeerApproach};
pub use choice::{Choice, Slots};
pub use comfort_braking::ComfortBraking;
pub use map::{Approach, Crossing, Intersection, Itinerary, MapError, Movements};
pub use order::{Arrival, Entry, Regard};
pub use path::{Path, Place, Scale, Segment};
pub(crate) use present::{Present, Side};

use lane::Lane;
use yield_timer::YieldTimer;

use crate::held::Held;
use crate::time::{Duration, Instant};
use crate::units::{Distance, Position, Speed};
pub use crate::wire::Movement;
use crate::wire::{Predecessor, StationHash};

/// What a vehicle on a way through intersections keeps in addition to the law's standstill distance. Where a queue has formed, a vehicle
/// brakes for what it alone knows, because a vehicle ahead has no slot. The vehicles behind that do not hear it cannot foresee that, and
/// need room for the error of their estimates.
pub const UNSEEN: Distance = Distance::from_mm(8_000);

/// The same behind a vehicle that the range sensor sees: it sees the braking too.
pub const SEEN: Distance = Distance::from_mm(2_000);

/// The standstill distance on a way through intersections, of a law's. `crossing` is where the way of the vehicle ahead conflicts with the
/// ego's, if it does. There the distance is at least the length of the conflict area: the rear of the vehicle ahead has then left the area
/// when the front of the ego enters it, at any speed. A sensor does not see that vehicle.
#[must_use]
pub fn standstill_on_way(law: Distance, crossing: Option<&Crossing>, has_sensor: bool) -> Distance {
    match crossing {
        Some(Crossing { intersection, .. }) => law.plus(UNSEEN).max(intersection.half.plus(intersection.half)),
        None if has_sensor => law.plus(SEEN),
        None => law.plus(UNSEEN),
    }
}

/// Time from one review to the next.
pub(crate) const REVIEW: Duration = Duration::from_millis(100);

/// The ego follows a vehicle on another leg only this long after it has heard of it, if the ego can still stop gently then; the ego's own
/// horizon says so from the beginning. The time is the longest silence that is to surprise no vehicle, and the time until the next
/// message is heard.
pub(crate) const ANNOUNCED: Duration = Duration::from_millis(4_500);

/// A fix that differs from the tie by more than this is another place. Other fixes are averaged over 16, which removes the rounding of a
/// position on the globe (11 mm).
const RELOCATED: Distance = Distance::from_mm(5_000);
const AVERAGED: i64 = 16;

/// The registration of the ego at its next crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Registration {
    /// When the ego arrived, as it tells the others.
    pub arrival: Arrival,
    /// When the ego arrived, by the unit's own clock.
    pub since: Instant,
}

/// The unit's coordination.
#[derive(Clone, Debug)]
pub struct Coordination<const PEERS: usize> {
    itinerary: Option<&'static Itinerary>,
    /// The position of the path's origin on the ego's axis.
    tie: Held<Position>,
    /// The index of the next crossing; the number of crossings if there is no next one.
    current: usize,
    registration: Held<Registration>,
    axes: [Axis; PEERS],
    /// For each slot: how long the station has not heeded the ego.
    yield_timer: [YieldTimer; PEERS],
    lane: Lane<PEERS>,
    claim: Held<StationHash>,
    choice: Choice,
    /// When the next review is due. The horizon that the ego sends tells the others what will be found then.
    due: Held<Instant>,
    /// Whether a review is due before that.
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
    /// The error in the map. Nothing is changed then.
    pub(crate) fn set_out(&mut self, itinerary: &'static Itinerary, length: Distance) -> Result<(), MapError> {
        itinerary.check(length)?;
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

    /// The crossing that the ego is at, or comes to next.
    #[must_use]
    pub fn crossing(&self) -> Option<&'static Crossing> {
        self.itinerary?.crossings.get(self.current)
    }

    /// The index of the next crossing; the number of crossings if there is no next one.
    #[must_use]
    pub const fn next(&self) -> usize {
        self.current
    }

    /// The index of the next crossing when the ego's front bumper is at `front`; `before` was the next crossing before.
    #[must_use]
    pub(crate) fn next_of(&self, before: usize, front: Position, length: Distance) -> usize {
        let rear = front.ahead(length.negated());
        let mut next = before;
        while self.end_of(next).is_some_and(|end| rear >= end) {
            next = next.saturating_add(1);
        }
        next
    }

    /// Where the conflict area of a crossing ends on the ego's axis.
    pub(crate) fn end_of(&self, place: usize) -> Option<Position> {
        let crossing = self.itinerary?.crossings.get(place)?;
        Some(self.crossing_point(crossing)?.ahead(crossing.intersection.half))
    }

    /// The crossing that the ego names to the others: the next one, or the last one until the ego sets out anew.
    #[must_use]
    pub fn named(&self) -> Option<&'static Crossing> {
        self.crossing().or_else(|| self.itinerary?.crossings.last())
    }

    /// When the ego arrived at the next crossing.
    #[must_use]
    pub fn registration(&self) -> Option<Registration> {
        self.registration.get()
    }

    /// The vehicles that the ego has to mind.
    #[must_use]
    pub const fn choice(&self) -> &Choice {
        &self.choice
    }

    /// What a peer says of its approach.
    #[must_use]
    pub fn approach(&self, index: usize) -> Option<&PeerApproach> {
        self.axes.get(index)?.approach()
    }

    /// The vehicle that the ego takes to be just ahead of it in the order, of those whose ways conflict with its own or that are ahead on
    /// its leg; unknown before the ego has arrived.
    #[must_use]
    pub fn claim(&self) -> Predecessor {
        match (self.registration.as_ref(), self.claim.get()) {
            (None, _) => Predecessor::Unknown,
            (Some(_), None) => Predecessor::None,
            (Some(_), Some(station)) => Predecessor::Station(station),
        }
    }

    /// The leg by which the ego comes to its next crossing.
    #[must_use]
    pub fn leg(&self) -> u8 {
        self.crossing().map_or(0, |crossing| crossing.movement.leg)
    }

    /// Where a crossing point of the ego's way lies on the ego's axis.
    #[must_use]
    pub fn crossing_point(&self, crossing: &Crossing) -> Option<Position> {
        let tie = self.tie.get()?;
        Some(Position::from_bits(tie.to_bits().saturating_add(crossing.at.to_bits())))
    }

    /// The axis of a slot.
    pub(crate) fn axis(&self, index: usize) -> Option<&Axis> {
        self.axes.get(index)
    }

    /// The axis of a slot, mutable.
    pub(crate) fn axis_mut(&mut self, index: usize) -> Option<&mut Axis> {
        self.axes.get_mut(index)
    }

    /// Ties the ego's axis to the path: `on_axis` and `along` are the same place at the same time.
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

    /// Whether an extra review is asked for.
    pub(crate) const fn is_asked_at_once(&self) -> bool {
        self.at_once
    }

    /// When the next review is due.
    pub(crate) fn next_review(&self) -> Option<Instant> {
        self.itinerary?;
        self.due.get()
    }

    /// Asks for an extra review before the next one that is due, because the findings of the last review do not hold any more.
    pub(crate) fn review_at_once(&mut self) {
        self.at_once = true;
    }

    /// Updates the next crossing of the ego, with its front bumper at `front` and its length.
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

    /// Another station has this slot now. What was decided of the station before does not hold for it.
    pub(crate) fn vacate(&mut self, index: usize) {
        self.choice.vacate(index);
        if let Some(yield_timer) = self.yield_timer.get_mut(index) {
            *yield_timer = YieldTimer::FULL;
        }
        self.forget_lane(index);
    }

    /// Forgets which vehicles are behind this one on the ego's leg, and which are ahead of it.
    pub(crate) fn forget_lane(&mut self, index: usize) {
        self.lane.forget(index);
    }

    /// Sets the vehicle to follow and how gently to brake for it, the vehicle to let pass first, and the vehicle just ahead on the lane.
    pub(crate) fn choose(
        &mut self,
        target: Option<usize>,
        comfort: ComfortBraking,
        order: Option<usize>,
        lane: Option<usize>,
    ) {
        let slot = |index: Option<usize>| index.and_then(|index| u8::try_from(index).ok());
        (self.choice.target, self.choice.comfort) = (slot(target), comfort);
        (self.choice.order, self.choice.lane) = (slot(order), slot(lane));
    }

    /// Notes the vehicles that are ahead on the ego's leg, and those of them that are beyond the radio's reach.
    pub(crate) fn note_leading(&mut self, leading: Slots, beyond: Slots) {
        (self.choice.leading, self.choice.beyond) = (leading, beyond);
    }

    /// Notes that one vehicle is ahead of another on the ego's leg, for certain. No vehicle passes another there, so that this remains
    /// so.
    pub(crate) fn note_behind(&mut self, ahead: usize, behind: usize) {
        self.lane.note_behind(ahead, behind);
    }

    /// Notes that a vehicle on the ego's leg has come at least to `near`. Every vehicle ahead of it has come there too.
    pub(crate) fn note_passed(&mut self, index: usize, near: Position) {
        self.lane.note_passed(index, near);
    }

    /// How far the rear bumper of a vehicle has come at least, by the vehicles that are known to be behind it.
    pub(crate) fn passed(&self, index: usize) -> Option<Position> {
        self.lane.passed(index)
    }

    /// Notes the vehicles that are out of reach, and those that are not in the area where they are estimated to be.
    pub(crate) fn note_lost(&mut self, lost: Slots, missed: Slots) {
        (self.choice.lost, self.choice.missed) = (lost, missed);
    }

    /// How gently the ego may brake for a peer with this approach, with the ego's front bumper at `front`, at this speed, and with `next`
    /// as its next crossing. If the peer comes by another leg, the ego brakes the more gently, the farther away the conflict area is.
    pub(crate) fn comfort(
        &self,
        approach: &PeerApproach,
        next: usize,
        front: Position,
        speed: Speed,
    ) -> ComfortBraking {
        let crossing = self.itinerary.and_then(|itinerary| itinerary.crossings.get(next));
        let shared =
            crossing.filter(|crossing| approach.crossing == next && approach.movement.leg != crossing.movement.leg);
        let Some((crossing, point)) = shared.and_then(|crossing| Some((crossing, self.crossing_point(crossing)?)))
        else {
            return ComfortBraking::NONE;
        };
        ComfortBraking::within(point.ahead_of(front).minus(crossing.intersection.half), speed)
    }

    /// Whether the ego follows a peer with this approach, with the ego's front bumper at `front`, at this speed, and with `next` as its
    /// next crossing. A peer on the ego's own leg, or at another crossing, is always followed. A peer on another leg is followed once the
    /// ego has announced it for long enough, or earlier where the ego could not stop gently any more.
    pub(crate) fn is_announced(
        &self,
        approach: &PeerApproach,
        at: Instant,
        next: usize,
        front: Position,
        speed: Speed,
    ) -> bool {
        at.since(approach.since) >= ANNOUNCED || self.comfort(approach, next, front, speed) == ComfortBraking::NONE
    }
}

#[cfg(test)]
mod tests;
