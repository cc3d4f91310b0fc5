//! `price`: what the envelope costs. Checked options enter; a table or JSON on stdout and a report of runs without and
//! with it leave; and the verdict.
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

use crate::commands::ending::write_report;
use crate::error::Error;
use crate::output;
use crate::verdict::Verdict;
use options::PriceOptions;
use rows::Row;

/// The results, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Results<'a> {
    rows: &'a [Row],
}

/// Runs everything and writes what the options ask for.
///
/// # Errors
/// A scenario that the units refuse, and places that cannot be written.
pub fn price(options: &PriceOptions) -> Result<Verdict, Error> {
    let bar = output::progress(2 * options.seeds * options.scenarios.len() as u64);
    let seeds = (options.seed, options.seeds);
    let run = |scenario| rows::run(scenario, seeds, options.distance_m, || bar.inc(1));
    let rows = options.scenarios.iter().map(run).collect::<Result<Vec<Row>, Error>>()?;
    bar.finish_and_clear();
    let failures = rows::failures(&rows);
    let report = match &options.report {
        Some(folder) => Some(write_report(folder, &page::render(options, &rows, &failures))?),
        None => None,
    };
    if options.json {
        let results = Results { rows: &rows };
        let json = serde_json::to_string(&results).map_err(|error| Error::new(error.to_string(), "report this"))?;
        output::print(&format!("{json}\n"))?;
        failures.iter().for_each(|failure| output::say(&format!("verdict: FAILED: {failure}")));
    } else {
        output::print(&table::text(&rows, &failures))?;
    }
    if let Some(report) = report {
        output::say(&format!("report: {}", report.display()));
    }
    Ok(if failures.is_empty() { Verdict::Pass } else { Verdict::Failed })
}
