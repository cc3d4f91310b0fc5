//! The bounds of the targets: the ticks of all vehicles enter, one after the other; how often a target was outside its bound, and how wide
//! the bounds were, leave.

use holdover::model::bound::AccelerationRange;
use holdover::parameters::RECOVERY_SAMPLES;
use serde::Serialize;

use crate::input::scenario::Scenario;
use crate::measure::metrics::{SETTLED_FROM_S, percentile_abs};
use crate::sim::world::{Measured, Tick};
use crate::thinned::Thinned;

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

/// The most widths of which the median is taken.
const MOST: usize = 200_000;

/// The running figures.
#[derive(Clone, Debug)]
pub struct BoundTally<'a> {
    scenario: &'a Scenario,
    by: usize,
    widths_m: Thinned<f64>,
    violations: usize,
    beyond_limits: usize,
    /// The leader's speed at the last tick.
    leader_mps: Option<f64>,
    /// When the recorded leader last changed its speed more than any road vehicle can.
    leapt_s: Option<f64>,
}

impl<'a> BoundTally<'a> {
    /// Before the first tick.
    #[must_use]
    pub fn new(scenario: &'a Scenario) -> Self {
        Self {
            scenario,
            by: Measured::of(scenario).by,
            widths_m: Thinned::to(MOST),
            violations: 0,
            beyond_limits: 0,
            leader_mps: None,
            leapt_s: None,
        }
    }

    /// A tick of every vehicle. Returns how many targets are outside their bounds in it.
    pub fn note(&mut self, at_s: f64, ticks: &[Tick]) -> usize {
        let bound = |tick: &Tick| tick.target.and_then(|target| target.bound);
        if at_s >= SETTLED_FROM_S - 1e-9
            && let Some(bound) = bound(&ticks[self.by])
        {
            self.widths_m.push(bound.width_m());
        }
        self.watch_leader(at_s, ticks[0].speed_mps);
        let before = self.violations;
        for (target, pair) in ticks.windows(2).enumerate() {
            let (truth, seen) = (&pair[0], &pair[1]);
            if bound(seen).is_none_or(|bound| bound.hold(truth.position_m, truth.speed_mps)) {
                continue;
            }
            if target == 0 && self.is_excused(at_s, seen) {
                self.beyond_limits += 1;
            } else {
                self.violations += 1;
            }
        }
        self.violations - before
    }

    fn watch_leader(&mut self, at_s: f64, speed_mps: f64) {
        if self.scenario.leader.motion.is_none() {
            return;
        }
        let (up, down): (f64, f64) =
            (AccelerationRange::WORST.acceleration.get().to_num(), AccelerationRange::WORST.braking.get().to_num());
        if let Some(before_mps) = self.leader_mps {
            let slope = (speed_mps - before_mps) / self.scenario.period_s;
            if !(-down - 1e-6..=up + 1e-6).contains(&slope) {
                self.leapt_s = Some(at_s);
            }
        }
        self.leader_mps = Some(speed_mps);
    }

    /// Whether a change of the recorded leader's speed that no road vehicle is capable of is so recent that the unit cannot yet have
    /// received enough samples to accept the leader's motion again.
    fn is_excused(&self, at_s: f64, seen: &Tick) -> bool {
        let recovery_s = 2.0 * f64::from(RECOVERY_SAMPLES) / self.scenario.message_rate_hz;
        let age_s = seen.target.map_or(0.0, |target| target.age_s);
        self.leapt_s.is_some_and(|leapt_s| at_s <= leapt_s + age_s + recovery_s)
    }

    /// The figures of all ticks.
    #[must_use]
    pub fn finish(self) -> BoundFigures {
        BoundFigures {
            violations: self.violations,
            median_width_m: percentile_abs(self.widths_m.values(), 50.0),
            beyond_limits: self.beyond_limits,
        }
    }
}
