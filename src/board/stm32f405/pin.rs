//! One output pin: levels enter by `embedded-hal`'s trait, and stand at the pin.

use super::registers::{GPIOA_BSRR, GPIOA_MODER, RCC_AHB1ENR};
use core::convert::Infallible;
use embedded_hal::digital::{ErrorType, OutputPin};

/// `PA8`.
pub struct Pin(());

impl Pin {
    const NUMBER: u32 = 8;

    pub fn start() -> Self {
        RCC_AHB1ENR.set(0, 1); // port A
        GPIOA_MODER.set(0b11 << (2 * Self::NUMBER), 0b01 << (2 * Self::NUMBER)); // output
        Self(())
    }
}

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        GPIOA_BSRR.write(1 << (Self::NUMBER + 16));
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        GPIOA_BSRR.write(1 << Self::NUMBER);
        Ok(())
    }
}
