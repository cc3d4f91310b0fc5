//! The registers of the chip that the board uses, by name: words enter, words leave. Addresses and bits are those of
//! ST's reference manual RM0090.
#![allow(dead_code)] // each port has registers that the other does not use

/// A 32-bit register.
#[derive(Clone, Copy)]
pub struct Register(usize);

/// Oscillators and the PLL; clock of the buses; enables of the buses' peripherals; why the chip was reset.
pub const RCC_CR: Register = Register(0x4002_3800);
pub const RCC_PLLCFGR: Register = Register(0x4002_3804);
pub const RCC_CFGR: Register = Register(0x4002_3808);
pub const RCC_AHB1ENR: Register = Register(0x4002_3830);
pub const RCC_APB1ENR: Register = Register(0x4002_3840);
pub const RCC_APB2ENR: Register = Register(0x4002_3844);
pub const RCC_CSR: Register = Register(0x4002_3874);
/// Wait states of the flash.
pub const FLASH_ACR: Register = Register(0x4002_3c00);
/// The counter of microseconds.
pub const TIM2_CR1: Register = Register(0x4000_0000);
pub const TIM2_EGR: Register = Register(0x4000_0014);
pub const TIM2_CNT: Register = Register(0x4000_0024);
pub const TIM2_PSC: Register = Register(0x4000_0028);
/// The serial line.
pub const USART1_SR: Register = Register(0x4001_1000);
pub const USART1_DR: Register = Register(0x4001_1004);
pub const USART1_BRR: Register = Register(0x4001_1008);
pub const USART1_CR1: Register = Register(0x4001_100c);
/// The independent watchdog.
pub const IWDG_KR: Register = Register(0x4000_3000);
pub const IWDG_PR: Register = Register(0x4000_3004);
pub const IWDG_RLR: Register = Register(0x4000_3008);

impl Register {
    /// One of a port's, by its number from port A on, and its offset.
    pub const fn of_port(number: usize, offset: usize) -> Self {
        Self(0x4002_0000 + 0x400 * (number & 0x7) + (offset & 0x3fc))
    }

    /// One of the CAN controller's, by its offset.
    pub const fn of_can1(offset: usize) -> Self {
        Self(0x4000_6400 + (offset & 0x3fc))
    }

    pub fn read(self) -> u32 {
        // SAFETY: the field is private, so the address is one of the constants above, of a port or of CAN1: aligned words of peripherals
        // that are mapped on this chip whatever the state of the clocks, and that no Rust object overlaps.
        unsafe { (self.0 as *const u32).read_volatile() }
    }

    pub fn write(self, word: u32) {
        // SAFETY: as for `read`; none of these registers makes the hardware write to memory.
        unsafe { (self.0 as *mut u32).write_volatile(word) }
    }

    pub fn set(self, mask: u32, bits: u32) {
        self.write(self.read() & !mask | bits);
    }

    /// Turns the clock of peripherals on. They have it some cycles later (an erratum in ES0182): to read the register back takes
    /// as long as that.
    pub fn enable(self, bits: u32) {
        self.set(0, bits);
        self.read();
    }

    /// Waits until all of these bits are set, but not for ever; whether they are.
    pub fn wait_for(self, bits: u32) -> bool {
        // A crystal takes 2 ms at most, which is 32,000 cycles of the 16 MHz that the chip starts with.
        (0..32_000).any(|_| self.read() & bits == bits)
    }
}
