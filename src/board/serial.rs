//! The serial line: bytes to send enter a queue, received bytes leave.
//!
//! It is polled, from the shell's loop: between two polls lies at most one tick of the unit, during which the line's
//! one-byte buffer may overrun on the chip (not in the emulator, which waits). What is lost then is a frame, and the
//! unit treats it like one that was never sent.

use super::registers::{
    GPIOA_AFRH, GPIOA_MODER, RCC_AHB1ENR, RCC_APB2ENR, USART1_BRR, USART1_CR1, USART1_DR, USART1_SR,
};
use heapless::Deque;

const BAUD: u32 = 460_800;
const RECEIVED: u32 = 1 << 5;
const TRANSMIT_EMPTY: u32 = 1 << 7;

/// The line, with room for the frames of one period.
pub struct Serial {
    outgoing: Deque<u8, 1024>,
}

impl Serial {
    /// Puts the pins and the line into operation: 460,800 baud, 8 data bits, no parity, 1 stop bit.
    pub fn start(core_hz: u32) -> Self {
        RCC_AHB1ENR.set(0, 1); // port A
        RCC_APB2ENR.set(0, 1 << 4); // USART1
        GPIOA_MODER.set(0b11_11 << 18, 0b10_10 << 18); // pins 9 and 10: alternate function
        GPIOA_AFRH.set(0xff << 4, 0x77 << 4); // which is number 7
        // Sixteenths of a bit time, to nearest: at 16 MHz 0.8 % off, of the 3 % or so that a receiver bears.
        USART1_BRR.write((core_hz + BAUD / 2) / BAUD);
        USART1_CR1.write(1 << 13 | 1 << 3 | 1 << 2); // on, transmitter, receiver
        Self { outgoing: Deque::new() }
    }

    /// Sends a byte if the line is free and one is waiting; the byte received, if there is one.
    pub fn exchange(&mut self) -> Option<u8> {
        let status = USART1_SR.read();
        if status & TRANSMIT_EMPTY != 0
            && let Some(byte) = self.outgoing.pop_front()
        {
            USART1_DR.write(u32::from(byte));
        }
        // Reading the data also clears an overrun, which otherwise would block the receiver.
        (status & RECEIVED != 0).then(|| USART1_DR.read() as u8)
    }

    /// Queues all of the bytes or none.
    pub fn queue(&mut self, bytes: &[u8]) {
        if self.outgoing.capacity() - self.outgoing.len() >= bytes.len() {
            self.outgoing.extend(bytes.iter().copied());
        }
    }
}
