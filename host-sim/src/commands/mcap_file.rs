//! The file of a run for Foxglove, Lichtblick and other readers of MCAP: the run enters tick by tick; a file leaves with JSON channels and
//! their schemas.
//!
//! | topic | schema | what |
//! |---|---|---|
//! | `/measured` | `holdover.Measured` | what the CSV of `--trace` has, by the same names |
//! | `/vehicle/N` | `holdover.Vehicle` | motion, command, mode, and the estimate of the vehicle ahead with its bound |
//! | `/vehicle/N/fix` | `foxglove.LocationFix` | its place on a map: the lane runs east along the equator from 0° |

use std::path::Path;

use serde::Serialize;

use super::mcap_writer::{FIX, McapWriter, fix, location_fix, properties};
use crate::error::Error;
use crate::input::scenario::Scenario;
use crate::measure::figures::mode_name;
use crate::sim::world::{Measured, Tick};

/// Metres of a degree of the equator, WGS 84.
const DEGREE_M: f64 = 111_319.490_793;

/// The file, as far as it is written.
pub struct McapFile {
    writer: McapWriter,
    measured: Measured,
    length_m: f64,
    channels: Channels,
}

struct Channels {
    measured: u16,
    /// For each vehicle its state, and its place on a map.
    vehicles: Vec<(u16, u16)>,
}

/// A tick of the measured vehicle, as its follower estimates it: the columns of the CSV.
#[derive(Serialize)]
struct Row {
    t_s: f64,
    true_position_m: f64,
    true_speed_mps: f64,
    true_acceleration_mps2: f64,
    estimated_position_m: Option<f64>,
    estimated_speed_mps: Option<f64>,
    age_s: Option<f64>,
    mode: &'static str,
    command_mps2: f64,
    paper_position_m: Option<f64>,
    gap_m: f64,
    lowest_position_m: Option<f64>,
    highest_position_m: Option<f64>,
    lowest_speed_mps: Option<f64>,
    highest_speed_mps: Option<f64>,
    limited: bool,
}

/// A tick of any vehicle.
#[derive(Serialize)]
struct State {
    t_s: f64,
    position_m: f64,
    speed_mps: f64,
    acceleration_mps2: f64,
    command_mps2: f64,
    mode: &'static str,
    limited: bool,
    target_position_m: Option<f64>,
    target_speed_mps: Option<f64>,
    target_error_m: Option<f64>,
    age_s: Option<f64>,
    lowest_position_m: Option<f64>,
    highest_position_m: Option<f64>,
}

impl McapFile {
    /// A file with its channels.
    ///
    /// # Errors
    /// A file that cannot be created.
    pub fn of(file: &Path, scenario: &Scenario) -> Result<Self, Error> {
        let measured = Measured::of(scenario);
        let mut writer = McapWriter::of(file)?;
        let channels = Channels::of(&mut writer, scenario.vehicles.len());
        let length_m = scenario.vehicles[measured.vehicle].length_m;
        Ok(Self { writer, measured, length_m, channels })
    }

    /// Writes a tick of all vehicles.
    pub fn note(&mut self, at_s: f64, ticks: &[Tick], paper_m: Option<f64>) {
        let Measured { vehicle, by } = self.measured;
        let row = row(at_s, &ticks[vehicle], &ticks[by], self.length_m, paper_m);
        self.writer.write(self.channels.measured, at_s, &row);
        for (index, tick) in ticks.iter().enumerate() {
            let (state, place) = self.channels.vehicles[index];
            let ahead = index.checked_sub(1).map(|ahead| &ticks[ahead]);
            self.writer.write(state, at_s, &state_of(at_s, tick, ahead));
            self.writer.write(place, at_s, &fix(at_s, 0.0, tick.position_m / DEGREE_M));
        }
        self.writer.next();
    }

    /// Ends the file.
    ///
    /// # Errors
    /// A file that could not be written.
    pub fn finish(self) -> Result<(), Error> {
        self.writer.finish()
    }
}

impl Channels {
    fn of(writer: &mut McapWriter, vehicles: usize) -> Self {
        let measured = writer.channel("holdover.Measured", &properties(&MEASURED), "/measured");
        let of = |index: usize| {
            let topic = format!("/vehicle/{index}");
            let state = writer.channel("holdover.Vehicle", &properties(&VEHICLE), &topic);
            (state, writer.channel(FIX, &location_fix(), &format!("{topic}/fix")))
        };
        Self { measured, vehicles: (0..vehicles).map(of).collect() }
    }
}

const MEASURED: [&str; 16] = [
    "t_s",
    "true_position_m",
    "true_speed_mps",
    "true_acceleration_mps2",
    "estimated_position_m",
    "estimated_speed_mps",
    "age_s",
    "mode",
    "command_mps2",
    "paper_position_m",
    "gap_m",
    "lowest_position_m",
    "highest_position_m",
    "lowest_speed_mps",
    "highest_speed_mps",
    "limited",
];
const VEHICLE: [&str; 13] = [
    "t_s",
    "position_m",
    "speed_mps",
    "acceleration_mps2",
    "command_mps2",
    "mode",
    "limited",
    "target_position_m",
    "target_speed_mps",
    "target_error_m",
    "age_s",
    "lowest_position_m",
    "highest_position_m",
];

fn row(at_s: f64, truth: &Tick, seen: &Tick, length_m: f64, paper_position_m: Option<f64>) -> Row {
    let bound = seen.target.and_then(|target| target.bound);
    Row {
        t_s: at_s,
        true_position_m: truth.position_m,
        true_speed_mps: truth.speed_mps,
        true_acceleration_mps2: truth.acceleration_mps2,
        estimated_position_m: seen.target.map(|target| target.position_m),
        estimated_speed_mps: seen.target.map(|target| target.speed_mps),
        age_s: seen.target.map(|target| target.age_s),
        mode: mode_name(seen.mode),
        command_mps2: seen.command_mps2,
        paper_position_m,
        gap_m: truth.position_m - length_m - seen.position_m,
        lowest_position_m: bound.map(|bound| bound.lowest_position_m),
        highest_position_m: bound.map(|bound| bound.highest_position_m),
        lowest_speed_mps: bound.map(|bound| bound.lowest_speed_mps),
        highest_speed_mps: bound.map(|bound| bound.highest_speed_mps),
        limited: seen.limited,
    }
}

fn state_of(at_s: f64, tick: &Tick, ahead: Option<&Tick>) -> State {
    let target = tick.target.filter(|_| ahead.is_some());
    let bound = target.and_then(|target| target.bound);
    State {
        t_s: at_s,
        position_m: tick.position_m,
        speed_mps: tick.speed_mps,
        acceleration_mps2: tick.acceleration_mps2,
        command_mps2: tick.command_mps2,
        mode: mode_name(tick.mode),
        limited: tick.limited,
        target_position_m: target.map(|target| target.position_m),
        target_speed_mps: target.map(|target| target.speed_mps),
        target_error_m: target.zip(ahead).map(|(target, ahead)| target.position_m - ahead.position_m),
        age_s: target.map(|target| target.age_s),
        lowest_position_m: bound.map(|bound| bound.lowest_position_m),
        highest_position_m: bound.map(|bound| bound.highest_position_m),
    }
}
