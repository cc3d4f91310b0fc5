//! The registers of the chip that the board uses, by name: words enter, words leave. Addresses and bits are those of
//! ST's reference manual RM0090.

/// A 32-bit register.
#[derive(Clone, Copy)]
pub struct Register(usize);

/// Enables of the buses' peripherals.
pub const RCC_AHB1ENR: Register = Register(0x4002_3830);
pub const RCC_APB2ENR: Register = Register(0x4002_3844);
/// Port A: mode of each pin, and the alternate function of pins 8 to 15.
pub const GPIOA_MODER: Register = Register(0x4002_0000);
pub const GPIOA_AFRH: Register = Register(0x4002_0024);
/// The serial line.
pub const USART1_SR: Register = Register(0x4001_1000);
pub const USART1_DR: Register = Register(0x4001_1004);
pub const USART1_BRR: Register = Register(0x4001_1008);
pub const USART1_CR1: Register = Register(0x4001_100c);

const RCC_CR: Register = Register(0x4002_3800);
const HSI_READY: u32 = 1 << 1;

impl Register {
    pub fn read(self) -> u32 {
        // SAFETY: the field is private, so the address is one of the constants above: aligned words of peripherals
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
}

/// How fast the core runs. After reset that is the internal 16 MHz oscillator, which says that it is ready, or no
/// instruction would be executed. A chip that denies it has no clock tree: it is the emulator's model, whose timer
/// counts at 168 MHz.
pub fn core_hz() -> u32 {
    if RCC_CR.read() & HSI_READY != 0 { 16_000_000 } else { 168_000_000 }
}
