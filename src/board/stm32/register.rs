//! A register of an STM32: words enter, words leave. And by name those that lie at one place in all of them.

/// A 32-bit register.
#[derive(Clone, Copy)]
pub struct Register(usize);

/// The counter of microseconds.
pub const TIM2_CR1: Register = common(0x4000_0000);
pub const TIM2_EGR: Register = common(0x4000_0014);
pub const TIM2_CNT: Register = common(0x4000_0024);
pub const TIM2_PSC: Register = common(0x4000_0028);
/// The independent watchdog.
pub const IWDG_KR: Register = common(0x4000_3000);
pub const IWDG_PR: Register = common(0x4000_3004);
pub const IWDG_RLR: Register = common(0x4000_3008);
/// What goes on while the core sleeps, and what stops while a debugger has halted it.
#[cfg(feature = "_log")]
pub const DBGMCU_CR: Register = common(0xe004_2004);
pub const DBGMCU_APB1_FREEZE: Register = common(0xe004_2008);

const fn common(address: usize) -> Register {
    // SAFETY: TIM2, IWDG and DBGMCU lie at these places in every chip that has a board here, by RM0090 and RM0440.
    unsafe { Register::at(address) }
}

impl Register {
    /// The one at this address.
    ///
    /// # Safety
    /// It is an aligned word of a peripheral that is mapped whatever the state of the clocks, that no Rust object overlaps, and that
    /// makes the hardware write to no memory but its own.
    pub const unsafe fn at(address: usize) -> Self {
        Self(address)
    }

    pub fn read(self) -> u32 {
        // SAFETY: who made it vouches for the address.
        unsafe { (self.0 as *const u32).read_volatile() }
    }

    pub fn write(self, word: u32) {
        // SAFETY: as for `read`.
        unsafe { (self.0 as *mut u32).write_volatile(word) }
    }

    pub fn set(self, mask: u32, bits: u32) {
        self.write(self.read() & !mask | bits);
    }

    /// Turns the clock of peripherals on. They have it some cycles later (an erratum in ES0182, a rule in RM0440): to read the
    /// register back takes as long as that.
    pub fn enable(self, bits: u32) {
        self.set(0, bits);
        self.read();
    }

    /// Waits until all of these bits are set, but not for ever; whether they are.
    pub fn wait_for(self, bits: u32) -> bool {
        // A crystal takes 2 ms at most, which is 32,000 cycles of the 16 MHz that the chips start with.
        (0..32_000).any(|_| self.read() & bits == bits)
    }
}
