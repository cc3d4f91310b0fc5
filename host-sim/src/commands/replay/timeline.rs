//! The log's clock: the times of a log's lines enter, the times of the unit's ticks leave.
//!
//! The first tick is at the first line's time, and every further one a period later. Frames at or before a tick are
//! received before it. Merged logs are slightly out of order, so a line may be up to [`DISORDER`] before the latest
//! line above it. Ticks never go back.

use holdover::time::{Duration, Instant};

use crate::error::Error;

/// Largest time by which a line may be before the latest line above it.
pub const DISORDER: Duration = Duration::from_millis(1_000);

/// Longest gap in a log. A longer gap comes from a clock that was set, or from two logs in one file. Ticking through
/// years would take days.
pub const LONGEST_GAP: Duration = Duration::from_millis(3_600_000);

/// The times of the unit's ticks.
#[derive(Clone, Copy, Debug)]
pub struct Timeline {
    period: Duration,
    /// Time of the next tick and of the latest line, once there was a line.
    next: Option<(Instant, Instant)>,
}

impl Timeline {
    /// A timeline without lines, with this period.
    #[must_use]
    pub fn new(period: Duration) -> Self {
        Self { period, next: None }
    }

    /// Takes in a line's time. All ticks that are then [`Timeline::due`] come before the line's content.
    ///
    /// # Errors
    /// A time that is impossible in one recording.
    pub fn read(&mut self, at: Instant) -> Result<(), Error> {
        let (next, latest) = self.next.unwrap_or((at, at));
        let step = at.since(latest);
        let split = "sort the log by time, or split it where its clock was set";
        if step < Duration::ZERO.minus(DISORDER) {
            return Err(Error::new(format!("the time is {} before that of a line above", spelled(step)), split));
        }
        if step > LONGEST_GAP {
            return Err(Error::new(format!("the time is {} after that of the line above", spelled(step)), split));
        }
        self.next = Some((next, latest.max(at)));
        Ok(())
    }

    /// The next tick before the latest line; `None`: the content of that line comes first.
    pub fn due(&mut self) -> Option<Instant> {
        let (tick, latest) = self.next.filter(|(tick, latest)| tick < latest)?;
        self.next = Some((tick.plus(self.period), latest));
        Some(tick)
    }

    /// The last tick: the first one at or after the last line. `None` if there was no line.
    #[must_use]
    pub fn last(self) -> Option<Instant> {
        self.next.map(|(tick, _)| tick)
    }
}

fn spelled(step: Duration) -> String {
    let millis = step.as_millis().unsigned_abs();
    format!("{}.{:03} s", millis / 1000, millis % 1000)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(millis: u64) -> Instant {
        Instant::from_micros(millis * 1000)
    }

    /// The ticks, in ms, that are due before each line is received, and the last one.
    fn ticks(lines: &[u64]) -> Vec<Vec<u64>> {
        let mut timeline = Timeline::new(Duration::from_millis(10));
        let mut ticks = Vec::new();
        for line in lines {
            timeline.read(at(*line)).unwrap();
            ticks.push(std::iter::from_fn(|| timeline.due()).map(|tick| tick.as_micros() / 1000).collect());
        }
        ticks.push(timeline.last().map(|tick| tick.as_micros() / 1000).into_iter().collect());
        ticks
    }

    #[test]
    fn a_line_at_the_time_of_a_tick_is_received_before_it() {
        assert_eq!(ticks(&[100, 110, 111]), [vec![], vec![100], vec![110], vec![120]]);
        assert_eq!(ticks(&[100, 100]), [vec![], vec![], vec![100]]);
        assert_eq!(ticks(&[]), [Vec::<u64>::new()]);
    }

    #[test]
    fn ticks_fill_a_gap_and_never_go_back() {
        assert_eq!(ticks(&[5, 40, 12, 46]), [vec![], vec![5, 15, 25, 35], vec![], vec![45], vec![55]]);
    }

    #[test]
    fn a_second_of_disorder_is_taken_and_no_more() {
        let mut timeline = Timeline::new(Duration::from_millis(10));
        timeline.read(at(5000)).unwrap();
        timeline.read(at(4000)).unwrap();
        let error = timeline.read(at(3999)).unwrap_err().to_string();
        assert!(error.starts_with("the time is 1.001 s before that of a line above; sort the log"), "{error}");
    }

    #[test]
    fn an_hour_of_silence_is_taken_and_no_more() {
        let mut timeline = Timeline::new(Duration::from_millis(10));
        timeline.read(at(0)).unwrap();
        timeline.read(at(3_600_000)).unwrap();
        let error = timeline.read(at(7_200_001)).unwrap_err().to_string();
        assert!(error.starts_with("the time is 3600.001 s after that of the line above; sort the log"), "{error}");
    }
}
