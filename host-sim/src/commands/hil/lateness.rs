//! How late the harness was, tick by tick, enters; when it could not measure the device leaves.
//!
//! What keeps the harness from its processor keeps a device that is a process of the same machine, or is emulated on it, from
//! it too, and makes late what the harness is told of any other one. So what a device is late by around a tick in which the
//! harness was late is not put down to it; and where that is most of the run, there is nothing to judge by.

use holdover::time::Duration;

use super::spread::Spread;

/// The harness may be so late in one tick: later, and the device rightly takes its vehicle's motion for lost.
pub const LATE_MAX_MS: f64 = 40.0;
/// And so late in one of a hundred: as late as a device may be.
pub const LATE_P99_MS: f64 = 20.0;
/// A tick that is late by a period divided by this disturbs.
const DISTURBS: i64 = 4;
/// What is said in a tick may be an answer to what was said so many ticks before.
const BEFORE: i64 = 3;
/// And may be known only so many ticks later.
const AFTER: i64 = 1;

/// The harness's ticks in real time; none in lock step, which no lateness disturbs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lateness {
    ticks_us: Vec<i64>,
    /// Of them, those before the time 0 of the run.
    warm_up: i64,
    period: Duration,
}

impl Lateness {
    /// No tick yet; so many are going to be before the time 0.
    #[must_use]
    pub const fn new(period: Duration, warm_up: i64) -> Self {
        Self { ticks_us: Vec::new(), warm_up, period }
    }

    /// A tick was so late.
    pub fn note(&mut self, late: Duration) {
        self.ticks_us.push(late.as_micros());
    }

    /// How late they were.
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

    /// Whether a command at that time may be so long after the motion that it rests on because of the harness: nothing that
    /// takes longer than the ticks that are looked at.
    #[must_use]
    pub fn excuses(&self, at_s: f64, latency: Duration) -> bool {
        latency <= self.period.times(BEFORE + 1 + AFTER) && self.is_around(at_s)
    }
}

/// Why so many disturbed commands are too many beside so many that could be judged: they are more.
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
