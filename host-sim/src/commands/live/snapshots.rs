//! Copies of the stage at some moments: the stage enters at every tick; the copy that a way back begins with leaves.
//!
//! There are never more than [`MOST`], so the memory is bounded. They lie the farther apart the longer ago they are: a way back of seconds
//! plays some seconds again, however long the run has been, and one of an hour plays again some share of that hour.

use super::stage::Stage;

/// Time from one copy to the next, in seconds of the run.
pub const EVERY_S: f64 = 5.0;

/// The most copies. One of a vehicle takes some 200 kB.
pub const MOST: usize = 16;

/// The copies, in the order of time.
pub struct Snapshots<S> {
    every: u64,
    kept: Vec<S>,
}

impl<S: Stage> Snapshots<S> {
    /// None yet, of a stage with this period.
    #[must_use]
    pub fn of_period(period_s: f64) -> Self {
        Self { every: (EVERY_S / period_s).round().max(1.0) as u64, kept: Vec::new() }
    }

    /// Takes a copy of the stage if it is time for one.
    pub fn note(&mut self, stage: &S) {
        let ticks = stage.ticks();
        if !ticks.is_multiple_of(self.every) || self.kept.last().is_some_and(|last| last.ticks() >= ticks) {
            return;
        }
        self.kept.push(stage.clone());
        if self.kept.len() > MOST {
            // The one goes that leaves the smallest gap behind, measured by how long ago it was.
            let gap = |place: usize| {
                let [before, here, after] = [place - 1, place, place + 1].map(|place| self.kept[place].ticks());
                (after - before) as f64 / (ticks - here) as f64
            };
            let least = (1..self.kept.len() - 1).min_by(|a, b| gap(*a).total_cmp(&gap(*b)));
            self.kept.remove(least.unwrap_or(0));
        }
    }

    /// A copy of the last stage that had no more ticks than these; later ones are of a time that may not come again.
    pub fn before(&mut self, ticks: u64) -> Option<S> {
        self.kept.truncate(self.kept.partition_point(|kept| kept.ticks() <= ticks));
        self.kept.last().cloned()
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.kept.clear();
    }
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::*;
    use crate::commands::live::bus_view::Row;
    use crate::commands::live::scene::{Pulse, Scene};
    use crate::input::scenario::Event;

    #[derive(Clone)]
    struct Clock(u64);

    impl Stage for Clock {
        fn ticks(&self) -> u64 {
            self.0
        }
        fn next_s(&self) -> f64 {
            self.0 as f64 * 0.01
        }
        fn is_over(&self) -> bool {
            false
        }
        fn has(&self, _: usize) -> bool {
            true
        }
        fn add(&mut self, _: Event) {}
        fn expect(&mut self, _: &[Event]) {}
        fn step(&mut self) -> io::Result<()> {
            self.0 += 1;
            Ok(())
        }
        fn frames(&self, _: usize) -> Option<Vec<Row>> {
            None
        }
        fn scene(&self, pulse: &Pulse) -> Scene {
            Scene {
                at_s: 0.0,
                pulse: pulse.clone(),
                largest_error_m: [None; 2],
                hits: Vec::new(),
                links: Vec::new(),
                vehicles: Vec::new(),
            }
        }
    }

    #[test]
    fn they_are_few_and_a_way_back_of_seconds_is_short_however_long_the_run_has_been() {
        let (mut snapshots, mut clock) = (Snapshots::of_period(0.01), Clock(0));
        for _ in 0..720_000 {
            clock.step().unwrap();
            snapshots.note(&clock);
        }
        assert_eq!(snapshots.kept.len(), MOST);
        for (back_s, again_s) in [(10, 15), (60, 60), (600, 600), (3600, 3600)] {
            let wanted = clock.0 - back_s * 100;
            let found = snapshots.before(wanted).unwrap().0;
            assert!(wanted - found <= again_s * 100, "{back_s} s back: {} s again", (wanted - found) / 100);
        }
        assert!(snapshots.before(10).is_none());
        snapshots.clear();
        assert!(snapshots.before(u64::MAX).is_none());
    }
}
