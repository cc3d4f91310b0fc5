//! The time: the core's cycles enter, instants and ticks leave.

use super::registers;
use crate::board::periods::{PERIOD_MICROS, Periods};
use holdover::time::Instant;

/// A frame takes 94 µs at least (47 bits at 500 kbit/s), so nothing is missed by asking every 50 µs whether one has come. To
/// ask all the time would keep the bus to the controller busy, and the emulator from everything else.
const POLL_MICROS: u64 = 50;

/// The time since the start, and the ticks.
pub struct Clock {
    cycles_per_micro: u32,
    /// The count at the last reading, and the cycles up to it that are not yet a microsecond.
    seen: u32,
    rest: u32,
    micros: u64,
    /// When the next period begins.
    next: u64,
    periods: Periods,
}

impl Clock {
    pub fn start(cycles_per_micro: u32) -> Self {
        registers::start_cycles();
        Self {
            cycles_per_micro,
            seen: registers::cycles(),
            rest: 0,
            micros: 0,
            next: PERIOD_MICROS,
            periods: Periods::new(),
        }
    }

    /// The time since the start, to a microsecond. To be called more often than the counter wraps (4 s), which the shell's
    /// loop does.
    pub fn now(&mut self) -> Instant {
        let count = registers::cycles();
        let passed = u64::from(count.wrapping_sub(self.seen)) + u64::from(self.rest);
        let per_micro = u64::from(self.cycles_per_micro.max(1));
        self.seen = count;
        self.rest = (passed % per_micro) as u32;
        self.micros = self.micros.wrapping_add(passed / per_micro);
        Instant::from_micros(self.micros)
    }

    /// Waits until it is time to look at the controller again, or a period begins.
    pub fn wait(&mut self) {
        let until = self.micros.wrapping_add(POLL_MICROS).min(self.next);
        while self.micros < until {
            self.now();
        }
    }

    /// How long it is from the last reading until a period begins, in microseconds.
    pub fn left(&self) -> u64 {
        self.next.saturating_sub(self.micros)
    }

    /// Whether a period has begun.
    pub fn is_due(&mut self) -> bool {
        self.now();
        self.micros >= self.next
    }

    /// The time, if a period has begun since the last call that returned one. Periods that passed unseen are not made up
    /// for, and counted.
    pub fn tick(&mut self) -> Option<Instant> {
        let now = self.now();
        (self.micros >= self.next).then(|| {
            self.periods.tick(now);
            self.next = (self.micros / PERIOD_MICROS + 1) * PERIOD_MICROS;
            now
        })
    }

    /// How many passed unseen since the last call.
    pub fn missed(&mut self) -> u32 {
        self.periods.missed()
    }
}
