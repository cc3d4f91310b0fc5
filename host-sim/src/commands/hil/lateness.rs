//! The lateness of the harness: its lateness enters tick by tick; the times at which it could not measure the device
//! leave.
//!
//! A cause that keeps the harness from the processor also delays a device that is a process of the same machine or is
//! emulated on it. For any other device it delays the harness's reception of the frames. So the lateness of a device
//! around a late tick of the harness does not count against the device. If that is most of the run, the device cannot
//! be judged.

use holdover::time::Duration;

use super::spread::Spread;

/// Largest lateness of the harness in a tick. Beyond it the device rightly takes its vehicle's motion for lost.
pub const LATE_MAX_MS: f64 = 40.0;
/// Largest lateness of the harness, except for one tick in a hundred: as late as a device may be.
pub const LATE_P99_MS: f64 = 20.0;
/// A tick disturbs if it is late by more than a period divided by this.
const DISTURBS: i64 = 4;
/// Number of ticks by which a device's answer may come after the message that it answers.
const BEFORE: i64 = 3;
/// Number of ticks by which it may be received later.
const AFTER: i64 = 1;

/// The lateness of the harness's ticks in real time; empty in lock step, which no lateness disturbs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lateness {
    ticks_us: Vec<i64>,
    /// Number of those ticks before the time 0 of the run.
    warm_up: i64,
    period: Duration,
}

impl Lateness {
    /// No tick yet; `warm_up` ticks will be before the time 0.
    #[must_use]
    pub const fn new(period: Duration, warm_up: i64) -> Self {
        Self { ticks_us: Vec::new(), warm_up, period }
    }

    /// Records the lateness of a tick.
    pub fn note(&mut self, late: Duration) {
        self.ticks_us.push(late.as_micros());
    }

    /// The distribution of the lateness.
    #[must_use]
    pub fn spread(&self) -> Spread {
        Spread::of(&self.ticks_us)
    }

    /// Whether the harness was late around a time of the run, in seconds: from three ticks before its tick to the one after.
    #[must_use]
    pub fn is_around(&self, at_s: f64) -> bool {
        let at_us = (at_s * 1e6).round() as i64;
        let period_us = self.period.as_micros().max(1);
        let tick = self.warm_up + at_us.div_euclid(period_us);
        (tick - BEFORE..=tick + AFTER)
            .filter_map(|tick| self.ticks_us.get(usize::try_from(tick).ok()?))
            .any(|late_us| *late_us > period_us / DISTURBS)
    }

    /// Whether a lateness of the harness may explain this latency of a command. It explains no latency longer than the
    /// ticks that are checked.
    #[must_use]
    pub fn excuses(&self, at_s: f64, latency: Duration) -> bool {
        latency <= self.period.times(BEFORE + 1 + AFTER) && self.is_around(at_s)
    }
}

/// Why there are too many disturbed commands for a judgement: there are more of them than judged ones.
#[must_use]
pub fn too_many(disturbed: usize, judged: usize) -> Option<String> {
    (disturbed > judged).then(|| format!("the harness was late around {disturbed} of {} commands", disturbed + judged))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_tick_disturbs_from_the_tick_before_it_to_the_third_after_it() {
        let mut lateness = Lateness::new(Duration::from_millis(10), 200);
        (0..400).for_each(|tick| lateness.note(Duration::from_micros(if tick == 200 + 58 { 2_501 } else { 2_500 })));
        let disturbed: Vec<i32> = (-200..200).filter(|tick| lateness.is_around(f64::from(*tick) * 0.01)).collect();
        assert_eq!(disturbed, [57, 58, 59, 60, 61]);
        assert!(lateness.is_around(0.61999) && !lateness.is_around(0.62) && !lateness.is_around(0.56999));
        assert!(
            lateness.excuses(0.6, Duration::from_millis(50)) && !lateness.excuses(0.6, Duration::from_micros(50_001))
        );
    }

    #[test]
    fn without_ticks_nothing_is_disturbed() {
        assert!(!Lateness::default().is_around(0.0) && !Lateness::default().is_around(-1.0));
    }
}
