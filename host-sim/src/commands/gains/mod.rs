//! `gains`: eq. 6. Only options enter. The table of gains that the core ships leaves, with the proof of every cell at
//! the time gap that the table is made for, at the shipped one, and at that of a vehicle with a range sensor, a report with a picture of it, and the verdict.
//!
//! ```text
//! sound pairs -> curve -> cells (on all cores) -> proofs -> source, JSON, report
//! ```

pub mod approach;
pub mod arguments;
pub mod cell;
pub mod grid;
pub mod linear;
mod page;
pub mod proof;
pub mod source;

use std::path::PathBuf;

use holdover::parameters;
use holdover::units::Seconds;
use serde::Serialize;

use crate::commands::ending::Destination;
use crate::draft::Draft;
use crate::error::Error;
use crate::output;
use crate::places::can_be_file;
use crate::verdict::Verdict;
use arguments::GainsArguments;
use cell::Cell;
use proof::Proof;

/// The output of the command.
#[derive(Clone, Debug, PartialEq)]
pub struct GainsOptions {
    /// File for the table as Rust.
    pub write: Option<PathBuf>,
    /// Where its results go.
    pub destination: Destination,
}

impl GainsOptions {
    /// Checks the arguments.
    ///
    /// # Errors
    /// Output that cannot be written.
    pub fn read(arguments: GainsArguments) -> Result<Self, Error> {
        let GainsArguments { write, output } = arguments;
        let destination = output.read()?;
        if let Some(file) = &write {
            can_be_file("--write", file, &[])?;
        }
        Ok(Self { write, destination })
    }
}

/// The table and its proofs.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// `γ` in ms over `k`.
    pub curve: Vec<u32>,
    /// Cells by own speed, target's speed and headway.
    pub cells: Vec<Cell>,
    /// Proofs at the time gap that the table is made for, at the shipped one, and at that of a vehicle with a range sensor, which feeds
    /// forward.
    pub proofs: [Proof; 3],
    /// The requirements that do not hold.
    pub failures: Vec<String>,
}

/// The results, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Results<'a> {
    cells: usize,
    curve_gain_milli: Vec<u32>,
    curve_damping_milli: &'a [u32],
    proofs: &'a [Proof],
    failures: &'a [String],
}

impl Table {
    /// Searches and proves the table.
    #[must_use]
    pub fn made() -> Self {
        let curve = grid::curve();
        let cells = grid::cells(&curve);
        let seconds = |gap: Seconds| f64::from(gap.to_millis()) / 1e3;
        let with_sensor = (seconds(parameters::TIME_GAP_WITH_SENSOR), parameters::FEED_FORWARD.get().to_num());
        let shipped = [(linear::DESIGN_TIME_GAP_S, 0.0), (seconds(parameters::TIME_GAP), 0.0), with_sensor];
        let proofs = shipped.map(|(time_gap_s, feed_forward)| Proof::at(time_gap_s, feed_forward, &curve, &cells));
        let failures = proofs.iter().flat_map(|proof| proof.failures.clone()).collect();
        Self { curve, cells, proofs, failures }
    }

    fn results(&self) -> Results<'_> {
        let gain = |point| grid::CURVE_FIRST_MILLI + point * grid::CURVE_STEP_MILLI;
        Results {
            cells: self.cells.len(),
            curve_gain_milli: (0..).map(gain).take(self.curve.len()).collect(),
            curve_damping_milli: &self.curve,
            proofs: &self.proofs,
            failures: &self.failures,
        }
    }
}

/// Makes and proves the table, and writes the output that the options ask for.
///
/// # Errors
/// Output that cannot be written.
pub fn run(options: &GainsOptions) -> Result<Verdict, Error> {
    let table = Table::made();
    let results = table.results();
    let delivered = options.destination.deliver(&results, &text(&results), "", || page::render(&table));
    if let Some(file) = &options.write {
        Draft::whole(file, &source::text(&table.curve, &table.cells))?;
        output::say(&format!("table: {}", file.display()));
    }
    delivered?;
    Ok(Verdict::of(results.failures))
}

fn text(results: &Results) -> String {
    let proofs: String = results.proofs.iter().map(of_proof).collect();
    let verdict = Verdict::of(results.failures).line(results.failures);
    format!(
        "{} cells; curve: k {:?}/1000, damping {:?} ms\n{proofs}{verdict}\n",
        results.cells, results.curve_gain_milli, results.curve_damping_milli,
    )
}

fn of_proof(proof: &Proof) -> String {
    let [none, car, lazy] = proof.largest_amplification;
    let nearest = proof.smallest_gap_m.map_or(String::new(), |gap_m| format!("; no collision: {gap_m:.2} m left"));
    format!(
        "time gap {} s, feed-forward {}: everything is asked of {} cells, no collision of {}, nothing of {}\n  \
         largest amplification: {none:.5} without lag, {car:.5} at 0.3 s, {lazy:.5} at 0.5 s\n  \
         least margins: {:.1} degrees, {:.2} s\n  \
         everything: settled in {:.1} s of {:.1} s, {:.2} m into the gap, braking {:.2} m/s²{nearest}\n",
        proof.time_gap_s,
        proof.feed_forward,
        proof.everything_asked,
        proof.no_collision_asked,
        proof.nothing_asked,
        proof.least_phase_margin_deg,
        proof.least_delay_margin_s,
        proof.longest_settling_s,
        proof.settling_limit_s,
        proof.largest_overshoot_m,
        proof.hardest_braking_mps2,
    )
}
