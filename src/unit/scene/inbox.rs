//! What the unit takes in. Whole messages enter. They go to the clock, to the ego's own motion or to the peers, or are refused by the
//! rules of time and place.

use super::Scene;
use crate::health::{Cause, Health};
#[cfg(feature = "fd")]
use crate::peers::Track;
use crate::peers::{Sample, timely};
use crate::time::Instant;
#[cfg(feature = "fd")]
use crate::wire::fd::State;
use crate::wire::motion::Motion;
use crate::wire::{Message, Said, Slot};

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// Takes in a whole message.
    pub fn take(&mut self, at: Instant, message: &Message, health: &mut Health) -> Result<(), Cause> {
        match message {
            Message::Sync(sync) => self.clock.sync(at, *sync),
            Message::FollowUp(follow_up) => self.clock.follow_up(at, *follow_up)?,
            Message::Ego(Said::Motion(motion)) => {
                if motion.station != self.config.station {
                    health.count(Cause::EgoStation);
                }
                self.take_ego(at, motion)?;
            }
            Message::DriverRequest(request) => {
                if self.request.as_ref().map(|held| held.predecessor) != Some(request.predecessor) {
                    self.ranging.note_named(at);
                }
                self.actuators.ask(at, request.engaged);
                let before = self.time_gap();
                self.request.set(*request);
                self.requested_at = at;
                if self.opening.is_opened() {
                    self.opening.give_way(self.time_gap().minus(before), self.most_opened());
                }
            }
            Message::Actuators(state) => {
                let is_asked = self.is_asked();
                if let Some(cause) = self.actuators.take(at, *state, is_asked, self.config.period) {
                    health.count(cause);
                }
            }
            Message::Peer(slot, said) => self.take_peer(at, *slot, said, health)?,
            Message::Range(seen) => self.take_range(at, *seen, health)?,
            Message::Unserved(unserved) => self.unknown.take(at, *unserved),
            Message::PeerPass(pass) => self.take_pass(at, pass, health)?,
            Message::Ego(Said::Geo(geo)) => self.take_ego_place(at, geo)?,
            Message::Ego(_) => {}
            Message::Own(_) | Message::OwnPass(_) | Message::Command(_) | Message::Estimate(_) | Message::Status(_) => {
            }
        }
        Ok(())
    }

    fn take_ego(&mut self, at: Instant, motion: &Motion) -> Result<(), Cause> {
        let stamped = self.instant_of(motion.stamp, at);
        let instant = stamped.unwrap_or(at);
        timely(instant, at, self.config.link.ego_timeout, self.config.link.future)?;
        let near = self.ego.as_ref().map(|ego| ego.position);
        let sample = Sample { is_timed: stamped.is_some(), ..Sample::of(motion, instant, at, near) };
        if let Some(held) = self.ego.as_ref() {
            // This also refuses a stamp that has come round: a clock that stands still brings no news.
            if held.stamp == sample.stamp {
                return Err(Cause::Duplicate);
            }
            if sample.at < held.at {
                return Err(Cause::OutOfOrder);
            }
        }
        self.ego.set(sample);
        Ok(())
    }

    fn take_peer(&mut self, at: Instant, slot: Slot, said: &Said, health: &mut Health) -> Result<(), Cause> {
        let index = usize::from(slot.0);
        #[cfg(feature = "fd")]
        if let Said::State(state) = said {
            return self.take_state(at, slot, state, health);
        }
        if !matches!(said, Said::Motion(_)) {
            let is_disputed = self.peers.get_mut(slot)?.is_disputed();
            // After a long silence a place is not refused like these two: it waits for the motion of its stamp, and holds from that on.
            let is_of_whom_moves = matches!(said, Said::DrivingParameters(_) | Said::Horizon(_));
            if is_disputed || is_of_whom_moves && self.may_be_of_another(at, index) {
                return Err(Cause::StationConflict);
            }
        }
        match said {
            Said::Motion(motion) => self.take_motion(at, slot, motion, health)?,
            Said::DrivingParameters(parameters) => {
                let track = self.peers.get_mut(slot)?;
                // A sample from before a long silence is not integrated anew, because that would take a time that grows with the silence.
                let is_young = track.newest().is_some_and(|newest| at.since(newest.at) <= self.config.link.stale);
                if track.publish(at, *parameters, self.config.link.stale) {
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
            #[cfg(feature = "fd")]
            Said::State(_) => {}
        }
        Ok(())
    }

    /// Takes in a motion, and what came with it. If the motion is refused, so is the rest; the rest may be refused by itself.
    #[cfg(feature = "fd")]
    fn take_state(&mut self, at: Instant, slot: Slot, state: &State, health: &mut Health) -> Result<(), Cause> {
        let State { motion, parameters, horizon } = *state;
        self.take_peer(at, slot, &Said::Motion(motion), health)?;
        // A motion that a later one has overtaken is not driven from: neither is its horizon.
        let newest = self.peers.get(usize::from(slot.0)).and_then(Track::newest);
        let is_overtaken = newest.is_some_and(|newest| newest.stamp.is_after(motion.stamp));
        let rest = [parameters.map(Said::DrivingParameters), horizon.filter(|_| !is_overtaken).map(Said::Horizon)];
        for said in rest.iter().flatten() {
            if let Err(cause) = self.take_peer(at, slot, said, health) {
                health.count(cause);
            }
        }
        Ok(())
    }

    /// Whether a slot has been silent for so long that it may belong to another station, whose first motion was lost or is still to come.
    pub(super) fn may_be_of_another(&self, at: Instant, index: usize) -> bool {
        let silence = self.peers.get(index).and_then(|track| track.link().silence(at));
        silence.is_some_and(|silence| silence >= self.config.link.slot_reuse)
    }
}
