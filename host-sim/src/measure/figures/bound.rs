//! The bounds of the targets: a trace enters; how often a target was outside its bound, and how wide the bounds were,
//! leave.

use holdover::model::bound::AccelerationRange;
use holdover::parameters::RECOVERY_SAMPLES;
use serde::Serialize;

use crate::input::scenario::Scenario;
use crate::measure::metrics::{SETTLED_FROM_S, percentile_abs};
use crate::sim::world::{Bounds, Tick, Trace};

/// The figures of the bounds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BoundFigures {
    /// Ticks of all units at which the target was outside its bound, in position or in speed. There must be none.
    pub violations: usize,
    /// Median over time of the width of the measured vehicle's bound, from the lowest to the highest position.
    pub median_width_m: Option<f64>,
    /// Ticks at which a recorded leader was outside its bound after the recording changed its speed more than any road
    /// vehicle can. A bound holds for vehicles only, so these ticks are not violations.
    pub beyond_limits: usize,
}

/// The bound of the measured vehicle over time, from the time on from which errors count.
pub fn bounds(trace: &Trace) -> impl Iterator<Item = (f64, Option<Bounds>)> + '_ {
    let seen = &trace.vehicles[trace.measured.by];
    let bound = |tick: &Tick| tick.target.and_then(|target| target.bound);
    let bounds = trace.times_s.iter().zip(seen).map(move |(at_s, tick)| (*at_s, bound(tick)));
    bounds.filter(|(at_s, _)| *at_s >= SETTLED_FROM_S - 1e-9)
}

impl BoundFigures {
    /// The figures of a trace.
    #[must_use]
    pub fn of(scenario: &Scenario, trace: &Trace) -> Self {
        let widths: Vec<f64> = bounds(trace).filter_map(|(_, bound)| Some(bound?.width_m())).collect();
        let mut figures = Self { violations: 0, median_width_m: percentile_abs(&widths, 50.0), beyond_limits: 0 };
        for target in 0..trace.vehicles.len() - 1 {
            let outside = outside(trace, target);
            let excused = if target == 0 { impossible(scenario, trace, &outside) } else { 0 };
            figures.beyond_limits += excused;
            figures.violations += outside.len() - excused;
        }
        figures
    }
}

/// The ticks at which a vehicle was outside the bound that its follower's unit sent.
fn outside(trace: &Trace, target: usize) -> Vec<usize> {
    let ticks = trace.vehicles[target].iter().zip(&trace.vehicles[target + 1]).enumerate();
    let is_outside = |(truth, seen): (&Tick, &Tick)| {
        let bound = seen.target.and_then(|target| target.bound);
        bound.is_some_and(|bound| !bound.hold(truth.position_m, truth.speed_mps))
    };
    ticks.filter(|(_, pair)| is_outside(*pair)).map(|(tick, _)| tick).collect()
}

/// The number of these ticks that follow a change of the recorded leader's speed that no road vehicle is capable of, so
/// soon that the unit cannot yet have received enough samples to accept the leader's motion again.
fn impossible(scenario: &Scenario, trace: &Trace, outside: &[usize]) -> usize {
    if scenario.leader.motion.is_none() {
        return 0;
    }
    let leader = &trace.vehicles[0];
    let (up, down): (f64, f64) =
        (AccelerationRange::WORST.acceleration.get().to_num(), AccelerationRange::WORST.braking.get().to_num());
    let is_possible = |tick: usize| {
        let slope = (leader[tick].speed_mps - leader[tick - 1].speed_mps) / scenario.period_s;
        (-down - 1e-6..=up + 1e-6).contains(&slope)
    };
    let jumps: Vec<f64> =
        (1..leader.len()).filter(|tick| !is_possible(*tick)).map(|tick| trace.times_s[tick]).collect();
    let recovery_s = 2.0 * f64::from(RECOVERY_SAMPLES) / scenario.message_rate_hz;
    let follows = |tick: &&usize| {
        let at_s = trace.times_s[**tick];
        let age_s = trace.vehicles[1][**tick].target.map_or(0.0, |target| target.age_s);
        jumps.iter().any(|jump_s| (*jump_s..=jump_s + age_s + recovery_s).contains(&at_s))
    };
    outside.iter().filter(follows).count()
}
