//! The registers of the chip that the board uses, by name. Addresses and bits are those of ST's reference manual RM0440.

use super::fdcan::offset::RAM;
use crate::board::stm32::register::Register;

/// Oscillators; clock of the buses; the PLL; enables of the buses' peripherals; clocks of the peripherals; why the chip was reset.
pub const RCC_CR: Register = at(0x4002_1000);
pub const RCC_CFGR: Register = at(0x4002_1008);
pub const RCC_PLLCFGR: Register = at(0x4002_100c);
/// Of the pins' ports, a bit each.
pub const RCC_PORTS: Register = at(0x4002_104c);
pub const RCC_APB1ENR: Register = at(0x4002_1058);
pub const RCC_CCIPR: Register = at(0x4002_1088);
pub const RCC_CSR: Register = at(0x4002_1094);
/// In it: forgets why.
pub const CLEAR_CAUSES: u32 = 1 << 23;
/// The regulator.
pub const PWR_CR5: Register = at(0x4000_7080);
/// Wait states of the flash.
pub const FLASH_ACR: Register = at(0x4002_2000);

/// One of a port of pins, by its number from port A on, and its offset.
pub const fn of_port(number: usize, offset: usize) -> Register {
    at(0x4800_0000 + 0x400 * (number & 0x7) + (offset & 0x3fc))
}

/// One of FDCAN1's, or a word of its message RAM, by its offset as the driver has it.
pub const fn of_fdcan1(offset: usize) -> Register {
    at(if offset < RAM { 0x4000_6400 } else { 0x4000_a400 } + (offset & 0x3fc))
}

const fn at(address: usize) -> Register {
    // SAFETY: this function is private, so the address is one of the constants above, of a port, of FDCAN1 or of its RAM: aligned
    // words of peripherals of this chip, none of which writes to other memory.
    unsafe { Register::at(address) }
}
