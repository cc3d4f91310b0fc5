//! Denser traffic, and fewer slots: a corridor, numbers of vehicles a minute and numbers of slots enter. The figures of
//! runs with each leave, with and without the envelope, over the scenario's links and over perfect links; and whether
//! all runs were safe and every vehicle was served.

use std::fmt::Write;

use serde::Serialize;

use super::verdict;
use crate::error::Error;
use crate::input::scenario::Envelope;
use crate::parallel;
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
    /// Whether the links have no delay, loss or silence.
    pub perfect_link: bool,
    /// Whether the envelope of every unit is engaged.
    pub envelope: bool,
    /// The figures.
    #[serde(flatten)]
    pub side: Side,
}

impl Row {
    /// Its name.
    fn name(&self) -> String {
        name(self.vehicles_per_min, self.slots, self.perfect_link, self.envelope)
    }
}

fn name(vehicles_per_min: f64, slots: usize, perfect_link: bool, envelope: bool) -> String {
    let link = if perfect_link { "perfect link" } else { "link" };
    let gate = if envelope { "envelope" } else { "no envelope" };
    format!("{vehicles_per_min} a minute, {slots} slots, {link}, {gate}")
}

/// A demand under one condition.
struct Case<'a> {
    vehicles_per_min: f64,
    experiment: &'a Experiment,
    conditions: Conditions,
    perfect_link: bool,
}

impl Case<'_> {
    fn name(&self) -> String {
        name(self.vehicles_per_min, self.conditions.slots, self.perfect_link, self.conditions.envelope.engaged)
    }
}

/// Runs every seed under every case. `done` is called after each run, with the case.
///
/// # Errors
/// A scenario that the units refuse.
pub fn run(
    experiment: &Experiment,
    demand: &[f64],
    slots: &[usize],
    seeds: &[u64],
    done: impl Fn(&str) + Sync,
) -> Result<Vec<Row>, Error> {
    let demanding: Vec<(f64, Experiment)> =
        demand.iter().map(|per_min| (*per_min, experiment.of(experiment.corridor.demanding(*per_min)))).collect();
    let mut cases = Vec::new();
    for (vehicles_per_min, experiment) in &demanding {
        let scenario = Conditions::of(&experiment.corridor);
        for slots in slots {
            for (perfect_link, engaged) in [(false, false), (true, false), (false, true), (true, true)] {
                let radio = if perfect_link { scenario.radio.perfect() } else { scenario.radio };
                let envelope = Envelope { engaged, ..scenario.envelope };
                let conditions = Conditions { slots: *slots, radio, envelope, ..scenario };
                cases.push(Case { vehicles_per_min: *vehicles_per_min, experiment, conditions, perfect_link });
            }
        }
    }
    let jobs: Vec<(&Case, u64)> = cases.iter().flat_map(|case| seeds.iter().map(move |seed| (case, *seed))).collect();
    let one = |(case, seed): &(&Case, u64)| {
        let outcome = case.experiment.run(*seed, case.conditions, None);
        done(&format!("{}, seed {seed}", case.name()));
        outcome
    };
    let outcomes: Vec<Outcome> = parallel::each(&jobs, one).into_iter().collect::<Result<_, _>>()?;
    let row = |(case, outcomes): (&Case, &[Outcome])| Row {
        vehicles_per_min: case.vehicles_per_min,
        slots: case.conditions.slots,
        perfect_link: case.perfect_link,
        envelope: case.conditions.envelope.engaged,
        side: Side::of(&outcomes.iter().collect::<Vec<_>>()),
    };
    Ok(cases.iter().zip(outcomes.chunks(seeds.len().max(1))).map(row).collect())
}

/// The reasons why the rows fail: collisions, other unsafe figures, and vehicles that were not served.
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
