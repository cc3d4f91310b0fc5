//! The unit at intersections: places on the globe and on routes enter; whom it follows leaves. The rules are those of
//! [`crate::coordination`].

use heapless::Vec;

use super::OnboardUnit;
use crate::coordination::{
    Arrival, Axis, ComfortBraking, Crossing, Itinerary, MapError, PeerApproach, Present, Side, Slots, standstill_behind,
};
use crate::estimator::Reading;
use crate::fixed::{quotient, saturate_i32};
use crate::health::Cause;
use crate::parameters::{DEFAULT_LENGTH, REACH};
use crate::time::{Duration, Instant, Stamp};
use crate::units::{Acceleration, Distance, Gain, Position, Seconds, Speed};
use crate::wire::geo::GeoPosition;
use crate::wire::route::Route;
use crate::wire::{Predecessor, Slot};

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// Sets out on a way through intersections: from now on, and until the unit is started anew, positions of peers are taken on
    /// the virtual lane, and where `DriverRequest` names no predecessor the order at the intersections decides whom to follow.
    ///
    /// # Errors
    /// What is wrong with the map; nothing is changed then.
    pub fn set_out(&mut self, itinerary: &'static Itinerary) -> Result<(), MapError> {
        self.coordination.set_out(itinerary)
    }

    /// Whom the ego is to follow: whom it was told to, or whom the order has put ahead of it.
    pub(super) fn predecessor(&self) -> Predecessor {
        if !self.is_decided_by_order() {
            return self.desired.as_ref().map_or(Predecessor::Unknown, |desired| desired.predecessor);
        }
        let Some(target) = self.coordination.choice().target else { return Predecessor::None };
        let station = self.peers.get(target.into()).and_then(|track| track.station());
        station.map_or(Predecessor::None, Predecessor::Station)
    }

    /// Whether the order decides whom to follow, and nobody else.
    pub(super) fn is_decided_by_order(&self) -> bool {
        let desired = self.desired.as_ref().map_or(Predecessor::Unknown, |desired| desired.predecessor);
        desired == Predecessor::Unknown && self.coordination.registration().is_some()
    }

    /// The slot of the vehicle that a sensor would see ahead.
    pub(super) fn visible(&self) -> Option<usize> {
        match self.coordination.itinerary() {
            Some(_) => self.coordination.choice().lane.map(usize::from),
            None => self.target(),
        }
    }

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

    /// A peer's axis is this one from now on, and moved so far by that.
    pub(super) fn place_on(&mut self, index: usize, axis: Axis, moved: Option<Distance>) {
        let before = self.coordination.standing(index).copied();
        if let Some(held) = self.coordination.axis_mut(index) {
            *held = axis;
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
        let standing = PeerApproach { crossing: place, leg: route.leg, arrival, claim, heard: at, since: at };
        self.take_standing(slot, route.stamp, crossing, route.distance, standing);
    }

    /// Takes in where a peer is on the globe, unless it says more than that.
    pub(super) fn take_peer_place(&mut self, at: Instant, slot: Slot, geo: &GeoPosition) {
        let index = usize::from(slot.0);
        let says_more = |standing: &PeerApproach| standing.arrival.is_some() && at.since(standing.heard) < SAYS_MORE;
        if self.coordination.itinerary().is_none() || self.coordination.standing(index).is_some_and(says_more) {
            return;
        }
        let Some((place, crossing, leg, distance)) = self.approached(geo) else { return self.leave(at, slot) };
        let standing =
            PeerApproach { crossing: place, leg, arrival: None, claim: Predecessor::Unknown, heard: at, since: at };
        self.take_standing(slot, geo.stamp, crossing, distance, standing);
    }

    /// The crossing of the ego's way that a vehicle at this place comes to next, and its leg and way there.
    fn approached(&self, geo: &GeoPosition) -> Option<(usize, &'static Crossing, u8, Distance)> {
        let mut next: Option<(usize, &'static Crossing, u8, Distance)> = None;
        for (place, crossing) in self.coordination.itinerary()?.crossings.iter().enumerate() {
            let intersection = crossing.intersection;
            for approach in intersection.approaches {
                let Some(found) = approach.path.place(geo) else { continue };
                let distance = approach.crossing.ahead_of(found.along);
                let has_left = distance < intersection.half.plus(DEFAULT_LENGTH).negated();
                if !has_left && next.is_none_or(|(.., nearest)| distance < nearest) {
                    next = Some((place, crossing, approach.leg, distance));
                }
            }
        }
        next
    }

    fn take_standing(
        &mut self,
        slot: Slot,
        stamp: Stamp,
        crossing: &Crossing,
        distance: Distance,
        standing: PeerApproach,
    ) {
        let index = usize::from(slot.0);
        let Some(point) = self.coordination.crossing_point(crossing) else { return };
        let before = self.coordination.standing(index).copied();
        let Some(axis) = self.coordination.axis_mut(index) else { return };
        let moved = axis.place(stamp, point, distance, standing);
        self.move_axis(index, moved);
        self.note_moving_on(index, before);
    }

    /// A peer that moves on to another intersection, on its way against the ego's, is far behind at once: until the next review
    /// the ego would follow it there.
    fn note_moving_on(&mut self, index: usize, before: Option<PeerApproach>) {
        let now = self.coordination.standing(index);
        if before.zip(now).is_some_and(|(before, now)| before.crossing != now.crossing) {
            self.coordination.review_at_once();
        }
    }

    fn leave(&mut self, at: Instant, slot: Slot) {
        if self.may_be_of_another(at, slot.0.into()) {
            return;
        }
        if let Some(axis) = self.coordination.axis_mut(slot.0.into()) {
            axis.leave();
        }
    }

    /// Everything that is held of a peer moves with its axis.
    fn move_axis(&mut self, index: usize, moved: Option<Distance>) {
        let (Some(moved), Some(track)) = (moved, self.peers.get_index_mut(index)) else { return };
        if moved.magnitude() > REACH {
            track.restart();
            self.estimator.forget(index);
            self.coordination.forget_lane(index);
        } else {
            track.shift(moved);
            self.estimator.shift(index, moved);
        }
    }

    /// Reviews who is ahead, when that is due.
    pub(super) fn coordinate(&mut self, now: Instant) {
        if !self.coordination.is_due(now) {
            return;
        }
        let (Some(sample), Some(state)) = (self.ego.as_ref(), self.ego_at(now)) else { return };
        let front = sample.position.ahead(state.position.ahead_of(sample.position.ring()));
        // Without the time the ego cannot tell when it arrives: it minds the others all the same, and arrives nowhere.
        let gnss = self.clock.gnss(now).filter(|_| self.is_synchronised(now));
        let arrival = gnss.map(|gnss| Arrival::of_micros(gnss.as_micros()));
        if let Some(arrival) = arrival {
            self.coordination.advance(front, self.config.length, now, arrival);
        }

        let is_committed = self.is_committed(front, state.speed);
        let is_inside = self.area_begins().is_some_and(|begins| front > begins);
        let mut present: Vec<Present, PEERS> = Vec::new();
        let mut lane: Option<(usize, Position)> = None;
        for index in 0..PEERS {
            let (Some(standing), Some((reading, rear))) = (self.coordination.standing(index), self.rear(index, now))
            else {
                continue;
            };
            let Some(entry) = self.entry(index, standing) else { continue };
            if self.coordination.is_here(standing) {
                let has_left = self.has_left(rear);
                let side = if reading.position > front { Side::Ahead } else { Side::Behind };
                let takes_along = side == Side::Behind || !is_committed;
                let lane = (self.coordination.is_on_lane(standing) && takes_along).then_some(side);
                let is_far_behind = is_committed || self.is_far_behind(&reading, front);
                let is_followed = self.coordination.choice().target.map(usize::from) == Some(index);
                // Who is in the area does not wait in it for one that comes after it.
                let is_passed = is_inside && side == Side::Behind;
                let is_announced = is_followed
                    || self.coordination.is_announced(standing, now, self.coordination.next(), front, state.speed);
                let is_announced = is_announced && !is_passed;
                let heard = standing.heard;
                let _ = present.push(Present { index, entry, heard, has_left, is_far_behind, is_announced, lane }); // as many as slots
            }
            let is_ahead = reading.position > front && self.coordination.is_on_lane(standing);
            if is_ahead && lane.is_none_or(|(_, nearest)| reading.position < nearest) {
                lane = Some((index, reading.position));
            }
        }
        let nearest = lane.map(|(index, _)| index);
        // Who stops at the line is a hair from where it could not.
        let can_wait = if self.coordination.choice().is_held { !is_inside } else { !is_committed };
        let has_room = self.has_room(nearest, now);
        let gives_way = can_wait && !has_room && self.waits_for_room(nearest, now, state.speed);
        if let Some(arrival) = arrival.filter(|_| gives_way) {
            self.coordination.give_way(arrival);
        }
        self.coordination.hold(can_wait && (!has_room || self.is_crossed_by_unknown(now)));
        if self.coordination.review(now, self.config.station, &present) {
            self.health.count(Cause::Overlooked);
        }
        self.coordination.note_lost(self.lost(now, front));
        let is_heeded = |index: &usize| self.is_heeded(*index, now, front, state.speed);
        let order = self.coordination.choice().order.map(usize::from).filter(is_heeded);
        let lane = nearest.filter(is_heeded);
        let next = self.coordination.next();
        let target = self.more_careful(order, lane, now, next, front, state.speed);
        let followed = self.coordination.choice().target.map(usize::from);
        let target = target.filter(|target| self.is_in_the_way(*target, now, next, front, followed));
        let (before, may) = (self.coordination.choice(), self.comfort(target, next, front, state.speed));
        let is_new = before.target.map(usize::from) != target;
        // Who has had to brake harder goes on until that is over.
        self.coordination.choose(target, if is_new { may } else { may.min(before.comfort) }, lane);
        self.note_lane(now, front);
    }

    /// Whether the ego, with its front bumper there, follows a peer; the gate minds it all the same. Who was far ahead when it was
    /// heard last has got out of reach, and nobody is ahead then as far as it matters; also where it is estimated to have stopped since, behind somebody
    /// whom nobody hears any more.
    pub(super) fn is_heeded(&self, index: usize, at: Instant, front: Position, speed: Speed) -> bool {
        self.is_in_reach(index, at)
            || !self.coordination.choice().lost.contains(index) && !self.is_far_ahead(index, at, front, speed)
    }

    pub(super) fn is_in_reach(&self, index: usize, at: Instant) -> bool {
        let silence = self.peers.get(index).and_then(|track| track.link().silence(at));
        silence.is_some_and(|silence| silence <= self.config.link.holdover)
    }

    fn is_far_ahead(&self, index: usize, at: Instant, front: Position, speed: Speed) -> bool {
        let heeded = front.ahead(HEEDED).ahead(speed.over(HEEDED_TIME)).ahead(speed.over(HEEDED_TIME));
        self.rear(index, at).is_none_or(|(_, rear)| rear > heeded)
    }

    /// Who has got out of reach far ahead, driving on. Who stood when it was heard last still stands there.
    fn lost(&self, now: Instant, front: Position) -> Slots {
        let mut lost = self.coordination.choice().lost;
        for index in 0..PEERS {
            let drives_off = || {
                let estimate = self.rear(index, now);
                estimate.is_some_and(|(reading, rear)| rear > front.ahead(OUT_OF_REACH) && reading.speed > Speed::ZERO)
            };
            lost.set(index, !self.is_in_reach(index, now) && (lost.contains(index) || drives_off()));
        }
        lost
    }

    /// Of the one just ahead in the order and the one just ahead on the leg, whom the ego follows with its front bumper there, at
    /// this speed and with that crossing next: the one that asks for more caution.
    ///
    /// The one with the smaller `q_j = r_j - l_j - s_0 + γ v_j` asks for the smaller acceleration in eq. 5,
    /// `k (q_j - r - (t_g + γ) v)`, because everything else in the law is the ego's own. For the first of them the ego brakes
    /// with no more than `b`, if gently, so that one asks for no less than `r + (t_g + γ) v - b/k`.
    pub(super) fn more_careful(
        &self,
        order: Option<usize>,
        lane: Option<usize>,
        at: Instant,
        next: usize,
        front: Position,
        speed: Speed,
    ) -> Option<usize> {
        let (Some(first), Some(ahead)) = (order, lane) else { return order.or(lane) };
        let law = &self.config.law;
        let gentle = self.comfort(order, next, front, speed).limit(Acceleration::MAX);
        let least = front
            .ahead(speed.over(self.time_gap()))
            .ahead(speed.over(law.damping))
            .ahead(braked_over(gentle, law.gain));
        let asks_first = if gentle == Acceleration::MAX {
            self.asks(first, at, next)
        } else {
            self.asks(first, at, next).max(least.to_bits())
        };
        Some(if asks_first <= self.asks(ahead, at, next) { first } else { ahead })
    }

    /// Whether a vehicle ahead is so near that the ego, with its front bumper there and that crossing next, follows it. At the speed
    /// `v_∞` that the ego wants on a free road, eq. 5 asks for braking from `q_j - r = (t_g + γ) v_∞` on. Behind whom is farther
    /// ahead the ego drives as on a free road; to follow would only make it hurry. Who is followed may get [`APART`] farther
    /// ahead than that before it is not any more.
    pub(super) fn is_in_the_way(
        &self,
        index: usize,
        at: Instant,
        next: usize,
        front: Position,
        followed: Option<usize>,
    ) -> bool {
        let wanted = self.target_speed();
        let free = front.ahead(wanted.over(self.time_gap())).ahead(wanted.over(self.config.law.damping));
        let apart = if followed == Some(index) { APART } else { Distance::ZERO };
        self.asks(index, at, next) < free.ahead(apart).to_bits()
    }

    /// `q_j` of a vehicle ahead with that crossing next, in words of a position.
    pub(super) fn asks(&self, index: usize, at: Instant, next: usize) -> i64 {
        self.rear(index, at).map_or(i64::MAX, |(reading, rear)| {
            let damped = reading.speed.over(self.config.law.damping);
            rear.ahead(damped).ahead(self.standstill_at(next, index).negated()).to_bits()
        })
    }

    /// How gently the ego may brake for a peer that it follows.
    pub(super) fn comfort(&self, index: Option<usize>, next: usize, front: Position, speed: Speed) -> ComfortBraking {
        let standing = index.and_then(|index| self.coordination.standing(index));
        standing.map_or(ComfortBraking::NONE, |standing| self.coordination.comfort(standing, next, front, speed))
    }

    /// The standstill distance behind whom the ego follows.
    pub(super) fn standstill(&self) -> Distance {
        let target = self.coordination.choice().target.map(usize::from);
        target.map_or(self.config.law.standstill, |index| self.standstill_at(self.coordination.next(), index))
    }

    /// The standstill distance behind a peer with that crossing next.
    pub(super) fn standstill_at(&self, next: usize, index: usize) -> Distance {
        let law = self.config.law.standstill;
        let Some(itinerary) = self.coordination.itinerary() else { return law };
        let law = law.plus(QUEUE);
        match (itinerary.crossings.get(next), self.coordination.standing(index)) {
            (Some(crossing), Some(standing)) if standing.crossing == next => {
                standstill_behind(law, crossing, standing.leg)
            }
            _ => law,
        }
    }

    /// Where a peer is estimated to be, and its rear bumper.
    pub(super) fn rear(&self, index: usize, now: Instant) -> Option<(Reading, Position)> {
        let reading = self.estimated(index, now)?;
        Some((reading, reading.position.ahead(self.length_of(index).negated())))
    }

    /// Whether a peer on the virtual lane is as far behind the ego's front bumper as it has to be to follow it over the crossing.
    fn is_far_behind(&self, peer: &Reading, front: Position) -> bool {
        let Some(crossing) = self.coordination.crossing() else { return false };
        let half = crossing.intersection.half;
        let needs = self.config.length.plus(half).plus(half).plus(self.config.law.standstill);
        front.ahead_of(peer.position) >= needs.plus(peer.speed.over(self.time_gap()))
    }

    /// Whether a rear bumper there on the virtual lane is out of the conflict area of the next crossing.
    fn has_left(&self, rear: Position) -> bool {
        self.coordination.end_of(self.coordination.next()).is_some_and(|end| rear >= end)
    }
}

/// Who has been silent for longer than a holdover lasts, with its rear farther ahead than this and twice [`HEEDED_TIME`], is not
/// followed. Behind a standing vehicle the law of eq. 5 asks for braking from `l + s_0 + (t_g + γ) v` on, which is less for
/// any gains that are shipped.
const HEEDED: Distance = Distance::from_mm(20_000);
/// Half of the time, because the whole of it is beyond the format's 4 s.
const HEEDED_TIME: Seconds = Seconds::from_millis(3_990);

/// Who drives on silently so far ahead is not heard because it is too far away.
const OUT_OF_REACH: Distance = Distance::from_mm(250_000);

/// What lets the ego go on following who gets away from it, so that it does not take turns.
const APART: Distance = Distance::from_mm(3_000);

/// What a vehicle on a way through intersections keeps beside the law's standstill distance. Where a queue has formed, vehicles brake
/// for what they alone know, as who is ahead has no slot or is silent; those behind who do not hear them do not foresee that, and
/// have to find room for what their estimates are off by.
const QUEUE: Distance = Distance::from_mm(8_000);

/// A peer that told its route less than this ago is not placed by the globe.
const SAYS_MORE: Duration = Duration::from_millis(2_000);

/// `-b/k`, to the millimetre.
fn braked_over(braking: Acceleration, gain: Gain) -> Distance {
    let mm = quotient(i64::from(braking.to_mm_per_s2()).saturating_mul(1_000), i64::from(gain.to_milli()).max(1));
    Distance::from_mm(saturate_i32(mm)).negated()
}
