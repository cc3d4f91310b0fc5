//! The options of `replay`: typed values enter, a log to read and a checked configuration leave.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use holdover::Config;
use holdover::coordination::Itinerary;
use holdover::wire::{StationHash, Transport};

use super::arguments::ReplayArguments;
use crate::bus::candump::Interface;
use crate::commands::corridor::options::exists;
use crate::commands::ecu::options::slots;
use crate::error::{Error, quoted};
use crate::input::library;
use crate::input::scenario::{Overrides, Scenario};
use crate::roads::conditions::{self, Conditions, Identity};
use crate::roads::description::Corridor;
use crate::roads::experiment::of_seed;
use crate::roads::map::itineraries;
use crate::roads::network::Network;
use crate::roads::read;
use crate::sim::quantities::duration;
use crate::sim::station::STATIONS;
use crate::sim::vehicle::STEPS;
use crate::sim::world;

/// A replay.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplayOptions {
    /// The log; `None`: standard input.
    pub log: Option<PathBuf>,
    /// The unit.
    pub config: Config,
    /// Its way through intersections, if it has one.
    pub itinerary: Option<&'static Itinerary>,
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
        let ReplayArguments {
            log, bus, scenario, vehicle, seed, station, identifiers, period, step, interface, ..
        } = arguments;
        let overrides = Overrides { seed, step_s: step, ..Overrides::default() };
        let (mut config, itinerary) = match (&scenario, vehicle) {
            (None, None) => (of_a_car(station, period, step)?, None),
            (None, vehicle) => (of_string(None, vehicle, &overrides)?, None),
            (Some(named), vehicle) => of_scenario(named, vehicle, &overrides)?,
        };
        if arguments.fd {
            config.transport = Transport::Fd;
        }
        config.identifiers = identifiers.read(config.transport, slots())?;
        let output = match (bus, arguments.json, arguments.summary) {
            (Some(bus), ..) => Output::Bus(bus),
            (None, true, _) => Output::Json,
            (None, false, true) => Output::Summary,
            (None, false, false) => Output::Frames,
        };
        let interface = interface.map(|name| self::interface(&name)).transpose()?;
        Ok(Self { log: (log != Path::new("-")).then_some(log), config, itinerary, interface, output })
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

fn of_scenario(
    named: &Path,
    vehicle: Option<usize>,
    overrides: &Overrides,
) -> Result<(Config, Option<&'static Itinerary>), Error> {
    let (file, text) = library::text(named)?;
    match library::kind(&file, &text)? {
        library::Kind::String => Ok((of_string(Some(named), vehicle, overrides)?, None)),
        library::Kind::Corridor => {
            let (config, itinerary) = of_corridor(&read::corridor(&file, &text, overrides)?, vehicle)?;
            Ok((config, Some(itinerary)))
        }
    }
}

/// The unit of a vehicle in a corridor, and its way.
fn of_corridor(corridor: &Corridor, vehicle: Option<usize>) -> Result<(Config, &'static Itinerary), Error> {
    let network = Network::of(corridor);
    let (trips, ego) = of_seed(corridor, corridor.seed);
    let vehicle = vehicle.or(ego).ok_or_else(|| {
        Error::new("no vehicle of this seed is the ego", "name one by --vehicle").in_option("--scenario")
    })?;
    exists("--vehicle", vehicle, trips.len())?;
    // The numbers of the first vehicles are their indices. Later ones depend on the vehicles that are under way then.
    if vehicle >= STATIONS {
        let cause = format!("the station of vehicle {vehicle} is known in a run only");
        return Err(Error::new(cause, format!("give an index below {STATIONS}")).in_option("--vehicle"));
    }
    let trip = &trips[vehicle];
    let conditions = Conditions::of(corridor);
    let identity = Identity::of(corridor, &conditions, corridor.seed, vehicle, vehicle);
    let config = conditions::config(corridor, &conditions, identity, trip.kind);
    Ok((config, itineraries(&network)[trip.road]))
}

/// The unit of a vehicle in a string.
fn of_string(file: Option<&Path>, vehicle: Option<usize>, overrides: &Overrides) -> Result<Config, Error> {
    let scenario = Scenario::read(file, overrides)?;
    let vehicle = vehicle.unwrap_or(scenario.ego);
    exists("--vehicle", vehicle, scenario.vehicles.len())?;
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
