//! `gains`: eq. 6. Nothing but options enters; the table of gains that the core ships leaves, with the proof of every cell, a
//! report with a picture of it, and the verdict.
//!
//! ```text
//! sound pairs -> curve -> cells (on all cores) -> source, JSON, report
//! ```

pub mod approach;
pub mod arguments;
pub mod cell;
pub mod grid;
pub mod linear;
mod page;
pub mod source;

use std::path::PathBuf;

use serde::Serialize;

use crate::error::Error;
use crate::options::{can_be_file, can_be_folder};
use crate::output;
use crate::run::write_report;
use crate::verdict::Verdict;
use arguments::GainsArguments;
use cell::{Asked, Cell};

/// What becomes of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct GainsOptions {
    /// Where to write it.
    pub write: Option<PathBuf>,
    /// Results as JSON.
    pub json: bool,
    /// Folder of the report; `None`: no report.
    pub report: Option<PathBuf>,
}

impl GainsOptions {
    /// Checks what the arguments say.
    ///
    /// # Errors
    /// Places that cannot be written.
    pub fn read(arguments: GainsArguments) -> Result<Self, Error> {
        let GainsArguments { write, json, out, no_report } = arguments;
        let report = (!no_report).then_some(out);
        if let Some(folder) = &report {
            can_be_folder(folder)?;
        }
        if let Some(file) = &write {
            can_be_file("--write", file, &[])?;
        }
        Ok(Self { write, json, report })
    }
}

/// The table and its proof.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// `γ` in ms over `k`.
    pub curve: Vec<u32>,
    /// By own speed, target's speed and headway.
    pub cells: Vec<Cell>,
    /// What does not hold.
    pub failures: Vec<String>,
}

/// The results, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Results {
    cells: usize,
    everything_asked: usize,
    no_collision_asked: usize,
    nothing_asked: usize,
    curve_gain_milli: Vec<u32>,
    curve_damping_milli: Vec<u32>,
    largest_amplification: [f64; 3],
    least_phase_margin_deg: f64,
    least_delay_margin_s: f64,
    longest_settling_s: f64,
    largest_overshoot_m: f64,
    hardest_braking_mps2: f64,
    largest_jerk_mps3: f64,
    failures: Vec<String>,
}

impl Table {
    /// Searches and proves it.
    #[must_use]
    pub fn made() -> Self {
        let curve = grid::curve();
        let cells = grid::cells(&curve);
        let unsound =
            grid::unsound(&curve).into_iter().map(|gain| format!("k = {gain}/1000 on the curve is not sound"));
        let wrong = cells.iter().filter(|cell| !cell.holds).map(|cell| {
            let situation = &cell.situation;
            format!(
                "{:?} does not hold at {} m/s behind {} m/s, {} m",
                cell.asked, situation.own_mps, situation.target_mps, situation.headway_m
            )
        });
        let failures = unsound.chain(wrong).collect();
        Self { curve, cells, failures }
    }

    fn results(&self) -> Results {
        let asked = |what| self.cells.iter().filter(|cell| cell.asked == what).count();
        let all = || self.cells.iter().filter(|cell| cell.asked == Asked::Everything).map(|cell| cell.approach);
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let gains: Vec<u32> = (0..)
            .map(|point| grid::CURVE_FIRST_MILLI + point * grid::CURVE_STEP_MILLI)
            .take(self.curve.len())
            .collect();
        let (first, last) = (gains.first().copied().unwrap_or(0), gains.last().copied().unwrap_or(0));
        let pairs: Vec<_> = (first..=last).map(|gain| grid::on_curve(&self.curve, gain)).collect();
        let margins: Vec<_> = pairs.iter().map(|pair| pair.margins(linear::LAZIEST_S)).collect();
        let least = |of: fn(&(f64, f64)) -> f64| margins.iter().map(of).fold(f64::INFINITY, f64::min);
        Results {
            cells: self.cells.len(),
            everything_asked: asked(Asked::Everything),
            no_collision_asked: asked(Asked::NoCollision),
            nothing_asked: asked(Asked::Nothing),
            largest_amplification: [0.0, 0.3, linear::LAZIEST_S]
                .map(|lag_s| largest(&mut pairs.iter().map(|pair| pair.largest_gain(lag_s)))),
            least_phase_margin_deg: least(|margin| margin.0).to_degrees(),
            least_delay_margin_s: least(|margin| margin.1),
            longest_settling_s: largest(&mut all().map(|approach| approach.settled_s)),
            largest_overshoot_m: largest(&mut all().map(|approach| approach.overshoot_m)),
            hardest_braking_mps2: largest(&mut all().map(|approach| approach.braking_mps2)),
            largest_jerk_mps3: largest(&mut self.cells.iter().map(|cell| cell.approach.jerk_mps3)),
            curve_gain_milli: gains,
            curve_damping_milli: self.curve.clone(),
            failures: self.failures.clone(),
        }
    }
}

/// Makes and proves the table, and writes what the options ask for.
///
/// # Errors
/// Places that cannot be written.
pub fn gains(options: &GainsOptions) -> Result<Verdict, Error> {
    let table = Table::made();
    if let Some(file) = &options.write {
        let text = source::text(&table.curve, &table.cells);
        std::fs::write(file, text).map_err(|error| Error::unwritable(file, &error))?;
        output::say(&format!("table: {}", file.display()));
    }
    let results = table.results();
    let report = match &options.report {
        Some(folder) => Some(write_report(folder, &page::render(&table))?),
        None => None,
    };
    if options.json {
        let json = serde_json::to_string(&results).map_err(|error| Error::new(error.to_string(), "report this"))?;
        output::print(&format!("{json}\n"))?;
    } else {
        output::print(&text(&results))?;
    }
    if let Some(report) = report {
        output::say(&format!("report: {}", report.display()));
    }
    Ok(if results.failures.is_empty() { Verdict::Pass } else { Verdict::Failed })
}

fn text(results: &Results) -> String {
    let [none, car, lazy] = results.largest_amplification;
    let verdict =
        if results.failures.is_empty() { "passed".into() } else { format!("FAILED: {}", results.failures.join("; ")) };
    format!(
        "{} cells: everything is asked of {}, no collision of {}, nothing of {}\n\
         curve: k {:?}/1000, damping {:?} ms\n\
         largest amplification: {none:.5} without lag, {car:.5} at 0.3 s, {lazy:.5} at 0.5 s\n\
         least margins: {:.1} degrees, {:.2} s\n\
         where everything is asked: settled in {:.1} s, {:.2} m into the gap, braking {:.2} m/s²\n\
         verdict: {verdict}\n",
        results.cells,
        results.everything_asked,
        results.no_collision_asked,
        results.nothing_asked,
        results.curve_gain_milli,
        results.curve_damping_milli,
        results.least_phase_margin_deg,
        results.least_delay_margin_s,
        results.longest_settling_s,
        results.largest_overshoot_m,
        results.hardest_braking_mps2,
    )
}
