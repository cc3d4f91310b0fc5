//! The options of `hil`: typed values enter, a checked setup leaves.

use std::path::PathBuf;

use super::arguments::HilArguments;
use super::fault::{Fault, Kind};
use super::session::Setup;
use crate::commands::ecu::options::{file_of, scenario, unit};
use crate::commands::ending::Destination;
use crate::error::Error;
use crate::input::scenario::{Overrides, Scenario, VehicleBus};
use crate::places::can_be_file;
use crate::sim::quantities::duration;
use crate::sim::world::MOST_TICKS;

/// A run with hardware in the loop.
#[derive(Clone, Debug)]
pub struct HilOptions {
    /// The interface.
    pub bus: String,
    /// The setup of the run.
    pub setup: Setup,
    /// The scenario's name.
    pub name: String,
    /// Whether the run is in lock step.
    pub lock_step: bool,
    /// The command that starts the device.
    pub device: Option<String>,
    /// File of every vehicle's ticks.
    pub mcap: Option<PathBuf>,
    /// Where its results go.
    pub destination: Destination,
}

impl HilOptions {
    /// Reads and checks the arguments.
    ///
    /// # Errors
    /// Impossible values, values that do not fit together, and an unusable scenario.
    pub fn read(arguments: HilArguments) -> Result<Self, Error> {
        let (seed, range_sensors) = (arguments.seed, arguments.range_sensors);
        let overrides = Overrides { seed, range_sensors, ..Overrides::default() };
        let scenario = scenario(&arguments.scenario, &overrides)?;
        if let Some(vehicle) = arguments.unit.vehicle {
            let error =
                Error::new(format!("is {vehicle}"), format!("leave it out: the device is the ego, {}", scenario.ego));
            return Err(error.in_option("--vehicle"));
        }
        let config = unit(&scenario, &arguments.unit)?;
        let bus = VehicleBus { transport: config.transport, ..scenario.bus };
        let scenario = Scenario { bus, identifiers: config.identifiers, ..scenario };
        if config.period != duration(scenario.period_s) {
            let cause = format!("`period_s` is {}, and the device ticks every 0.01 s", scenario.period_s);
            let error = Error::new(cause, "set it to 0.01 for a device with the firmware");
            return Err(file_of(&arguments.scenario).map_or(error.clone(), |file| error.in_file(file)));
        }
        if !(0.1..=3600.0).contains(&arguments.wait) {
            let error = Error::new(format!("is {}", arguments.wait), "give seconds from 0.1 to 3600");
            return Err(error.in_option("--wait"));
        }
        if !(1.0..=1000.0).contains(&arguments.latency) {
            let error = Error::new(format!("is {}", arguments.latency), "give milliseconds from 1 to 1000");
            return Err(error.in_option("--latency"));
        }
        let faults = arguments.fault.iter().map(|fault| fault.parse()).collect::<Result<Vec<Fault>, Error>>()?;
        let refuse = |cause: &str, remedy: &str| Err(Error::new(cause, remedy).in_option("--fault"));
        if arguments.lock_step && !faults.is_empty() {
            return refuse("in lock step there is no time for a fault to happen in", "leave out --lock-step");
        }
        if arguments.device.is_none() && faults.iter().any(|fault| fault.kind == Kind::Power) {
            return refuse("power cannot be cut from a device that was not started here", "give --device COMMAND");
        }
        if let Some(late) = faults.iter().find(|fault| fault.from_s >= scenario.duration_s) {
            let cause = format!("{} begins at {} s, after the run", late.kind.name(), late.from_s);
            return refuse(&cause, &format!("give a time before {} s", scenario.duration_s));
        }
        if let Some(file) = &arguments.mcap {
            can_be_file("--mcap", file, &[&arguments.scenario])?;
        }
        let destination = Destination::new(arguments.json, arguments.out)?;
        let destination =
            destination.with_inputs(file_of(&arguments.scenario).into_iter().chain(scenario.recordings()))?;
        let destination = destination.with_findings(scenario.findings(), false)?;
        Ok(Self {
            bus: arguments.bus,
            setup: Setup {
                scenario,
                config,
                wait: duration(arguments.wait),
                latency_p99_ms: arguments.latency,
                faults,
                // The file has every tick.
                most_ticks: if arguments.mcap.is_some() { usize::MAX } else { MOST_TICKS },
            },
            name: arguments.scenario.display().to_string(),
            lock_step: arguments.lock_step,
            device: arguments.device,
            mcap: arguments.mcap,
            destination,
        })
    }
}
