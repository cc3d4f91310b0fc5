//! The trace of a run: the latest tick of every vehicle enters; the ticks that are kept, and what else is known at the end, leave.

use holdover::health::Cause;

use super::{Measured, Tick};
use crate::bus::Frame;
use crate::sim::channel::Channel;
use crate::thinned::{Thinning, halve};

/// The most ticks that the trace of a run has: ten minutes at the usual period.
pub const MOST_TICKS: usize = 60_000;

/// The trace of a run.
pub struct Trace {
    /// The time of each tick.
    pub times_s: Vec<f64>,
    /// For each vehicle, its ticks.
    pub vehicles: Vec<Vec<Tick>>,
    /// For each tick, where the literal paper's method estimates the measured vehicle to be; empty if it is not
    /// evaluated.
    pub paper: Vec<Option<f64>>,
    /// The vehicle whose position is estimated, and the vehicle that estimates it.
    pub measured: Measured,
    /// Refusals of all units together, by cause.
    pub refusals: Vec<(Cause, u64)>,
    /// The channel with all that happened on it.
    pub channel: Channel,
    /// The bus of the logged vehicle, if there is one: times of the run, and frames.
    pub log: Vec<(f64, Frame)>,
    /// Number of messages that found no slot in a modem.
    pub turned_away: u64,
    /// The last tick of every vehicle, whether it is kept or not.
    pub latest: Vec<Tick>,
    /// Which ticks are kept: every one, unless the trace is of bounded length.
    pub thinning: Thinning,
}

impl Trace {
    /// The same with at most this many ticks. Of a longer run every second, every fourth and so on is kept.
    #[must_use]
    pub fn of_at_most(self, ticks: usize) -> Self {
        Self { thinning: Thinning::to(ticks), ..self }
    }

    /// Every tick that is kept: its time, the ticks of all vehicles, and the estimate of the literal paper's method.
    pub fn each(&self, mut tick: impl FnMut(f64, &[Tick], Option<f64>)) {
        let mut ticks = Vec::with_capacity(self.vehicles.len());
        for (index, at_s) in self.times_s.iter().enumerate() {
            ticks.clear();
            ticks.extend(self.vehicles.iter().map(|vehicle| vehicle[index]));
            tick(*at_s, &ticks, self.paper.get(index).copied().flatten());
        }
    }

    /// Adds the latest tick.
    pub(super) fn push(&mut self, at_s: f64) {
        let place = self.thinning.place();
        if place.is_full {
            halve(&mut self.times_s);
            halve(&mut self.paper);
            self.vehicles.iter_mut().for_each(halve);
        }
        if place.is_kept {
            self.times_s.push(at_s);
            self.vehicles.iter_mut().zip(&self.latest).for_each(|(ticks, tick)| ticks.push(*tick));
        }
    }

    /// Adds the estimate of the literal paper's method at the latest tick.
    pub fn push_paper(&mut self, paper_m: Option<f64>) {
        if self.paper.len() < self.times_s.len() {
            self.paper.push(paper_m);
        }
    }
}
