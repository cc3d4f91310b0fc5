//! How late the harness was, tick by tick, enters; when it could not measure the device leaves.
//!
//! What keeps the harness from its processor keeps a device that is a process of the same machine, or is emulated on it, from
//! it too, and makes late what the harness is told of any other one. So around a tick in which the harness was late nothing is
//! put down to the device that only a clock tells; and where that is most of the run, there is nothing to judge by.

use super::outcome::Outcome;
use super::session::Setup;

/// The harness may be so late in one tick: later, and the device rightly takes its vehicle's motion for lost.
pub const LATE_MAX_MS: f64 = 40.0;
/// And so late in one of a hundred: as late as a device may be.
pub const LATE_P99_MS: f64 = 20.0;
/// This share of a period late, it has missed something.
const DISTURBED: f64 = 0.25;
/// The harness's ticks in real time; none in lock step, which no lateness disturbs.
#[derive(Clone, Copy, Debug)]
pub struct Lateness<'a> {
    ticks_us: &'a [i64],
    /// Ticks before the time 0.
    warm_up: usize,
    period_s: f64,
}

impl<'a> Lateness<'a> {
    /// Of a run.
    #[must_use]
    pub fn of(setup: &Setup, outcome: &'a Outcome) -> Self {
        let ticks_us: &[i64] = if outcome.steps.is_none() { &outcome.lateness_us } else { &[] };
        // One tick more than there are samples of the trace.
        let warm_up = ticks_us.len().saturating_sub(outcome.trace.times_s.len() + 1);
        Self { ticks_us, warm_up, period_s: setup.scenario.period_s }
    }

    /// Whether the harness was late around a time of the run: from three ticks before, when what was said then was sent, to
    /// the one after.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)] // ticks of a run
    pub fn is_around(&self, at_s: f64) -> bool {
        let tick = self.warm_up + (at_s / self.period_s).max(0.0) as usize;
        let around = self.ticks_us.iter().skip(tick.saturating_sub(3)).take(5);
        around.into_iter().any(|late_us| *late_us as f64 * 1e-6 > DISTURBED * self.period_s)
    }
}

/// Why so many disturbed commands are too many beside so many that could be judged: they are more.
#[must_use]
pub fn too_many(disturbed: usize, judged: usize) -> Option<String> {
    (disturbed > judged).then(|| format!("the harness was late around {disturbed} of {} commands", disturbed + judged))
}
