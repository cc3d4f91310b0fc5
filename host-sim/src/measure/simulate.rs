//! A whole run: a scenario and a seed enter; the trace leaves, with the literal paper's estimates beside the unit's,
//! and the figures. What has to be of every tick of a long run, such as a file, is told each tick.

use std::io;
use std::path::Path;
use std::time::Instant;

use super::figures::{Summary, Tally};
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
    simulate_beside(scenario, seed, logged, |_, _, _| {}, progress)
}

/// The same, and `each` sees every tick: its time, the trace with the latest tick of every vehicle and the frames that were logged before
/// it, which `each` may take out, and the estimate of the literal paper's method.
///
/// # Errors
/// An error that a unit finds in the configuration from the scenario.
pub fn simulate_beside(
    scenario: &Scenario,
    seed: u64,
    logged: Option<usize>,
    mut each: impl FnMut(f64, &mut Trace, Option<f64>),
    progress: impl FnMut(f64),
) -> Result<(Trace, Summary), Error> {
    let world = World::new(scenario, seed, logged).map_err(|cause| {
        Error::new(format!("the units refuse the scenario: {cause}"), "change the scenario accordingly")
            .in_file(Path::new("scenario"))
    })?;
    let start = Instant::now();
    let mut paper = PaperBeside::of(&world, scenario);
    let mut tally = Tally::new(scenario);
    let beside = |world: &World<'_>, at_s: f64, trace: &mut Trace| -> io::Result<()> {
        let paper_m = paper.note(world, at_s, trace)?;
        tally.note(at_s, &trace.latest, paper_m);
        each(at_s, trace, paper_m);
        Ok(())
    };
    let trace = world
        .run_beside(beside, progress)
        .map_err(|error| Error::new(format!("the bus failed: {error}"), "see the system's log"))?;
    let realtime_factor = scenario.duration_s / start.elapsed().as_secs_f64().max(1e-9);
    Ok((trace, tally.finish(realtime_factor)))
}
