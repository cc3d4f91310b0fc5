//! The registers of the chip that the board uses: words enter, words leave. Addresses and bits are those of AMD's reference
//! manuals UG1085 and UG1087, and of Arm's for the core.

use crate::board::registers::Registers;
use core::arch::asm;

/// A block of 32-bit registers.
pub struct Block(usize);

impl Block {
    /// The CAN controllers, on the pins that the boot loader gave them. On the ZCU102 the second one has the transceiver; of the
    /// emulator the first one is used.
    pub const CAN0: Self = Self(0xff06_0000);
    pub const CAN1: Self = Self(0xff07_0000);
    /// General-purpose pins.
    pub const GPIO: Self = Self(0xff0a_0000);

    /// Timers.
    pub const TIMERS: Self = Self(0xff11_0000);

    /// Any word of these.
    const LAST: usize = 0xffc;
}

impl Registers for Block {
    fn read(&self, offset: usize) -> u32 {
        let place = self.0 + (offset & Self::LAST);
        // SAFETY: the field is private, so the address is an aligned word of one of the blocks above, which no Rust object
        // overlaps.
        unsafe { (place as *const u32).read_volatile() }
    }

    fn write(&mut self, offset: usize, word: u32) {
        let place = self.0 + (offset & Self::LAST);
        // SAFETY: as for `read`; no block makes the hardware write to memory.
        unsafe { (place as *mut u32).write_volatile(word) }
    }
}

/// The core's number among those that share its memory.
pub fn core_number() -> u32 {
    let affinity: u32;
    // SAFETY: reads an identification register.
    unsafe { asm!("mrc p15, 0, {}, c0, c0, 5", out(reg) affinity, options(nomem, nostack, preserves_flags)) };
    affinity & 0xff
}

/// Starts the core's cycle counter.
pub fn start_cycles() {
    // SAFETY: turns on the performance counters (bit 0), zeroes the cycle counter (bit 2) and lets it count (bit 31); nothing
    // else uses them, and they have no effect but their own values.
    unsafe {
        asm!(
            "mcr p15, 0, {control}, c9, c12, 0",
            "mcr p15, 0, {counters}, c9, c12, 1",
            control = in(reg) 0b101,
            counters = in(reg) 1u32 << 31,
            options(nomem, nostack, preserves_flags)
        );
    }
}

/// Halts the core until an interrupt is there, masked or not; at once, if one is.
pub fn halt() {
    // SAFETY: it has no effect but to wait.
    unsafe { asm!("wfi", options(nomem, nostack, preserves_flags)) };
}

/// The core's cycles since then, modulo 2^32.
pub fn cycles() -> u32 {
    let count: u32;
    // SAFETY: reads a counter. It is not `pure`, so that each call reads it anew.
    unsafe { asm!("mrc p15, 0, {}, c9, c13, 0", out(reg) count, options(nomem, nostack, preserves_flags)) };
    count
}
