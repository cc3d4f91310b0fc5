//! The options of `run` for a string of vehicles: typed values enter, checked options or an error leave.

use std::path::{Path, PathBuf};

use super::arguments::RunArguments;
use super::candump::Candump;
use crate::commands::ending::Destination;
use crate::error::Error;
use crate::input::scenario::{Overrides, Scenario};
use crate::measure::trajectories::{self, Wanted};
use crate::places::can_be_file;
use crate::provenance::shell_word;

/// A run, and where its results go.
#[derive(Clone, Debug, PartialEq)]
pub struct RunOptions {
    /// The scenario, with the values of the command line.
    pub scenario: Scenario,
    /// The scenario file; `None`: the paper's scenario.
    pub scenario_file: Option<PathBuf>,
    /// The other arguments about the scenario, as they would be typed again.
    pub arguments: Vec<String>,
    /// Where its results go.
    pub destination: Destination,
    /// File for the trace of every tick.
    pub trace: Option<PathBuf>,
    /// File for the trajectories of all vehicles.
    pub trajectories: Option<Wanted>,
    /// File of every vehicle's ticks.
    pub mcap: Option<PathBuf>,
    /// The bus to log.
    pub candump: Option<Candump>,
}

impl RunOptions {
    /// Reads and checks the arguments.
    ///
    /// # Errors
    /// Options for a corridor, an unusable scenario, and output that cannot be written.
    pub fn read(RunArguments { scenario: scenario_file, settings }: RunArguments) -> Result<Self, Error> {
        let foreign = [
            ("--seeds", settings.seeds.is_some()),
            ("--vehicles", settings.vehicles.is_some()),
            ("--demand", settings.demand.is_some()),
            ("--slots", settings.slots.is_some()),
            ("--picture", settings.picture.is_some()),
        ];
        if let Some((option, _)) = foreign.iter().find(|(_, is_given)| *is_given) {
            let remedy = "leave it out; `sweep` runs a string with many seeds";
            return Err(Error::new("is for a corridor, and this is a string of vehicles", remedy).in_option(option));
        }
        let overrides = Overrides {
            seed: settings.seed,
            step_s: settings.step,
            leader_motion: settings.leader_motion.clone(),
            channel_trace: settings.channel_trace.clone(),
            envelope: settings.envelope,
            range_sensors: settings.range_sensors,
            set: settings.set.clone(),
        };
        let arguments = typed(&overrides);
        let scenario = Scenario::read(scenario_file.as_deref(), &overrides)?;
        let vehicle = settings.candump_vehicle.unwrap_or(scenario.ego);
        let last = scenario.vehicles.len() - 1;
        if vehicle > last {
            let error = Error::new(format!("there is no vehicle {vehicle}"), format!("give an index from 0 to {last}"));
            return Err(error.in_option("--candump-vehicle"));
        }
        let inputs = [scenario_file.as_ref(), settings.leader_motion.as_ref(), settings.channel_trace.as_ref()];
        let destination = settings.output.read()?;
        let destination = destination.with_inputs(scenario_file.as_deref().into_iter().chain(scenario.recordings()))?;
        let destination = destination.with_findings(scenario.findings(), settings.strict)?;
        let outputs = [
            ("--trace", settings.trace.as_deref()),
            ("--mcap", settings.mcap.as_deref()),
            ("--candump", settings.candump.as_deref()),
        ];
        let mut taken: Vec<&Path> = inputs.into_iter().flatten().map(PathBuf::as_path).collect();
        for (option, file) in outputs {
            if let Some(file) = file {
                can_be_file(option, file, &taken)?;
                taken.push(file);
            }
        }
        let trajectories = trajectories::wanted(settings.trajectories.as_deref(), settings.trajectories_every, &taken)?;
        let candump = settings.candump.map(|file| Candump { file, vehicle });
        Ok(Self {
            scenario,
            scenario_file,
            arguments,
            destination,
            trace: settings.trace,
            trajectories,
            mcap: settings.mcap,
            candump,
        })
    }
}

/// The options that change the scenario, except the seed, as they would be typed again.
fn typed(overrides: &Overrides) -> Vec<String> {
    let file = |option: &str, file: &Option<PathBuf>| file.as_ref().map(|file| format!("{option} {}", file.display()));
    let step = overrides.step_s.map(|step_s| format!("--step {step_s}"));
    let motion = file("--leader-motion", &overrides.leader_motion);
    let trace = file("--channel-trace", &overrides.channel_trace);
    let envelope = overrides.envelope.map(|switch| format!("--envelope={switch}"));
    let sensors = overrides.range_sensors.map(|share| format!("--range-sensors {share}"));
    let set = overrides.set.iter().map(|set| format!("--set {}", shell_word(set)));
    [step, motion, trace, envelope, sensors].into_iter().flatten().chain(set).collect()
}
