//! Instructions executed between two readings of the chip's timer TIM2.
//!
//! Under `-icount shift=6` the emulator lets 64 ns of virtual time pass with each instruction, and its TIM2 counts nanoseconds. Divided by
//! 64, this counts instructions, up to 2³²; the core's own timer, of 24 bits, would wrap within a tick that is too long. They are not
//! cycles: the emulator has no pipeline, no flash wait states and no caches.

/// Registers of TIM2: control, event, count and prescaler, which divides by one more.
const CONTROL: *mut u32 = 0x4000_0000 as *mut u32;
const EVENT: *mut u32 = 0x4000_0014 as *mut u32;
const COUNT: *mut u32 = 0x4000_0024 as *mut u32;
const PRESCALER: *mut u32 = 0x4000_0028 as *mut u32;
const PER_INSTRUCTION: u32 = 64;

/// The counter, started.
pub struct Counter {
    /// What an empty measurement reads.
    empty: u32,
}

impl Counter {
    /// Starts it.
    pub fn start() -> Self {
        // SAFETY: nothing else in these programs uses the timer, and its registers have no effect on memory.
        unsafe {
            PRESCALER.write_volatile(PER_INSTRUCTION - 1);
            CONTROL.write_volatile(1);
            EVENT.write_volatile(1);
        }
        let mut counter = Self { empty: 0 };
        counter.empty = counter.count(|| ()).1;
        counter
    }

    #[inline(always)]
    fn read() -> u32 {
        // SAFETY: as above.
        unsafe { COUNT.read_volatile() }
    }

    /// How many instructions this takes, up to 4,294 million.
    #[inline(never)]
    pub fn count<T>(&self, work: impl FnOnce() -> T) -> (T, u32) {
        let begun = self.begin();
        let result = work();
        (result, self.since(begun))
    }

    /// Where the count is now, for work whose result is not to be moved.
    #[inline(always)]
    pub fn begin(&self) -> u32 {
        Self::read()
    }

    /// How many instructions it took since then.
    #[inline(always)]
    pub fn since(&self, begun: u32) -> u32 {
        Self::read().wrapping_sub(begun).saturating_sub(self.empty)
    }

    /// Counts waits of a known length, short ones and far beyond what a tick may take, and fails if the count is another.
    pub fn check(&self) {
        for rounds in (0..27).map(|power| (1 << power) + 1_000) {
            // A round is two instructions, and there is one more.
            let (asked, (_, count)) = (2 * rounds + 2, self.count(|| cortex_m::asm::delay(rounds)));
            assert!(count.abs_diff(asked) < 64, "{asked} instructions counted as {count}");
        }
    }
}
