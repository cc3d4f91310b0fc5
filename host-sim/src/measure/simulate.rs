//! A whole run: a scenario and a seed enter; the trace leaves, with the literal paper's estimates beside the unit's,
//! and the figures.

use std::io;
use std::path::Path;
use std::time::Instant;

use super::figures::{Summary, summarise};
use super::paper_beside::PaperBeside;
use crate::error::Error;
use crate::input::scenario::Scenario;
use crate::sim::world::{Trace, World};

/// Runs the scenario and measures the wall-clock time.
///
/// # Errors
/// An error that a unit finds in the configuration from the scenario.
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
    let trace = run(world, scenario, progress)
        .map_err(|error| Error::new(format!("the bus failed: {error}"), "see the system's log"))?;
    let realtime_factor = scenario.duration_s / start.elapsed().as_secs_f64().max(1e-9);
    let summary = summarise(scenario, &trace, realtime_factor);
    Ok((trace, summary))
}

fn run(world: World<'_>, scenario: &Scenario, progress: impl FnMut(f64)) -> io::Result<Trace> {
    let mut paper = PaperBeside::of(&world, scenario);
    world.run_beside(|world, at_s, trace| paper.note(world, at_s, trace), progress)
}
