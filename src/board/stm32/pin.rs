//! One output pin: levels enter by `embedded-hal`'s trait, and stand at the pin.

use crate::board::chip::wiring::WIRING;
use core::convert::Infallible;
use embedded_hal::digital::{ErrorType, OutputPin};

/// The pin that is high while a tick runs.
pub struct Pin(());

impl Pin {
    pub fn start() -> Self {
        WIRING.busy.start_output();
        Self(())
    }
}

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        WIRING.busy.write(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        WIRING.busy.write(true);
        Ok(())
    }
}
