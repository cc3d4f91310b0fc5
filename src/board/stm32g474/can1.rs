//! The chip's CAN controller as the port of the board, over a transceiver. The [driver](super::fdcan) has run against a model
//! of its registers, and on no chip.

use super::clocks::Clocks;
use super::fdcan::Controller;
use super::registers::{RCC_APB1ENR, of_fdcan1};
use super::wiring::WIRING;
use crate::board::acceptance::Patterns;
use crate::board::registers::Registers;
use crate::board::stm32::port::Select;
use crate::firmware::CONFIG;

/// The registers and the message RAM of FDCAN1.
pub struct Can1;

impl Registers for Can1 {
    fn read(&self, offset: usize) -> u32 {
        of_fdcan1(offset).read()
    }

    fn write(&mut self, offset: usize, word: u32) {
        of_fdcan1(offset).write(word);
    }
}

impl Select for Controller<Can1> {
    /// The first of FDCAN1's two lines.
    const INTERRUPTS: &'static [i16] = &[21];
    const TELLS_WHEN_SENT: bool = true;

    fn start(clocks: &Clocks) -> Self {
        let (pins, function) = WIRING.can;
        pins.into_iter().for_each(|pin| pin.start_function(function));
        RCC_APB1ENR.enable(1 << 25); // FDCAN
        let wanted = Patterns::of(CONFIG.identifiers.heard_by_unit());
        Self::start(Can1, clocks.can_hz, wanted)
    }
}
