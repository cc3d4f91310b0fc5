//! `braking`: how a string of ten comes to rest behind a leader that brakes in a silence. Checked options enter; a table or JSON on
//! stdout, a report of runs without and with the envelope, and the verdict leave.
//!
//! ```text
//! leader's drive, mixed string, silence -> runs of each seed, without and with -> rows -> table, JSON, report
//! ```

pub mod arguments;
mod avoidable;
pub mod leader;
pub mod options;
mod page;
pub mod rows;
pub mod table;

use serde::Serialize;

use crate::error::Error;
use crate::progress::Progress;
use crate::verdict::Verdict;
use options::BrakingOptions;
use rows::Row;

/// The results, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Results<'a> {
    /// Whether every follower has a range sensor.
    range_sensors: bool,
    /// The share of the followers that have one.
    range_sensor_share: f64,
    /// Speed from which the leader brakes.
    speed_mps: f64,
    /// Length of the silence.
    silence_s: f64,
    /// Delay of every message.
    delay_s: f64,
    /// Fraction of messages lost besides.
    loss: f64,
    /// The first seed.
    seed: u64,
    rows: &'a [Row],
}

/// Runs everything and writes the output that the options ask for.
///
/// # Errors
/// A configuration that the units refuse, and output that cannot be written.
pub fn run(options: &BrakingOptions) -> Result<Verdict, Error> {
    let progress = Progress::new(rows::count(options));
    let rows = rows::run(options, || progress.inc())?;
    progress.finish();
    let failures = rows::failures(&rows);
    let results = Results {
        range_sensors: options.range_sensors.is_all(),
        range_sensor_share: options.range_sensors.share(),
        speed_mps: options.speed_mps,
        silence_s: options.silence_s,
        delay_s: options.delay_s,
        loss: options.loss,
        seed: options.seed,
        rows: &rows,
    };
    let verdict = Verdict::of(&failures);
    let said = if verdict == Verdict::Pass { String::new() } else { verdict.line(&failures) };
    let page = || page::render(options, &rows, &failures);
    options.destination.deliver(&results, &table::text(&rows, &failures), &said, page)?;
    Ok(verdict)
}
