//! The clock of an evaluation: times of the recordings enter; whole microseconds since an origin leave, so that sends,
//! arrivals, stamps and ticks can be compared exactly.
//!
//! Recorded times are decimal fractions, which binary fractions hold only approximately: 0.11 s + 0.02 s is not 0.13 s.
//! Whether a message has arrived at a tick must not depend on that. A microsecond is far below the resolution of
//! recordings.

use crate::sim::time::micros;

/// The clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timeline {
    origin_s: f64,
    step_s: f64,
}

impl Timeline {
    /// A clock whose origin is the last multiple of the step at or before a time, so that ticks are at multiples of the
    /// step.
    #[must_use]
    pub fn around(start_s: f64, step_s: f64) -> Self {
        Self { origin_s: (start_s / step_s).floor() * step_s, step_s }
    }

    /// A clock whose origin, and tick 0, is at a time.
    #[must_use]
    pub fn from(start_s: f64, step_s: f64) -> Self {
        Self { origin_s: start_s, step_s }
    }

    /// A recorded time, rounded to the nearest microsecond.
    #[must_use]
    pub fn micros(&self, recorded_s: f64) -> i64 {
        micros(recorded_s - self.origin_s)
    }

    /// The recorded time of an instant.
    #[must_use]
    pub fn recorded_s(&self, at_us: i64) -> f64 {
        self.origin_s + seconds(at_us)
    }

    /// The instant of a tick.
    #[must_use]
    pub fn tick(&self, index: u64) -> i64 {
        micros(index as f64 * self.step_s)
    }

    /// The instants of the ticks up to an instant.
    pub fn ticks(self, end_us: i64) -> impl Iterator<Item = i64> {
        (0..).map(move |index| self.tick(index)).take_while(move |at_us| *at_us <= end_us)
    }
}

/// The time in seconds. The quotient is the float nearest to the decimal fraction, so it equals a limit that is written
/// as one.
#[must_use]
pub fn seconds(us: i64) -> f64 {
    us as f64 / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_decimal_fractions_meet_their_tick() {
        let timeline = Timeline::around(0.0, 0.01);
        assert_ne!(0.1 + 0.2, 0.3);
        assert_eq!(timeline.micros(0.1) + timeline.micros(0.2), timeline.tick(30));
        assert_eq!(seconds(timeline.tick(10)), 0.1);
    }

    #[test]
    fn ticks_are_multiples_of_the_step_wherever_a_recording_starts() {
        for (start_s, first_us) in [(0.0, 0), (0.004, 4_000), (17.25, 0), (1_700_000_000.255, 5_000), (-3.996, 4_000)] {
            let timeline = Timeline::around(start_s, 0.01);
            assert_eq!(timeline.micros(start_s), first_us, "{start_s}");
        }
    }

    #[test]
    fn the_last_tick_is_at_the_end_or_before() {
        let timeline = Timeline::from(5.0, 0.3);
        assert_eq!(timeline.ticks(900_000).collect::<Vec<_>>(), [0, 300_000, 600_000, 900_000]);
        assert_eq!(timeline.ticks(899_999).count(), 3);
        assert_eq!(timeline.ticks(-1).count(), 0);
    }
}
