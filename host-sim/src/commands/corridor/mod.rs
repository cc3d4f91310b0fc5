//! `run` on a corridor: checked options enter; a table or JSON on stdout, a report, a picture, a candump log and the
//! verdict leave.

pub mod cost;
pub mod demand;
mod map;
pub mod options;
mod page;
mod picture;
mod plots;
pub mod scale;
mod table;
mod verdict;

use std::time::Instant;

use serde::Serialize;

use crate::commands::mcap_road::RoadMcap;
use crate::commands::motions::rows::{self, Row};
use crate::draft::Draft;
use crate::error::Error;
use crate::input::scenario::{Envelope, Faults, Fitted, SensorShare};
use crate::output;
use crate::progress::{LongRuns, Progress};
use crate::roads::conditions::Conditions;
use crate::roads::description::{Corridor, Emergencies};
use crate::roads::experiment::{Experiment, STEPS_S, Sides};
use crate::roads::figures::{StepRow, WrongRow};
use crate::roads::journal::Journal;
use crate::roads::shares::{self, SHARES, ShareRow};
use crate::roads::trajectories::Records;
use crate::roads::watch::Watch;
use crate::verdict::Verdict;
use options::CorridorOptions;

/// Number of runs besides those of the seeds: the table of differences.
const WRONGS: usize = 6;

/// Number of silences of each motion in the report and the picture: the default of `motions`.
const SILENCES: u32 = 50;

/// Wall-clock figures. All other figures are the same for the same seed.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Timing {
    /// Duration of the runs of all seeds.
    pub wall_s: f64,
    /// Simulated vehicle seconds per second, of all threads together.
    pub vehicle_seconds_per_s: f64,
    /// Computing time of a tick of the ego's unit at each prediction step.
    pub cost: Vec<cost::Cost>,
    /// Speed of the simulation with given numbers of vehicles at once; empty if it was not measured.
    pub scale: Vec<scale::Load>,
}

/// The range sensors, as the scenario says, and how many vehicles have one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sensors {
    /// Share of the vehicles that have one, as the scenario says.
    pub share: f64,
    /// Vehicles of all seeds that have one.
    pub vehicles: usize,
    /// Range.
    pub range_m: f64,
    /// Accuracy of the distance.
    pub range_accuracy_m: f64,
    /// Accuracy of the speed difference.
    pub range_speed_accuracy_mps: f64,
    /// Faults.
    #[serde(flatten)]
    pub faults: Faults,
}

impl Sensors {
    /// Those of an experiment with these seeds.
    #[must_use]
    pub fn of(experiment: &Experiment, seeds: &[u64]) -> Self {
        let Fitted { share, sensor } = experiment.corridor.sensors;
        Self {
            share,
            vehicles: seeds.iter().map(|seed| experiment.fitted(*seed)).sum(),
            range_m: sensor.sees_up_to_m,
            range_accuracy_m: sensor.distance_m,
            range_speed_accuracy_mps: sensor.speed_mps,
            faults: sensor.faults,
        }
    }
}

/// The results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Results {
    /// The scenario.
    pub scenario: String,
    /// The first seed.
    pub seed: u64,
    /// Number of seeds.
    pub seeds: usize,
    /// The range sensors.
    pub sensors: Sensors,
    /// The emergency stops and faults of the side with emergencies, as the scenario says.
    pub emergency: Emergencies,
    /// The figures of all seeds, beside the references.
    #[serde(flatten)]
    pub sides: Sides,
    /// Whether the following figures are with the envelope. The sides are without and with it in any case.
    pub excerpts_with_envelope: bool,
    /// The errors under each difference between a vehicle and what its unit assumes.
    pub wrong: Vec<WrongRow>,
    /// The figures with several shares of vehicles that keep no passes, with the envelope in any case.
    pub without_passes: Vec<ShareRow>,
    /// The errors at each prediction step; empty without a report and a picture.
    pub steps: Vec<StepRow>,
    /// The errors in a silence over five motions of a target; empty without a report and a picture.
    pub motions: Vec<Row>,
    /// The reasons why it failed; empty if it passed.
    pub failures: Vec<String>,
    /// Wall-clock figures.
    pub timing: Timing,
}

/// Runs the corridor and writes what the options ask for.
///
/// # Errors
/// A scenario that the units refuse, and places that cannot be written.
pub fn run(options: &CorridorOptions) -> Result<Verdict, Error> {
    let experiment = Experiment::new(options.corridor.clone());
    if !options.demand.is_empty() {
        return run_demand(options, &experiment);
    }
    let is_drawn = options.destination.report.is_some() || options.picture.is_some();
    let drawn = if is_drawn { STEPS_S.len() } else { 0 };
    let is_watched = options.trajectories.is_some() || options.mcap.is_some();
    let logged = usize::from(options.candump.is_some() || is_watched);
    let progress = Progress::new(
        (Sides::COUNT * options.seeds.len() + WRONGS + SHARES.len() + drawn + options.vehicles.len() + logged) as u64,
    );
    let done = || progress.inc();
    let start = Instant::now();
    let sides = experiment.sides(&options.seeds, done)?;
    let wall_s = start.elapsed().as_secs_f64();
    let first = options.seeds[0];
    let engaged = options.excerpts_with_envelope;
    let envelope = Envelope { engaged, ..options.corridor.envelope };
    let excerpts = experiment.of(Corridor { envelope, ..options.corridor.clone() });
    let wrong = excerpts.wrong(first, done)?;
    let without_passes = shares::run(&experiment, first, done)?;
    let steps: Vec<(StepRow, Journal)> = if is_drawn { excerpts.steps(first, done)? } else { Vec::new() };
    let costs: Vec<cost::Cost> = steps
        .iter()
        .filter_map(|(row, journal)| {
            let (config, itinerary) = excerpts.ego_unit(first, row.step_s)?;
            cost::measure(row.step_s, &config, itinerary, &journal.log)
        })
        .collect();
    let mut logged_to = Ok(());
    let mut records = match &options.trajectories {
        Some(wanted) => Some(Records::of(wanted, &experiment.network)?),
        None => None,
    };
    let mut mcap = match &options.mcap {
        Some(file) => Some(RoadMcap::of(file, &experiment.network)?),
        None => None,
    };
    if logged > 0 {
        let mut journal = Journal::new(options.candump.as_ref().map(|candump| candump.vehicle));
        let mut others: Vec<&mut dyn Watch> = Vec::new();
        others.extend(records.as_mut().map(|records| records as &mut dyn Watch));
        others.extend(mcap.as_mut().map(|mcap| mcap as &mut dyn Watch));
        experiment.run_before(first, Conditions::of(&options.corridor), Some(&mut journal), &mut others)?;
        logged_to = options.candump.as_ref().map_or(Ok(()), |candump| candump.write(&journal.log));
        done();
    }
    let recorded = records.map_or(Ok(()), Records::finish).and(mcap.map_or(Ok(()), RoadMcap::finish));
    let mut loads = Vec::new();
    let timed = if engaged { &sides.envelope } else { &sides.holdover };
    if let Some(travel_s) = timed.mean_travel_time_s {
        for vehicles in &options.vehicles {
            loads.push(scale::measure(&excerpts, first, *vehicles, travel_s)?);
            done();
        }
    }
    progress.finish();
    let motions = if is_drawn { rows::run(first, SILENCES, SensorShare::NONE, || {})? } else { Vec::new() };

    let mut failures = verdict::failures(&options.corridor.limits, options.seeds.len(), &sides);
    failures.extend(verdict::of_shares(&without_passes));
    let driven_s =
        sides.all().iter().map(|side| side.mean_travel_time_s.unwrap_or(0.0) * side.served as f64).sum::<f64>();
    let results = Results {
        scenario: options.name.clone(),
        seed: first,
        seeds: options.seeds.len(),
        sensors: Sensors::of(&experiment, &options.seeds),
        emergency: options.corridor.emergencies,
        sides,
        excerpts_with_envelope: engaged,
        wrong,
        without_passes,
        steps: steps.iter().map(|(row, _)| row.clone()).collect(),
        motions,
        failures,
        timing: Timing { wall_s, vehicle_seconds_per_s: driven_s / wall_s.max(1e-9), cost: costs, scale: loads },
    };
    let text = table::text(&results);
    let page = || page::render(options, &experiment, &results, &steps);
    let delivered = options.destination.deliver(&results, &text, &text, page);
    let picture = || picture::draw(&experiment, &results, &steps);
    let drawn = options.picture.as_ref().map_or(Ok(()), |file| Draft::whole(file, &picture()));
    delivered.and(drawn).and(logged_to).and(recorded)?;
    Ok(Verdict::of(&results.failures))
}

/// Runs denser traffic, and nothing else.
fn run_demand(options: &CorridorOptions, experiment: &Experiment) -> Result<Verdict, Error> {
    let cases = demand::runs(experiment) * options.demand.len();
    let runs = cases * options.slots.len() * options.seeds.len();
    let progress = LongRuns::new(runs);
    let rows = demand::run(experiment, &options.demand, &options.slots, &options.seeds, |which| progress.done(which))?;
    progress.finish();
    let failures = demand::failures(&rows);
    let sensors = Sensors::of(experiment, &options.seeds);
    let page = || demand::render(options, &sensors, &rows);
    options.destination.deliver(&rows, &demand::text(&rows), "", page)?;
    failures.iter().for_each(|failure| output::say(failure));
    Ok(Verdict::of(&failures))
}
