//! What the unit takes in: whole messages enter, and go to the clock, the ego's own motion or the peers, or are refused by
//! the rules of time and place.

use super::OnboardUnit;
use crate::health::Refusal;
use crate::peers::plausibility::doubt;
use crate::peers::{Admission, Sample, Track};
use crate::time::{Duration, Instant, Stamp};
use crate::wire::motion::Motion;
use crate::wire::{Message, Said, Slot, StationHash};

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// Takes in a whole message.
    pub(super) fn take(&mut self, at: Instant, message: &Message) -> Result<(), Refusal> {
        match message {
            Message::Sync(sync) => self.clock.sync(at, *sync),
            Message::FollowUp(follow_up) => self.clock.follow_up(at, *follow_up)?,
            Message::Ego(Said::Motion(motion)) => self.take_ego(at, motion)?,
            Message::EgoIntent(wish) => self.wish.set(*wish),
            Message::Peer(slot, said) => self.take_peer(at, *slot, said)?,
            Message::Range(seen) => self.take_range(at, *seen)?,
            Message::Ego(Said::Geo(geo)) => self.take_ego_place(at, geo)?,
            Message::Ego(_) => {}
            Message::Own(_) | Message::Command(_) | Message::Estimate(_) | Message::Status(_) => {}
        }
        Ok(())
    }

    fn take_ego(&mut self, at: Instant, motion: &Motion) -> Result<(), Refusal> {
        let instant = self.instant_of(motion.stamp, at).unwrap_or(at);
        let age = at.since(instant);
        if age > self.config.link.ego_timeout {
            return Err(Refusal::Stale);
        }
        if age < Duration::ZERO.minus(self.config.link.future) {
            return Err(Refusal::Future);
        }
        let near = self.ego.as_ref().map(|ego| ego.position);
        let sample = Sample::of(motion, instant, at, near);
        if let Some(held) = self.ego.as_ref() {
            if held.stamp == sample.stamp && at.since(held.received) < Duration::from_millis(1000) {
                return Err(Refusal::Duplicate);
            }
            if sample.at < held.at {
                return Err(Refusal::OutOfOrder);
            }
        }
        self.ego.set(sample);
        Ok(())
    }

    fn take_peer(&mut self, at: Instant, slot: Slot, said: &Said) -> Result<(), Refusal> {
        let index = usize::from(slot.0);
        if !matches!(said, Said::Motion(_)) && self.peers.get_mut(slot)?.is_disputed() {
            return Err(Refusal::StationConflict);
        }
        match said {
            Said::Motion(motion) => {
                let instant =
                    self.instant_of(motion.stamp, at).unwrap_or_else(|| at.minus(self.config.link.assumed_delay));
                let left = self.settle(at, slot, motion.station, instant)?;
                let Some(motion) = self.translate(index, motion) else { return Ok(()) };
                let ego = self.ego.as_ref().map(|ego| ego.position);
                let is_synchronised = self.is_synchronised(at);
                let track = self.peers.get_mut(slot)?;
                let near = ego.or(track.newest().map(|sample| sample.position));
                let sample = Sample::of(&motion, instant, at, near);
                let doubt = doubt(&sample, is_synchronised, &self.config.link);
                if ego.is_some_and(|ego| sample.position.ahead_of(ego).magnitude() > crate::parameters::REACH) {
                    return Err(Refusal::TooFar);
                }
                let is_first = track.station().is_none();
                let admission = track.admit(sample, &doubt, &self.config.link)?;
                if is_first {
                    self.estimator.note_change(&self.peers);
                }
                if let Some(left) = left {
                    self.vacate(left);
                }
                if admission == Admission::News {
                    self.estimator.note_news(index);
                }
            }
            Said::Intent(intent) => {
                let track = self.peers.get_mut(slot)?;
                // A sample from before a long silence is not integrated anew: that would take as long as the silence was.
                let is_young = track.newest().is_some_and(|newest| at.since(newest.at) <= self.config.link.stale);
                if track.intend(*intent) {
                    self.estimator.note_change(&self.peers);
                    if is_young {
                        self.estimator.note_news(index);
                    }
                }
            }
            Said::Horizon(knots) => {
                if self.peers.get_mut(slot)?.foresee(at, *knots) {
                    self.estimator.note_news(index);
                }
            }
            Said::Geo(geo) => {
                self.peers.get_mut(slot)?;
                self.take_peer_place(at, slot, geo);
            }
            Said::Route(route) => {
                self.peers.get_mut(slot)?;
                self.take_peer_route(at, slot, route);
            }
        }
        Ok(())
    }

    /// A station speaks in one slot at a time, and a slot is one station's. If it was another one's, that one's time is over from
    /// here on. The slot in which the station was, if it now speaks in another.
    ///
    /// # Errors
    /// * [`Refusal::StationConflict`]: the other station was heard in the slot, or the station in another slot, within
    ///   `slot_reuse`. Or else whoever takes its name could end what is certain of it, and with that the check of whether
    ///   what is said of it can be;
    /// * [`Refusal::Stale`] and [`Refusal::Future`]: what is said so late, or so early, does not end anything.
    fn settle(
        &mut self,
        at: Instant,
        slot: Slot,
        station: StationHash,
        said: Instant,
    ) -> Result<Option<usize>, Refusal> {
        let (index, link) = (usize::from(slot.0), &self.config.link);
        let holder = self.peers.get_mut(slot)?.station();
        if holder == Some(station) {
            return Ok(None);
        }
        let left = self.peers.index_of(station).filter(|left| *left != index);
        let is_heard = |index: usize| {
            let silence = self.peers.get(index).and_then(|track| track.link().silence(at));
            silence.is_some_and(|silence| silence < link.slot_reuse)
        };
        let age = at.since(said);
        let refusal = if holder.is_some() && is_heard(index) || left.is_some_and(is_heard) {
            Some(Refusal::StationConflict)
        } else if age > link.stale {
            Some(Refusal::Stale)
        } else if age < Duration::ZERO.minus(link.future) {
            Some(Refusal::Future)
        } else {
            None
        };
        if let Some(refusal) = refusal {
            self.peers.get_mut(slot)?.dispute();
            if let Some(axis) = self.coordination.axis_mut(index) {
                axis.dispute();
            }
            return Err(refusal);
        }
        if holder.is_some() {
            self.vacate(index);
        }
        // Its motion is taken only when its place is known, and that only if what else it says is.
        self.peers.get_mut(slot)?.settle();
        Ok(left)
    }

    /// What was known of a station in a slot that it has left is from before, and ends.
    fn vacate(&mut self, index: usize) {
        if let Some(track) = self.peers.get_index_mut(index) {
            *track = Track::new(self.config.link.period);
        }
        self.estimator.forget(index);
        self.estimator.note_change(&self.peers);
        self.coordination.vacate(index);
    }

    /// The instant of a message's stamp, while GNSS time is known.
    pub(super) fn instant_of(&self, stamp: Stamp, at: Instant) -> Option<Instant> {
        if !self.clock.is_synchronised(at, self.config.link.sync_timeout) {
            return None;
        }
        self.clock.instant_of(stamp, at)
    }
}
