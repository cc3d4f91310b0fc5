//! The runs: options enter; for each time gap, delay and loss the largest ratio of all disturbances leaves, with
//! holdover and without.

use holdover::wire::command::ModeCode;
use serde::Serialize;

use super::amplification::{Speeds, Worst};
use super::disturbance::Disturbance;
use super::mixture::Mixture;
use super::options::StringOptions;
use super::others::{self, Other};
use super::scenario::{Place, scenario};
use crate::error::Error;
use crate::input::scenario::Driver;
use crate::measure::bootstrap::{Interval, mean, of_mean};
use crate::measure::simulate::simulate;
use crate::parallel;
use crate::sim::world::{Tick, Trace};

/// The largest ratio that is allowed.
pub const LIMIT: f64 = 1.01;

/// The figures of one time gap, delay and loss; `None`: no amplitude was large enough to measure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Time gap of the followers.
    pub time_gap_s: f64,
    /// Delay of every message.
    pub delay_s: f64,
    /// Fraction of messages lost.
    pub loss: f64,
    /// Largest ratio with holdover.
    pub holdover: Option<Worst>,
    /// Largest ratio with the newest message as it is.
    pub as_it_stands: Option<Worst>,
    /// Largest ratio with the newest message, extrapolated by its age times its speed.
    pub age_times_speed: Option<Worst>,
    /// Largest ratio with the controller of Ploeg et al.
    pub cacc: Option<Worst>,
    /// Largest ratio with that controller without messages.
    pub degraded_cacc: Option<Worst>,
    /// The largest ratio of a run with each method, in the mean over the runs.
    pub means: Vec<Mean>,
    /// Largest ratio of each disturbance, with holdover.
    pub by_disturbance: Vec<Option<Worst>>,
    /// Runs with holdover, one for each disturbance and seed.
    pub runs: usize,
    /// Number of those runs with a ratio above the limit.
    pub runs_above: usize,
    /// Collisions with holdover.
    pub collisions: usize,
    /// Followers whose units did not always drive by their law during the measurement, in all runs.
    pub not_following: usize,
}

/// The mean over the runs of the largest ratio in each.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mean {
    /// The method.
    pub method: &'static str,
    /// The mean.
    pub ratio: Option<f64>,
    /// Its interval of 95 % confidence over the runs.
    pub ratio_interval: Option<Interval>,
    /// The interval of the difference to holdover in the same runs: holdover's ratio less this one.
    pub holdover_less_this_interval: Option<Interval>,
}

/// How a method's outcome is found.
type Method = (&'static str, fn(&Outcome) -> &Option<Worst>);

/// The methods, holdover first.
const METHODS: [Method; 5] = [
    ("holdover", |outcome| &outcome.holdover),
    ("as_it_stands", |outcome| &outcome.as_it_stands),
    ("age_times_speed", |outcome| &outcome.age_times_speed),
    ("cacc", |outcome| &outcome.cacc),
    ("degraded_cacc", |outcome| &outcome.degraded_cacc),
];

fn means(outcomes: &[&Outcome]) -> Vec<Mean> {
    let ratios = |of: fn(&Outcome) -> &Option<Worst>| {
        outcomes.iter().map(|outcome| Some(of(outcome).as_ref()?.ratio)).collect::<Option<Vec<f64>>>()
    };
    let ours = ratios(METHODS[0].1);
    let of_method = |(index, (method, of)): (usize, Method)| {
        let theirs = ratios(of);
        let differences = ours.as_ref().zip(theirs.as_ref()).filter(|_| index > 0);
        let differences =
            differences.map(|(ours, theirs)| ours.iter().zip(theirs).map(|(a, b)| a - b).collect::<Vec<_>>());
        Mean {
            method,
            ratio: theirs.as_deref().and_then(mean),
            ratio_interval: theirs.as_deref().and_then(of_mean),
            holdover_less_this_interval: differences.as_deref().and_then(of_mean),
        }
    };
    METHODS.into_iter().enumerate().map(of_method).collect()
}

/// The outcome of one run.
struct Outcome {
    holdover: Option<Worst>,
    as_it_stands: Option<Worst>,
    age_times_speed: Option<Worst>,
    cacc: Option<Worst>,
    degraded_cacc: Option<Worst>,
    collisions: usize,
    not_following: usize,
}

/// The runs of each place, in the order of the rows: each disturbance once per seed.
fn places(options: &StringOptions) -> Vec<(Place, Vec<(Disturbance, u64)>)> {
    let mut places = Vec::new();
    for &time_gap_s in &options.time_gaps_s {
        for &delay_s in &options.delays_s {
            for &loss in &options.losses {
                let of = |&disturbance| (disturbance, options.seeds_of(disturbance, loss));
                places.push(((time_gap_s, delay_s, loss), options.disturbances.iter().map(of).collect()));
            }
        }
    }
    places
}

/// Number of runs.
#[must_use]
pub fn count(options: &StringOptions) -> u64 {
    places(options).iter().flat_map(|(_, disturbances)| disturbances).map(|(_, seeds)| seeds).sum()
}

/// Runs everything on all cores. `done` is called after each run.
///
/// # Errors
/// An error that a unit finds in the configuration.
pub fn run(options: &StringOptions, done: impl Fn() + Sync) -> Result<Vec<Row>, Error> {
    let places = places(options);
    let mut jobs = Vec::new();
    for (place, disturbances) in &places {
        for &(disturbance, seeds) in disturbances {
            jobs.extend((options.seed..=options.seed + (seeds - 1)).map(|seed| (*place, disturbance, seed)));
        }
    }
    let one = |&(place, disturbance, seed)| {
        let outcome = outcome(place, disturbance, seed, options);
        done();
        outcome
    };
    let outcomes: Vec<Outcome> = parallel::each(&jobs, one).into_iter().collect::<Result<_, _>>()?;
    let mut outcomes = outcomes.into_iter();
    let mut all_seeds = |&(_, seeds): &(_, u64)| (0..seeds).filter_map(|_| outcomes.next()).collect();
    let of_place = |(place, disturbances): &(Place, Vec<_>)| {
        row(*place, &disturbances.iter().map(&mut all_seeds).collect::<Vec<_>>())
    };
    Ok(places.iter().map(of_place).collect())
}

/// The row of a place, from the outcomes of each disturbance with all its seeds.
fn row((time_gap_s, delay_s, loss): Place, outcomes: &[Vec<Outcome>]) -> Row {
    let largest = |outcomes: &mut dyn Iterator<Item = &Outcome>, of: fn(&Outcome) -> &Option<Worst>| {
        outcomes.filter_map(|outcome| of(outcome).clone()).max_by(|a, b| a.ratio.total_cmp(&b.ratio))
    };
    let all = || outcomes.iter().flatten();
    let worst = |of| largest(&mut all(), of);
    Row {
        time_gap_s,
        delay_s,
        loss,
        holdover: worst(|outcome| &outcome.holdover),
        as_it_stands: worst(|outcome| &outcome.as_it_stands),
        age_times_speed: worst(|outcome| &outcome.age_times_speed),
        cacc: worst(|outcome| &outcome.cacc),
        degraded_cacc: worst(|outcome| &outcome.degraded_cacc),
        means: means(&all().collect::<Vec<_>>()),
        by_disturbance: outcomes.iter().map(|of| largest(&mut of.iter(), |outcome| &outcome.holdover)).collect(),
        runs: all().count(),
        runs_above: all().filter(|outcome| is_above(&outcome.holdover)).count(),
        collisions: all().map(|outcome| outcome.collisions).sum(),
        not_following: all().map(|outcome| outcome.not_following).sum(),
    }
}

fn is_above(worst: &Option<Worst>) -> bool {
    worst.as_ref().is_some_and(|worst| worst.ratio > LIMIT)
}

fn outcome(place: Place, disturbance: Disturbance, seed: u64, options: &StringOptions) -> Result<Outcome, Error> {
    let mixture = &options.mixture;
    let scenario = scenario(place, disturbance, options.range_sensors, &options.kinds, mixture)?;
    let (trace, summary) = simulate(&scenario, seed, None, |_| {})?;
    let units = Speeds::of(&trace, scenario.period_s);
    // The others drive every vehicle of a string, or none.
    let without =
        |other| if mixture.is_mixed() { None } else { others::run(&scenario, seed, other).worst(disturbance) };
    Ok(Outcome {
        holdover: units.worst_of(disturbance, |vehicle| mixture.driver(vehicle) == Driver::Unit),
        as_it_stands: without(Other::AsItStands),
        age_times_speed: without(Other::AgeTimesSpeed),
        cacc: without(Other::Cacc),
        degraded_cacc: without(Other::DegradedCacc),
        collisions: summary.collisions,
        not_following: not_following(&trace, disturbance.measured_from_s(), mixture),
    })
}

/// Number of units that did not always drive by their law from this time on. Behind a vehicle that nobody hears that is the law of the
/// cruise control.
fn not_following(trace: &Trace, from_s: f64, mixture: &Mixture) -> usize {
    let begins = trace.times_s.partition_point(|at_s| *at_s < from_s - 1e-9);
    let follows = |vehicle: usize, tick: &Tick| match tick.mode {
        ModeCode::Cooperative | ModeCode::Holdover => true,
        ModeCode::Fallback => mixture.driver(vehicle - 1) == Driver::Unequipped,
        ModeCode::Standby | ModeCode::Fault => false,
    };
    let units =
        trace.vehicles.iter().enumerate().skip(1).filter(|(vehicle, _)| mixture.driver(*vehicle) == Driver::Unit);
    units.filter(|(vehicle, ticks)| !ticks.iter().skip(begins).all(|tick| follows(*vehicle, tick))).count()
}

/// The failures: the largest ratio with holdover, if it is above the limit, and strings that did not drive.
#[must_use]
pub fn failures(rows: &[Row]) -> Vec<String> {
    let above = |row: &Row| {
        let worst = row.holdover.as_ref().filter(|worst| worst.ratio > LIMIT)?;
        Some(format!(
            "a ratio of {:.4} at a time gap of {} s, a delay of {} s and a loss of {} ({}, vehicle {})",
            worst.ratio, row.time_gap_s, row.delay_s, row.loss, worst.disturbance, worst.vehicle
        ))
    };
    let crashed = |row: &Row| {
        (row.collisions > 0).then(|| format!("{} collisions at a delay of {} s", row.collisions, row.delay_s))
    };
    // A vehicle at standstill passes no disturbance on, so its ratio does not show the failure.
    let lost = |row: &Row| {
        (row.not_following > 0).then(|| {
            let Row { time_gap_s, delay_s, loss, not_following, .. } = row;
            format!(
                "{not_following} vehicles that did not follow at a time gap of {time_gap_s} s, a delay of {delay_s} s and a \
                 loss of {loss}"
            )
        })
    };
    let each = |of: &dyn Fn(&Row) -> Option<String>| rows.iter().filter_map(of).collect::<Vec<_>>();
    [each(&above), each(&crashed), each(&lost)].concat()
}

/// The smallest time gap for which the limit holds there and at every larger one that was run.
#[must_use]
pub fn smallest_time_gap_s(rows: &[Row]) -> Option<f64> {
    smallest_where(rows, |row| failures(std::slice::from_ref(row)).is_empty())
}

/// The smallest time gaps at one link; `None`: the limit does not hold at the largest that was run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Smallest {
    /// Delay of every message.
    pub delay_s: f64,
    /// Fraction of messages lost.
    pub loss: f64,
    /// With holdover.
    pub holdover_s: Option<f64>,
    /// The same law on the newest message as it stands.
    pub as_it_stands_s: Option<f64>,
    /// The same law on the newest message, moved on by its age times its speed.
    pub age_times_speed_s: Option<f64>,
    /// The controller of Ploeg et al.
    pub cacc_s: Option<f64>,
    /// That controller without messages.
    pub degraded_cacc_s: Option<f64>,
}

/// The smallest time gaps at each link.
#[must_use]
pub fn smallest(rows: &[Row]) -> Vec<Smallest> {
    let mut links: Vec<(f64, f64)> = Vec::new();
    for link in rows.iter().map(|row| (row.delay_s, row.loss)) {
        if !links.contains(&link) {
            links.push(link);
        }
    }
    let of_link = |(delay_s, loss): (f64, f64)| {
        let here: Vec<Row> = rows.iter().filter(|row| (row.delay_s, row.loss) == (delay_s, loss)).cloned().collect();
        let other =
            |of: fn(&Row) -> &Option<Worst>| smallest_where(&here, |row| of(row).is_some() && !is_above(of(row)));
        Smallest {
            delay_s,
            loss,
            holdover_s: smallest_time_gap_s(&here),
            as_it_stands_s: other(|row| &row.as_it_stands),
            age_times_speed_s: other(|row| &row.age_times_speed),
            cacc_s: other(|row| &row.cacc),
            degraded_cacc_s: other(|row| &row.degraded_cacc),
        }
    };
    links.into_iter().map(of_link).collect()
}

/// The smallest time gap for which something holds in all rows there, and at every larger time gap.
fn smallest_where(rows: &[Row], holds: impl Fn(&Row) -> bool) -> Option<f64> {
    let mut gaps: Vec<f64> = rows.iter().map(|row| row.time_gap_s).collect();
    gaps.sort_by(|a, b| b.total_cmp(a));
    let all = |gap: &f64| rows.iter().filter(|row| row.time_gap_s == *gap).all(&holds);
    gaps.into_iter().take_while(all).last()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(ratio: f64, disturbance: &str) -> Outcome {
        let worst = Some(Worst { ratio, disturbance: disturbance.into(), vehicle: 1 });
        Outcome {
            holdover: worst.clone(),
            as_it_stands: worst,
            age_times_speed: None,
            cacc: None,
            degraded_cacc: None,
            collisions: 1,
            not_following: 0,
        }
    }

    #[test]
    fn the_largest_of_all_seeds_counts_for_each_disturbance_and_for_all() {
        let outcomes = [vec![outcome(0.9, "step"), outcome(1.1, "step")], vec![outcome(0.7, "1 Hz")]];
        let row = row((1.0, 0.1, 0.2), &outcomes);
        let ratios: Vec<f64> = row.by_disturbance.iter().flatten().map(|worst| worst.ratio).collect();
        assert_eq!(ratios, [1.1, 0.7]);
        assert_eq!(
            (row.holdover.unwrap().ratio, row.age_times_speed, row.runs, row.runs_above, row.collisions),
            (1.1, None, 3, 1, 3)
        );
    }
}
