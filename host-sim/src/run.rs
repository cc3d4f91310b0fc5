//! `run`: checked options enter; a table or JSON on stdout, a report, a trace and a candump log leave; and the verdict.

mod files;
mod page;
mod table;

pub use files::{mode_name, write_report};

use std::path::Path;
use std::time::Instant;

use indicatif::ProgressBar;

use crate::error::Error;
use crate::figures::{Summary, failures, summarise};
use crate::options::RunOptions;
use crate::output;
use crate::scenario::Scenario;
use crate::verdict::Verdict;
use crate::world::{Trace, World};

/// Runs the scenario of the options and writes all that they ask for.
///
/// # Errors
/// A scenario that the units refuse, and places that cannot be written.
pub fn run(options: &RunOptions) -> Result<Verdict, Error> {
    let scenario = &options.scenario;
    let bar = ProgressBar::new(1000);
    let logged = options.candump.as_ref().map(|candump| candump.vehicle);
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

/// Runs the scenario, with the wall clock around it.
///
/// # Errors
/// What a unit finds wrong with the configuration that the scenario gives it.
pub fn simulate(
    scenario: &Scenario,
    seed: u64,
    logged: Option<usize>,
    progress: impl FnMut(f64),
) -> Result<(Trace, Summary), Error> {
    let world = World::new(scenario, seed, logged).map_err(|cause| {
        Error::new(format!("the units refuse the scenario: {cause}"), "change the scenario accordingly")
            .in_file(Path::new("scenario"))
    })?;
    let start = Instant::now();
    let trace =
        world.run(progress).map_err(|error| Error::new(format!("the bus failed: {error}"), "see the system's log"))?;
    let realtime_factor = scenario.duration_s / start.elapsed().as_secs_f64().max(1e-9);
    let summary = summarise(scenario, &trace, realtime_factor);
    Ok((trace, summary))
}
