//! `motions`: the estimate of a target in a silence, over five motions. Checked options enter; a table or JSON on
//! stdout and a report leave.
//!
//! ```text
//! motion, phase -> scenario -> world: bus -> unit      -> errors in the silence -> rows -> table, JSON, report
//!                                         -> baselines
//! ```
//!
//! [`rows::run`] computes the figures, and [`table::text`] their table. [`section`] and [`largest`] are their parts of
//! a report and of a picture, for other commands.

pub mod arguments;
pub mod consensus;
pub mod motion;
pub mod options;
mod page;
pub mod rows;
pub mod silence;
pub mod table;

pub use page::{largest, section};

use serde::Serialize;

use crate::error::Error;
use crate::progress::Progress;
use crate::verdict::Verdict;
use motion::TargetMotion;
use options::MotionsOptions;
use rows::Row;

/// The results, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Results<'a> {
    /// The share of the followers that have a range sensor.
    range_sensor_share: f64,
    rows: &'a [Row],
}

/// Runs everything and writes the output that the options ask for.
///
/// # Errors
/// A configuration that the units refuse, and output that cannot be written.
pub fn run(options: &MotionsOptions) -> Result<Verdict, Error> {
    let progress = Progress::new(TargetMotion::ALL.len() as u64 * u64::from(options.silences));
    let rows = rows::run(options.seed, options.silences, options.range_sensors, || progress.inc())?;
    progress.finish();
    let page = || page::render(options, &rows);
    let results = Results { range_sensor_share: options.range_sensors.share(), rows: &rows };
    options.destination.deliver(&results, &table::text(&rows), "", page)?;
    Ok(Verdict::Pass)
}
