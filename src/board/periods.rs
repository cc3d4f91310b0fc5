//! Periods without a tick: the times of the ticks enter, and how many periods passed between them leaves.
//!
//! Periods are counted by the time and not by the interrupts of a timer: while interrupts are off, or the core stands still, those
//! are lost, and the gap would look shorter than it was.

use holdover::time::Instant;

/// The period of the boards' ticks.
pub const PERIOD_MICROS: u64 = 10_000;

/// What has been missed. Periods begin at multiples of their length.
pub struct Periods {
    /// The one with the last tick in it.
    last: u64,
    missed: u32,
}

impl Periods {
    /// From time 0 on.
    pub const fn new() -> Self {
        Self { last: 0, missed: 0 }
    }

    /// There is a tick.
    pub fn tick(&mut self, now: Instant) {
        let number = now.as_micros() / PERIOD_MICROS;
        let between = number.saturating_sub(self.last).saturating_sub(1);
        self.missed = self.missed.saturating_add(u32::try_from(between).unwrap_or(u32::MAX));
        self.last = number;
    }

    /// How many periods had no tick, since the last call.
    pub fn missed(&mut self) -> u32 {
        core::mem::take(&mut self.missed)
    }
}
