//! How well vehicles foresee when they will come to a conflict area: sightings enter, tick by tick; the error of the foreseen times leaves.
//!
//! A claim of a pass can be firm [`AHEAD_S`] after it was made, and no sooner. So what counts is the time that a vehicle's own horizon has
//! for its entry so long before it. What has to be claimed besides, before and after the stay, follows from how far that time is off.

use std::collections::{BTreeMap, BTreeSet};

use holdover::passes::Rules;
use serde::Serialize;

use super::network::Network;
use super::watch::{Sighting, Watch};

/// So long before an entry its time is foreseen, in seconds: the time after which a claim counts.
pub const AHEAD_S: f64 = (Rules::UNIT.silence.as_micros() + Rules::UNIT.clocks.as_micros()) as f64 / 1e6;

/// Errors of foreseen times: the true minus the foreseen time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    count: u64,
    sum_s: f64,
    squares: f64,
}

impl Errors {
    fn add(&mut self, error_s: f64) {
        *self = self.with(Self { count: 1, sum_s: error_s, squares: error_s * error_s });
    }

    /// Those of two runs together.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self { count: self.count + other.count, sum_s: self.sum_s + other.sum_s, squares: self.squares + other.squares }
    }
}

/// The figures of such errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EntryFigures {
    /// Entries.
    pub entries: u64,
    /// Mean of the true minus the foreseen time.
    pub mean_s: Option<f64>,
    /// Standard deviation.
    pub std_s: Option<f64>,
}

impl From<Errors> for EntryFigures {
    fn from(Errors { count, sum_s, squares }: Errors) -> Self {
        let mean_s = (count > 0).then(|| sum_s / count as f64);
        let std_s = mean_s.map(|mean_s| (squares / count as f64 - mean_s * mean_s).max(0.0).sqrt());
        Self { entries: count, mean_s, std_s }
    }
}

/// The errors of all vehicles.
pub struct Entries<'a> {
    network: &'a Network,
    /// The errors so far.
    pub errors: Errors,
    /// Trips and intersections that a vehicle's own horizon did not reach in the last tick.
    short: BTreeSet<(usize, usize)>,
    /// The foreseen times, until the vehicle is there.
    foreseen_s: BTreeMap<(usize, usize), f64>,
}

impl<'a> Entries<'a> {
    /// Nothing is foreseen yet.
    #[must_use]
    pub fn new(network: &'a Network) -> Self {
        Self { network, errors: Errors::default(), short: BTreeSet::new(), foreseen_s: BTreeMap::new() }
    }
}

impl Watch for Entries<'_> {
    fn tick(&mut self, at_s: f64, sightings: &[Sighting]) {
        for own in sightings {
            for stop in &self.network.lanes[own.road].stops {
                let key = (own.trip, stop.intersection);
                let way_m = stop.at_m - self.network.junctions[stop.intersection].half_m - own.way_m;
                if way_m <= 0.0 {
                    if let Some(foreseen_s) = self.foreseen_s.remove(&key) {
                        self.errors.add(at_s - foreseen_s);
                    }
                } else if own.foreseen_m.is_some_and(|foreseen_m| foreseen_m < way_m) {
                    self.short.insert(key);
                } else if own.foreseen_m.is_some() && self.short.remove(&key) {
                    self.foreseen_s.entry(key).or_insert(at_s + AHEAD_S);
                }
            }
        }
    }

    fn left(&mut self, _: f64, _: usize) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::example;

    /// The errors of a vehicle that comes to the first intersection at 10 m/s, from 100 m before the area on. `reads` is the way that its
    /// own horizon has at each time.
    fn figures(reads: impl Fn(f64) -> Option<f64>) -> EntryFigures {
        let network = Network::of(&example::corridor());
        let stop = network.lanes[2].stops[0];
        let begins_m = stop.at_m - network.junctions[stop.intersection].half_m;
        let mut entries = Entries::new(&network);
        for tick in 0..=1_000 {
            let at_s = f64::from(tick) / 100.0;
            let own = example::sighting(7, 2, begins_m - 100.0 + 10.0 * at_s);
            entries.tick(at_s, &[Sighting { foreseen_m: reads(at_s), ..own }]);
        }
        entries.errors.into()
    }

    #[test]
    fn a_vehicle_that_drives_as_foreseen_is_there_at_the_foreseen_time() {
        let figures = figures(|_| Some(10.0 * AHEAD_S));
        assert_eq!(figures.entries, 1);
        assert!(figures.mean_s.unwrap().abs() < 0.011 && figures.std_s.unwrap() < 1e-9, "{figures:?}");
    }

    #[test]
    fn one_that_is_slower_than_foreseen_is_late_by_that_and_counts_once_whatever_it_foresees_later() {
        // It foresees 11 m/s, and so its entry 4.56 s after it is 50.16 m before the area; it takes 5.016 s.
        let figures = figures(|at_s| Some(if (5.2..5.4).contains(&at_s) { 0.0 } else { 11.0 * AHEAD_S }));
        assert_eq!(figures.entries, 1);
        assert!((figures.mean_s.unwrap() - 0.456).abs() < 0.011, "{figures:?}");
    }

    #[test]
    fn without_a_horizon_and_for_one_that_begins_too_near_there_is_no_error() {
        let nothing = EntryFigures { entries: 0, mean_s: None, std_s: None };
        assert_eq!(figures(|_| None), nothing);
        assert_eq!(figures(|_| Some(200.0)), nothing);
    }

    #[test]
    fn the_errors_of_two_runs_are_those_of_all_their_entries() {
        let (mut one, mut other) = (Errors::default(), Errors::default());
        one.add(-0.1);
        other.add(0.1);
        other.add(0.3);
        let figures = EntryFigures::from(one.with(other));
        assert_eq!(figures.entries, 3);
        assert!((figures.mean_s.unwrap() - 0.1).abs() < 1e-12);
        assert!((figures.std_s.unwrap() - (0.08_f64 / 3.0).sqrt()).abs() < 1e-12);
    }
}
