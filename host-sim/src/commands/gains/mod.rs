//! `gains`: eq. 6. Only options enter. The two tables of gains that the core ships leave, for the law of eq. 5 and for that with
//! feed-forward, with the proof of every cell at every tenth of a second of the time gap, a report with pictures of them, and the verdict.
//!
//! ```text
//! design -> curve -> cells (on all cores) -> proofs -> source, JSON, report
//! ```

pub mod approach;
pub mod arguments;
pub mod cell;
pub mod design;
pub mod grid;
pub mod linear;
mod page;
pub mod proof;
pub mod source;

use std::path::PathBuf;

use serde::Serialize;

use crate::commands::ending::Destination;
use crate::draft::Draft;
use crate::error::Error;
use crate::output;
use crate::places::can_be_file;
use crate::verdict::Verdict;
use arguments::GainsArguments;
use cell::Cell;
use design::Design;
use proof::Proof;

/// The output of the command.
#[derive(Clone, Debug, PartialEq)]
pub struct GainsOptions {
    /// File for the tables as Rust.
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

/// A table and its proofs.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What it is made for.
    pub design: Design,
    /// `γ` in ms over `k`.
    pub curve: Vec<u32>,
    /// Cells by own speed, target's speed and headway.
    pub cells: Vec<Cell>,
    /// Proofs at each time gap of the design, the smallest first.
    pub proofs: Vec<Proof>,
}

/// The results, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Results<'a> {
    tables: Vec<TableResults<'a>>,
    failures: Vec<String>,
}

/// The results of a table, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct TableResults<'a> {
    feed_forward: f64,
    cells: usize,
    curve_gain_milli: Vec<u32>,
    curve_damping_milli: &'a [u32],
    proofs: &'a [Proof],
}

impl Table {
    /// Searches and proves a table.
    #[must_use]
    pub fn made(design: Design) -> Self {
        let curve = grid::curve(&design);
        let cells = grid::cells(&design, &curve);
        let proofs = design.time_gaps_s().map(|time_gap_s| Proof::at(time_gap_s, &design, &curve, &cells)).collect();
        Self { design, curve, cells, proofs }
    }

    /// Both: that of the law of eq. 5, and that of the law with feed-forward.
    #[must_use]
    pub fn both() -> [Self; 2] {
        [Self::made(design::PLAIN), Self::made(design::fed())]
    }

    fn results(&self) -> TableResults<'_> {
        let gain = |point| self.design.first_milli + point * self.design.step_milli;
        TableResults {
            feed_forward: self.design.feed_forward,
            cells: self.cells.len(),
            curve_gain_milli: (0..design::POINTS).map(gain).collect(),
            curve_damping_milli: &self.curve,
            proofs: &self.proofs,
        }
    }
}

/// The requirements that do not hold, of all tables.
#[must_use]
pub fn failures(tables: &[Table]) -> Vec<String> {
    tables.iter().flat_map(|table| &table.proofs).flat_map(|proof| proof.failures.clone()).collect()
}

/// Makes and proves the tables, and writes the output that the options ask for.
///
/// # Errors
/// Output that cannot be written.
pub fn run(options: &GainsOptions) -> Result<Verdict, Error> {
    let tables = Table::both();
    let results = Results { tables: tables.iter().map(Table::results).collect(), failures: failures(&tables) };
    let delivered = options.destination.deliver(&results, &text(&results), "", || page::render(&tables));
    if let Some(file) = &options.write {
        Draft::whole(file, &source::text(&tables))?;
        output::say(&format!("tables: {}", file.display()));
    }
    delivered?;
    Ok(Verdict::of(&results.failures))
}

fn text(results: &Results) -> String {
    let tables: String = results.tables.iter().map(of_table).collect();
    let verdict = Verdict::of(&results.failures).line(&results.failures);
    format!("{tables}{verdict}\n")
}

fn of_table(table: &TableResults) -> String {
    let TableResults { feed_forward, cells, curve_gain_milli, curve_damping_milli, proofs } = table;
    let rows: String = proofs.iter().map(of_proof).collect();
    format!(
        "feed-forward {feed_forward}: {cells} cells; curve: k {curve_gain_milli:?}/1000, damping {curve_damping_milli:?} ms\n\
         time gap   cells      amplification, lag 0, 0.3, 0.5 s   margins          settled, limit    overshoot  braking\n{rows}\n"
    )
}

fn of_proof(proof: &Proof) -> String {
    let [none, car, lazy] = proof.largest_amplification;
    format!(
        "{:6.1} s   {:3} {:2} {:2}  {none:10.5}{car:10.5}{lazy:10.5}     {:.1} deg, {:.2} s   {:.1} s, {:.1} s   {:.2} m     {:.2} m/s²\n",
        proof.time_gap_s,
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
