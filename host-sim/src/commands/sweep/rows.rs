//! The runs of one step: a scenario and seeds enter, the figures of all of them together leave.

use serde::Serialize;

use super::timing::Timing;
use crate::error::Error;
use crate::input::scenario::Scenario;
use crate::measure::bootstrap::{Interval, Squares, interval};
use crate::measure::figures::{errors, failures, ours, papers};
use crate::measure::metrics::{max_abs, percentile_abs};
use crate::measure::simulate::simulate;
use crate::parallel;

/// The figures of one step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Prediction step, `δt`.
    pub step_s: f64,
    /// Number of runs.
    pub seeds: u64,
    /// Errors of the unit.
    pub ours: Errors,
    /// Errors of the literal paper's method, on the same messages.
    pub paper: Errors,
    /// Whose rms is less, where the interval of the difference says so.
    pub less_rms: Option<&'static str>,
    /// Wall-clock figures. All other figures are the same for the same seeds.
    pub timing: Timing,
}

/// The position errors of one estimator over all seeds; `None` if it never had an estimate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Largest magnitude, in metres.
    pub max_position_error_m: Option<f64>,
    /// 99th percentile of the magnitudes of all runs together, by nearest rank, in metres.
    pub p99_position_error_m: Option<f64>,
    /// Root of the mean square of all runs together, in metres.
    pub rms_position_error_m: Option<f64>,
    /// Its interval of 95 % confidence over the seeds.
    pub rms_interval_m: Option<Interval>,
}

impl Errors {
    fn of(errors: &[f64], largest: &[f64], squares: &[Squares]) -> Self {
        Self {
            max_position_error_m: max_abs(largest),
            p99_position_error_m: percentile_abs(errors, 99.0),
            rms_position_error_m: Squares::rms(squares),
            rms_interval_m: interval(squares.len(), |drawn| Squares::rms(drawn.iter().map(|run| &squares[*run]))),
        }
    }
}

/// Whose rms is less, if every difference that the seeds allow for says the same.
fn less([ours, papers]: [&[Squares]; 2]) -> Option<&'static str> {
    let rms = |of: &[Squares], drawn: &[usize]| Squares::rms(drawn.iter().map(|run| &of[*run]));
    match interval(ours.len(), |drawn| Some(rms(ours, drawn)? - rms(papers, drawn)?))? {
        [_, high] if high < 0.0 => Some("holdover"),
        [low, _] if low > 0.0 => Some("paper"),
        _ => None,
    }
}

/// A run that failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Its seed.
    pub seed: u64,
    /// Its step, as text.
    pub step: String,
    /// The causes.
    pub causes: Vec<String>,
}

/// All runs of one step.
#[derive(Clone, Debug, PartialEq)]
pub struct Runs {
    /// Errors of the unit.
    pub ours: Errors,
    /// Errors of the literal paper's method.
    pub paper: Errors,
    /// Whose rms is less.
    pub less_rms: Option<&'static str>,
    /// Failed runs, by seed.
    pub failures: Vec<Failure>,
}

struct Outcome {
    ours: Vec<f64>,
    paper: Vec<f64>,
    /// The largest errors of both, which a thinned trace may lack.
    largest: [Option<f64>; 2],
    causes: Vec<String>,
}

/// Runs the scenario with every seed on all cores. `done` is called after each run.
///
/// # Errors
/// An error that a unit finds in the configuration from the scenario.
pub fn run(scenario: &Scenario, seed: u64, seeds: u64, done: impl Fn() + Sync) -> Result<Runs, Error> {
    let one = |seed: u64| {
        let outcome = outcome(scenario, seed);
        done();
        outcome.map(|outcome| (seed, outcome))
    };
    let (mut ours, mut paper, mut largest, mut failures) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut squares = [Vec::new(), Vec::new()];
    for outcome in parallel::each(seed..=seed + (seeds - 1), one) {
        let (seed, outcome) = outcome?;
        squares[0].push(Squares::of(outcome.ours.iter().copied()));
        squares[1].push(Squares::of(outcome.paper.iter().copied()));
        ours.extend(outcome.ours);
        paper.extend(outcome.paper);
        largest.push(outcome.largest);
        if !outcome.causes.is_empty() {
            failures.push(Failure { seed, step: scenario.step_s.to_string(), causes: outcome.causes });
        }
    }
    let of = |errors: &[f64], index: usize| {
        let largest: Vec<f64> = largest.iter().filter_map(|run| run[index]).collect();
        Errors::of(errors, &largest, &squares[index])
    };
    let less_rms = less([&squares[0], &squares[1]]);
    Ok(Runs { ours: of(&ours, 0), paper: of(&paper, 1), less_rms, failures })
}

fn outcome(scenario: &Scenario, seed: u64) -> Result<Outcome, Error> {
    let (trace, summary) = simulate(scenario, seed, None, |_| {})?;
    let values = |errors: Vec<(f64, f64)>| errors.into_iter().map(|(_, error)| error).collect();
    Ok(Outcome {
        ours: values(errors(&trace, ours(&trace))),
        paper: values(errors(&trace, papers(&trace))),
        largest: [summary.ours.max_position_error_m, summary.paper.max_position_error_m],
        causes: failures(scenario, &summary),
    })
}
