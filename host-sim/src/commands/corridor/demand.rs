//! More traffic, and fewer slots: a corridor, numbers of vehicles a minute and of slots enter; a run of each, with the envelope and
//! without it, by the scenario's link and by a perfect one, and whether all of them were safe and served everybody, leave.

use std::fmt::Write;

use rayon::prelude::*;
use serde::Serialize;

use super::verdict;
use crate::error::Error;
use crate::input::scenario::Envelope;
use crate::roads::conditions::Conditions;
use crate::roads::experiment::Experiment;
use crate::roads::figures::{Outcome, Side};

/// The figures of one demand under one condition, of all seeds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Arrivals a minute on all roads together.
    pub vehicles_per_min: f64,
    /// Slots of every unit.
    pub slots: usize,
    /// Whether nothing is delayed, lost or silent.
    pub perfect_link: bool,
    /// Whether every unit has its last gate engaged.
    pub envelope: bool,
    /// The figures.
    #[serde(flatten)]
    pub side: Side,
}

impl Row {
    /// What it is called.
    fn name(&self) -> String {
        let link = if self.perfect_link { "perfect link" } else { "link" };
        let gate = if self.envelope { "envelope" } else { "no envelope" };
        format!("{} a minute, {} slots, {link}, {gate}", self.vehicles_per_min, self.slots)
    }
}

/// Runs every seed under all of them; `done` is called after each run.
///
/// # Errors
/// A scenario that the units refuse.
pub fn run(
    experiment: &Experiment,
    demand: &[f64],
    slots: &[usize],
    seeds: &[u64],
    done: impl Fn() + Sync,
) -> Result<Vec<Row>, Error> {
    let demanding: Vec<Experiment> =
        demand.iter().map(|per_min| experiment.of(experiment.corridor.demanding(*per_min))).collect();
    let mut cases: Vec<(usize, Conditions, bool)> = Vec::new();
    for (which, experiment) in demanding.iter().enumerate() {
        let scenario = Conditions::of(&experiment.corridor);
        for slots in slots {
            for (perfect, engaged) in [(false, false), (true, false), (false, true), (true, true)] {
                let radio = if perfect { scenario.radio.perfect() } else { scenario.radio };
                let envelope = Envelope { engaged, ..scenario.envelope };
                cases.push((which, Conditions { slots: *slots, radio, envelope, ..scenario }, perfect));
            }
        }
    }
    let jobs: Vec<(usize, Conditions, u64)> =
        cases.iter().flat_map(|(which, conditions, _)| seeds.iter().map(|seed| (*which, *conditions, *seed))).collect();
    let one = |(which, conditions, seed): &(usize, Conditions, u64)| {
        let outcome = demanding[*which].run(*seed, *conditions, None);
        done();
        outcome
    };
    let outcomes: Vec<Outcome> = jobs.par_iter().map(one).collect::<Vec<_>>().into_iter().collect::<Result<_, _>>()?;
    let row = |((which, conditions, perfect_link), outcomes): (&(usize, Conditions, bool), &[Outcome])| Row {
        vehicles_per_min: demand[*which],
        slots: conditions.slots,
        perfect_link: *perfect_link,
        envelope: conditions.envelope.engaged,
        side: Side::of(&outcomes.iter().collect::<Vec<_>>()),
    };
    Ok(cases.iter().zip(outcomes.chunks(seeds.len().max(1))).map(row).collect())
}

/// Why they fail: whoever was not safe, or not served.
#[must_use]
pub fn failures(rows: &[Row]) -> Vec<String> {
    rows.iter().flat_map(|row| verdict::safety(&format!(" ({})", row.name()), &row.side)).collect()
}

/// The table.
#[must_use]
pub fn text(rows: &[Row]) -> String {
    let mut text = String::from(
        "a minute  slots  link     envelope  served  left over  collisions: road  area  outside  stops  mean s  longest s  turned away\n",
    );
    for row in rows {
        let side = &row.side;
        let (link, gate) =
            (if row.perfect_link { "perfect" } else { "as said" }, if row.envelope { "on" } else { "off" });
        let seconds = |time: Option<f64>| time.map_or("-".into(), |time| format!("{time:.1}"));
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:8}{:7}  {link:9}{gate:8}{:8}{:11}{:18}{:6}{:9}{:7}{:>8}{:>11}{:13}",
            row.vehicles_per_min,
            row.slots,
            side.served,
            side.unserved,
            side.collisions_on_roads,
            side.collisions_at_intersections,
            side.bound_violations,
            side.full_stops,
            seconds(side.mean_travel_time_s),
            seconds(side.longest_travel_time_s),
            side.turned_away,
        );
    }
    text
}
