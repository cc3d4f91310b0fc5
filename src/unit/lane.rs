//! Who is ahead on the ego's own leg, by what is certain: bounds enter at every review; what is to spare behind them leaves.
//!
//! Nobody passes there. So whoever was ahead for certain stays ahead, however long it is silent and wherever it is estimated to
//! be: it may have braked to a stand at once, and the gate keeps behind that. What ends this is certain too: it is heard
//! farther on, or on another way; or somebody who was behind it for certain is heard farther on, and then so is it.

use heapless::Vec;

use super::OnboardUnit;
use crate::coordination::Slots;
use crate::envelope::{Obstacle, Spare};
use crate::parameters::DEFAULT_LENGTH;
use crate::peers::Track;
use crate::time::Instant;
use crate::units::{Distance, Position};

/// Where a peer on the ego's leg is, for certain.
struct Certain {
    index: usize,
    near: Position,
    far: Position,
    /// The near end of its rear bumper.
    rear: Position,
}

/// Whoever would stand farther ahead than this when it was heard last is out of the radio's reach, and not minded until it is heard
/// again: no more is known there of anybody else either. An assumption of use: whoever comes nearer than this is heard.
const RADIO_REACH: Distance = Distance::from_mm(300_000);

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// Takes note of who is ahead of the ego's front bumper on its own leg for certain, who of them is behind whom, and how far
    /// they have come by that.
    pub(super) fn note_lane(&mut self, now: Instant, front: Position) {
        let lane = self.certain_on_lane(now);
        let (mut leading, mut beyond) = (Slots::NONE, Slots::NONE);
        for one in &lane {
            // Who may be on either side is where it was.
            let was_ahead = self.coordination.choice().leading.contains(one.index);
            leading.set(one.index, one.near > front || one.far > front && was_ahead);
            beyond.set(one.index, self.is_beyond(one.index, now, front));
            for other in lane.iter().filter(|other| other.rear >= one.far) {
                self.coordination.note_behind(other.index, one.index);
            }
        }
        for one in &lane {
            self.coordination.note_passed(one.index, one.near);
        }
        self.coordination.note_leading(leading, beyond);
    }

    fn certain_on_lane(&self, now: Instant) -> Vec<Certain, PEERS> {
        let certain = |index: usize| {
            self.coordination.standing(index).filter(|standing| self.coordination.is_on_lane(standing))?;
            let bound = self.bound(index, now)?;
            let (near, far) = (bound.lowest_position(), bound.highest_position());
            Some(Certain { index, near, far, rear: near.ahead(self.length_of(index).negated()) })
        };
        let mut lane = Vec::new();
        for one in (0..PEERS).filter_map(certain) {
            // There is room for all: no more than there are slots.
            let _ = lane.push(one);
        }
        lane
    }

    /// The length of a peer.
    pub(super) fn length_of(&self, index: usize) -> Distance {
        self.peers.get(index).and_then(Track::parameters).map_or(DEFAULT_LENGTH, |parameters| parameters.length)
    }

    fn is_beyond(&self, index: usize, now: Instant, front: Position) -> bool {
        let is_silent = self.peers.get(index).is_some_and(|track| !track.link().is_on(now, &self.config.link));
        let is_far = || self.stop_behind(index).is_some_and(|stop| stop >= front.ahead(RADIO_REACH));
        is_silent && (self.coordination.choice().beyond.contains(index) || is_far())
    }

    /// Where a peer's rear comes to rest if it has braked at its hardest since it was heard last.
    fn stop_behind(&self, index: usize) -> Option<Position> {
        let track = self.peers.get(index)?;
        let stop = track.certainty().bound()?.nearest_stop(&track.reach());
        Some(stop.ahead(self.length_of(index).negated()))
    }

    /// What is to spare behind everyone ahead on the same leg. Who is estimated to be the nearest of them need not be: one that is
    /// silent may have braked where it is estimated to have driven on, past another one that is heard.
    pub(super) fn spare_on_lane(&self, now: Instant, spare: &impl Fn(Obstacle) -> Spare) -> Option<Spare> {
        let choice = self.coordination.choice();
        let leading = (0..PEERS).filter(|index| choice.leading.contains(*index) && !choice.beyond.contains(*index));
        let ahead = leading.chain(choice.lane.map(usize::from)).filter(|index| !self.is_seen_past(*index, now));
        // Its rear is not behind its own near end, nor behind the place that it is known to have passed: so the better of both holds.
        let behind = |index: usize| {
            let passed = self.coordination.passed(index).map(Obstacle::standing);
            [self.obstacle(now, index), passed].into_iter().flatten().map(spare).max()
        };
        ahead.filter_map(behind).min()
    }
}
