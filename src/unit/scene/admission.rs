//! The admission of a peer's motion. A motion enters; a plan of what it changes leaves, or the cause for which it is refused. Then all of
//! the plan is carried out, or nothing. So a refused motion cannot harm what is held of any station.
//!
//! The checks in their order, each once, and all before the first change: whether another station was heard in this slot just now,
//! where a new name is never the same vehicle (on a way through intersections); the age, too old or in the future; whether a station
//! of this name was heard in another slot just now, unless it is certain to be another vehicle; whether another station was heard in
//! this slot just now, unless both are certain to be the same vehicle; with the place on the ego's axis, too far; twice, or too late;
//! and whether it can be.

use super::Scene;
use crate::coordination::{Axis, PeerApproach};
use crate::health::{Cause, Health};
use crate::model::bound::{AccelerationRange, Bound, Uncertainty};
use crate::parameters::{FARTHEST_PEER, SHORTEST};
use crate::peers::plausibility::{Belief, Certainty, Grounds, Judgement, uncertainty};
use crate::peers::{Admission, Off, Sample, Track, excess, timely};
use crate::time::{Duration, Instant};
use crate::units::Distance;
use crate::wire::motion::Motion;
use crate::wire::{Slot, StationHash};

/// Which station the slot belongs to, and belonged to.
#[derive(Clone, Copy)]
struct Seat {
    /// The slot was another station's, which has been silent for long enough.
    is_taken_over: bool,
    /// The slot is another station's, which was heard just now. It is the same vehicle with a new station hash, or a mistake.
    is_renamed: bool,
    /// The slot is no station's so far, but what was said in it may be another station's.
    is_of_another: bool,
    /// The slot that the station was in before.
    left: Option<usize>,
}

/// Where a motion is on the ego's axis.
#[derive(Clone, Copy)]
struct Placed {
    /// The peer's axis after this motion; `None` where there are no intersections.
    axis: Option<Axis>,
    /// How far the axis moved, and with it everything that is held of the peer.
    moved: Option<Distance>,
    /// The motion on the ego's axis; `None` while the peer's axis is not known.
    motion: Option<Motion>,
    /// The peer had left the ego's way, and is on it again.
    is_back: bool,
}

impl Placed {
    /// Whether what is held of the peer's place is not on this axis.
    fn is_elsewhere(&self) -> bool {
        self.is_back || self.moved.is_some_and(|moved| moved.magnitude() > FARTHEST_PEER)
    }
}

impl Seat {
    /// Of the station that spoke here before.
    const KEPT: Self = Self { is_taken_over: false, is_renamed: false, is_of_another: false, left: None };
}

/// What a motion will change, before it changes anything.
struct Plan {
    seat: Seat,
    placed: Placed,
    /// The sample and its judgement, on the axis as it was before; `None` while the peer's axis is not known.
    sample: Option<(Sample, Judgement)>,
}

impl Plan {
    /// Nothing. As a constant it would be copied as a whole.
    #[inline(always)]
    fn none() -> Self {
        let placed = Placed { axis: None, moved: None, motion: None, is_back: false };
        Self { seat: Seat::KEPT, placed, sample: None }
    }

    fn verdict(&self) -> Result<(), Cause> {
        self.sample.as_ref().map_or(Ok(()), |(_, judgement)| judgement.verdict.map(|_| ()))
    }
}

/// Judges a sample where nothing is held of its station's place.
#[inline(never)] // keeps its stack apart from that of the other case
fn weigh_anew<const SAMPLES: usize>(
    track: Option<&Track<SAMPLES>>,
    sample: &Sample,
    uncertainty: Uncertainty,
    period: Duration,
) -> Judgement {
    let (at, position, speed) = (sample.at, sample.position, sample.speed);
    let (around, reach) = match track {
        Some(track) => (track.around(at, position, speed, &uncertainty), track.reach()),
        None => (Bound::around(at, position, speed, &uncertainty, &AccelerationRange::WORST), AccelerationRange::WORST),
    };
    let grounds = Grounds { around, uncertainty, reach, from_last: reach, period };
    let judgement = Certainty::NONE.judge(sample, None, &grounds);
    let held = track.map_or(Certainty::NONE, |track| *track.certainty());
    if judgement.verdict.is_ok() { judgement } else { Judgement { certainty: held, ..judgement } }
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// Takes in the motion of a peer.
    ///
    /// # Errors
    /// The first cause for which it is refused. Then only the evidence is changed: that of misbehaviour, and that of which station the
    /// other messages in the slot are from.
    pub(super) fn take_motion(
        &mut self,
        at: Instant,
        slot: Slot,
        motion: &Motion,
        health: &mut Health,
    ) -> Result<(), Cause> {
        let index = usize::from(slot.0);
        let holder = self.peers.get(index).ok_or(Cause::UnknownSlot)?.station();
        let mut plan = Plan::none();
        let is_planned = self.plan(at, index, holder, motion, &mut plan);
        let verdict = is_planned.and_then(|()| plan.verdict());
        let is_own = holder == Some(motion.station);
        if verdict.is_ok() {
            self.carry_out(index, &plan);
        } else {
            self.note_refused(index, is_own, is_planned.is_ok().then_some(&plan));
        }
        // A station whose clock is ahead is refused before it holds a slot. So its clock is noted for a free slot too.
        if (is_own || holder.is_none()) && matches!(verdict, Ok(()) | Err(Cause::Future)) {
            self.note_clock(at, index, motion, health);
        }
        verdict
    }

    /// The plan is written where it is wanted, because it is large.
    fn plan(
        &self,
        at: Instant,
        index: usize,
        holder: Option<StationHash>,
        motion: &Motion,
        plan: &mut Plan,
    ) -> Result<(), Cause> {
        let link = &self.config.link;
        let Plan { seat, placed, sample: judged } = plan;
        *seat = self.seat(at, index, holder, motion.station)?;
        let stamped = self.instant_of(motion.stamp, at).unwrap_or_else(|| at.minus(link.assumed_delay));
        let own = self.peers.get(index).filter(|_| holder.is_none_or(|holder| holder == motion.station));
        let own = own.filter(|_| !seat.is_of_another);
        let off = own.filter(|_| self.is_synchronised(at)).map_or(Off::No, Track::clock_off);
        let stamped = off.corrected(stamped);
        timely(stamped, at, link.stale, link.future)?;
        self.place_motion(index, motion, placed);
        let track = self.peers.get(index).filter(|_| !seat.is_taken_over && !seat.is_of_another);
        if let Some(motion) = &placed.motion {
            let moved = placed.moved.unwrap_or(Distance::ZERO);
            let newest = || Some(track?.newest()?.position.ahead(moved));
            let ego = self.ego.as_ref().map(|ego| ego.position);
            let is_timed = self.is_synchronised(at);
            let sample = Sample { is_timed, ..Sample::of(motion, stamped, at, ego.or_else(newest)) };
            *judged = Some((sample, self.judge(track, &sample, placed)));
        }
        let is_new = holder != Some(motion.station);
        // A motion without a place changes nothing of what is held, and the place that would tell two vehicles apart comes after it.
        if let Some((sample, _)) = judged.as_ref().filter(|_| is_new) {
            let approach = placed.axis.as_ref().and_then(Axis::approach);
            let is_namesake = |other: &usize| self.is_namesake(*other, sample, approach);
            if self.is_in_another_slot(at, index, motion.station, is_namesake) {
                return Err(Cause::StationConflict);
            }
            // A silent station does not move here if this is certain to be another vehicle: its place would be forgotten.
            seat.left = seat.left.filter(|left| !is_namesake(left));
        } else {
            seat.left = None;
        }
        if seat.is_renamed
            && !judged.as_ref().is_some_and(|(sample, judgement)| self.continues(track, sample, judgement))
        {
            return Err(Cause::StationConflict);
        }
        Ok(())
    }

    /// Whether a motion with a new station hash is of the vehicle that has the slot. It is if the motion agrees with what is certain of
    /// that vehicle, and this leaves no room for another vehicle. Stations change their hash with their pseudonym, for privacy.
    fn continues(&self, track: Option<&Track<SAMPLES>>, sample: &Sample, judgement: &Judgement) -> bool {
        let Some((bound, newest)) = track.and_then(|track| track.certainty().bound().zip(track.newest())) else {
            return false;
        };
        let bound = bound.after(sample.at, &track.map_or(AccelerationRange::WORST, Track::reach));
        let off =
            sample.position_error().minus(excess(sample.position_accuracy)).minus(excess(newest.position_accuracy));
        let room = bound.highest_position().ahead_of(bound.lowest_position()).plus(off).plus(off);
        matches!(judgement.verdict, Ok(Belief::Agrees)) && sample.at > newest.at && room < SHORTEST
    }

    /// A slot is one station's. If it was another one's, that one's time is over.
    ///
    /// # Errors
    /// [`Cause::StationConflict`]: the other one was heard in this slot within `slot_reuse`, and it is not certain that both are the
    /// same vehicle ([`continues`](Self::continues)). Or else whoever takes its slot could end what is certain of it, and with that
    /// the check of whether what is said of it can be.
    fn seat(
        &self,
        at: Instant,
        index: usize,
        holder: Option<StationHash>,
        station: StationHash,
    ) -> Result<Seat, Cause> {
        if holder == Some(station) {
            return Ok(Seat::KEPT);
        }
        let is_renamed = holder.is_some() && self.is_heard(at, index);
        // Where there are intersections a new name has to tell its way first.
        if is_renamed && self.coordination.itinerary().is_some() {
            return Err(Cause::StationConflict);
        }
        let slot_reuse = self.config.link.slot_reuse;
        let is_of_another = self.peers.get(index).is_some_and(|track| track.is_of_another(at, slot_reuse));
        let left = self.peers.named(station).find(|left| !self.is_heard(at, *left));
        Ok(Seat { is_taken_over: holder.is_some() && !is_renamed, is_renamed, is_of_another, left })
    }

    /// Whether a slot was heard within `slot_reuse`.
    fn is_heard(&self, at: Instant, index: usize) -> bool {
        let silence = self.peers.get(index).and_then(|track| track.link().silence(at));
        silence.is_some_and(|silence| silence < self.config.link.slot_reuse)
    }

    /// Whether a station of this name is heard in another slot, and is not certain to be another vehicle: a station speaks in one
    /// slot at a time.
    fn is_in_another_slot(
        &self,
        at: Instant,
        index: usize,
        station: StationHash,
        is_namesake: impl Fn(&usize) -> bool,
    ) -> bool {
        self.peers.named(station).any(|other| other != index && self.is_heard(at, other) && !is_namesake(&other))
    }

    /// Whether a motion is certain not to be of the vehicle in another slot: it is not where that one can be, or comes to the same
    /// crossing by another leg. Places on different legs are not to be compared.
    fn is_namesake(&self, other: usize, sample: &Sample, approach: Option<&PeerApproach>) -> bool {
        let held = self.coordination.itinerary().and_then(|_| self.coordination.approach(other));
        let is_by_another_leg = |(one, other): (&PeerApproach, &PeerApproach)| {
            one.crossing == other.crossing && one.movement.leg != other.movement.leg
        };
        if approach.zip(held).is_some_and(is_by_another_leg) {
            return true;
        }
        let Some(track) = self.peers.get(other) else { return false };
        let uncertainty = uncertainty(sample, self.is_synchronised(sample.received), &self.config.link, Off::No);
        let around = track.around(sample.at, sample.position, sample.speed, &uncertainty);
        // The range sensor may have narrowed what is held to an instant later than the sample's.
        track.certainty().bound().is_some_and(|bound| bound.is_apart_from(&around, &track.reach()))
    }

    /// A motion on the ego's axis.
    fn place_motion(&self, index: usize, motion: &Motion, placed: &mut Placed) {
        placed.axis = self.coordination.itinerary().and(self.coordination.axis(index)).copied();
        let Some(axis) = &mut placed.axis else {
            placed.motion = Some(*motion);
            return;
        };
        let was_placed = axis.approach().is_some();
        (placed.motion, placed.moved) = axis.translate(motion);
        placed.is_back = !was_placed && axis.approach().is_some() && self.is_placed_before(index);
    }

    /// Judges a sample by what is held of its station, if anything is.
    ///
    /// A sample that is too far away is refused, and the ego does not drive by it. If the station was near before and the sample agrees
    /// with what is certain, it still tells where the station is. Otherwise a vehicle that is long gone would be taken to stand where it
    /// was heard last.
    fn judge(&self, track: Option<&Track<SAMPLES>>, sample: &Sample, placed: &Placed) -> Judgement {
        let judgement = self.weigh(track, sample, placed);
        let ego = self.ego.as_ref().map(|ego| ego.position);
        if ego.is_none_or(|ego| sample.position.ahead_of(ego).magnitude() <= FARTHEST_PEER) {
            return judgement;
        }
        let is_known = !placed.is_elsewhere() && track.is_some_and(|track| track.newest().is_some());
        let certainty = match judgement.verdict {
            Ok(Belief::Agrees) if is_known => judgement.certainty,
            _ => track.map_or(Certainty::NONE, |track| *track.certainty()),
        };
        Judgement { certainty, verdict: Err(Cause::TooFar) }
    }

    fn weigh(&self, track: Option<&Track<SAMPLES>>, sample: &Sample, placed: &Placed) -> Judgement {
        let off = track.map_or(Off::No, Track::clock_off);
        let uncertainty = uncertainty(sample, self.is_synchronised(sample.received), &self.config.link, off);
        let period = self.config.link.period;
        match track {
            // On the axis as it was before, because everything that is held is on that axis.
            Some(track) if !placed.is_elsewhere() => {
                let back = placed.moved.unwrap_or(Distance::ZERO).negated();
                track.judge(&Sample { position: sample.position.ahead(back), ..*sample }, &uncertainty, period)
            }
            _ => weigh_anew(track, sample, uncertainty, period),
        }
    }

    /// Carries out all that a motion changes.
    #[inline(never)] // keeps its stack apart from that of the judgement
    fn carry_out(&mut self, index: usize, plan: &Plan) {
        if plan.seat.is_taken_over {
            self.vacate(index);
        }
        if plan.seat.is_of_another
            && let Some(track) = self.peers.get_index_mut(index)
        {
            track.begin();
        }
        if let Some(left) = plan.seat.left {
            self.peers.follow_on(left, index);
        }
        if let Some(axis) = &plan.placed.axis {
            self.place_on(index, axis, plan.placed.moved, plan.placed.is_back);
        }
        let Some(track) = self.peers.get_index_mut(index) else { return };
        // A sample is admitted only when the station's place is known. The place is taken in only while the slot is not disputed. So this
        // comes first.
        track.settle();
        let Some((sample, Judgement { certainty, verdict: Ok(belief) })) = &plan.sample else { return };
        let is_first = track.station() != Some(sample.station);
        let admission = track.admit(sample, certainty, *belief);
        if let Some(moved) = plan.placed.moved.filter(|_| !plan.placed.is_elsewhere()) {
            track.shift_certainty(moved);
        }
        if is_first {
            self.estimator.note_change(&self.peers);
        }
        if let Some(left) = plan.seat.left {
            self.vacate(left);
        }
        if admission == Admission::News {
            self.estimator.note_news(index);
            self.fuse_message(index, sample.received);
        }
    }

    /// Keeps the evidence of a refused motion. After the motion of another station, other messages in the slot may be that station's.
    #[inline(never)] // keeps its stack apart from that of the judgement
    fn note_refused(&mut self, index: usize, is_own: bool, plan: Option<&Plan>) {
        let Some(track) = self.peers.get_index_mut(index) else { return };
        if is_own {
            if let Some((_, judgement)) = plan.and_then(|plan| plan.sample.as_ref()) {
                track.note(&judgement.certainty);
            }
            return;
        }
        track.dispute();
        if let Some(axis) = self.coordination.axis_mut(index) {
            axis.dispute();
        }
    }

    /// Notes what a motion says of its sender's clock.
    fn note_clock(&mut self, at: Instant, index: usize, motion: &Motion, health: &mut Health) {
        let Some(stamped) = self.instant_of(motion.stamp, at) else { return };
        let Some(track) = self.peers.get_index_mut(index) else { return };
        if track.hear_clock(at, stamped, &self.config.link) {
            health.count(Cause::PeerClock);
        }
    }

    /// Forgets the station that has left a slot.
    fn vacate(&mut self, index: usize) {
        self.displace(index);
        if let Some(track) = self.peers.get_index_mut(index) {
            *track = Track::new(self.config.link.period);
        }
        self.estimator.forget(index);
        self.estimator.note_change(&self.peers);
        self.coordination.vacate(index);
    }
}
