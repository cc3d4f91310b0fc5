//! When a tick does what is not done in every tick. The time, and whether the tick has much else to do, enter; what it does leaves.
//!
//! The own messages need the own horizon, which takes most of a tick. So the rest has other ticks, where two ticks or more fit between
//! own messages:
//!
//! * passes are planned in the tick before;
//! * a tick that has much else to do leaves the own messages to the next one, once;
//! * after a pause, passes are planned before the own messages are sent, in a tick of their own.

use crate::time::{Duration, Instant};

/// The ego's own horizon, past its changes of target and with its messages, takes as long as so many of peers. A review takes as long as
/// one.
const OWN: usize = 3;

/// When the own messages are due next, and what was done for them.
#[derive(Clone, Debug)]
pub(super) struct Schedule {
    due: Option<Instant>,
    /// Passes are planned for them.
    is_planned: bool,
    /// A tick that had much else to do left them to a later one.
    is_put_off: bool,
}

/// What a tick does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tasks {
    /// It reviews the order at the intersections.
    pub reviews: bool,
    /// It plans passes.
    pub plans: bool,
    /// It computes the own horizon, and sends the own messages.
    pub speaks: bool,
    /// It leaves to the next tick what can wait.
    pub waits: bool,
}

impl Tasks {
    /// What this takes as long as so many horizons of peers.
    pub fn besides(self) -> usize {
        let own = if self.speaks { OWN } else { 0 };
        if self.reviews { own.saturating_add(1) } else { own }
    }
}

impl Schedule {
    /// The own messages are due at once.
    pub const NEW: Self = Self { due: None, is_planned: false, is_put_off: false };

    /// What the tick of now does, with own messages every so often. A schedule that was missed starts anew from now.
    pub fn tasks(
        &mut self,
        now: Instant,
        period: Duration,
        between: Duration,
        is_busy: impl FnOnce() -> bool,
    ) -> Tasks {
        let spreads = period.times(2) <= between;
        let due = self.due.unwrap_or(now);
        let is_due = now >= due;
        // Half a period more, because ticks may come a little early.
        let soon = if spreads { Duration::from_micros(period.times(3).as_micros() >> 1) } else { Duration::ZERO };
        let puts_off = spreads && is_due && !self.is_put_off && is_busy();
        let plans = now.plus(soon) >= due && !self.is_planned && !puts_off;
        // At the start there is nothing to plan yet.
        let is_late = spreads && plans && self.due.is_some();
        let speaks = is_due && !puts_off && !is_late;
        let next = due.plus(between);
        self.due = Some(match speaks {
            true if next <= now => now.plus(between),
            true => next,
            false => due,
        });
        self.is_planned = (self.is_planned || plans) && !speaks;
        self.is_put_off = (self.is_put_off || puts_off) && !speaks;
        Tasks { reviews: false, plans, speaks, waits: speaks && spreads }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK: Duration = Duration::from_millis(10);
    const BETWEEN: Duration = Duration::from_millis(100);

    /// The milliseconds of the ticks that plan, and of those that speak.
    fn ticks(at: impl IntoIterator<Item = u32>, busy: &[u32]) -> (Vec<u32>, Vec<u32>) {
        let mut schedule = Schedule::NEW;
        let (mut plans, mut speaks) = (Vec::new(), Vec::new());
        for milliseconds in at {
            let now = Instant::from_micros(u64::from(milliseconds) * 1_000);
            let tasks = schedule.tasks(now, TICK, BETWEEN, || busy.contains(&milliseconds));
            plans.extend(tasks.plans.then_some(milliseconds));
            speaks.extend(tasks.speaks.then_some(milliseconds));
        }
        (plans, speaks)
    }

    #[test]
    fn passes_are_planned_in_the_tick_before() {
        assert_eq!(ticks((0..=300).step_by(10), &[]), (vec![0, 90, 190, 290], vec![0, 100, 200, 300]));
        // Ticks that come a little early or late.
        assert_eq!(ticks([0, 81, 89, 101, 190, 199, 211], &[]), (vec![0, 89, 190], vec![0, 101, 211]));
    }

    #[test]
    fn a_busy_tick_leaves_the_own_messages_to_the_next_one_and_the_schedule_stays() {
        assert_eq!(ticks((0..=210).step_by(10), &[100]), (vec![0, 90, 190], vec![0, 110, 200]));
        // Once, though the next one is busy too; and a tick in which nothing is due leaves nothing.
        assert_eq!(ticks((0..=210).step_by(10), &[50, 90, 100, 110]), (vec![0, 90, 190], vec![0, 110, 200]));
    }

    #[test]
    fn after_a_pause_each_has_a_tick_of_its_own() {
        let after = (3_000..=3_120).step_by(10);
        assert_eq!(ticks([0, 10].into_iter().chain(after), &[3_000]), (vec![0, 3_010, 3_110], vec![0, 3_020, 3_120]));
    }

    #[test]
    fn where_a_period_is_as_long_as_the_time_between_messages_a_tick_does_all() {
        let mut schedule = Schedule::NEW;
        for tick in 0..5 {
            let now = Instant::ZERO.plus(BETWEEN.times(tick));
            let tasks = schedule.tasks(now, BETWEEN, BETWEEN, || true);
            assert_eq!(tasks, Tasks { reviews: false, plans: true, speaks: true, waits: false });
        }
    }
}
