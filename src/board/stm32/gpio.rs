//! Pins: a place and what it is for enter, and the pin is set up for it.

use super::register::Register;
use crate::board::chip::registers::{RCC_PORTS, of_port};

/// The ports that a board may use.
#[derive(Clone, Copy)]
#[allow(dead_code)] // each board uses its own
pub enum Port {
    A = 0,
    B = 1,
    C = 2,
    D = 3,
}

/// A pin.
#[derive(Clone, Copy)]
pub struct Place {
    pub port: Port,
    /// 0 to 15.
    pub pin: u32,
}

const MODE: usize = 0x00;
const SET: usize = 0x18;
/// Of pins 0 to 7; of the others in the next word.
const FUNCTION: usize = 0x20;

impl Place {
    fn register(self, offset: usize) -> Register {
        of_port(self.port as usize, offset)
    }

    /// Of each pin's two bits.
    fn set_mode(self, mode: u32) {
        self.register(MODE).set(0b11 << (2 * self.pin), mode << (2 * self.pin));
    }

    /// The pin is an output, and low.
    pub fn start_output(self) {
        RCC_PORTS.enable(1 << self.port as u32);
        self.write(false);
        self.set_mode(0b01);
    }

    /// The pin belongs to the peripheral that has it by this function.
    pub fn start_function(self, function: u32) {
        RCC_PORTS.enable(1 << self.port as u32);
        let shift = 4 * (self.pin % 8);
        self.register(FUNCTION + 4 * (self.pin / 8) as usize).set(0xf << shift, function << shift);
        self.set_mode(0b10);
    }

    /// Sets an output.
    pub fn write(self, is_high: bool) {
        self.register(SET).write(1 << (self.pin + if is_high { 0 } else { 16 }));
    }
}
