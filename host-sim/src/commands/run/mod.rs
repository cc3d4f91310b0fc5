//! `run`: checked options enter; a table or JSON on stdout, a report, a trace and a candump log leave; and the verdict.

pub mod arguments;
pub mod candump;
mod files;
pub mod options;
mod page;
mod table;

use indicatif::ProgressBar;

use crate::error::Error;
use crate::measure::figures::failures;
use crate::measure::simulate::simulate;
use crate::verdict::Verdict;
use options::RunOptions;

/// Runs the scenario and writes the output that the options ask for.
///
/// # Errors
/// A scenario that the units refuse, and output that cannot be written.
pub fn run(options: &RunOptions) -> Result<Verdict, Error> {
    options.destination.warn();
    let scenario = &options.scenario;
    let bar = ProgressBar::new(1000);
    let logged = options.candump.as_ref().map(|candump| candump.vehicle);
    let (trace, summary) =
        simulate(scenario, scenario.seed, logged, |share| bar.set_position((share * 1000.0) as u64))?;
    bar.finish_and_clear();
    let failures = failures(scenario, &summary);
    let text = table::text(scenario, &summary, &failures);
    let page = || page::report(options, &trace, &summary, &failures).page();
    // One file that cannot be written does not keep the others away.
    let delivered = options.destination.deliver(&summary, &text, &text, page);
    let traced = options.trace.as_ref().map_or(Ok(()), |file| files::write_trace(file, scenario, &trace));
    let logged = options.candump.as_ref().map_or(Ok(()), |candump| candump.write(&trace.log));
    delivered.and(traced).and(logged)?;
    Ok(Verdict::of(&failures))
}
