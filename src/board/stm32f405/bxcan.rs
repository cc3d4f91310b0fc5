//! The chip's own CAN controller as the port of the board: `PB9` transmits, `PB8` receives, over a transceiver. The
//! [driver](super::can) has run against a model of its registers; the emulator has none of the controller, and it has run on
//! no chip.

use super::can::Controller;
use super::clocks::Clocks;
use super::port::Select;
use super::registers::{GPIOB_AFRH, GPIOB_MODER, RCC_AHB1ENR, RCC_APB1ENR, Register};
use crate::board::registers::Registers;

/// The registers of CAN1.
pub struct Can1;

impl Registers for Can1 {
    fn read(&self, offset: usize) -> u32 {
        Register::of_can1(offset).read()
    }

    fn write(&mut self, offset: usize, word: u32) {
        Register::of_can1(offset).write(word);
    }
}

impl Select for Controller<Can1> {
    /// CAN1_TX, CAN1_RX0.
    const INTERRUPTS: &'static [i16] = &[19, 20];
    const TELLS_WHEN_SENT: bool = true;

    fn start(clocks: &Clocks) -> Self {
        RCC_AHB1ENR.set(0, 1 << 1); // port B
        RCC_APB1ENR.set(0, 1 << 25); // CAN1
        GPIOB_MODER.set(0b11_11 << 16, 0b10_10 << 16); // pins 8 and 9: alternate function
        GPIOB_AFRH.set(0xff, 0x99); // which is number 9
        Self::start(Can1, clocks.slow_bus_hz)
    }
}
