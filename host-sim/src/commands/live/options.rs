//! The options of `live`: typed values enter, checked options or an error leave.

use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;

use super::archive::{Archive, Piece};
use super::arguments::LiveArguments;
use super::road::RoadPlay;
use crate::commands::ecu::arguments::UnitArguments;
use crate::commands::ecu::options::unit;
use crate::commands::hil::judge::LATENCY_P99_MS;
use crate::commands::hil::session::Setup;
use crate::error::Error;
use crate::input::library::{self, Kind};
use crate::input::scenario::{Overrides, Scenario, VehicleBus};
use crate::output;
use crate::places::can_be_file;
use crate::roads::read;
use crate::sim::quantities::duration;
use crate::sim::world::MOST_TICKS;

/// Longest wait for the first frame of a device, in seconds.
const WAIT_S: f64 = 10.0;
/// With a device the run is no longer than this, in seconds.
const LONGEST_S: f64 = 86_400.0;

/// A live run.
#[derive(Clone, Debug)]
pub struct LiveOptions {
    /// The scenario.
    pub archive: Arc<Archive>,
    /// Where the page is served.
    pub address: SocketAddr,
    /// File of every vehicle's ticks.
    pub mcap: Option<PathBuf>,
    /// The device in the world, if there is one.
    pub device: Option<OnBus>,
    /// Whether a browser is opened.
    pub opens_browser: bool,
}

/// A device on a CAN interface.
#[derive(Clone, Debug)]
pub struct OnBus {
    /// The interface.
    pub bus: String,
    /// The world and the device.
    pub setup: Setup,
    /// The command that starts the device.
    pub command: Option<String>,
}

impl LiveOptions {
    /// Reads and checks the arguments.
    ///
    /// # Errors
    /// An unusable scenario.
    pub fn read(arguments: LiveArguments) -> Result<Self, Error> {
        let mut overrides = Overrides { seed: arguments.seed, set: arguments.set, ..Overrides::default() };
        let (file, text) = match &arguments.scenario {
            Some(named) => library::text(named)?,
            None => (PathBuf::new(), String::new()),
        };
        if let Some(mcap) = &arguments.mcap {
            can_be_file("--mcap", mcap, &[&file])?;
        }
        let mut piece = match library::kind(&file, &text)? {
            Kind::String => Piece::String(Box::new(Scenario::parse(&file, &text, &overrides)?)),
            Kind::Corridor => Piece::Road(Box::new(RoadPlay::new(read::corridor(&file, &text, &overrides)?))),
        };
        if let (Some(vehicle), Some(_), Piece::String(scenario)) = (arguments.unit.vehicle, &arguments.bus, &piece) {
            overrides.set.push(seat(scenario, vehicle)?);
            piece = Piece::String(Box::new(Scenario::parse(&file, &text, &overrides)?));
        }
        let title = match &arguments.scenario {
            Some(named) => named.file_stem().unwrap_or(named.as_os_str()).to_string_lossy().into_owned(),
            None => "the paper's scenario".into(),
        };
        let device = device(&mut piece, arguments.bus, &arguments.unit, arguments.device)?;
        let mut archive = Archive::new(piece, (file, text), overrides, title)?;
        if device.is_some() {
            archive.has_device()?;
        }
        archive.findings().iter().for_each(|finding| output::say(&format!("warning: {finding}")));
        Ok(Self {
            archive: Arc::new(archive),
            address: SocketAddr::new(arguments.listen, arguments.port),
            mcap: arguments.mcap,
            device,
            opens_browser: !arguments.no_browser,
        })
    }
}

/// What makes this vehicle the ego, which the device drives.
fn seat(scenario: &Scenario, vehicle: usize) -> Result<String, Error> {
    let last = scenario.vehicles.len() - 1;
    let cause = match vehicle {
        0 => "is 0, the leader, and a device follows somebody".into(),
        other if other > last => format!("is {other}, and there is no such vehicle"),
        _ => return Ok(format!("ego={vehicle}")),
    };
    Err(Error::new(cause, format!("give an index from 1 to {last}")).in_option("--vehicle"))
}

/// The device, and the world as it is with it.
fn device(
    piece: &mut Piece,
    bus: Option<String>,
    arguments: &UnitArguments,
    command: Option<String>,
) -> Result<Option<OnBus>, Error> {
    let Some(bus) = bus else {
        let given = [
            ("--station", arguments.station.is_some()),
            ("--vehicle", arguments.vehicle.is_some()),
            ("--fd", arguments.fd),
        ];
        return match given.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(Error::new("is of a device", "give its --bus too").in_option(option)),
            None => Ok(None),
        };
    };
    let Piece::String(scenario) = piece else {
        let remedy = "give a string of vehicles, such as paper or motorway";
        return Err(
            Error::new("a device drives in a string of vehicles, and this is a corridor", remedy).in_option("--bus")
        );
    };
    let config = unit(scenario, arguments)?;
    if config.period != duration(scenario.period_s) {
        let cause = format!("`period_s` is {}, and the device ticks every 0.01 s", scenario.period_s);
        return Err(Error::new(cause, "set it to 0.01 for a device with the firmware"));
    }
    scenario.bus = VehicleBus { transport: config.transport, ..scenario.bus };
    scenario.identifiers = config.identifiers;
    // It goes on until it is ended, unless the leader's recording ends before.
    let duration_s = if scenario.leader.motion.is_some() { scenario.duration_s } else { LONGEST_S };
    let world = Scenario { duration_s, ..(**scenario).clone() };
    let setup = Setup {
        scenario: world,
        config,
        wait: duration(WAIT_S),
        latency_p99_ms: LATENCY_P99_MS,
        faults: Vec::new(),
        most_ticks: MOST_TICKS,
    };
    Ok(Some(OnBus { bus, setup, command }))
}
