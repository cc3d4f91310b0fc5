//! `string`: how a string of ten vehicles damps what its leader does. Checked options enter; a table or JSON on stdout and
//! a report leave; and the verdict.
//!
//! ```text
//! disturbance -> string of units, and strings without holdover -> speeds -> amplification -> rows -> table, JSON, report
//! ```

pub mod amplification;
pub mod arguments;
pub mod disturbance;
pub mod options;
mod page;
pub mod rows;
pub mod table;
pub mod uncompensated;

use serde::Serialize;

use crate::commands::ending::write_report;
use crate::error::Error;
use crate::output;
use crate::verdict::Verdict;
use options::StringOptions;
use rows::Row;

/// The results, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Results<'a> {
    /// The largest ratio allowed.
    limit: f64,
    /// The time gap that is shipped.
    shipped_time_gap_s: f64,
    /// The smallest of the time gaps at and above which it holds; none if it does not hold at the largest.
    smallest_time_gap_s: Option<f64>,
    /// The first seed.
    seed: u64,
    rows: &'a [Row],
}

/// Runs everything and writes what the options ask for.
///
/// # Errors
/// A configuration that the units refuse, and places that cannot be written.
pub fn string(options: &StringOptions) -> Result<Verdict, Error> {
    let bar = output::progress(rows::count(options));
    let rows = rows::run(options, || bar.inc(1))?;
    bar.finish_and_clear();
    let failures = rows::failures(&rows);
    let report = match &options.report {
        Some(folder) => Some(write_report(folder, &page::render(options, &rows, &failures))?),
        None => None,
    };
    if options.json {
        let smallest_time_gap_s = rows::smallest_time_gap_s(&rows);
        let shipped_time_gap_s = options::shipped_time_gap_s();
        let results =
            Results { limit: rows::LIMIT, shipped_time_gap_s, smallest_time_gap_s, seed: options.seed, rows: &rows };
        let json = serde_json::to_string(&results).map_err(|error| Error::new(error.to_string(), "report this"))?;
        output::print(&format!("{json}\n"))?;
        output::say(&table::verdict(options, &rows, &failures));
    } else {
        output::print(&table::text(options, &rows, &failures))?;
    }
    if let Some(report) = report {
        output::say(&format!("report: {}", report.display()));
    }
    Ok(if failures.is_empty() { Verdict::Pass } else { Verdict::Failed })
}
