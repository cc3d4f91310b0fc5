//! `sweep`: checked options enter; a table or JSON on stdout, a report of errors and cost over the prediction step, and
//! the verdict leave.
//!
//! ```text
//! scenario at each step -> rows (runs of all seeds, on all cores) -> timing (alone) -> table, JSON, report
//! ```

pub mod arguments;
pub mod options;
mod page;
pub mod rows;
pub mod table;
pub mod timing;

pub use timing::of_log;

use serde::Serialize;

use crate::error::Error;
use crate::progress::Progress;
use crate::verdict::Verdict;
use options::SweepOptions;
use rows::{Failure, Row};

/// The results, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Results<'a> {
    rows: &'a [Row],
}

/// Runs the scenario at all steps with all seeds, and writes the output that the options ask for.
///
/// # Errors
/// A scenario that the units refuse, and output that cannot be written.
pub fn run(options: &SweepOptions) -> Result<Verdict, Error> {
    options.destination.warn();
    let progress = Progress::new(options.runs());
    let (mut rows, mut failures) = (Vec::new(), Vec::new());
    for scenario in &options.scenarios {
        let runs = rows::run(scenario, options.seed, options.seeds, || progress.inc())?;
        let timing = timing::measure(scenario, options.seed)?;
        let (step_s, seeds) = (scenario.step_s, options.seeds);
        rows.push(Row { step_s, seeds, ours: runs.ours, paper: runs.paper, less_rms: runs.less_rms, timing });
        failures.extend(runs.failures);
    }
    progress.finish();
    let said = match &failures[..] {
        [] => String::new(),
        failures => verdict(options.runs(), failures),
    };
    let page = || page::report(options, &rows, &failures).page();
    options.destination.deliver(&Results { rows: &rows }, &table::text(options, &rows, &failures), &said, page)?;
    Ok(Verdict::of(&failures))
}

/// The line of the verdict.
fn verdict(runs: u64, failures: &[Failure]) -> String {
    let reasons: Vec<String> = reason(runs, failures).into_iter().collect();
    Verdict::of(failures).line(&reasons)
}

/// How many runs failed, and how the first one did; `None` if none did.
fn reason(runs: u64, failures: &[Failure]) -> Option<String> {
    let first = failures.first()?;
    let (count, causes) = (failures.len(), first.causes.join("; "));
    Some(format!("{count} of {runs} runs, the first at a step of {} s with seed {}: {causes}", first.step, first.seed))
}
