//! The serial line: bytes leave when it is free, and enter by an interrupt each.

use super::clocks::Clocks;
use super::registers::{RCC_APB2ENR, USART1_BRR, USART1_CR1, USART1_DR, USART1_SR};
use super::wiring::WIRING;
use crate::board::port::Overrun;

const BAUD: u32 = 460_800;
const OVERRUN: u32 = 1 << 3;
const RECEIVED: u32 = 1 << 5;
const TRANSMIT_EMPTY: u32 = 1 << 7;
/// USART1's place in the chip's vector table.
pub const INTERRUPT: i16 = 37;

/// USART1.
pub struct Serial(());

impl Serial {
    /// Puts the pins and the line into operation: 460,800 baud, 8 data bits, no parity, 1 stop bit.
    pub fn start(clocks: &Clocks) -> Self {
        let (pins, function) = WIRING.serial;
        pins.into_iter().for_each(|pin| pin.start_function(function));
        RCC_APB2ENR.enable(1 << 4); // USART1
        // Sixteenths of a bit time, to nearest: at 84 MHz 0.2 % off, of the 3 % or so that a receiver bears.
        USART1_BRR.write((clocks.fast_bus_hz + BAUD / 2) / BAUD);
        USART1_CR1.write(1 << 13 | 1 << 5 | 1 << 3 | 1 << 2); // on, interrupt of the receiver, transmitter, receiver
        Self(())
    }

    /// The byte received, if there is one.
    pub fn read(&mut self) -> Result<Option<u8>, Overrun> {
        let status = USART1_SR.read();
        if status & (RECEIVED | OVERRUN) == 0 {
            return Ok(None);
        }
        // Reading the data clears an overrun too, which otherwise would block the receiver. Of the bytes the older one is
        // still there, but the line that it belongs to is not whole any more.
        let byte = USART1_DR.read() as u8;
        if status & OVERRUN == 0 { Ok(Some(byte)) } else { Err(Overrun) }
    }

    /// Sends a byte, if the line is free; whether it did.
    pub fn write(&mut self, byte: u8) -> bool {
        let is_free = USART1_SR.read() & TRANSMIT_EMPTY != 0;
        if is_free {
            USART1_DR.write(u32::from(byte));
        }
        is_free
    }
}
