//! Instructions executed between two readings of the core's timer.
//!
//! Under `-icount shift=6` the emulator lets 64 ns of virtual time pass with each instruction, and the timer counts them at
//! 168 MHz. So this counts instructions, not cycles: the emulator has no pipeline, no flash wait states and no caches.

use core::cell::RefCell;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{Peripherals, SYST};

/// Timer counts in 1000 instructions.
const COUNTS: u32 = 64 * 168;

/// The counter, started.
pub struct Counter {
    timer: RefCell<SYST>,
    /// What an empty measurement reads.
    empty: u32,
}

impl Counter {
    /// Takes the core's timer; only the first call gets it.
    pub fn start() -> Option<Self> {
        let mut timer = Peripherals::take()?.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(0x00ff_ffff);
        timer.clear_current();
        timer.enable_counter();
        let mut counter = Self { timer: RefCell::new(timer), empty: 0 };
        counter.empty = counter.count(|| ()).1;
        Some(counter)
    }

    /// How many instructions this takes; up to 1.5 million, and a panic from there to 3 million.
    #[inline(never)]
    pub fn count<T>(&self, work: impl FnOnce() -> T) -> (T, u32) {
        let mut timer = self.timer.borrow_mut();
        timer.clear_current(); // and the mark that it has wrapped
        let before = SYST::get_current();
        let result = work();
        let after = SYST::get_current();
        assert!(!timer.has_wrapped() || before < after, "more instructions than the timer can count");
        let counts = before.wrapping_sub(after) & 0x00ff_ffff;
        let thousandths = u64::from(counts) * 1000 + u64::from(COUNTS) / 2;
        (result, (thousandths / u64::from(COUNTS)) as u32 - self.empty)
    }
}
