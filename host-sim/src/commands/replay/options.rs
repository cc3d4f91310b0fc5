//! The options of `replay`: typed values enter, a log to read and a checked configuration leave.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use holdover::Config;
use holdover::wire::StationHash;

use super::arguments::ReplayArguments;
use crate::bus::candump::Interface;
use crate::commands::base_id;
use crate::error::{Error, quoted};
use crate::input::scenario::{Overrides, Scenario};
use crate::sim::quantities::duration;
use crate::sim::vehicle::STEPS;
use crate::sim::world;

/// A replay.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplayOptions {
    /// The log; `None`: standard input.
    pub log: Option<PathBuf>,
    /// The unit.
    pub config: Config,
    /// The interface to replay; `None`: that of the first frame.
    pub interface: Option<Interface>,
    /// The output.
    pub output: Output,
}

/// The output of a replay.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Output {
    /// The log's own frames, on this interface; no unit runs.
    Bus(String),
    /// The unit's frames.
    Frames,
    /// The summary as text.
    Summary,
    /// The summary as JSON.
    Json,
}

impl ReplayOptions {
    /// Reads and checks the arguments.
    ///
    /// # Errors
    /// Impossible values, and an unusable scenario.
    pub fn read(arguments: ReplayArguments) -> Result<Self, Error> {
        let ReplayArguments { log, bus, scenario, vehicle, station, base_id, period, step, interface, summary, json } =
            arguments;
        let mut config = match (&scenario, vehicle) {
            (None, None) => of_a_car(station, period, step)?,
            (file, vehicle) => of_scenario(file.as_deref(), vehicle, step)?,
        };
        config.base_id = base_id::checked(base_id)?;
        let output = match (bus, json, summary) {
            (Some(bus), ..) => Output::Bus(bus),
            (None, true, _) => Output::Json,
            (None, false, true) => Output::Summary,
            (None, false, false) => Output::Frames,
        };
        let interface = interface.map(|name| self::interface(&name)).transpose()?;
        Ok(Self { log: (log != Path::new("-")).then_some(log), config, interface, output })
    }
}

fn of_a_car(station: Option<u8>, period_s: Option<f64>, step_s: Option<f64>) -> Result<Config, Error> {
    let mut config = Config::car(StationHash(station.unwrap_or(1)));
    if let Some(period_s) = period_s {
        config.period = duration(within("--period", period_s, 0.001..=0.1)?);
    }
    if let Some(step_s) = step_s {
        config.prediction.step = duration(within("--step", step_s, 0.001..=1.0)?);
        config.prediction.horizon = world::horizon(world::HORIZON_S, step_s);
    }
    Ok(config)
}

fn of_scenario(file: Option<&Path>, vehicle: Option<usize>, step_s: Option<f64>) -> Result<Config, Error> {
    let scenario = Scenario::read(file, &Overrides { step_s, ..Overrides::default() })?;
    let vehicle = vehicle.unwrap_or(scenario.ego);
    let last = scenario.vehicles.len() - 1;
    if vehicle > last {
        let remedy = format!("give an index from 0 to {last}");
        return Err(Error::new(format!("there is no vehicle {vehicle}"), remedy).in_option("--vehicle"));
    }
    let config = world::config(&scenario, vehicle);
    config.check(STEPS).map_err(|cause| {
        Error::new(format!("a unit refuses the scenario: {cause}"), "change the scenario accordingly")
            .in_file(file.unwrap_or(Path::new("scenario")))
    })?;
    Ok(config)
}

fn within(option: &str, value: f64, limits: RangeInclusive<f64>) -> Result<f64, Error> {
    if limits.contains(&value) {
        return Ok(value);
    }
    let remedy = format!("give seconds from {} to {}", limits.start(), limits.end());
    Err(Error::new(format!("is {value}"), remedy).in_option(option))
}

fn interface(name: &str) -> Result<Interface, Error> {
    let fits = !name.is_empty() && !name.contains(|c: char| c.is_whitespace() || c.is_control());
    Interface::try_from(name).ok().filter(|_| fits).ok_or_else(|| {
        Error::new(format!("{} is no network interface", quoted(name)), "give a name as it stands in the log")
            .in_option("--interface")
    })
}
