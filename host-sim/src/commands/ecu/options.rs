//! The options of `ecu`: typed values enter, a checked configuration of a unit leaves. `hil` describes its device with
//! the same arguments.

use std::path::Path;

use holdover::Config;
use holdover::wire::catalogue::{CATALOGUE, Node};
use holdover::wire::{Identifier, Identifiers, StationHash, Transport};

use super::arguments::{EcuArguments, UnitArguments};
use crate::error::Error;
use crate::input::scenario::{Overrides, Scenario};
use crate::sim::modem::PEERS;
use crate::sim::vehicle::STEPS;
use crate::sim::world;

/// A unit as a process.
#[derive(Clone, Debug, PartialEq)]
pub struct EcuOptions {
    /// The interface.
    pub bus: String,
    /// The unit.
    pub config: Config,
    /// Whether it ticks by the time synchronisation of the bus.
    pub lock_step: bool,
}

impl EcuOptions {
    /// Reads and checks the arguments.
    ///
    /// # Errors
    /// Impossible values, and an unusable scenario.
    pub fn read(arguments: &EcuArguments) -> Result<Self, Error> {
        let overrides = Overrides { range_sensors: arguments.range_sensors, ..Overrides::default() };
        let scenario = scenario(&arguments.scenario, &overrides)?;
        let config = unit(&scenario, &arguments.unit)?;
        Ok(Self { bus: arguments.bus.clone(), config, lock_step: arguments.lock_step })
    }
}

/// A scenario by its file, or `paper`.
///
/// # Errors
/// The errors of [`Scenario::read`].
pub fn scenario(name: &Path, overrides: &Overrides) -> Result<Scenario, Error> {
    Scenario::read(file_of(name), overrides)
}

/// The file of a scenario; `None`: it is built in.
#[must_use]
pub fn file_of(name: &Path) -> Option<&Path> {
    (name != Path::new("paper") || name.exists()).then_some(name)
}

/// The configuration of a unit: that of a vehicle of the scenario, or that of the firmware.
///
/// # Errors
/// An index without a vehicle, and a scenario that a unit refuses.
pub fn unit(scenario: &Scenario, arguments: &UnitArguments) -> Result<Config, Error> {
    let transport = if arguments.fd { Transport::Fd } else { scenario.bus.transport };
    let identifiers = arguments.identifiers.read(transport, slots())?;
    if let Some(station) = arguments.station {
        return Ok(Config { identifiers, transport, ..Config::car(StationHash(station)) });
    }
    let vehicle = arguments.vehicle.unwrap_or(scenario.ego);
    let last = scenario.vehicles.len() - 1;
    if vehicle > last {
        let remedy = format!("give an index from 0 to {last}");
        return Err(Error::new(format!("there is no vehicle {vehicle}"), remedy).in_option("--vehicle"));
    }
    let config = Config { identifiers, transport, ..world::config(scenario, vehicle) };
    config.check(STEPS).map_err(|cause| {
        Error::new(format!("a unit refuses the scenario: {cause}"), "change the scenario accordingly")
    })?;
    Ok(config)
}

/// The identifiers that a unit listens to.
pub fn heard(identifiers: &Identifiers) -> impl Iterator<Item = Identifier> {
    let lines = CATALOGUE.iter().filter(|line| line.sender != Node::Unit);
    lines.flat_map(|line| identifiers.of_line(line.offset, slots()))
}

/// The slots of a unit here.
#[must_use]
pub fn slots() -> u8 {
    u8::try_from(PEERS).unwrap_or(u8::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_listens_to_the_vehicle_the_modem_and_every_slot() {
        let ids: Vec<u32> = heard(&Identifiers::DEFAULT).map(Identifier::number).collect();
        assert_eq!(ids.len(), 10 + 6 * PEERS);
        assert!(ids.contains(&0x480) && ids.contains(&0x4C0) && ids.contains(&(0x4C0 + 8 * 7 + 5)));
        assert!(!ids.contains(&0x482) && !ids.contains(&(0x4C0 + 8 * u32::try_from(PEERS).unwrap())));
    }

    #[test]
    fn the_unit_is_the_scenarios_ego_unless_it_is_the_firmwares() {
        let paper = scenario(Path::new("paper"), &Overrides::default()).unwrap();
        assert_eq!(unit(&paper, &UnitArguments::default()).unwrap(), world::config(&paper, 2));
        let firmware = unit(&paper, &UnitArguments { station: Some(1), ..UnitArguments::default() }).unwrap();
        assert_eq!(firmware, Config::car(StationHash(1)));
        let beyond = unit(&paper, &UnitArguments { vehicle: Some(5), ..UnitArguments::default() }).unwrap_err();
        assert_eq!(beyond.to_string(), "--vehicle: there is no vehicle 5; give an index from 0 to 4");
    }
}
