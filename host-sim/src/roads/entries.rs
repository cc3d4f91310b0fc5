//! How well vehicles foresee when they will come to a conflict area: sightings enter, tick by tick; the error of the foreseen times leaves.
//!
//! A claim of a pass can be firm [`AHEAD_S`] after it was made, and no sooner. So what counts is the time that a vehicle's own horizon has
//! for its entry so long before it. A vehicle whose horizon does not reach the area then has no such time.

use std::collections::{BTreeMap, VecDeque};

use holdover::passes::Rules;
use serde::Serialize;

use super::network::Network;
use super::watch::{Sighting, Watch};

/// So long before an entry the foreseen time is taken, in seconds: the time after which a claim counts.
pub const AHEAD_S: f64 = (Rules::UNIT.silence.as_micros() + Rules::UNIT.clocks.as_micros()) as f64 / 1e6;

/// What is foreseen is asked once in so long, in seconds.
pub const ASKED_S: f64 = 0.1;

/// Errors of foreseen times: the true minus the foreseen time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    count: u64,
    sum_s: f64,
    squares: f64,
}

impl Errors {
    pub(super) fn add(&mut self, error_s: f64) {
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

/// What a vehicle foresees of its next area.
struct Foreseen {
    /// The area, by its place among those of the road.
    next: usize,
    /// When it was asked, and the time that it foresaw.
    times_s: VecDeque<(f64, f64)>,
}

/// The errors of all vehicles.
pub struct Entries<'a> {
    network: &'a Network,
    /// The errors so far.
    pub errors: Errors,
    foreseen: BTreeMap<usize, Foreseen>,
}

impl<'a> Entries<'a> {
    /// Nothing is foreseen yet.
    #[must_use]
    pub fn new(network: &'a Network) -> Self {
        Self { network, errors: Errors::default(), foreseen: BTreeMap::new() }
    }
}

impl Watch for Entries<'_> {
    fn tick(&mut self, at_s: f64, sightings: &[Sighting]) {
        for own in sightings {
            let (next, _) = self.network.next_area(own.road, own.way_m);
            let nothing = || Foreseen { next, times_s: VecDeque::new() };
            let foreseen = self.foreseen.entry(own.trip).or_insert_with(nothing);
            let off_s = |asked_s: f64| (at_s - AHEAD_S - asked_s).abs();
            if foreseen.next != next {
                let then = foreseen.times_s.iter().find(|(asked_s, _)| off_s(*asked_s) <= 0.5 * ASKED_S + 1e-9);
                if let Some((_, entry_s)) = then {
                    self.errors.add(at_s - entry_s);
                }
                *foreseen = nothing();
            }
            foreseen.times_s.extend(own.foreseen_entry_s.map(|entry_s| (at_s, entry_s)));
            while foreseen.times_s.front().is_some_and(|(asked_s, _)| *asked_s < at_s - AHEAD_S - ASKED_S) {
                foreseen.times_s.pop_front();
            }
        }
    }

    fn left(&mut self, _: f64, trip: usize) {
        self.foreseen.remove(&trip);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::example;

    /// The errors of a vehicle that comes to the first intersection at 10 m/s, from so many metres before the area on. `reads` is the time
    /// that it foresees at each time; it is there at 0 s.
    fn figures(from_m: f64, reads: impl Fn(f64) -> Option<f64>) -> EntryFigures {
        let network = Network::of(&example::corridor());
        let (_, way_m) = network.next_area(2, 0.0);
        let mut entries = Entries::new(&network);
        for tick in (-10.0 * from_m) as i32..=500 {
            let at_s = f64::from(tick) / 100.0;
            let foreseen_entry_s = (tick % 10 == 0).then(|| reads(at_s)).flatten();
            let own = example::sighting(7, 2, way_m.unwrap() + 10.0 * at_s);
            entries.tick(at_s, &[Sighting { foreseen_entry_s, ..own }]);
        }
        entries.errors.into()
    }

    #[test]
    fn what_counts_is_what_was_foreseen_4_56_s_before() {
        let right = figures(100.0, |_| Some(0.0));
        assert_eq!(right.entries, 1);
        assert!(right.mean_s.unwrap().abs() < 0.011, "{right:?}");
        let late = figures(100.0, |at_s| Some(if (-4.62..-4.5).contains(&at_s) { -0.4 } else { 3.0 }));
        assert_eq!(late.entries, 1);
        assert!((late.mean_s.unwrap() - 0.4).abs() < 0.011, "{late:?}");
    }

    #[test]
    fn an_entry_that_was_not_foreseen_so_long_before_has_no_error() {
        let nothing = EntryFigures { entries: 0, mean_s: None, std_s: None };
        assert_eq!(figures(100.0, |_| None), nothing);
        assert_eq!(figures(100.0, |at_s| (at_s > -4.4).then_some(0.0)), nothing);
        assert_eq!(figures(100.0, |at_s| (at_s < -4.7).then_some(0.0)), nothing);
        assert_eq!(figures(40.0, |_| Some(0.0)), nothing);
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
