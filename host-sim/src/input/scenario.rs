//! Scenario files: TOML enters; a checked scenario leaves, or an error with file, line, cause and remedy.
//!
//! Every key has a default, and the defaults together are the paper's scenario. `scenarios/paper.toml` states and
//! explains all keys. The values of a [`Scenario`] have been checked, so its users need not check again.

pub(crate) mod bus;
mod draw;
mod driver;
pub(crate) mod envelope;
pub mod event;
pub(crate) mod keys;
mod plant;
pub mod saved;
pub(crate) mod sensors;
pub(crate) mod set;
mod share;
mod start;
mod validate;

pub use bus::VehicleBus;
pub use driver::Driver;
pub use envelope::Envelope;
pub use event::{Change, DRIVEN_MPS2, Event, Fleet, OUTAGES_S, Part, Radio};
pub use sensors::{Accuracy, Faults, Fitted, RangeSensor};
pub use share::SensorShare;

use crate::error::Error;
use crate::input::impairment::{ChannelModel, Impairment};
use crate::input::kind::{Difference, Kind};
use crate::input::library;
use crate::input::recording::Motion;
use holdover::wire::Identifiers;
use std::fmt;
use std::path::{Path, PathBuf};

/// The most vehicles of a scenario: a leader and a string of ten. A unit has slots for the nearest eight.
pub const MAX_VEHICLES: usize = 11;

/// A scenario of a string of vehicles.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Seed of everything random.
    pub seed: u64,
    /// Length of the run; 2 s to a day. With a recorded leader it is at most the recording's length, which is also the
    /// default.
    pub duration_s: f64,
    /// Tick of every unit and step of the plants; 1 ms to 0.1 s.
    pub period_s: f64,
    /// Prediction step `δt` of the core; 1 ms to 1 s.
    pub step_s: f64,
    /// Rate of every vehicle's messages; 0.1 Hz to one per tick.
    pub message_rate_hz: f64,
    /// The leader.
    pub leader: Leader,
    /// The vehicles in the order of driving, 2 to [`MAX_VEHICLES`]. Index 0 is the leader; each next vehicle follows
    /// the one before.
    pub vehicles: Vec<Vehicle>,
    /// Index of the vehicle that the figures are about. It follows another vehicle, so the index is at least 1.
    pub ego: usize,
    /// The V2X channel.
    pub channel: ChannelModel,
    /// The envelope of every unit.
    pub envelope: Envelope,
    /// Every vehicle's own bus.
    pub bus: VehicleBus,
    /// What is driven and changed during the run, in the order of time.
    pub events: Vec<Event>,
    /// The identifiers on it. A scenario's file does not tell them; a device under test may have its own.
    pub identifiers: Identifiers,
}

/// The motion of the leader.
#[derive(Clone, Debug, PartialEq)]
pub struct Leader {
    /// Target speed on the free road, `v_∞`; 0 to 65.534 m/s.
    pub target_speed_mps: f64,
    /// Target speeds from these times on: `(s, m/s)`, in order of time. Empty: always the target speed above.
    pub program: Vec<(f64, f64)>,
    /// The recorded drive that it replays instead, from its first sample on. Such a leader publishes no driving
    /// parameters.
    pub motion: Option<Motion>,
}

impl Leader {
    /// The target speed of its followers on a free road: its own. Behind a recorded drive, more than a road vehicle
    /// drives.
    #[must_use]
    pub fn followers_target_speed_mps(&self) -> f64 {
        if self.motion.is_some() { 50.0 } else { self.target_speed_mps }
    }
}

/// A vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct Vehicle {
    /// The kind gives its unit's configuration, and its length and lag unless they are given.
    pub kind: Kind,
    /// Where it starts.
    pub start: Start,
    /// Speed at the start; 0 to 65.534 m/s. A leader on a recording starts with the recording's speed.
    pub speed_mps: Span,
    /// Length, bumper to bumper, `l`; 0.5 to 40.95 m.
    pub length_m: f64,
    /// Published time constant of its actuators, `T`; 0 to 1.998 s.
    pub lag_s: f64,
    /// Real time constant of its actuators; 0 to 5 s, `lag_s` by default.
    pub plant_lag_s: f64,
    /// Other differences of its body and its road from what its unit assumes.
    pub difference: Difference,
    /// Time gap, `t_g`; 0.1 to 3.995 s.
    pub time_gap_s: f64,
    /// Time gap to which that opens while the vehicle ahead is neither heard nor seen; 0.1 to 3.995 s.
    pub silent_time_gap_s: f64,
    /// Standstill distance, `s_0`; 0 to 10.23 m.
    pub standstill_m: f64,
    /// Share by which it exceeds the speed that it wants on a free road to catch up with the vehicle ahead; 0 to 0.75.
    pub catch_up: f64,
    /// Share of the acceleration of the vehicle ahead that it passes on; 0 or 0.5. The latter needs `step_s` and `period_s` of at least
    /// 7.813 ms.
    pub feed_forward: f64,
    /// Who drives it; the leader's is always its unit, or a recording.
    pub driver: Driver,
    /// How well it knows its own motion, as it publishes it.
    pub accuracy: Accuracy,
    /// Its range sensor for the vehicle ahead, if it has one.
    pub range_sensor: Option<RangeSensor>,
}

/// Start of a vehicle. Whatever is drawn, no vehicle starts inside the vehicle ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// Position of its front bumper on the lane, in metres.
    Position(Span),
    /// Distance from its front bumper to the rear bumper of the vehicle ahead, in metres.
    Gap(Span),
}

/// A number, or a range from which a number is drawn uniformly; `low <= high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The smallest value.
    pub low: f64,
    /// The largest value; the number itself if it equals `low`.
    pub high: f64,
}

/// The drawn position and speed of a vehicle at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialState {
    /// Front bumper along the lane.
    pub position_m: f64,
    /// Speed along the lane.
    pub speed_mps: f64,
}

/// The values that the command line sets instead of the scenario file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// `--seed`.
    pub seed: Option<u64>,
    /// `--step`.
    pub step_s: Option<f64>,
    /// `--leader-motion`, relative to the current directory.
    pub leader_motion: Option<PathBuf>,
    /// `--channel-trace`, relative to the current directory.
    pub channel_trace: Option<PathBuf>,
    /// `--envelope`.
    pub envelope: Option<Switch>,
    /// `--range-sensors`.
    pub range_sensors: Option<SensorShare>,
    /// Each `--set`, as typed: `key=value`.
    pub set: Vec<String>,
}

impl Overrides {
    /// Those of a study of the estimate from messages alone: without the envelope, which changes commands that nobody can foresee, and
    /// without range sensors.
    pub const MESSAGES_ALONE: Self = Self {
        seed: None,
        step_s: None,
        leader_motion: None,
        channel_trace: None,
        envelope: Some(Switch::Off),
        range_sensors: Some(SensorShare::NONE),
        set: Vec::new(),
    };
}

/// What a switch on the command line is set to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Switch {
    /// On.
    On,
    /// Off.
    Off,
}

impl fmt::Display for Switch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.is_on() { "on" } else { "off" })
    }
}

impl Switch {
    /// Whether it is on.
    #[must_use]
    pub fn is_on(self) -> bool {
        self == Self::On
    }
}

impl Scenario {
    /// The scenario of a file, or of a name in the library, or the paper's if there is no `file`, with the values of
    /// the command line.
    ///
    /// # Errors
    /// A file that cannot be read, text that is not TOML, unknown keys, wrong types, impossible values.
    pub fn read(file: Option<&Path>, overrides: &Overrides) -> Result<Self, Error> {
        let Some(file) = file else { return Self::parse(Path::new(""), "", overrides) };
        let (file, text) = library::text(file)?;
        if library::kind(&file, &text)? == library::Kind::Corridor {
            let error = Error::new("is a corridor, and this needs a string of vehicles", "give it to `run`");
            return Err(error.in_file(&file));
        }
        Self::parse(&file, &text, overrides)
    }

    /// The scenario in the text of a file. Relative paths in it start from the file's folder.
    ///
    /// # Errors
    /// The errors of [`Scenario::read`].
    pub fn parse(file: &Path, text: &str, overrides: &Overrides) -> Result<Self, Error> {
        validate::scenario(file, text, overrides)
    }

    /// What an event of it is checked against.
    #[must_use]
    pub fn fleet(&self) -> Fleet {
        Fleet::of(&self.vehicles, &self.leader)
    }

    /// The files of its recordings.
    pub fn recordings(&self) -> impl Iterator<Item = &Path> {
        let link = match &self.channel.impairment {
            Impairment::Recorded(link) => Some(link.file()),
            Impairment::Random { .. } => None,
        };
        self.leader.motion.as_ref().map(Motion::file).into_iter().chain(link)
    }

    /// What its recordings say that cannot be, and whether the run hears a recorded channel more than once.
    #[must_use]
    pub fn findings(&self) -> Vec<Error> {
        let drive = self.leader.motion.iter().flat_map(Motion::findings).cloned();
        let Impairment::Recorded(link) = &self.channel.impairment else { return drive.collect() };
        drive.chain(link.findings().iter().cloned()).chain(link.repeats(self.duration_s)).collect()
    }

    /// The same scenario with another prediction step.
    ///
    /// # Errors
    /// A step outside 1 ms to 1 s.
    pub fn at_step(&self, step_s: f64) -> Result<Self, Error> {
        Ok(Self { step_s: validate::step(step_s)?, ..self.clone() })
    }

    /// The starts of all vehicles, drawn by a seed; the same for the same seed. Each vehicle has random numbers of its
    /// own. A leader without a position starts so far along the lane that the last vehicle starts at 0 or beyond.
    #[must_use]
    pub fn initial_states(&self, seed: u64) -> Vec<InitialState> {
        draw::initial_states(self, seed)
    }
}
