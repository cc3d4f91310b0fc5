//! What can be kept of a run: its events enter; the scenario with them, the log of a bus and the catalogue leave.

use std::path::{Path, PathBuf};

use holdover::time::Instant;
use holdover::wire::Transport;
use holdover::wire::dbc::Dbc;

use super::scene::{Cast, Role};
use crate::bus::candump::LogWriter;
use crate::commands::mcap_file::McapFile;
use crate::error::Error;
use crate::input::impairment::Impairment;
use crate::input::scenario::{Event, Overrides, Scenario, saved};
use crate::measure::simulate::simulate_beside;
use crate::sim::modem::ECU_PEERS;
use crate::sim::time::{EPOCH_US, micros};
use crate::sim::world::{Trace, World, config};

/// The scenario, as it was read.
#[derive(Debug)]
pub struct Archive {
    /// The checked scenario.
    pub scenario: Scenario,
    /// The file that it is from, as errors name it, and its text.
    pub source: (PathBuf, String),
    /// What the command line sets.
    pub overrides: Overrides,
    cast: String,
}

impl Archive {
    /// Of a scenario that is called by this title.
    ///
    /// # Errors
    /// What JSON cannot represent.
    pub fn new(
        scenario: Scenario,
        source: (PathBuf, String),
        overrides: Overrides,
        title: String,
    ) -> Result<Self, Error> {
        let cast = crate::commands::ending::json(&cast_of(&scenario, title))?;
        Ok(Self { scenario, source, overrides, cast })
    }

    /// What stays the same over the run, as JSON.
    #[must_use]
    pub fn cast(&self) -> &str {
        &self.cast
    }

    /// The scenario with these events, as a file that ends after so many ticks.
    ///
    /// # Errors
    /// A recording that has gone.
    pub fn scenario(&self, events: &[Event], ticks: u64) -> Result<String, Error> {
        let (file, text) = &self.source;
        saved::text((file, text), &self.overrides, events, ticks as f64 * self.scenario.period_s)
    }

    /// The frames on the bus of a vehicle over a run with these events, as a candump log; `None` without such a vehicle.
    #[must_use]
    pub fn candump(&self, events: Vec<Event>, ticks: u64, vehicle: usize) -> Option<String> {
        let scenario = self.with(events, ticks);
        if vehicle >= scenario.vehicles.len() {
            return None;
        }
        let world = World::new(&scenario, scenario.seed, Some(vehicle)).ok()?;
        let mut log = LogWriter::new(Vec::new(), "can0")?;
        let instant = |at_s: f64| Instant::from_micros(EPOCH_US.saturating_add_signed(micros(at_s)));
        let trace = world.run(|_| {}).ok()?;
        trace.log.iter().try_for_each(|(at_s, frame)| log.write(instant(*at_s), frame)).ok()?;
        String::from_utf8(log.finish().ok()?).ok()
    }

    /// Writes every tick of a run with these events.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn mcap(&self, events: Vec<Event>, ticks: u64, file: &Path) -> Result<(), Error> {
        let scenario = self.with(events, ticks);
        let mut mcap = McapFile::of(file, &scenario)?;
        let each = |at_s: f64, trace: &mut Trace, paper_m| mcap.note(at_s, &trace.latest, paper_m);
        simulate_beside(&scenario, scenario.seed, None, each, |_| {})?;
        mcap.finish()
    }

    fn with(&self, events: Vec<Event>, ticks: u64) -> Scenario {
        Scenario { events, duration_s: ticks as f64 * self.scenario.period_s, ..self.scenario.clone() }
    }

    /// The messages on the buses.
    #[must_use]
    pub fn dbc(&self) -> String {
        let dbc = Dbc::new(self.scenario.identifiers, ECU_PEERS as u8);
        let is_fd = self.scenario.bus.transport == Transport::Fd;
        if is_fd { dbc.over_fd().to_string() } else { dbc.to_string() }
    }
}

fn cast_of(scenario: &Scenario, title: String) -> Cast {
    let radio = match &scenario.channel.impairment {
        Impairment::Random { delay_mean_s, delay_std_s, loss, .. } => Some([*delay_mean_s, *delay_std_s, *loss]),
        Impairment::Recorded(_) => None,
    };
    let role = |index: usize| {
        let limits = config(scenario, index).limits;
        Role {
            name: match index {
                0 => "leader".into(),
                ego if ego == scenario.ego => format!("{ego} (ego)"),
                other => other.to_string(),
            },
            length_m: scenario.vehicles[index].length_m,
            has_sensor: scenario.vehicles[index].range_sensor.is_some(),
            most_mps2: limits.acceleration.get().to_num(),
            braking_mps2: limits.emergency_braking.get().to_num(),
        }
    };
    Cast {
        title,
        seed: scenario.seed,
        period_s: scenario.period_s,
        ego: scenario.ego,
        radio,
        has_envelope: scenario.envelope.engaged,
        is_recorded: scenario.leader.motion.is_some(),
        vehicles: (0..scenario.vehicles.len()).map(role).collect(),
    }
}
