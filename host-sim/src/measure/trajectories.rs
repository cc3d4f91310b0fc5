//! The trajectories of all vehicles, as a file: what is true of each vehicle and what its unit believes of its target enters, tick by tick;
//! a table (CSV), or the floating-car data that SUMO writes (FCD, XML), leaves.
//!
//! Positions of a row are on the axis of its vehicle: distances along its road, or along the one lane of a string. The true position of the
//! target is given on that axis too, so that error and bound can be read off a row.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use holdover::wire::command::ModeCode;
use serde::Serialize;

use super::figures::mode_name;
use crate::draft::Draft;
use crate::error::Error;
use crate::sim::world::TargetBelief;

/// How a vehicle moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moves {
    /// Front bumper.
    pub position_m: f64,
    /// Speed.
    pub speed_mps: f64,
}

/// A vehicle at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Index of its road; 0 for a string.
    pub road: usize,
    /// East and north of the first place of the first road.
    pub place_m: (f64, f64),
    /// Clockwise from north, in degrees.
    pub heading_deg: f64,
    /// Its motion.
    pub moves: Moves,
    /// Acceleration reached.
    pub acceleration_mps2: f64,
    /// Acceleration that its unit commanded.
    pub command_mps2: f64,
    /// Its unit's mode.
    pub mode: ModeCode,
    /// Whether its envelope changed the command.
    pub limited: bool,
    /// The vehicle that it follows, and how that really moves.
    pub target: Option<(usize, Moves)>,
    /// What its unit believes of that vehicle.
    pub belief: Option<TargetBelief>,
}

/// A row of the table.
#[derive(Serialize)]
struct Row {
    t_s: f64,
    vehicle: usize,
    road: usize,
    x_m: f64,
    y_m: f64,
    position_m: f64,
    speed_mps: f64,
    acceleration_mps2: f64,
    command_mps2: f64,
    mode: &'static str,
    limited: u8,
    target: Option<usize>,
    target_position_m: Option<f64>,
    target_speed_mps: Option<f64>,
    estimated_position_m: Option<f64>,
    estimated_speed_mps: Option<f64>,
    age_s: Option<f64>,
    lowest_position_m: Option<f64>,
    highest_position_m: Option<f64>,
    lowest_speed_mps: Option<f64>,
    highest_speed_mps: Option<f64>,
}

/// A number to a thousandth of a millimetre, so that a file is no longer than what it says.
fn rounded(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}

impl Row {
    fn of(at_s: f64, seen: &Seen) -> Self {
        let target = seen.target.map(|(_, moves)| moves);
        let bound = seen.belief.and_then(|belief| belief.bound);
        Self {
            t_s: rounded(at_s),
            vehicle: seen.vehicle,
            road: seen.road,
            x_m: rounded(seen.place_m.0),
            y_m: rounded(seen.place_m.1),
            position_m: rounded(seen.moves.position_m),
            speed_mps: rounded(seen.moves.speed_mps),
            acceleration_mps2: rounded(seen.acceleration_mps2),
            command_mps2: rounded(seen.command_mps2),
            mode: mode_name(seen.mode),
            limited: u8::from(seen.limited),
            target: seen.target.map(|(index, _)| index),
            target_position_m: target.map(|target| rounded(target.position_m)),
            target_speed_mps: target.map(|target| rounded(target.speed_mps)),
            estimated_position_m: seen.belief.map(|belief| rounded(belief.position_m)),
            estimated_speed_mps: seen.belief.map(|belief| rounded(belief.speed_mps)),
            age_s: seen.belief.map(|belief| rounded(belief.age_s)),
            lowest_position_m: bound.map(|bound| rounded(bound.lowest_position_m)),
            highest_position_m: bound.map(|bound| rounded(bound.highest_position_m)),
            lowest_speed_mps: bound.map(|bound| rounded(bound.lowest_speed_mps)),
            highest_speed_mps: bound.map(|bound| rounded(bound.highest_speed_mps)),
        }
    }
}

/// Where they go, and how often.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// The file: `.csv` or `.xml`.
    pub file: PathBuf,
    /// Time from one row of a vehicle to the next.
    pub every_s: f64,
}

impl Wanted {
    /// What the command line asks for.
    ///
    /// # Errors
    /// A file of another kind, and a time that is not from 1 ms to 60 s.
    pub fn read(file: PathBuf, every_s: f64) -> Result<Self, Error> {
        let extension = file.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        if !["csv", "xml"].contains(&extension) {
            let cause = format!("{} is of no kind that can be written", file.display());
            return Err(Error::new(cause, "name it .csv, or .xml for SUMO's FCD").in_option("--trajectories"));
        }
        if !(1e-3..=60.0).contains(&every_s) {
            let error = Error::new(format!("is {every_s}"), "give seconds from 0.001 to 60");
            return Err(error.in_option("--trajectories-every"));
        }
        Ok(Self { file, every_s })
    }
}

enum Form {
    Table(Box<csv::Writer<Draft>>),
    Fcd(Draft),
}

/// The file, as far as it is written.
pub struct Trajectories {
    file: PathBuf,
    form: Form,
    every_s: f64,
    rows: u64,
    /// The first failure. After it nothing more is written, and the run goes on.
    written: io::Result<()>,
}

impl Trajectories {
    /// An empty file.
    ///
    /// # Errors
    /// A file that cannot be created.
    pub fn of(wanted: &Wanted) -> Result<Self, Error> {
        let mut draft = Draft::of(&wanted.file)?;
        let is_fcd = wanted.file.extension().is_some_and(|extension| extension == "xml");
        let (form, written) = if is_fcd {
            let written = writeln!(draft, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fcd-export>");
            (Form::Fcd(draft), written)
        } else {
            (Form::Table(Box::new(csv::Writer::from_writer(draft))), Ok(()))
        };
        Ok(Self { file: wanted.file.clone(), form, every_s: wanted.every_s, rows: 0, written })
    }

    /// Notes all vehicles at a time, if it is time for a row. Times grow.
    pub fn note(&mut self, at_s: f64, vehicles: impl Iterator<Item = Seen>) {
        // Due times are counted, so that no rounding adds up.
        if self.written.is_err() || at_s < self.rows as f64 * self.every_s - 1e-9 {
            return;
        }
        self.rows = (at_s / self.every_s + 1e-9) as u64 + 1;
        self.written = match &mut self.form {
            Form::Table(table) => table_rows(table, at_s, vehicles),
            Form::Fcd(out) => timestep(out, at_s, vehicles),
        };
    }

    /// Ends the file.
    ///
    /// # Errors
    /// A file that could not be written.
    pub fn finish(self) -> Result<(), Error> {
        let ended = |form: Form| match form {
            Form::Table(table) => table.into_inner().map_err(|error| io::Error::other(error.to_string())),
            Form::Fcd(mut draft) => writeln!(draft, "</fcd-export>").map(|()| draft),
        };
        let ended = self.written.and_then(|()| ended(self.form));
        ended.map_err(|error| Error::unwritable(&self.file, &error))?.finish()
    }
}

fn table_rows(table: &mut csv::Writer<Draft>, at_s: f64, mut vehicles: impl Iterator<Item = Seen>) -> io::Result<()> {
    vehicles.try_for_each(|seen| table.serialize(Row::of(at_s, &seen)).map_err(io::Error::from))
}

/// SUMO has the position of the front bumper, angles clockwise from north, and positions along a lane.
fn timestep(out: &mut impl Write, at_s: f64, vehicles: impl Iterator<Item = Seen>) -> io::Result<()> {
    writeln!(out, "    <timestep time=\"{at_s:.2}\">")?;
    for seen in vehicles {
        let Seen { vehicle, road, place_m: (x_m, y_m), heading_deg, moves, acceleration_mps2, .. } = seen;
        writeln!(
            out,
            "        <vehicle id=\"{vehicle}\" x=\"{x_m:.3}\" y=\"{y_m:.3}\" angle=\"{heading_deg:.2}\" type=\"DEFAULT_VEHTYPE\" \
             speed=\"{:.3}\" pos=\"{:.3}\" lane=\"{road}_0\" slope=\"0.00\" acceleration=\"{acceleration_mps2:.3}\"/>",
            moves.speed_mps, moves.position_m
        )?;
    }
    writeln!(out, "    </timestep>")
}

/// A file that cannot be what it is called is refused before the run.
///
/// # Errors
/// As for [`Wanted::read`], and a place that cannot be written.
pub fn wanted(file: Option<&Path>, every_s: f64, taken: &[&Path]) -> Result<Option<Wanted>, Error> {
    let Some(file) = file else { return Ok(None) };
    crate::places::can_be_file("--trajectories", file, taken)?;
    Wanted::read(file.to_owned(), every_s).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(vehicle: usize) -> Seen {
        Seen {
            vehicle,
            road: 2,
            place_m: (1.0, 2.0),
            heading_deg: 90.0,
            moves: Moves { position_m: 100.0, speed_mps: 10.0 },
            acceleration_mps2: 0.5,
            command_mps2: 0.25,
            mode: ModeCode::Cooperative,
            limited: false,
            target: (vehicle > 0).then_some((vehicle.wrapping_sub(1), Moves { position_m: 120.0, speed_mps: 9.0 })),
            belief: None,
        }
    }

    fn written(name: &str, every_s: f64, ticks: u32) -> String {
        let folder = tempfile::tempdir().unwrap();
        let wanted = Wanted::read(folder.path().join(name), every_s).unwrap();
        let mut trajectories = Trajectories::of(&wanted).unwrap();
        for tick in 0..ticks {
            trajectories.note(f64::from(tick) * 0.01, (0..2).map(seen));
        }
        trajectories.finish().unwrap();
        std::fs::read_to_string(&wanted.file).unwrap()
    }

    #[test]
    fn a_table_has_a_row_for_each_vehicle_at_each_due_time() {
        let text = written("a.csv", 0.1, 101);
        let mut table = csv::Reader::from_reader(text.as_bytes());
        let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 11 * 2);
        let times: Vec<f64> = rows.iter().step_by(2).map(|row| row[0].parse().unwrap()).collect();
        assert_eq!(times, (0..11).map(|n| rounded(f64::from(n) * 0.1)).collect::<Vec<_>>());
        assert_eq!((&rows[0][11], &rows[1][11], &rows[1][12]), ("", "0", "120.0"));
    }

    #[test]
    fn every_tick_is_a_row_where_that_is_asked_for() {
        assert_eq!(written("a.csv", 0.01, 50).lines().count(), 1 + 50 * 2);
        assert_eq!(written("a.csv", 0.001, 50).lines().count(), 1 + 50 * 2);
    }

    #[test]
    fn floating_car_data_is_well_formed_and_complete() {
        let text = written("a.xml", 0.5, 101);
        let document = roxmltree::Document::parse(&text).unwrap();
        let steps: Vec<_> = document.descendants().filter(|node| node.has_tag_name("timestep")).collect();
        assert_eq!(steps.len(), 3);
        let vehicle = steps[2].children().find(|node| node.has_tag_name("vehicle")).unwrap();
        assert_eq!((vehicle.attribute("id"), vehicle.attribute("pos")), (Some("0"), Some("100.000")));
    }

    #[test]
    fn other_kinds_and_times_are_refused() {
        for name in ["a.parquet", "a", "a.CSV"] {
            let error = Wanted::read(name.into(), 0.1).unwrap_err().to_string();
            assert!(
                error.starts_with("--trajectories: ") && error.ends_with("name it .csv, or .xml for SUMO's FCD"),
                "{error}"
            );
        }
        for every_s in [0.0, -1.0, f64::NAN, 61.0] {
            assert!(Wanted::read("a.csv".into(), every_s).is_err(), "{every_s}");
        }
    }
}
