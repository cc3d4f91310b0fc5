//! `run`: checked options enter; a table or JSON on stdout, a report, a trace and a candump log leave; and the verdict.

pub mod arguments;
mod files;
pub mod options;
mod page;
mod table;

use indicatif::ProgressBar;

use crate::commands::ending::write_report;
use crate::error::Error;
use crate::measure::figures::failures;
use crate::measure::simulate::simulate;
use crate::output;
use crate::verdict::Verdict;
use options::RunOptions;

/// Runs the scenario of the options and writes all that they ask for.
///
/// # Errors
/// A scenario that the units refuse, and places that cannot be written.
pub fn run(options: &RunOptions) -> Result<Verdict, Error> {
    let scenario = &options.scenario;
    let bar = ProgressBar::new(1000);
    let logged = options.candump.as_ref().map(|candump| candump.vehicle);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a share of 1000
    let (trace, summary) =
        simulate(scenario, scenario.seed, logged, |share| bar.set_position((share * 1000.0) as u64))?;
    bar.finish_and_clear();
    let failures = failures(scenario, &summary);
    if let Some(file) = &options.trace {
        files::write_trace(file, scenario, &trace)?;
    }
    if let Some(candump) = &options.candump {
        files::write_log(&candump.file, &trace)?;
    }
    let report = match &options.report {
        Some(folder) => Some(write_report(folder, &page::report(options, &trace, &summary, &failures).render())?),
        None => None,
    };
    if options.json {
        output::say(table::text(scenario, &summary, &failures).trim_end());
        let json = serde_json::to_string(&summary).map_err(|error| Error::new(error.to_string(), "report this"))?;
        output::print(&format!("{json}\n"))?;
    } else {
        output::print(&table::text(scenario, &summary, &failures))?;
    }
    if let Some(report) = report {
        output::say(&format!("report: {}", report.display()));
    }
    Ok(if failures.is_empty() { Verdict::Pass } else { Verdict::Failed })
}
