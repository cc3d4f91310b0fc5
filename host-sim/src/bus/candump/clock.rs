//! The times of candump's screen: times as they stand in the lines enter, times since one moment leave.
//!
//! `-t z` (since the first frame) and `-t d` (since the frame before) look alike. But in one interface's lines the times
//! of `-t z` hardly ever go back, and those of `-t d` do in about half of the lines.

use std::collections::BTreeMap;

use holdover::time::{Duration, Instant};

/// In at least this share of the lines, one in so many, differences go back. Two frames of `-t z` may have changed places.
const BACK_IN: usize = 10;

/// So many lines are enough to tell the two apart.
pub(super) const ENOUGH: usize = 100;

/// The meaning of the times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Clock {
    /// Since one moment.
    Since,
    /// Since the line before; with the sum up to the last line.
    Differences(Instant),
}

impl Clock {
    /// The meaning of the first times of a log, each with its interface. Differences that are all alike do not go back
    /// either, but no bus has most of its frames in one microsecond.
    pub(super) fn of<'a>(times: impl Iterator<Item = (&'a str, Instant)>) -> Self {
        let differences = Self::Differences(Instant::from_micros(0));
        let mut last = BTreeMap::new();
        let (mut steps, mut back, mut none) = (0, 0, 0);
        for (interface, at) in times {
            let Some(before) = last.insert(interface, at) else { continue };
            steps += 1;
            back += usize::from(at < before);
            none += usize::from(at == before);
        }
        if 2 * none > steps || BACK_IN * back > steps { differences } else { Self::Since }
    }

    /// The time of the next line.
    pub(super) fn read(&mut self, at: Instant) -> Instant {
        match self {
            Self::Since => at,
            Self::Differences(sum) => {
                let difference = i64::try_from(at.as_micros()).unwrap_or(i64::MAX);
                *sum = sum.plus(Duration::from_micros(difference));
                *sum
            }
        }
    }
}
