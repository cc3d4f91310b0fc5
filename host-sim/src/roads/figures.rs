//! The figures of a corridor: the results of the referee and of the estimates enter; the figures of all seeds together
//! leave, and the reasons of a failed verdict.

use serde::Serialize;

use super::beliefs::{Beliefs, Class};
use super::entries::{EntryFigures, Errors};
use super::referee::Referee;
use super::touching::Place;
use super::traffic::Remains;
use crate::measure::bootstrap::{Interval, interval};
use crate::measure::metrics::percentile_abs;

/// Pairs of a unit and its target with a settled error beyond this, in metres, are counted.
const BEYOND_M: f64 = 0.2;

/// One run under one seed.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The seed.
    pub seed: u64,
    /// Travel times of the vehicles that have left.
    pub travel_times_s: Vec<f64>,
    /// The times at which they left.
    pub exits_s: Vec<f64>,
    /// Full stops.
    pub full_stops: usize,
    /// Collisions on roads, and in conflict areas.
    pub collisions: [usize; 2],
    /// Smallest bumper gap on a road, as the referee measured it.
    pub smallest_gap_m: Option<f64>,
    /// Shortest clearance of a conflict area, as the referee measured it.
    pub smallest_clearance_s: Option<f64>,
    /// Lowest speed of any vehicle, as the referee measured it.
    pub lowest_speed_mps: Option<f64>,
    /// Ticks of all vehicles, and those at which an envelope changed the command.
    pub ticks: [u64; 2],
    /// Errors: settled; within a second of a change; and those settled ones where nothing was heard since the change.
    pub errors: [Class; 3],
    /// The largest settled error of each pair of a unit and its target.
    pub pairs_m: Vec<f64>,
    /// Errors of the times at which vehicles foresaw to come to a conflict area.
    pub entries: Errors,
    /// Changes of association.
    pub changes: u64,
    /// Ticks at which a target was outside its bound; the second number is of those where a clock was off.
    pub violations: [u64; 2],
    /// The counts at the end of the run.
    pub remains: Remains,
}

impl Outcome {
    /// The result of a run that has ended.
    #[must_use]
    pub fn of(seed: u64, referee: &Referee, beliefs: &Beliefs, entries: Errors, remains: Remains) -> Self {
        let on_roads = referee.collisions.iter().filter(|one| matches!(one.place, Place::Road(_))).count();
        Self {
            seed,
            travel_times_s: referee.travel_times_s.iter().flatten().copied().collect(),
            exits_s: referee.exits_s(),
            full_stops: referee.stops.len(),
            collisions: [on_roads, referee.collisions.len() - on_roads],
            smallest_gap_m: referee.smallest_gap_m,
            smallest_clearance_s: referee.smallest_clearance_s,
            lowest_speed_mps: referee.lowest_speed_mps,
            ticks: referee.ticks,
            errors: [beliefs.settled, beliefs.changing, beliefs.unheard],
            pairs_m: beliefs.pairs_m.values().copied().collect(),
            entries,
            changes: beliefs.changes,
            violations: beliefs.violations,
            remains,
        }
    }
}

/// Position errors of one class.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorFigures {
    /// Ticks.
    pub ticks: u64,
    /// Largest magnitude.
    pub max_m: Option<f64>,
    /// Root of the mean square.
    pub rms_m: Option<f64>,
}

impl From<Class> for ErrorFigures {
    fn from(class: Class) -> Self {
        Self { ticks: class.count, max_m: class.max_m(), rms_m: class.rms_m() }
    }
}

/// The figures of all seeds together, under one condition.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Side {
    /// Vehicles that reached the end of their way.
    pub served: usize,
    /// Vehicles that had not reached it when the run was stopped.
    pub unserved: usize,
    /// Bumper gaps below 0 on a road.
    pub collisions_on_roads: usize,
    /// Two vehicles in one conflict area, on crossing ways.
    pub collisions_at_intersections: usize,
    /// Full stops, emergency stops among them.
    pub full_stops: usize,
    /// Emergency stops.
    pub emergency_stops: u64,
    /// Vehicles with a fault.
    pub faults: u64,
    /// Number of times that a driver took over.
    pub takeovers: u64,
    /// Mean travel time, from the arrival on.
    pub mean_travel_time_s: Option<f64>,
    /// Its interval of 95 % confidence over the seeds.
    pub mean_travel_time_interval_s: Option<Interval>,
    /// Longest travel time.
    pub longest_travel_time_s: Option<f64>,
    /// Smallest bumper gap on a road.
    pub smallest_gap_m: Option<f64>,
    /// Shortest time from when one vehicle leaves a conflict area to when the next one enters it.
    pub smallest_clearance_s: Option<f64>,
    /// Lowest speed of any vehicle.
    pub lowest_speed_mps: Option<f64>,
    /// Errors of the target's position, while its own association has not changed within a second.
    pub position_error: ErrorFigures,
    /// Errors within a second after such a change.
    pub position_error_after_change: ErrorFigures,
    /// Errors later than a second after a change, while nothing has been heard from the target since it.
    pub position_error_unheard: ErrorFigures,
    /// Pairs of a unit and its target that have a `position_error`.
    pub pairs: usize,
    /// Of these, pairs with an error beyond 0.2 m.
    pub pairs_beyond: usize,
    /// What the largest error of 99 % of the pairs does not exceed.
    pub pairs_p99_m: Option<f64>,
    /// How far off the times are at which vehicles foresee to come to a conflict area.
    pub entry_error: EntryFigures,
    /// Changes of association.
    pub association_changes: u64,
    /// Ticks at which a target was outside its bound, while neither its clock nor that of the unit was off.
    pub bound_violations: u64,
    /// The same while one of the clocks was off.
    pub bound_violations_by_clock: u64,
    /// Fraction of time in which an envelope changed the command.
    pub limited_share: f64,
    /// Number of times that a unit yielded to a vehicle that did not heed it.
    pub order_disagreements: u64,
    /// All refusals of the units, these included.
    pub refusals: u64,
    /// Messages that found no slot in a modem.
    pub turned_away: u64,
}

impl Side {
    /// The figures of the runs of all seeds, in their order.
    #[must_use]
    pub fn of(outcomes: &[&Outcome]) -> Self {
        let all = || outcomes.iter().copied();
        let times: Vec<f64> = all().flat_map(|outcome| outcome.travel_times_s.iter().copied()).collect();
        let least = |of: fn(&Outcome) -> Option<f64>| all().filter_map(of).reduce(f64::min);
        let class =
            |index: usize| all().map(|outcome| outcome.errors[index]).fold(Class::default(), Class::with).into();
        let pairs_m: Vec<f64> = all().flat_map(|outcome| outcome.pairs_m.iter().copied()).collect();
        let ticks: [u64; 2] = [0, 1].map(|which| all().map(|outcome| outcome.ticks[which]).sum());
        Self {
            served: times.len(),
            unserved: all().map(|outcome| outcome.remains.unserved).sum(),
            collisions_on_roads: all().map(|outcome| outcome.collisions[0]).sum(),
            collisions_at_intersections: all().map(|outcome| outcome.collisions[1]).sum(),
            full_stops: all().map(|outcome| outcome.full_stops).sum(),
            emergency_stops: all().map(|outcome| outcome.remains.emergencies).sum(),
            faults: all().map(|outcome| outcome.remains.faults).sum(),
            takeovers: all().map(|outcome| outcome.remains.takeovers).sum(),
            mean_travel_time_s: (!times.is_empty()).then(|| times.iter().sum::<f64>() / times.len() as f64),
            mean_travel_time_interval_s: of_seeds(outcomes),
            longest_travel_time_s: times.iter().copied().reduce(f64::max),
            smallest_gap_m: least(|outcome| outcome.smallest_gap_m),
            smallest_clearance_s: least(|outcome| outcome.smallest_clearance_s),
            lowest_speed_mps: least(|outcome| outcome.lowest_speed_mps),
            position_error: class(0),
            position_error_after_change: class(1),
            position_error_unheard: class(2),
            pairs: pairs_m.len(),
            pairs_beyond: pairs_m.iter().filter(|error_m| **error_m > BEYOND_M).count(),
            pairs_p99_m: percentile_abs(&pairs_m, 99.0),
            entry_error: all().map(|outcome| outcome.entries).fold(Errors::default(), Errors::with).into(),
            association_changes: all().map(|outcome| outcome.changes).sum(),
            bound_violations: all().map(|outcome| outcome.violations[0]).sum(),
            bound_violations_by_clock: all().map(|outcome| outcome.violations[1]).sum(),
            limited_share: ticks[1] as f64 / ticks[0].max(1) as f64,
            order_disagreements: all().map(|outcome| outcome.remains.disagreements).sum(),
            refusals: all().map(|outcome| outcome.remains.refusals).sum(),
            turned_away: all().map(|outcome| outcome.remains.turned_away).sum(),
        }
    }

    /// The mean travel time with the interval over the seeds, if there is one.
    #[must_use]
    pub fn spelled_travel_time(&self) -> String {
        let number = |value: f64| format!("{value:.2}");
        let mean = self.mean_travel_time_s.filter(|time| time.is_finite()).map_or("-".into(), number);
        match self.mean_travel_time_interval_s {
            Some([low, high]) => format!("{mean} ±{:.2}", (high - low) / 2.0),
            None => mean,
        }
    }

    /// Collisions on roads and in conflict areas together.
    #[must_use]
    pub fn collisions(&self) -> usize {
        self.collisions_on_roads + self.collisions_at_intersections
    }
}

/// The interval of the mean travel time; seeds with more vehicles count for more.
fn of_seeds(outcomes: &[&Outcome]) -> Option<Interval> {
    let sums: Vec<(f64, usize)> =
        outcomes.iter().map(|one| (one.travel_times_s.iter().sum::<f64>(), one.travel_times_s.len())).collect();
    interval(sums.len(), |drawn| {
        let (sum, count) = drawn.iter().fold((0.0, 0), |all, run| (all.0 + sums[*run].0, all.1 + sums[*run].1));
        (count > 0).then(|| sum / count as f64)
    })
}

/// The figures under one difference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WrongRow {
    /// The difference.
    pub what: String,
    /// The figures.
    #[serde(flatten)]
    pub side: Side,
}

/// The figures at a prediction step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepRow {
    /// Prediction step.
    pub step_s: f64,
    /// The figures.
    #[serde(flatten)]
    pub side: Side,
}

#[cfg(test)]
mod tests {
    use super::super::beliefs::Worst;
    use super::*;

    fn outcome(travel_times_s: &[f64], gap_m: Option<f64>, error_m: f64) -> Outcome {
        let worst = Worst { error_m, at_s: 1.0, by: 0, target: 1, age_s: 0.1 };
        let settled = Class { count: 2, worst: Some(worst), squares: error_m * error_m };
        let mut entries = Errors::default();
        entries.add(error_m);
        Outcome {
            seed: 1,
            travel_times_s: travel_times_s.to_vec(),
            exits_s: Vec::new(),
            full_stops: 1,
            collisions: [1, 2],
            smallest_gap_m: gap_m,
            smallest_clearance_s: None,
            lowest_speed_mps: gap_m,
            ticks: [10, 5],
            errors: [settled, Class::default(), Class::default()],
            pairs_m: vec![0.19, 0.21, 0.3],
            entries,
            changes: 4,
            violations: [5, 6],
            remains: Remains {
                unserved: 1,
                refusals: 2,
                disagreements: 3,
                turned_away: 4,
                emergencies: 5,
                faults: 6,
                takeovers: 7,
            },
        }
    }

    #[test]
    fn the_figures_of_several_seeds_are_of_all_their_vehicles_together() {
        let (one, other) = (outcome(&[20.0], Some(3.0), -0.3), outcome(&[30.0, 40.0], None, 0.1));
        let side = Side::of(&[&one, &other]);
        assert_eq!((side.served, side.unserved), (3, 2));
        assert_eq!((side.mean_travel_time_s, side.longest_travel_time_s), (Some(30.0), Some(40.0)));
        assert_eq!((side.collisions_on_roads, side.collisions_at_intersections, side.collisions()), (2, 4, 6));
        assert_eq!(
            (side.smallest_gap_m, side.smallest_clearance_s, side.lowest_speed_mps),
            (Some(3.0), None, Some(3.0))
        );
        assert_eq!((side.position_error.ticks, side.position_error.max_m), (4, Some(0.3)));
        assert!((side.position_error.rms_m.unwrap() - 0.025_f64.sqrt()).abs() < 1e-12);
        assert_eq!(
            (side.entry_error.entries, side.entry_error.mean_s.map(|mean_s| (mean_s * 100.0).round())),
            (2, Some(-10.0))
        );
        assert_eq!(side.position_error_unheard, ErrorFigures { ticks: 0, max_m: None, rms_m: None });
        assert_eq!((side.full_stops, side.association_changes, side.bound_violations), (2, 8, 10));
        assert_eq!((side.pairs, side.pairs_beyond, side.pairs_p99_m), (6, 4, Some(0.3)));
        assert_eq!((side.emergency_stops, side.faults, side.takeovers), (10, 12, 14));
        assert_eq!(side.bound_violations_by_clock, 12);
        assert_eq!((side.limited_share, side.refusals, side.order_disagreements, side.turned_away), (0.5, 4, 6, 8));
    }

    #[test]
    fn one_pair_in_a_hundred_may_be_farther_off_than_99_of_them() {
        let p99_m = |pairs: usize, off: usize| {
            let pairs_m = (0..pairs).map(|pair| if pair < off { 1.0 } else { 0.1 }).collect();
            Side::of(&[&Outcome { pairs_m, ..outcome(&[20.0], None, 0.1) }]).pairs_p99_m
        };
        assert_eq!([p99_m(0, 0), p99_m(99, 1), p99_m(100, 1)], [None, Some(1.0), Some(0.1)]);
        assert_eq!([p99_m(4_000, 40), p99_m(4_000, 41)], [Some(0.1), Some(1.0)]);
    }

    #[test]
    fn without_vehicles_there_is_no_figure() {
        let side = Side::of(&[&Outcome { travel_times_s: Vec::new(), ticks: [0, 0], ..outcome(&[], None, 0.1) }]);
        assert_eq!((side.served, side.mean_travel_time_s, side.longest_travel_time_s), (0, None, None));
        assert!(side.limited_share == 0.0);
    }
}
