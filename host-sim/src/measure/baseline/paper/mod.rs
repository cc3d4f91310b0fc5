//! The literal paper as a baseline: plain state messages of the chain `0..=j` enter, the target's motion read from its
//! horizon leaves. This file is Algorithm 1 (whose horizon is computed when), [`horizon`] is Algorithms 2 to 4.
//!
//! The paper leaves much open. What is printed is kept; where it does not say, the readings are these:
//!
//! - **Time step.** Messages are read once per `δt`, at its multiples: one that arrives between two reads is read at the
//!   later one. Of one vehicle's messages read together, the one with the newest stamp counts; one that is not newer
//!   than what was read before does not count.
//! - **Connected.** Vehicle `n` is connected at a time step if a message of it counts in this step. Then its horizon is
//!   computed anew, from that message and from the horizon that its predecessor has at this step (front vehicle
//!   first). Otherwise `Ṽ_n(t) = Ṽ_n(t-1)`: the horizon held keeps its own time anchor, so its index advances with time.
//! - **Anchor.** A horizon starts at the stamp of the message that it was computed from, and reaches 5 s.
//! - **Reading.** At an instant, the nearest step counts (no interpolation); past the end the last value, before the
//!   anchor the first.
//! - **Delay.** `τ` of a vehicle is arrival minus stamp of its last counted message, not below 0, one value for a whole
//!   horizon.
//! - **Chain.** Who follows whom is what the driving parameters say. Whoever leads, names nobody, names a vehicle not heard yet, or
//!   would close the chain to a ring, is index 0: Algorithm 2 with `v_∞` from its own driving parameters, 13.4 m/s without one.
//! - **Parameters** are those of the vehicle's own driving parameters; what it said last holds until it says something else. The
//!   length of a predecessor that has said nothing is 4.8 m. `α` = 1; there is no standstill distance.

pub mod horizon;

use super::{Baseline, Estimate};
use crate::measure::heard::{Heard, HeardParameters};
use horizon::{Horizon, Preceding};
use std::collections::BTreeMap;

/// How far a horizon reaches.
pub const HORIZON_S: f64 = 5.0;
/// `v_∞` of a vehicle that published none.
pub const UNPUBLISHED_TARGET_SPEED_MPS: f64 = 13.4;
/// `l` of a vehicle that published none.
pub const UNPUBLISHED_LENGTH_M: f64 = 4.8;

/// A time this small share of a step before a multiple of `δt` is that multiple: times are sums and products of
/// decimal fractions, which float64 holds only nearly.
const SAME_STEP: f64 = 1e-7;

/// What is known of one vehicle.
#[derive(Clone, Debug)]
struct Track {
    sample: Heard,
    parameters: Option<HeardParameters>,
    horizon: Option<Horizon>,
    /// The sample has not entered the horizon yet.
    connected: bool,
}

/// The literal paper for one target vehicle.
#[derive(Clone, Debug)]
pub struct Paper {
    target: usize,
    step_s: f64,
    steps: usize,
    /// Arrived but not read: the multiple of `δt` at which it will be, and the message, in the order of arrival.
    unread: Vec<(i64, Heard)>,
    tracks: BTreeMap<usize, Track>,
}

impl Paper {
    /// For that vehicle with the prediction step `δt`, which must be positive.
    #[must_use]
    pub fn new(target: usize, step_s: f64) -> Self {
        assert!(step_s > 0.0, "the prediction step is {step_s} s, which is not a step");
        let steps = (HORIZON_S / step_s).round().max(1.0) as usize;
        Self { target, step_s, steps, unread: Vec::new(), tracks: BTreeMap::new() }
    }

    /// Reads, step by step, what is due at `now_s`.
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

    /// Algorithm 1, its loop over `n = 0..=j`.
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

    /// The vehicles from index 0 to the target; empty before the target was heard.
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
