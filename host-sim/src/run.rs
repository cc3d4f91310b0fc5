//! `run`: checked options enter, the verdict on the scenario leaves; results on stdout, the rest in files.

use crate::error::Error;
use crate::options::RunOptions;
use crate::output;
use crate::verdict::Verdict;

/// Reads the scenario back: who starts where, under which seed. Nothing is driven, so nothing can be said of it.
///
/// # Errors
/// The results cannot be written.
pub fn run(options: &RunOptions) -> Result<Verdict, Error> {
    let scenario = &options.scenario;
    for (index, state) in scenario.initial_states(scenario.seed).iter().enumerate() {
        let line = format!("vehicle {index} starts at {:.3} m with {:.3} m/s\n", state.position_m, state.speed_mps);
        output::print(&line)?;
    }
    Ok(Verdict::Inconclusive)
}
