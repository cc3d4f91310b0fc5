//! The samples of an evaluation: the comparisons of one recording's estimates with the truth.

use holdover::health::Cause;

use super::listener::{Beliefs, METHODS};
use crate::measure::baseline::Estimate;

/// The names of the methods in results: the unit, then the baselines.
pub const NAMES: [&str; METHODS] =
    ["holdover", "freeze", "constant_speed", "constant_acceleration", "singer", "kalman", "paper"];

/// One instant at which estimates are compared with the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time of the recording.
    pub at_s: f64,
    /// Time since the stamp of the newest delivered sample.
    pub age_s: f64,
    /// Length of the silence so far, where silences are measured.
    pub outage_s: Option<f64>,
    /// The truth.
    pub truth: Estimate,
    /// The estimate of each method.
    pub beliefs: Beliefs,
}

impl Sample {
    /// The position error of a method.
    #[must_use]
    pub fn position_error(&self, method: usize) -> Option<f64> {
        Some(self.beliefs[method]?.position_m - self.truth.position_m)
    }

    /// The speed error of a method.
    #[must_use]
    pub fn speed_error(&self, method: usize) -> Option<f64> {
        Some(self.beliefs[method]?.speed_mps - self.truth.speed_mps)
    }
}

/// The result of one recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// The comparisons, in the order of time; silences one after the other.
    pub samples: Vec<Sample>,
    /// Messages sent.
    pub sent: usize,
    /// Messages that were not lost.
    pub delivered: usize,
    /// For each message its time of sending and its delay, in seconds of the recording; `None`: lost.
    pub messages: Vec<(f64, Option<f64>)>,
    /// The last instant of the run.
    pub end_s: f64,
    /// The unit's refusals, by cause.
    pub refusals: Vec<(Cause, u64)>,
    /// Ticks of the unit, for the figure of speed.
    pub unit_ticks: u64,
}

/// The refusals of the units in all outcomes together, by cause, without causes that did not occur.
#[must_use]
pub fn refusals(outcomes: &[Outcome]) -> Vec<(&'static str, u64)> {
    let of = |cause: Cause| {
        let counts = outcomes.iter().flat_map(|outcome| &outcome.refusals).filter(|(other, _)| *other == cause);
        (cause.name(), counts.map(|(_, count)| count).sum())
    };
    Cause::ALL.iter().map(|cause| of(*cause)).filter(|(_, count)| *count > 0).collect()
}
