//! The literal paper as a baseline: plain messages of the chain `0..=j` enter; the target's motion leaves, read from
//! its horizon. This file is Algorithm 1 (whose horizon is computed when). [`horizon`] is Algorithms 2 to 4.
//!
//! The paper leaves much open. Printed text is followed; where the paper does not say, the readings are these:
//!
//! - **Time step.** Messages are read once per `δt`, at its multiples. A message that arrives between two reads is read
//!   at the later one. Of the messages of one vehicle that are read together, the one with the newest stamp counts. A
//!   message that is not newer than those read before does not count.
//! - **Connected.** Vehicle `n` is connected at a time step if a message of it counts in this step. Then its horizon is
//!   computed anew, from that message and from the horizon that its predecessor has at this step (front vehicle first).
//!   Otherwise `Ṽ_n(t) = Ṽ_n(t-1)`: the horizon keeps its own time anchor, so its index advances with time.
//! - **Anchor.** A horizon starts at the stamp of the message that it was computed from, and is 5 s long.
//! - **Reading.** At an instant, the nearest step counts (no interpolation). After the end the last value counts,
//!   before the anchor the first.
//! - **Delay.** `τ` of a vehicle is arrival minus stamp of its last counted message, not below 0: one value for a whole
//!   horizon.
//! - **Chain.** The driving parameters say which vehicle follows which. A vehicle is index 0 if it leads, names no
//!   predecessor, names a vehicle that has not been heard yet, or would close the chain to a ring. Index 0 uses
//!   Algorithm 2 with `v_∞` from its own driving parameters, or 13.4 m/s without them.
//! - **Parameters** are those of the vehicle's own driving parameters; the last message holds until the next one. A
//!   predecessor that has sent none is taken to be 4.8 m long. `α` = 1; there is no standstill distance.

pub mod horizon;

use super::{Baseline, Estimate};
use crate::measure::heard::{Heard, HeardParameters};
use horizon::{Horizon, Preceding};
use std::collections::BTreeMap;

/// Length of a horizon.
pub const HORIZON_S: f64 = 5.0;
/// `v_∞` of a vehicle that did not publish it.
pub const UNPUBLISHED_TARGET_SPEED_MPS: f64 = 13.4;
/// `l` of a vehicle that did not publish it.
pub const UNPUBLISHED_LENGTH_M: f64 = 4.8;

/// A time this small fraction of a step before a multiple of `δt` counts as that multiple. Times are sums and products
/// of decimal fractions, which float64 holds only approximately.
const SAME_STEP: f64 = 1e-7;

/// What has been received of one vehicle.
#[derive(Clone, Debug)]
struct Track {
    sample: Heard,
    parameters: Option<HeardParameters>,
    horizon: Option<Horizon>,
    /// Whether there is a sample that has not entered the horizon yet.
    connected: bool,
}

/// The literal paper for one target vehicle.
#[derive(Clone, Debug)]
pub struct Paper {
    target: usize,
    step_s: f64,
    steps: usize,
    /// Messages that have arrived and have not been read: the multiple of `δt` at which each will be read, and the
    /// message, in the order of arrival.
    unread: Vec<(i64, Heard)>,
    tracks: BTreeMap<usize, Track>,
}

impl Paper {
    /// The method for the vehicle `target`, with the prediction step `δt`, which must be positive.
    #[must_use]
    pub fn new(target: usize, step_s: f64) -> Self {
        assert!(step_s > 0.0, "the prediction step is {step_s} s, which is not a step");
        let steps = (HORIZON_S / step_s).round().max(1.0) as usize;
        Self { target, step_s, steps, unread: Vec::new(), tracks: BTreeMap::new() }
    }

    /// Reads, step by step, the messages that are due at `now_s`.
    fn read_until(&mut self, now_s: f64) {
        let now = (now_s / self.step_s + SAME_STEP).floor() as i64;
        while let Some(step) = self.unread.iter().map(|&(step, _)| step).min().filter(|&step| step <= now) {
            for (_, heard) in self.unread.extract_if(.., |&mut (due, _)| due == step) {
                let track = self.tracks.entry(heard.vehicle);
                track.and_modify(|track| track.take(&heard)).or_insert_with(|| Track::starting_at(&heard));
            }
            self.estimate_chain();
        }
    }

    /// Algorithm 1: its loop over `n = 0..=j`.
    fn estimate_chain(&mut self) {
        let mut predecessor = None;
        for vehicle in self.chain() {
            let Some(track) = self.tracks.get(&vehicle) else { return };
            if track.connected {
                let horizon = self.horizon_of(track, predecessor.and_then(|ahead| self.tracks.get(&ahead)));
                if let Some(track) = self.tracks.get_mut(&vehicle) {
                    track.horizon = Some(horizon);
                    track.connected = false;
                }
            }
            predecessor = Some(vehicle);
        }
    }

    /// The vehicles from index 0 to the target; empty before the first message of the target.
    fn chain(&self) -> Vec<usize> {
        let mut chain = Vec::new();
        let mut next = Some(self.target);
        while let Some(vehicle) = next.filter(|vehicle| !chain.contains(vehicle)) {
            let Some(track) = self.tracks.get(&vehicle) else { break };
            chain.push(vehicle);
            next =
                track.parameters.filter(|parameters| !parameters.leads).and_then(|parameters| parameters.predecessor);
        }
        chain.reverse();
        chain
    }

    fn horizon_of(&self, track: &Track, ahead: Option<&Track>) -> Horizon {
        match (track.parameters, ahead.and_then(|ahead| ahead.horizon.as_ref().map(|horizon| (ahead, horizon)))) {
            (Some(parameters), Some((ahead, horizon))) => {
                let length_m = ahead.parameters.map_or(UNPUBLISHED_LENGTH_M, |parameters| parameters.length_m);
                let delay_s = (ahead.sample.at_s - ahead.sample.stamp_s).max(0.0);
                let preceding = Preceding { horizon, delay_s, length_m };
                Horizon::of_follower(&track.sample, &preceding, &parameters, self.step_s, self.steps)
            }
            (parameters, _) => {
                let target_speed_mps =
                    parameters.map_or(UNPUBLISHED_TARGET_SPEED_MPS, |parameters| parameters.target_speed_mps);
                Horizon::of_leader(&track.sample, target_speed_mps, self.step_s, self.steps)
            }
        }
    }
}

impl Track {
    fn starting_at(heard: &Heard) -> Self {
        Self { sample: *heard, parameters: heard.parameters, horizon: None, connected: true }
    }

    fn take(&mut self, heard: &Heard) {
        if heard.stamp_s > self.sample.stamp_s {
            self.sample = *heard;
            self.parameters = heard.parameters.or(self.parameters);
            self.connected = true;
        }
    }
}

impl Baseline for Paper {
    fn name(&self) -> &'static str {
        "paper"
    }

    fn hear(&mut self, heard: &Heard) {
        self.unread.push(((heard.at_s / self.step_s - SAME_STEP).ceil() as i64, *heard));
    }

    fn estimate(&mut self, now_s: f64) -> Option<Estimate> {
        self.read_until(now_s);
        self.tracks.get(&self.target)?.horizon.as_ref().map(|horizon| horizon.at(now_s))
    }

    fn duplicate(&self) -> Box<dyn Baseline> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests;
