//! The runs of one silence: a scenario and seeds enter, the figures without and with the envelope leave.

use serde::Serialize;

use crate::error::Error;
use crate::input::scenario::Scenario;
use crate::measure::bootstrap::{Interval, mean, of_mean};
use crate::measure::figures::impaired_followers;
use crate::measure::simulate::simulate;
use crate::parallel;
use crate::sim::world::Trace;

/// The figures of one silence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Length of the silence; `None`: the channel is a recording.
    pub silence_s: Option<f64>,
    /// Number of runs without the envelope; there are as many with it.
    pub seeds: u64,
    /// The distance for which the travel time is measured.
    pub distance_m: f64,
    /// Figures without the envelope.
    pub off: Side,
    /// Figures with the envelope.
    pub on: Side,
    /// The interval of 95 % confidence, over the seeds, of what the envelope adds to the travel time.
    pub cost_interval_s: Option<Interval>,
}

/// The figures of all runs with one setting of the envelope.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Side {
    /// Fraction of time in which the envelope changed a command, of the vehicles whose link to the vehicle ahead is
    /// impaired.
    pub limited_share: f64,
    /// Mean travel time of these vehicles; `None`: one of them did not cover the distance.
    pub travel_time_s: Option<f64>,
    /// Its interval of 95 % confidence over the seeds.
    pub travel_time_interval_s: Option<Interval>,
    /// Full stops of vehicles that are driven by a unit, in all runs together.
    pub full_stops: usize,
    /// Smallest bumper gap.
    pub min_gap_m: Option<f64>,
    /// Hardest braking of a vehicle that is driven by a unit, as a magnitude.
    pub hardest_braking_mps2: f64,
    /// Episodes of a bumper gap below 0, in all runs together.
    pub collisions: usize,
    /// Ticks at which a target was outside its bound, in all runs together.
    pub bound_violations: usize,
}

/// The figures of one run.
#[derive(Clone, Debug)]
struct Outcome {
    side: Side,
    travel_times_s: Vec<Option<f64>>,
}

/// Runs the scenario with every seed, without and with the envelope, on all cores. `done` is called after each run.
///
/// # Errors
/// An error that a unit finds in the configuration from the scenario.
pub fn run(
    (silence_s, scenario): &(Option<f64>, Scenario),
    (seed, seeds): (u64, u64),
    distance_m: f64,
    done: impl Fn() + Sync,
) -> Result<Row, Error> {
    let [off, on] = [false, true].map(|engaged| {
        let mut scenario = scenario.clone();
        scenario.envelope.engaged = engaged;
        scenario
    });
    let one = |number: u64| {
        let scenario = if number.is_multiple_of(2) { &off } else { &on };
        let outcome = outcome(scenario, seed + number / 2, distance_m);
        done();
        outcome
    };
    let outcomes: Vec<Outcome> = parallel::each(0..2 * seeds, one).into_iter().collect::<Result<_, _>>()?;
    let side = |first: usize| Side::of(&outcomes.iter().skip(first).step_by(2).collect::<Vec<_>>());
    let costs = outcomes.chunks(2).map(|pair| Some(pair.get(1)?.mean_time_s()? - pair.first()?.mean_time_s()?));
    let cost_interval_s = costs.collect::<Option<Vec<f64>>>().and_then(|costs| of_mean(&costs));
    Ok(Row { silence_s: *silence_s, seeds, distance_m, off: side(0), on: side(1), cost_interval_s })
}

fn outcome(scenario: &Scenario, seed: u64, distance_m: f64) -> Result<Outcome, Error> {
    let (trace, summary) = simulate(scenario, seed, None, |_| {})?;
    let followers = impaired_followers(scenario);
    Ok(Outcome {
        side: Side {
            limited_share: summary.envelope.limited_share,
            travel_time_s: None,
            travel_time_interval_s: None,
            full_stops: summary.full_stops,
            min_gap_m: summary.min_gap_m,
            hardest_braking_mps2: summary.hardest_braking_mps2,
            collisions: summary.collisions,
            bound_violations: summary.bound.violations,
        },
        travel_times_s: followers.iter().map(|index| travel_time(&trace, *index, distance_m)).collect(),
    })
}

/// Time at which a vehicle has covered this distance from its start.
fn travel_time(trace: &Trace, vehicle: usize, distance_m: f64) -> Option<f64> {
    let ticks = &trace.vehicles[vehicle];
    let goal_m = ticks.first()?.position_m + distance_m;
    let after = ticks.iter().position(|tick| tick.position_m >= goal_m)?;
    let before = after.checked_sub(1)?;
    let share = (goal_m - ticks[before].position_m) / (ticks[after].position_m - ticks[before].position_m);
    Some(trace.times_s[before] + share * (trace.times_s[after] - trace.times_s[before]))
}

impl Outcome {
    /// The mean travel time; `None`: a vehicle did not cover the distance.
    fn mean_time_s(&self) -> Option<f64> {
        mean(&self.travel_times_s.iter().copied().collect::<Option<Vec<f64>>>()?)
    }
}

impl Side {
    fn of(outcomes: &[&Outcome]) -> Self {
        let sides = || outcomes.iter().map(|outcome| outcome.side);
        let times: Option<Vec<f64>> = outcomes.iter().flat_map(|outcome| outcome.travel_times_s.clone()).collect();
        Self {
            limited_share: sides().map(|side| side.limited_share).sum::<f64>() / outcomes.len().max(1) as f64,
            travel_time_interval_s: outcomes
                .iter()
                .map(|outcome| outcome.mean_time_s())
                .collect::<Option<Vec<f64>>>()
                .and_then(|means| of_mean(&means)),
            travel_time_s: times.map(|times| times.iter().sum::<f64>() / times.len().max(1) as f64),
            full_stops: sides().map(|side| side.full_stops).sum(),
            min_gap_m: sides().filter_map(|side| side.min_gap_m).reduce(f64::min),
            hardest_braking_mps2: sides().map(|side| side.hardest_braking_mps2).fold(0.0, f64::max),
            collisions: sides().map(|side| side.collisions).sum(),
            bound_violations: sides().map(|side| side.bound_violations).sum(),
        }
    }
}

/// The reasons why the rows fail; empty if they pass.
#[must_use]
pub fn failures(rows: &[Row]) -> Vec<String> {
    let mut failures = Vec::new();
    for row in rows {
        let silence =
            row.silence_s.map_or("over the recorded channel".into(), |length| format!("in silences of {length} s"));
        if row.on.collisions > 0 {
            failures.push(format!("{} collision(s) {silence} with the envelope", row.on.collisions));
        }
        let violations = row.off.bound_violations + row.on.bound_violations;
        if violations > 0 {
            failures.push(format!("{violations} tick(s) {silence} at which a target was outside its bound"));
        }
    }
    failures
}
