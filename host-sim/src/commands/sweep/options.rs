//! The options of `sweep`: typed values enter, a checked scenario for each step leaves.

use std::path::PathBuf;

use super::arguments::SweepArguments;
use crate::commands::ending::Destination;
use crate::error::Error;
use crate::input::scenario::{Overrides, Scenario};
use crate::seeds;

/// A sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepOptions {
    /// The scenario.
    pub base: Scenario,
    /// The same scenario at each step, in the order given; at least one.
    pub scenarios: Vec<Scenario>,
    /// The scenario file; `None`: the paper's scenario.
    pub scenario_file: Option<PathBuf>,
    /// The first seed.
    pub seed: u64,
    /// Number of seeds; at least 1.
    pub seeds: u64,
    /// Where its results go.
    pub destination: Destination,
}

impl SweepOptions {
    /// Reads and checks the arguments.
    ///
    /// # Errors
    /// Impossible values, an unusable scenario, and a folder that cannot be written.
    pub fn read(arguments: SweepArguments) -> Result<Self, Error> {
        let SweepArguments { scenario: scenario_file, steps, seeds, seed, envelope, range_sensors, strict, output } =
            arguments;
        let (envelope, range_sensors) = (Some(envelope), Some(range_sensors));
        let overrides = Overrides { seed, envelope, range_sensors, ..Overrides::default() };
        let scenario = Scenario::read(scenario_file.as_deref(), &overrides)?;
        let at_step = |step_s| scenario.at_step(step_s).map_err(|error| error.in_option("--steps"));
        let scenarios = steps.into_iter().map(at_step).collect::<Result<Vec<_>, _>>()?;
        seeds::checked(scenario.seed, seeds)?;
        let destination = output.read()?;
        let destination = destination.with_inputs(scenario_file.as_deref().into_iter().chain(scenario.recordings()))?;
        let destination = destination.with_findings(scenario.findings(), strict)?;
        Ok(Self { seed: scenario.seed, base: scenario, scenarios, scenario_file, seeds, destination })
    }

    /// The last seed.
    #[must_use]
    pub fn last_seed(&self) -> u64 {
        self.seed + (self.seeds - 1)
    }

    /// Number of runs of all steps and seeds.
    #[must_use]
    pub fn runs(&self) -> u64 {
        self.scenarios.len() as u64 * self.seeds
    }
}
