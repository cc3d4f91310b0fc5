//! What can be kept of a run: its events enter; the scenario with them, the log of a bus and the catalogue leave.

use std::path::{Path, PathBuf};

use holdover::time::Instant;
use holdover::wire::dbc::Dbc;
use holdover::wire::{Identifiers, Transport};

use super::road::RoadPlay;
use super::road_scene;
use super::scene::{Cast, Role};
use super::stage::Play;
use crate::bus::candump::LogWriter;
use crate::commands::mcap_file::McapFile;
use crate::commands::mcap_road::RoadMcap;
use crate::error::Error;
use crate::input::impairment::Impairment;
use crate::input::scenario::{Event, Overrides, Scenario, saved};
use crate::measure::simulate::simulate_beside;
use crate::roads::Corridor;
use crate::roads::experiment::refused;
use crate::sim::modem::ECU_PEERS;
use crate::sim::time::{EPOCH_US, micros};
use crate::sim::world::{Trace, World, config};

/// What is played.
pub enum Piece {
    /// A string of vehicles.
    String(Box<Scenario>),
    /// A corridor.
    Road(Box<RoadPlay>),
}

/// What is played, and what it was read from.
pub struct Archive {
    /// What is played.
    pub piece: Piece,
    /// The file that it is from, as errors name it, and its text.
    pub source: (PathBuf, String),
    /// What the command line sets.
    pub overrides: Overrides,
    cast: Cast,
    said: String,
}

impl std::fmt::Debug for Archive {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Archive").field("source", &self.source.0).finish_non_exhaustive()
    }
}

impl Archive {
    /// Of a scenario that is called by this title.
    ///
    /// # Errors
    /// What JSON cannot represent.
    pub fn new(piece: Piece, source: (PathBuf, String), overrides: Overrides, title: String) -> Result<Self, Error> {
        let cast = match &piece {
            Piece::String(scenario) => cast_of(scenario, title),
            Piece::Road(road) => cast_of_road(road, title),
        };
        Ok(Self { said: crate::commands::ending::json(&cast)?, cast, piece, source, overrides })
    }

    /// What stays the same over the run, as JSON.
    #[must_use]
    pub fn cast(&self) -> &str {
        &self.said
    }

    /// From now on a device drives the ego.
    ///
    /// # Errors
    /// What JSON cannot represent.
    pub fn has_device(&mut self) -> Result<(), Error> {
        self.cast.device = Some(self.cast.ego);
        self.said = crate::commands::ending::json(&self.cast)?;
        Ok(())
    }

    /// Whether a device drives this vehicle, whose log only the interface has.
    #[must_use]
    pub fn is_device(&self, vehicle: usize) -> bool {
        self.cast.device == Some(vehicle)
    }

    /// What the scenario's recordings say that cannot be.
    #[must_use]
    pub fn findings(&self) -> Vec<Error> {
        match &self.piece {
            Piece::String(scenario) => scenario.findings(),
            Piece::Road(_) => Vec::new(),
        }
    }

    fn period_s(&self) -> f64 {
        match &self.piece {
            Piece::String(scenario) => scenario.period_s,
            Piece::Road(road) => road.period_s(),
        }
    }

    /// The scenario with these events, as a file that ends after so many ticks.
    ///
    /// # Errors
    /// A recording that has gone.
    pub fn scenario(&self, events: &[Event], ticks: u64) -> Result<String, Error> {
        let (file, text) = &self.source;
        saved::text((file, text), &self.overrides, events, ticks as f64 * self.period_s())
    }

    /// The frames on the bus of a vehicle over a run with these events, as a candump log; `None` without such a vehicle.
    #[must_use]
    pub fn candump(&self, events: Vec<Event>, ticks: u64, vehicle: usize) -> Option<String> {
        let frames = match &self.piece {
            Piece::String(scenario) => {
                let scenario = with(scenario, events, ticks);
                scenario.vehicles.get(vehicle)?;
                World::new(&scenario, scenario.seed, Some(vehicle)).ok()?.run(|_| {}).ok()?.log
            }
            Piece::Road(road) => road.log(&events, ticks, vehicle)?,
        };
        let mut log = LogWriter::new(Vec::new(), "can0")?;
        let instant = |at_s: f64| Instant::from_micros(EPOCH_US.saturating_add_signed(micros(at_s)));
        frames.iter().try_for_each(|(at_s, frame)| log.write(instant(*at_s), frame)).ok()?;
        String::from_utf8(log.finish().ok()?).ok()
    }

    /// Writes every tick of a run with these events.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn mcap(&self, events: Vec<Event>, ticks: u64, file: &Path) -> Result<(), Error> {
        match &self.piece {
            Piece::String(scenario) => {
                let scenario = with(scenario, events, ticks);
                let mut mcap = McapFile::of(file, &scenario)?;
                let each = |at_s: f64, trace: &mut Trace, paper_m| mcap.note(at_s, &trace.latest, paper_m);
                simulate_beside(&scenario, scenario.seed, None, each, |_| {})?;
                mcap.finish()
            }
            Piece::Road(road) => {
                let mut mcap = RoadMcap::of(file, &road.experiment.network)?;
                road.again(&events, ticks, None, &mut [&mut mcap]).map_err(refused)?;
                mcap.finish()
            }
        }
    }

    /// The messages on the buses.
    #[must_use]
    pub fn dbc(&self) -> String {
        let (identifiers, transport) = match &self.piece {
            Piece::String(scenario) => (scenario.identifiers, scenario.bus.transport),
            Piece::Road(road) => (Identifiers::DEFAULT, road.experiment.corridor.bus.transport),
        };
        let dbc = Dbc::new(identifiers, ECU_PEERS as u8);
        if transport == Transport::Fd { dbc.over_fd().to_string() } else { dbc.to_string() }
    }
}

fn with(scenario: &Scenario, events: Vec<Event>, ticks: u64) -> Scenario {
    Scenario { events, duration_s: ticks as f64 * scenario.period_s, ..scenario.clone() }
}

fn cast_of_road(road: &RoadPlay, title: String) -> Cast {
    let Corridor { seed, period_s, radio, envelope, .. } = &road.experiment.corridor;
    Cast {
        title,
        seed: *seed,
        period_s: *period_s,
        ego: road.ego.unwrap_or(0),
        radio: Some([radio.delay_mean_s, radio.delay_std_s, radio.loss]),
        has_envelope: envelope.engaged,
        is_recorded: false,
        vehicles: Vec::new(),
        device: None,
        map: Some(road_scene::map(road)),
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
        device: None,
        map: None,
    }
}
