//! The registers of the chip that the board uses, by name. Addresses and bits are those of ST's reference manual RM0090.
#![allow(dead_code)] // each port has registers that the other does not use

use crate::board::stm32::register::Register;

/// Oscillators and the PLL; clock of the buses; enables of the buses' peripherals; why the chip was reset.
pub const RCC_CR: Register = at(0x4002_3800);
pub const RCC_PLLCFGR: Register = at(0x4002_3804);
pub const RCC_CFGR: Register = at(0x4002_3808);
/// Of the pins' ports, a bit each.
pub const RCC_PORTS: Register = at(0x4002_3830);
pub const RCC_APB1ENR: Register = at(0x4002_3840);
pub const RCC_APB2ENR: Register = at(0x4002_3844);
pub const RCC_CSR: Register = at(0x4002_3874);
/// In it: forgets why.
pub const CLEAR_CAUSES: u32 = 1 << 24;
/// Wait states of the flash.
pub const FLASH_ACR: Register = at(0x4002_3c00);
/// The serial line.
pub const USART1_SR: Register = at(0x4001_1000);
pub const USART1_DR: Register = at(0x4001_1004);
pub const USART1_BRR: Register = at(0x4001_1008);
pub const USART1_CR1: Register = at(0x4001_100c);

/// One of a port of pins, by its number from port A on, and its offset.
pub const fn of_port(number: usize, offset: usize) -> Register {
    at(0x4002_0000 + 0x400 * (number & 0x7) + (offset & 0x3fc))
}

/// One of the CAN controller's, by its offset.
pub const fn of_can1(offset: usize) -> Register {
    at(0x4000_6400 + (offset & 0x3fc))
}

const fn at(address: usize) -> Register {
    // SAFETY: this function is private, so the address is one of the constants above, of a port or of CAN1: aligned words of
    // peripherals of this chip, none of which writes to memory.
    unsafe { Register::at(address) }
}
