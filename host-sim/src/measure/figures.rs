//! The figures of a run: its ticks or its trace enter; the figures of merit leave, and the reasons of a failed verdict.

use holdover::wire::command::ModeCode;
use serde::Serialize;

use crate::input::impairment::{Impairment, Link};
use crate::input::scenario::Scenario;
use crate::measure::metrics::{SETTLED_FROM_S, STANDING_BELOW_MPS};
use crate::sim::world::{Tick, Trace};

mod bound;
mod collision;
mod tally;

pub use bound::BoundFigures;
pub use collision::Collision;
pub use tally::Tally;

/// The position errors of one estimator, in metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Largest magnitude.
    pub max_position_error_m: Option<f64>,
    /// 99th percentile of the magnitude, by nearest rank.
    pub p99_position_error_m: Option<f64>,
    /// Root of the mean square.
    pub rms_position_error_m: Option<f64>,
}

/// The envelope.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EnvelopeFigures {
    /// Whether the envelope was engaged.
    pub engaged: bool,
    /// Fraction of time in which it changed the command of a vehicle whose link to the vehicle ahead is impaired, 0 to
    /// 1.
    pub limited_share: f64,
}

/// Wall-clock figures. All other figures are the same for the same seed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Timing {
    /// Simulated seconds per second.
    pub realtime_factor: f64,
}

/// The figures of one run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The errors of the unit.
    #[serde(flatten)]
    pub ours: Errors,
    /// The errors of the literal paper's method, on the same messages.
    pub paper: Errors,
    /// Smallest bumper gap along the virtual lane.
    pub min_gap_m: Option<f64>,
    /// Lowest speed of any vehicle.
    pub min_speed_mps: Option<f64>,
    /// Full stops of vehicles that are driven by a unit.
    pub full_stops: usize,
    /// Episodes of a bumper gap below 0.
    pub collisions: usize,
    /// The first of them, one by one.
    pub collided: Vec<Collision>,
    /// Wall-clock figures.
    pub timing: Timing,
    /// The bounds of the targets.
    pub bound: BoundFigures,
    /// The envelope.
    pub envelope: EnvelopeFigures,
    /// Hardest braking of a vehicle that is driven by a unit, as a magnitude.
    #[serde(skip)]
    pub hardest_braking_mps2: f64,
}

/// The errors over time, from [`SETTLED_FROM_S`] on: `(time, error)`.
#[must_use]
pub fn errors(trace: &Trace, estimates: impl Fn(usize) -> Option<f64>) -> Vec<(f64, f64)> {
    let truth = &trace.vehicles[trace.measured.vehicle];
    let settled = trace.times_s.iter().enumerate().filter(|(_, at_s)| **at_s >= SETTLED_FROM_S - 1e-9);
    settled.filter_map(|(tick, at_s)| Some((*at_s, estimates(tick)? - truth[tick].position_m))).collect()
}

/// The measured vehicle's position as its follower's unit estimates it, at a tick.
pub fn ours(trace: &Trace) -> impl Fn(usize) -> Option<f64> + '_ {
    |tick| trace.vehicles[trace.measured.by][tick].target.map(|belief| belief.position_m)
}

/// The measured vehicle's position as the literal paper's method estimates it, at a tick.
pub fn papers(trace: &Trace) -> impl Fn(usize) -> Option<f64> + '_ {
    |tick| trace.paper.get(tick).copied().flatten()
}

/// For each vehicle but the first: the bumper gap to the vehicle ahead, over time.
#[must_use]
pub fn gaps(scenario: &Scenario, trace: &Trace) -> Vec<Vec<(f64, f64)>> {
    let gap = |follower: usize| {
        let (ahead, behind) = (&trace.vehicles[follower - 1], &trace.vehicles[follower]);
        let length_m = scenario.vehicles[follower - 1].length_m;
        let gap = move |tick: usize| ahead[tick].position_m - length_m - behind[tick].position_m;
        trace.times_s.iter().enumerate().map(|(tick, at_s)| (*at_s, gap(tick))).collect()
    };
    (1..trace.vehicles.len()).map(gap).collect()
}

/// The speed of each vehicle over time.
#[must_use]
pub fn speeds(trace: &Trace) -> Vec<Vec<(f64, f64)>> {
    let speeds =
        |ticks: &Vec<Tick>| trace.times_s.iter().zip(ticks).map(|(at_s, tick)| (*at_s, tick.speed_mps)).collect();
    trace.vehicles.iter().map(speeds).collect()
}

/// The followers whose link to the vehicle ahead is impaired; all followers, if no such link is impaired.
#[must_use]
pub fn impaired_followers(scenario: &Scenario) -> Vec<usize> {
    let followers = 1..scenario.vehicles.len();
    let impaired = |index: &usize| scenario.channel.impairs(Link { from: index - 1, to: *index });
    let found: Vec<usize> = followers.clone().filter(impaired).collect();
    if found.is_empty() { followers.collect() } else { found }
}

/// The reasons why a run failed; empty if it passed.
#[must_use]
pub fn failures(scenario: &Scenario, summary: &Summary) -> Vec<String> {
    let mut failures = Vec::new();
    if summary.collisions > 0 {
        let first = summary.collided.first().map_or(String::new(), |first| format!("; first {first}"));
        failures.push(format!("{} collision(s): a bumper gap fell below 0{first}", summary.collisions));
    }
    if summary.bound.violations > 0 {
        failures.push(format!("{} tick(s) at which a target was outside its bound", summary.bound.violations));
    }
    // A recorded or programmed leader may stop, and then all vehicles behind it have to stop. With the envelope,
    // stopping in a silence is intended.
    let stops = scenario.leader.program.iter().any(|(_, speed_mps)| *speed_mps < STANDING_BELOW_MPS);
    let may_stop = scenario.leader.motion.is_some() || stops || scenario.envelope.engaged;
    if summary.full_stops > 0 && !may_stop {
        failures.push(format!("{} full stop(s)", summary.full_stops));
    }
    if let Impairment::Recorded(link) = &scenario.channel.impairment
        && !link.delivers()
    {
        failures.push(format!("no message arrives over {}", link.file().display()));
    }
    if summary.ours.max_position_error_m.is_none() {
        failures.push("the target was never estimated".into());
    }
    failures
}

/// The name of a mode in reports.
#[must_use]
pub const fn mode_name(mode: ModeCode) -> &'static str {
    match mode {
        ModeCode::Standby => "standby",
        ModeCode::Cooperative => "cooperative",
        ModeCode::Holdover => "holdover",
        ModeCode::Fallback => "fallback",
        ModeCode::Fault => "fault",
    }
}
