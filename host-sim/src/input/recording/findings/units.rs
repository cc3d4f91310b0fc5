//! The units of a drive: its intervals enter; the unit that a column seems to have leaves, if it is another one than its name says.
//!
//! Distance by the positions over distance by the speeds is 1. A wrong unit makes it a number that is known.

use super::{Step, short};

/// A sum of intervals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Share {
    /// Their time.
    pub length_s: f64,
    /// Their distance by the positions.
    pub moved_m: f64,
    /// Their distance by the speeds.
    pub driven_m: f64,
}

impl Share {
    /// One more.
    pub fn with(self, step: &Step) -> Self {
        Self {
            length_s: self.length_s + step.length_s,
            moved_m: self.moved_m + step.moved_m,
            driven_m: self.driven_m + step.driven_m,
        }
    }

    /// One less.
    pub fn without(self, step: &Step) -> Self {
        let Step { length_s, moved_m, driven_m, .. } = *step;
        self.with(&Step { length_s: -length_s, moved_m: -moved_m, driven_m: -driven_m, ..*step })
    }
}

/// Below this way, in metres, nothing is to be seen.
const LEAST_M: f64 = 5.0;
/// A ratio is a known one within this share.
const WITHIN: f64 = 0.1;
/// The ratios of a drive whose units are right.
const RIGHT: (f64, f64) = (0.8, 1.25);
/// The way by positions may differ by this mean speed without a word, in m/s.
const NOISE_MPS: f64 = 0.3;

/// Cause and remedy, if the units are not those of the columns.
pub fn of(steps: &[Step]) -> Option<(String, &'static str)> {
    let all = steps.iter().fold(Share::default(), Share::with);
    let (moved, driven) = (all.moved_m / all.length_s, all.driven_m / all.length_s);
    if all.moved_m.abs().max(all.driven_m.abs()) < LEAST_M || (moved - driven).abs() <= NOISE_MPS {
        return None;
    }
    let ratio = all.moved_m / all.driven_m;
    let is = |known: f64| (ratio / known - 1.0).abs() < WITHIN;
    if (RIGHT.0..=RIGHT.1).contains(&ratio) {
        return None;
    }
    let moves =
        format!("the positions move at {} m/s in the mean where the speeds say {} m/s", short(moved), short(driven));
    Some(if is(1e-3) {
        (format!("{moves}, as if the times were milliseconds"), "give `t_s` in seconds, and every column in its unit")
    } else if is(1.0 / 3.6) {
        (format!("{moves}, as if the speeds were km/h"), "divide the speeds by 3.6")
    } else if is(1e3) {
        (format!("{moves}, as if the positions were millimetres"), "give `position_m` in metres")
    } else if is(-1.0) {
        (format!("{moves}, so they fall while it drives"), "count positions in the direction of driving")
    } else {
        (moves, "check the units of `t_s`, `position_m` and `speed_mps`")
    })
}
