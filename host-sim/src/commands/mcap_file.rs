//! The file of a run for Foxglove, Lichtblick and other readers of MCAP: the run enters tick by tick; a file leaves with JSON channels and
//! their schemas.
//!
//! | topic | schema | what |
//! |---|---|---|
//! | `/measured` | `holdover.Measured` | what the CSV of `--trace` has, by the same names |
//! | `/vehicle/N` | `holdover.Vehicle` | motion, command, mode, and the estimate of the vehicle ahead with its bound |
//! | `/vehicle/N/fix` | `foxglove.LocationFix` | its place on a map: the lane runs east along the equator from 0° |
//!
//! Times are GNSS time of the run, as in a log of its bus. Nothing is compressed, so the file needs no C library.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{McapError, WriteOptions, Writer};
use serde::Serialize;
use serde_json::{Value, json};

use crate::draft::Draft;
use crate::error::Error;
use crate::input::scenario::Scenario;
use crate::measure::figures::mode_name;
use crate::sim::time::gnss;
use crate::sim::world::{Measured, Tick};

/// Metres of a degree of the equator, WGS 84.
const DEGREE_M: f64 = 111_319.490_793;

/// The file, as far as it is written.
pub struct McapFile {
    file: PathBuf,
    writer: Writer<NoSeek<Draft>>,
    measured: Measured,
    length_m: f64,
    channels: Channels,
    sequence: u32,
    /// The first failure. After it nothing more is written, and the run goes on.
    written: Result<(), McapError>,
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
        let options = WriteOptions::new().compression(None).disable_seeking(true).library("holdover-sim");
        let draft = NoSeek::new(Draft::of(file)?);
        let created = options.create(draft).and_then(|mut writer| {
            let channels = Channels::of(&mut writer, scenario.vehicles.len())?;
            Ok((writer, channels))
        });
        let (writer, channels) = created.map_err(|error| unwritable(file, error))?;
        let length_m = scenario.vehicles[measured.vehicle].length_m;
        Ok(Self { file: file.to_owned(), writer, measured, length_m, channels, sequence: 0, written: Ok(()) })
    }

    /// Writes a tick of all vehicles.
    pub fn note(&mut self, at_s: f64, ticks: &[Tick], paper_m: Option<f64>) {
        if self.written.is_ok() {
            self.written = self.tick(at_s, ticks, paper_m);
        }
    }

    /// Ends the file.
    ///
    /// # Errors
    /// A file that could not be written.
    pub fn finish(self) -> Result<(), Error> {
        let Self { file, mut writer, written, .. } = self;
        written.and_then(|()| writer.finish()).map_err(|error| unwritable(&file, error))?;
        writer.into_inner().into_inner().finish()
    }

    fn tick(&mut self, at_s: f64, ticks: &[Tick], paper_m: Option<f64>) -> Result<(), McapError> {
        let Measured { vehicle, by } = self.measured;
        let row = row(at_s, &ticks[vehicle], &ticks[by], self.length_m, paper_m);
        self.write(self.channels.measured, at_s, &row)?;
        for (index, tick) in ticks.iter().enumerate() {
            let (state, fix) = self.channels.vehicles[index];
            let ahead = index.checked_sub(1).map(|ahead| &ticks[ahead]);
            self.write(state, at_s, &state_of(at_s, tick, ahead))?;
            self.write(fix, at_s, &fix_of(at_s, tick))?;
        }
        self.sequence += 1;
        Ok(())
    }

    fn write(&mut self, channel_id: u16, at_s: f64, message: &impl Serialize) -> Result<(), McapError> {
        let at = gnss(at_s).as_micros() * 1_000;
        let header = MessageHeader { channel_id, sequence: self.sequence, log_time: at, publish_time: at };
        let data = serde_json::to_vec(message).map_err(io::Error::other)?;
        self.writer.write_to_known_channel(&header, &data)
    }
}

impl Channels {
    fn of(writer: &mut Writer<NoSeek<Draft>>, vehicles: usize) -> Result<Self, McapError> {
        let mut schema = |name: &str, properties: Value| {
            let text = json!({ "title": name, "type": "object", "properties": properties }).to_string();
            writer.add_schema(name, "jsonschema", text.as_bytes())
        };
        let measured = schema("holdover.Measured", properties(&MEASURED))?;
        let vehicle = schema("holdover.Vehicle", properties(&VEHICLE))?;
        let fix = schema("foxglove.LocationFix", location_fix())?;
        let mut channel = |schema, topic: &str| writer.add_channel(schema, topic, "json", &BTreeMap::new());
        let measured = channel(measured, "/measured")?;
        let of = |index: usize| {
            let topic = format!("/vehicle/{index}");
            Ok((channel(vehicle, &topic)?, channel(fix, &format!("{topic}/fix"))?))
        };
        Ok(Self { measured, vehicles: (0..vehicles).map(of).collect::<Result<_, McapError>>()? })
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

/// What a schema says of these names; a number that is not known is null.
fn properties(names: &[&str]) -> Value {
    let kind = |name: &str| match name {
        "mode" => json!({ "type": "string" }),
        "limited" => json!({ "type": "boolean" }),
        _ => json!({ "type": ["number", "null"] }),
    };
    names.iter().map(|name| ((*name).to_owned(), kind(name))).collect()
}

fn location_fix() -> Value {
    let number = json!({ "type": "number" });
    let time =
        json!({ "type": "object", "properties": { "sec": { "type": "integer" }, "nsec": { "type": "integer" } } });
    json!({
        "timestamp": time,
        "frame_id": { "type": "string" },
        "latitude": number,
        "longitude": number,
        "altitude": number,
        "position_covariance": { "type": "array", "items": number },
        "position_covariance_type": { "type": "integer" },
    })
}

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

fn fix_of(at_s: f64, tick: &Tick) -> Value {
    let micros = gnss(at_s).as_micros();
    json!({
        "timestamp": { "sec": micros / 1_000_000, "nsec": micros % 1_000_000 * 1_000 },
        "frame_id": "earth",
        "latitude": 0.0,
        "longitude": tick.position_m / DEGREE_M,
        "altitude": 0.0,
        "position_covariance": [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        "position_covariance_type": 0,
    })
}

fn unwritable(file: &Path, error: McapError) -> Error {
    let error = match error {
        McapError::Io(error) => error,
        other => io::Error::other(other.to_string()),
    };
    Error::unwritable(file, &error)
}
