//! One output pin: levels enter by `embedded-hal`'s trait, and stand at the pin.

use super::registers::Block;
use crate::board::registers::Registers;
use core::convert::Infallible;
use embedded_hal::digital::{ErrorType, OutputPin};

/// MIO pin 23, which on the ZCU102 drives an LED with a test point. The emulator has no pins.
pub struct Pin(Option<Block>);

impl Pin {
    /// Pins 16 to 25 have a register of their own: a mask of those to leave alone, and the levels.
    const NUMBER: u32 = 23;
    const LEVELS: usize = 0x004;
    const DIRECTION: usize = 0x204;
    const OUTPUT_ENABLE: usize = 0x208;

    pub fn start(mut block: Option<Block>) -> Self {
        if let Some(block) = &mut block {
            for place in [Self::DIRECTION, Self::OUTPUT_ENABLE] {
                let bits = block.read(place);
                block.write(place, bits | 1 << Self::NUMBER);
            }
        }
        Self(block)
    }

    fn set(&mut self, level: u32) {
        let bit = Self::NUMBER - 16;
        if let Some(block) = &mut self.0 {
            block.write(Self::LEVELS, (0xffff & !(1 << bit)) << 16 | level << bit);
        }
    }
}

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.set(0);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.set(1);
        Ok(())
    }
}
