//! Scenario files: TOML enters, a checked scenario or an error with file, line, cause and remedy leaves.
//!
//! Every key has a default, and the defaults together are the paper's scenario; `scenarios/paper.toml` states and
//! explains all of them. What stands in a [`Scenario`] has been checked: whoever uses one need not check again.

mod draw;
pub(crate) mod envelope;
pub(crate) mod keys;
mod plant;
mod sensors;
mod start;
mod validate;

pub use envelope::Envelope;
pub use sensors::{Accuracy, RangeSensor};

use crate::error::Error;
use crate::input::impairment::ChannelModel;
use crate::input::kind::{Difference, Kind};
use crate::input::library;
use crate::input::recording::Motion;
use std::path::{Path, PathBuf};

/// The most vehicles of a scenario: a leader and a string of ten. A unit has slots for the eight that are nearest.
pub const MAX_VEHICLES: usize = 11;

/// What happens, to whom, for how long.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Seed of everything random.
    pub seed: u64,
    /// Length of the run; 2 s to a day. With a recorded leader at most, and by default, the recording's length.
    pub duration_s: f64,
    /// Tick of every unit and step of the plants; 1 ms to 0.1 s.
    pub period_s: f64,
    /// Prediction step `δt` of the core; 1 ms to 1 s.
    pub step_s: f64,
    /// How often every vehicle sends its messages; 0.1 Hz to one per tick.
    pub message_rate_hz: f64,
    /// What the first vehicle does.
    pub leader: Leader,
    /// The vehicles in the order of driving; index 0 is the leader and each next one follows the one before. 2 to
    /// [`MAX_VEHICLES`].
    pub vehicles: Vec<Vehicle>,
    /// Index of the vehicle that the figures are about; it follows another one, so it is at least 1.
    pub ego: usize,
    /// The V2X channel.
    pub channel: ChannelModel,
    /// The last gate of every unit.
    pub envelope: Envelope,
}

/// What the first vehicle does.
#[derive(Clone, Debug, PartialEq)]
pub struct Leader {
    /// Speed that it wants on the free road, `v_∞`; 0 to 65.534 m/s.
    pub target_speed_mps: f64,
    /// The speeds that it wants from those times on: `(s, m/s)`, in order of time; empty: always the one above.
    pub program: Vec<(f64, f64)>,
    /// The drive that it follows instead, from its first sample on. A leader on a recording publishes no driving parameters.
    pub motion: Option<Motion>,
}

impl Leader {
    /// The speed that its followers want on a free road: its own; behind a recorded drive, more than a road vehicle drives.
    #[must_use]
    pub fn followers_target_speed_mps(&self) -> f64 {
        if self.motion.is_some() { 50.0 } else { self.target_speed_mps }
    }
}

/// A vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct Vehicle {
    /// What its unit is told of its body, and its length and lag unless they are given.
    pub kind: Kind,
    /// Where it starts.
    pub start: Start,
    /// Speed at the start; 0 to 65.534 m/s. The leader's is the recording's if it drives one.
    pub speed_mps: Span,
    /// Bumper to bumper, `l`; 0.5 to 40.95 m.
    pub length_m: f64,
    /// Time constant of its actuators as it publishes it, `T`; 0 to 1.998 s.
    pub lag_s: f64,
    /// The time constant that its actuators really have; 0 to 5 s, `lag_s` by default.
    pub plant_lag_s: f64,
    /// How its body and its road differ otherwise from what its unit believes.
    pub difference: Difference,
    /// Time gap that it keeps, `t_g`; 0.1 to 3.995 s.
    pub time_gap_s: f64,
    /// Distance that it keeps at standstill, `s_0`; 0 to 10.23 m.
    pub standstill_m: f64,
    /// Share by which it exceeds the speed that it wants on a free road to catch up with the vehicle ahead; 0 to 0.75.
    pub catch_up: f64,
    /// How well it knows its own motion, as it publishes it.
    pub accuracy: Accuracy,
    /// Its sensor of the vehicle ahead, if it has one.
    pub range_sensor: Option<RangeSensor>,
}

/// Where a vehicle starts. No vehicle can start inside the one ahead of it, whatever is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// With its front bumper at that position of the lane, in metres.
    Position(Span),
    /// That far behind the rear bumper of the vehicle ahead, in metres.
    Gap(Span),
}

/// A number, or a range in which one is drawn uniformly; `low <= high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The smallest value.
    pub low: f64,
    /// The largest value; the number itself if it equals `low`.
    pub high: f64,
}

/// Where a vehicle really starts, and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialState {
    /// Front bumper along the lane.
    pub position_m: f64,
    /// Speed along the lane.
    pub speed_mps: f64,
}

/// What the command line says instead of the scenario file.
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
    pub envelope: bool,
}

impl Scenario {
    /// The scenario in that file or of that name in the library, or the paper's if there is none, with what the command line says instead.
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

    /// The scenario in the text of that file; relative paths in it start from the file's folder.
    ///
    /// # Errors
    /// As [`Scenario::read`].
    pub fn parse(file: &Path, text: &str, overrides: &Overrides) -> Result<Self, Error> {
        validate::scenario(file, text, overrides)
    }

    /// The same scenario at another prediction step.
    ///
    /// # Errors
    /// A step outside 1 ms to 1 s.
    pub fn at_step(&self, step_s: f64) -> Result<Self, Error> {
        Ok(Self { step_s: validate::step(step_s)?, ..self.clone() })
    }

    /// Where every vehicle starts, drawn by that seed; the same for the same seed, and each vehicle's own numbers are
    /// drawn apart from those of the others. A leader without a position starts far enough along the lane for the
    /// last vehicle to start at 0 or beyond.
    #[must_use]
    pub fn initial_states(&self, seed: u64) -> Vec<InitialState> {
        draw::initial_states(self, seed)
    }
}
