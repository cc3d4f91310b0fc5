//! Places on the globe and on routes, of the ego and of its peers, enter. The place of each of them on the ego's axis, and what it says
//! of its way through an intersection, are known from then on. The axis is that of [`crate::coordination`].

use super::Scene;
use crate::coordination::{Arrival, Axis, Crossing, PeerApproach};
use crate::health::Cause;
use crate::parameters::FARTHEST_PEER;
use crate::time::{Duration, Instant, Stamp};
use crate::units::Distance;
use crate::wire::geo::GeoPosition;
use crate::wire::route::Route;
use crate::wire::{Movement, Predecessor, Slot};

/// A peer that told its route less than this ago is not placed by its position on the globe.
const SAYS_MORE: Duration = Duration::from_millis(2_000);

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// Takes in where the ego is on the globe.
    pub(super) fn take_ego_place(&mut self, at: Instant, geo: &GeoPosition) -> Result<(), Cause> {
        let (Some(itinerary), Some(ego)) = (self.coordination.itinerary(), self.ego.as_ref()) else { return Ok(()) };
        let since = self.instant_of(geo.stamp, at).unwrap_or(at).since(ego.at);
        if since.as_micros().unsigned_abs() > self.config.link.ego_timeout.as_micros().unsigned_abs() {
            return Err(Cause::Stale);
        }
        let place = itinerary.path.place(geo).ok_or(Cause::OffRoute)?;
        self.coordination.locate(ego.position.ahead(ego.speed.over(since.seconds())), place.along);
        Ok(())
    }

    /// Sets the axis of a peer, and moves everything that is held of the peer by how far the axis moved.
    pub(super) fn place_on(&mut self, index: usize, axis: &Axis, moved: Option<Distance>, is_back: bool) {
        let before = self.coordination.approach(index).copied();
        if let Some(held) = self.coordination.axis_mut(index) {
            *held = *axis;
        }
        if is_back {
            self.forget_place(index);
        }
        self.move_axis(index, moved);
        self.note_moving_on(index, before);
    }

    /// Takes in what a peer says of its way to a crossing point.
    pub(super) fn take_peer_route(&mut self, at: Instant, slot: Slot, route: &Route) {
        let Some((place, crossing)) = self.coordination.itinerary().and_then(|way| way.find(route.intersection)) else {
            return self.leave(at, slot);
        };
        let (arrival, claim) = (Some(Arrival(route.arrival)), route.predecessor);
        let movement = route.movement;
        let shift = crossing.intersection.shift(crossing.movement, movement);
        let approach = PeerApproach { crossing: place, movement, shift, arrival, claim, heard: at, since: at };
        self.take_approach(slot, route.stamp, crossing, route.distance, approach);
    }

    /// Takes in where a peer is on the globe, unless the peer told its route just now.
    pub(super) fn take_peer_place(&mut self, at: Instant, slot: Slot, geo: &GeoPosition) {
        let index = usize::from(slot.0);
        let says_more = |approach: &PeerApproach| approach.arrival.is_some() && at.since(approach.heard) < SAYS_MORE;
        if self.coordination.itinerary().is_none() || self.coordination.approach(index).is_some_and(says_more) {
            return;
        }
        let Some((place, crossing, movement, distance)) = self.approached(index, geo) else {
            return self.leave(at, slot);
        };
        let shift = crossing.intersection.shift(crossing.movement, movement);
        let (arrival, claim) = (None, Predecessor::Unknown);
        let approach = PeerApproach { crossing: place, movement, shift, arrival, claim, heard: at, since: at };
        self.take_approach(slot, geo.stamp, crossing, distance, approach);
    }

    /// The crossing of the ego's way that a vehicle at this place comes to next, with its index, and the vehicle's movement and way to
    /// the crossing point. Where several movements have the same way, the first on the map is taken.
    fn approached(&self, index: usize, geo: &GeoPosition) -> Option<(usize, &'static Crossing, Movement, Distance)> {
        let mut next: Option<(usize, &'static Crossing, Movement, Distance)> = None;
        for (place, crossing) in self.coordination.itinerary()?.crossings.iter().enumerate() {
            let intersection = crossing.intersection;
            for approach in intersection.approaches {
                let Some(found) = approach.path.place(geo) else { continue };
                let distance = approach.crossing.ahead_of(found.along);
                let has_left = distance < intersection.half.plus(self.peers.length_of(index)).negated();
                if !has_left && next.is_none_or(|(.., nearest)| distance < nearest) {
                    next = Some((place, crossing, approach.movement, distance));
                }
            }
        }
        next
    }

    fn take_approach(
        &mut self,
        slot: Slot,
        stamp: Stamp,
        crossing: &Crossing,
        distance: Distance,
        approach: PeerApproach,
    ) {
        let index = usize::from(slot.0);
        let Some(point) = self.coordination.crossing_point(crossing) else { return };
        let before = self.coordination.approach(index).copied();
        let Some(axis) = self.coordination.axis_mut(index) else { return };
        let moved = axis.place(stamp, point.ahead(approach.shift), distance, approach);
        let is_placed = axis.approach().is_some();
        if before.is_none() && is_placed && self.is_placed_before(index) {
            self.forget_place(index);
        }
        self.move_axis(index, moved);
        self.note_moving_on(index, before);
    }

    /// A peer that drives against the ego's direction, and moves on to another intersection, is far behind at once. Without an extra
    /// review the ego would follow it there until the next review.
    fn note_moving_on(&mut self, index: usize, before: Option<PeerApproach>) {
        let now = self.coordination.approach(index);
        if before.zip(now).is_some_and(|(before, now)| before.crossing != now.crossing) {
            self.coordination.review_at_once();
        }
    }

    fn leave(&mut self, at: Instant, slot: Slot) {
        // The driver's word that a vehicle is ahead counts for more than what that vehicle says of its way.
        let is_named = !self.is_decided_by_order() && self.named.slot() == Some(slot.0.into());
        if is_named || self.may_be_of_another(at, slot.0.into()) {
            return;
        }
        if let Some(axis) = self.coordination.axis_mut(slot.0.into()) {
            axis.leave();
        }
    }

    /// Whether something is held of where a peer is or was.
    pub(super) fn is_placed_before(&self, index: usize) -> bool {
        self.peers.get(index).is_some_and(|track| track.newest().is_some())
    }

    /// Forgets where a peer was. What was certain of it on an axis that it left, and which vehicles it was ahead of, say nothing of where
    /// it is on a new one: it may have come back behind them.
    fn forget_place(&mut self, index: usize) {
        if let Some(track) = self.peers.get_index_mut(index) {
            track.restart();
        }
        self.estimator.forget(index);
        self.coordination.forget_lane(index);
    }

    /// Moves everything that is held of a peer by how far its axis moved.
    fn move_axis(&mut self, index: usize, moved: Option<Distance>) {
        let (Some(moved), Some(track)) = (moved, self.peers.get_index_mut(index)) else { return };
        if moved.magnitude() > FARTHEST_PEER {
            self.forget_place(index);
        } else {
            track.shift(moved);
            self.estimator.move_horizon(index, moved);
            self.fused.shift(index, moved);
        }
    }
}
