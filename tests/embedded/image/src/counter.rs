//! Instructions executed between two readings of the core's timer.
//!
//! Under `-icount shift=6` the emulator lets 64 ns of virtual time pass with each instruction, and the timer counts them at
//! 168 MHz. So this counts instructions, not cycles: the emulator has no pipeline, no flash wait states and no caches.

use core::cell::RefCell;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{Peripherals, SYST};

/// Timer counts in 1000 instructions.
const COUNTS: u32 = 64 * 168;

/// What the timer's 24 bits can count.
const MOST: u32 = ((1u64 << 24) * 1000 / COUNTS as u64) as u32;

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

    /// How many instructions this takes, up to 1.56 million.
    ///
    /// # Panics
    /// If it takes more.
    pub fn count<T>(&self, work: impl FnOnce() -> T) -> (T, u32) {
        let (result, count) = self.counted(work);
        (result, count.expect("no more instructions than the timer can count"))
    }

    /// The same; `None` if it takes more.
    #[inline(never)]
    fn counted<T>(&self, work: impl FnOnce() -> T) -> (T, Option<u32>) {
        let mut timer = self.timer.borrow_mut();
        timer.clear_current();
        // It begins anew at its next count, and only then the mark that it has wrapped is one of this measurement: reading clears it,
        // and it stays set however often the timer wraps. To compare the readings would miss a whole turn.
        while SYST::get_current() == 0 {}
        timer.has_wrapped();
        let before = SYST::get_current();
        let result = work();
        let after = SYST::get_current();
        if timer.has_wrapped() {
            return (result, None);
        }
        let counts = before.wrapping_sub(after) & 0x00ff_ffff;
        let thousandths = u64::from(counts) * 1000 + u64::from(COUNTS) / 2;
        let count = (thousandths / u64::from(COUNTS)) as u32;
        (result, Some(count.saturating_sub(self.empty)))
    }

    /// Counts more and more up to beyond what the timer can, and fails if a turn of it goes unseen.
    pub fn check(&self) {
        let mut last = Some(0);
        for beyond in -64..256 {
            let asked = (MOST as i32 + beyond) as u32;
            last = self.counted(|| cortex_m::asm::delay(asked)).1;
            assert!(last.is_none_or(|count| count.abs_diff(asked) < 64), "{asked} instructions counted as {last:?}");
        }
        assert_eq!(last, None);
    }
}
