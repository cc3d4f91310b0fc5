//! `string`: how a string of ten vehicles damps a disturbance by its leader. Checked options enter; a table or JSON on
//! stdout, a report and the verdict leave.
//!
//! ```text
//! disturbance -> string of units, and strings without holdover -> speeds -> amplification -> rows -> table, JSON, report
//! ```

pub mod amplification;
pub mod arguments;
pub mod disturbance;
pub mod mixture;
pub mod options;
pub mod others;
mod page;
pub mod ploeg;
pub mod rows;
mod scenario;
pub mod table;

use serde::Serialize;

use crate::error::Error;
use crate::input::scenario::SensorShare;
use crate::progress::Progress;
use crate::verdict::Verdict;
use options::StringOptions;
use rows::{Row, Smallest};

/// The results, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Results<'a> {
    /// The largest ratio allowed.
    limit: f64,
    /// Whether every follower has a range sensor.
    range_sensors: bool,
    /// The share of the followers that have one.
    range_sensor_share: f64,
    /// The kinds of the followers, each in turn.
    kinds: Vec<&'static str>,
    /// The followers that a person drives and that tell their states.
    people: &'a [usize],
    /// The followers without a unit.
    unequipped: &'a [usize],
    /// The shipped time gap of a unit without a range sensor.
    shipped_time_gap_s: f64,
    /// The shipped time gap of a unit with a range sensor.
    shipped_time_gap_with_sensor_s: f64,
    /// The smallest time gap from which on the limit holds at every time gap; `None` if it does not hold at the
    /// largest.
    smallest_time_gap_s: Option<f64>,
    /// The same for each link, and for the others.
    smallest: Vec<Smallest>,
    /// The first seed.
    seed: u64,
    rows: &'a [Row],
}

/// Runs everything and writes the output that the options ask for.
///
/// # Errors
/// A configuration that the units refuse, and output that cannot be written.
pub fn run(options: &StringOptions) -> Result<Verdict, Error> {
    let progress = Progress::new(rows::count(options));
    let rows = rows::run(options, || progress.inc())?;
    progress.finish();
    let failures = rows::failures(&rows);
    let results = Results {
        limit: rows::LIMIT,
        range_sensors: options.range_sensors.is_all(),
        range_sensor_share: options.range_sensors.share(),
        kinds: options.kinds.iter().map(|kind| kind.name()).collect(),
        people: &options.mixture.people,
        unequipped: &options.mixture.unequipped,
        shipped_time_gap_s: options::shipped_time_gap_s(SensorShare::NONE),
        shipped_time_gap_with_sensor_s: options::shipped_time_gap_s(SensorShare::ALL),
        smallest_time_gap_s: rows::smallest_time_gap_s(&rows),
        smallest: rows::smallest(&rows),
        seed: options.seed,
        rows: &rows,
    };
    let (text, said) = (table::text(options, &rows, &failures), table::verdict(options, &rows, &failures));
    options.destination.deliver(&results, &text, &said, || page::render(options, &rows, &failures))?;
    Ok(Verdict::of(&failures))
}
