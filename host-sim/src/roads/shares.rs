//! Vehicles that keep no passes among others that do: a corridor enters; the figures with several shares of them leave.

use serde::Serialize;

use super::conditions::Conditions;
use super::experiment::Experiment;
use super::figures::Side;
use crate::error::Error;
use crate::input::scenario::Envelope;

/// The shares, and none beside them.
pub const SHARES: [f64; 4] = [0.0, 0.1, 0.5, 0.9];

/// The figures with a share.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShareRow {
    /// Share of the vehicles whose units keep no passes.
    pub share: f64,
    /// The figures.
    #[serde(flatten)]
    pub side: Side,
}

/// Excerpts of a seed with the envelope, one with each share. `done` is called after each.
///
/// # Errors
/// A scenario that the units refuse.
pub fn run(experiment: &Experiment, seed: u64, done: impl Fn() + Sync) -> Result<Vec<ShareRow>, Error> {
    let scenario = Conditions::of(&experiment.corridor);
    let envelope = Envelope { engaged: true, ..scenario.envelope };
    let jobs = SHARES.map(|without_passes| (seed, Conditions { envelope, without_passes, ..scenario }));
    let outcomes = experiment.excerpt().all(&jobs, done)?;
    let row = |(share, outcome)| ShareRow { share, side: Side::of(&[outcome]) };
    Ok(SHARES.into_iter().zip(&outcomes).map(row).collect())
}
