//! `envelope-cost`: the cost of the envelope. Checked options enter; a table or JSON on stdout, a report of runs
//! without and with the envelope, and the verdict leave.
//!
//! ```text
//! scenario with each silence -> rows (all seeds, without and with, on all cores) -> table, JSON, report
//! ```

pub mod arguments;
pub mod options;
mod page;
pub mod rows;
pub mod table;

use serde::Serialize;

use crate::error::Error;
use crate::progress::Progress;
use crate::verdict::Verdict;
use options::EnvelopeCostOptions;
use rows::Row;

/// The results, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Results<'a> {
    rows: &'a [Row],
}

/// Runs everything and writes the output that the options ask for.
///
/// # Errors
/// A scenario that the units refuse, and output that cannot be written.
pub fn run(options: &EnvelopeCostOptions) -> Result<Verdict, Error> {
    options.destination.warn();
    let progress = Progress::new(2 * options.seeds * options.scenarios.len() as u64);
    let seeds = (options.seed, options.seeds);
    let run = |scenario| rows::run(scenario, seeds, options.distance_m, || progress.inc());
    let rows = options.scenarios.iter().map(run).collect::<Result<Vec<Row>, Error>>()?;
    progress.finish();
    let failures = rows::failures(&rows);
    let verdict = Verdict::of(&failures);
    let said = if verdict == Verdict::Pass { String::new() } else { verdict.line(&failures) };
    let page = || page::render(options, &rows, &failures);
    options.destination.deliver(&Results { rows: &rows }, &table::text(&rows, &failures), &said, page)?;
    Ok(verdict)
}
