//! The chip's own CAN controller as the port of the board, over a transceiver. The
//! [driver](super::can) has run against a model of its registers; the emulator has none of the controller, and it has run on
//! no chip.

use super::can::Controller;
use super::clocks::Clocks;
use super::registers::{RCC_APB1ENR, of_can1};
use super::wiring::WIRING;
use crate::board::acceptance::Patterns;
use crate::board::registers::Registers;
use crate::board::stm32::port::Select;
use crate::firmware::CONFIG;

/// The registers of CAN1.
pub struct Can1;

impl Registers for Can1 {
    fn read(&self, offset: usize) -> u32 {
        of_can1(offset).read()
    }

    fn write(&mut self, offset: usize, word: u32) {
        of_can1(offset).write(word);
    }
}

impl Select for Controller<Can1> {
    /// CAN1_TX, CAN1_RX0.
    const INTERRUPTS: &'static [i16] = &[19, 20];
    const TELLS_WHEN_SENT: bool = true;

    fn start(clocks: &Clocks) -> Self {
        let (pins, function) = WIRING.can;
        pins.into_iter().for_each(|pin| pin.start_function(function));
        RCC_APB1ENR.enable(1 << 25); // CAN1
        let wanted = Patterns::of(CONFIG.identifiers.heard_by_unit());
        // Without the crystal the bit rate would be off by more than a bus bears.
        Self::start(Can1, if clocks.is_by_crystal { clocks.slow_bus_hz } else { 0 }, wanted)
    }
}
