//! The figures of a run while it runs: the ticks of all vehicles enter, one after the other; the figures leave at the end. The memory that
//! this takes does not grow with the length of the run.
//!
//! Largest, smallest and counted figures are of every tick. Percentiles are of every tick of runs up to [`MOST`] ticks, and of evenly
//! chosen ones beyond.

use super::bound::BoundTally;
use super::collision::Collision;
use super::{EnvelopeFigures, Errors, Summary, Timing, impaired_followers};
use crate::input::scenario::Scenario;
use crate::measure::metrics::{SETTLED_FROM_S, StandTally, percentile_abs};
use crate::sim::world::{Measured, Tick};
use crate::thinned::Thinned;

/// The most samples of which a percentile is taken.
const MOST: usize = 200_000;
/// The most collisions that are told one by one.
const MOST_COLLISIONS: usize = 20;

/// Errors of one estimator.
#[derive(Clone, Debug)]
struct ErrorTally {
    count: usize,
    squares: f64,
    largest: Option<f64>,
    sample: Thinned<f64>,
}

impl Default for ErrorTally {
    fn default() -> Self {
        Self { count: 0, squares: 0.0, largest: None, sample: Thinned::to(MOST) }
    }
}

impl ErrorTally {
    fn note(&mut self, error: f64) {
        self.count += 1;
        self.squares += error * error;
        let magnitude = error.abs();
        self.largest = Some(
            self.largest.map_or(magnitude, |most| if most > magnitude || most.is_nan() { most } else { magnitude }),
        );
        self.sample.push(error);
    }

    fn finish(&self) -> Errors {
        Errors {
            max_position_error_m: self.largest,
            p99_position_error_m: percentile_abs(self.sample.values(), 99.0),
            rms_position_error_m: (self.count > 0).then(|| (self.squares / self.count as f64).sqrt()),
        }
    }
}

/// The running figures.
#[derive(Clone, Debug)]
pub struct Tally<'a> {
    scenario: &'a Scenario,
    measured: Measured,
    ours: ErrorTally,
    paper: ErrorTally,
    bound: BoundTally<'a>,
    /// For each vehicle.
    stands: Vec<StandTally>,
    /// For each vehicle but the first, whether it overlaps the one ahead.
    overlaps: Vec<bool>,
    smallest_gap_m: Option<f64>,
    lowest_speed_mps: Option<f64>,
    hardest_braking_mps2: f64,
    collisions: usize,
    collided: Vec<Collision>,
    impaired: Vec<usize>,
    limited: (usize, usize),
}

impl<'a> Tally<'a> {
    /// Before the first tick.
    #[must_use]
    pub fn new(scenario: &'a Scenario) -> Self {
        let vehicles = scenario.vehicles.len();
        Self {
            scenario,
            measured: Measured::of(scenario),
            ours: ErrorTally::default(),
            paper: ErrorTally::default(),
            bound: BoundTally::new(scenario),
            stands: vec![StandTally::default(); vehicles],
            overlaps: vec![false; vehicles],
            smallest_gap_m: None,
            lowest_speed_mps: None,
            hardest_braking_mps2: 0.0,
            collisions: 0,
            collided: Vec::new(),
            impaired: impaired_followers(scenario),
            limited: (0, 0),
        }
    }

    /// A tick of every vehicle, and where the literal paper's method then estimates the measured one to be. Returns how many targets are
    /// outside their bounds in it.
    pub fn note(&mut self, at_s: f64, ticks: &[Tick], paper_m: Option<f64>) -> usize {
        let Measured { vehicle, by } = self.measured;
        if at_s >= SETTLED_FROM_S - 1e-9 {
            let truth_m = ticks[vehicle].position_m;
            if let Some(target) = ticks[by].target {
                self.ours.note(target.position_m - truth_m);
            }
            if let Some(paper_m) = paper_m {
                self.paper.note(paper_m - truth_m);
            }
        }
        let outside = self.bound.note(at_s, ticks);
        let driven = usize::from(self.scenario.leader.motion.is_some());
        for (index, (tick, stand)) in ticks.iter().zip(&mut self.stands).enumerate() {
            self.lowest_speed_mps = least(self.lowest_speed_mps, tick.speed_mps);
            if index >= driven {
                stand.note(at_s, tick.speed_mps);
                self.hardest_braking_mps2 = self.hardest_braking_mps2.max(-tick.acceleration_mps2);
            }
        }
        for index in 1..ticks.len() {
            self.gap(at_s, index, &ticks[index - 1], &ticks[index]);
        }
        let limited = self.impaired.iter().filter(|index| ticks[**index].limited).count();
        self.limited = (self.limited.0 + limited, self.limited.1 + self.impaired.len());
        outside
    }

    fn gap(&mut self, at_s: f64, index: usize, ahead: &Tick, behind: &Tick) {
        let length_m = self.scenario.vehicles[index - 1].length_m;
        let gap_m = ahead.position_m - length_m - behind.position_m;
        self.smallest_gap_m = least(self.smallest_gap_m, gap_m);
        let overlaps = gap_m < 0.0;
        if overlaps && !self.overlaps[index] {
            self.collisions += 1;
            if self.collided.len() < MOST_COLLISIONS {
                self.collided.push(Collision::of(at_s, index, (ahead, length_m), behind));
            }
        }
        self.overlaps[index] = overlaps;
    }

    /// The figures of all ticks.
    #[must_use]
    pub fn finish(self, realtime_factor: f64) -> Summary {
        Summary {
            ours: self.ours.finish(),
            paper: self.paper.finish(),
            min_gap_m: self.smallest_gap_m,
            min_speed_mps: self.lowest_speed_mps,
            full_stops: self.stands.into_iter().map(StandTally::finish).sum(),
            collisions: self.collisions,
            collided: self.collided,
            timing: Timing { realtime_factor },
            bound: self.bound.finish(),
            envelope: EnvelopeFigures {
                engaged: self.scenario.envelope.engaged,
                limited_share: self.limited.0 as f64 / self.limited.1.max(1) as f64,
            },
            hardest_braking_mps2: self.hardest_braking_mps2,
        }
    }
}

/// The smaller one; a value that is not a number stays.
fn least(known: Option<f64>, value: f64) -> Option<f64> {
    Some(known.map_or(value, |known| if known < value || known.is_nan() { known } else { value }))
}
