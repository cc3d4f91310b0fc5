//! Denser traffic, and fewer slots: a corridor, numbers of vehicles a minute and numbers of slots enter. The figures of runs with each
//! leave, on every side; and whether all runs were safe and every vehicle was served.

pub mod cases;
mod page;
mod plots;
mod table;

use serde::Serialize;

use super::verdict;
use crate::error::Error;
use crate::parallel;
use crate::roads::capacity::Capacity;
use crate::roads::conditions::Conditions;
use crate::roads::experiment::Experiment;
use crate::roads::figures::{Outcome, Side};
use crate::roads::throughput::exits_per_min;
use cases::{Which, sides};
pub use page::render;
pub use table::text;

/// The figures of one demand on one side, of all seeds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Arrivals a minute on all roads together.
    pub vehicles_per_min: f64,
    /// Slots of every unit.
    pub slots: usize,
    /// The side.
    #[serde(rename = "side")]
    pub which: Which,
    /// Whether the links have no delay, loss or silence.
    pub perfect_link: bool,
    /// Whether the envelope of every unit is engaged.
    pub envelope: bool,
    /// Whether the units keep passes, all but those of the scenario's share.
    pub passes: bool,
    /// How long every vehicle is silent.
    pub dark_s: f64,
    /// Vehicles that left a minute, while vehicles arrived.
    pub exits_per_min: Option<f64>,
    /// The most that the busiest intersection can serve: the same in every row. `None` where no roads cross.
    pub capacity: Option<Capacity>,
    /// The figures.
    #[serde(flatten)]
    pub side: Side,
}

impl Row {
    /// What it is of, but for the demand and the slots.
    fn condition(&self) -> String {
        condition(self.which, self.dark_s)
    }

    /// Its name.
    fn name(&self) -> String {
        format!("{} a minute, {} slots, {}", self.vehicles_per_min, self.slots, self.condition())
    }
}

fn condition(which: Which, dark_s: f64) -> String {
    if which == Which::Silence { format!("{} {dark_s} s", which.name()) } else { which.name().to_owned() }
}

/// A demand on one side.
struct Case<'a> {
    vehicles_per_min: f64,
    experiment: &'a Experiment,
    which: Which,
    conditions: Conditions,
}

impl Case<'_> {
    fn row(&self, capacity: Option<&Capacity>, outcomes: &[Outcome]) -> Row {
        let Conditions { slots, radio, envelope, without_passes, .. } = self.conditions;
        let exits = outcomes.iter().map(|outcome| &outcome.exits_s[..]);
        Row {
            vehicles_per_min: self.vehicles_per_min,
            slots,
            which: self.which,
            perfect_link: matches!(self.which, Which::PerfectLink | Which::EnvelopePerfectLink),
            envelope: envelope.engaged,
            passes: envelope.engaged && without_passes < 1.0,
            dark_s: radio.dark_s,
            exits_per_min: exits_per_min(exits, self.experiment.corridor.duration_s),
            capacity: capacity.cloned(),
            side: Side::of(&outcomes.iter().collect::<Vec<_>>()),
        }
    }
}

/// Number of runs for each demand, number of slots and seed.
#[must_use]
pub fn runs(experiment: &Experiment) -> usize {
    sides(&experiment.corridor).len()
}

/// Runs every seed in every case. `done` is called after each run, with the case.
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
        for slots in slots {
            for (which, conditions) in sides(&experiment.corridor) {
                let conditions = Conditions { slots: *slots, ..conditions };
                cases.push(Case { vehicles_per_min: *vehicles_per_min, experiment, which, conditions });
            }
        }
    }
    let jobs: Vec<(&Case, u64)> = cases.iter().flat_map(|case| seeds.iter().map(move |seed| (case, *seed))).collect();
    let one = |(case, seed): &(&Case, u64)| {
        let outcome = case.experiment.run(*seed, case.conditions, None);
        let Case { vehicles_per_min, which, conditions, .. } = case;
        let side = condition(*which, conditions.radio.dark_s);
        done(&format!("{vehicles_per_min} a minute, {} slots, {side}, seed {seed}", conditions.slots));
        outcome
    };
    let outcomes: Vec<Outcome> = parallel::each(&jobs, one).into_iter().collect::<Result<_, _>>()?;
    let capacity = Capacity::of(&experiment.corridor, &experiment.network);
    let row = |(case, outcomes): (&Case, &[Outcome])| case.row(capacity.as_ref(), outcomes);
    Ok(cases.iter().zip(outcomes.chunks(seeds.len().max(1))).map(row).collect())
}

/// The reasons why the rows fail: collisions, other unsafe figures, and vehicles that were not served.
#[must_use]
pub fn failures(rows: &[Row]) -> Vec<String> {
    let judged = rows.iter().filter(|row| !row.which.is_reference());
    judged.flat_map(|row| verdict::safety(&format!(" ({})", row.name()), &row.side)).collect()
}
