//! What is around the chip: the crystal and the pins of each board that has it.

use crate::board::stm32::gpio::{Place, Port};

/// A board.
#[allow(dead_code)] // the serial line or the transceiver
pub struct Wiring {
    /// The crystal, in MHz: an even number, as the PLL takes 2 MHz of it.
    pub crystal_mhz: u32,
    /// High while a tick runs.
    pub busy: Place,
    /// The serial line to the adapter, transmit and receive, and the alternate function by which these pins are USART1's.
    pub serial: ([Place; 2], u32),
    /// The CAN transceiver, transmit and receive, and the alternate function by which these pins are CAN1's.
    pub can: ([Place; 2], u32),
}

/// The board that is built for.
pub const WIRING: Wiring = if cfg!(board = "feather_stm32f405") {
    FEATHER
} else if cfg!(board = "pyboard") {
    PYBOARD
} else {
    BARE
};

/// The chip with the crystal of ST's Discovery boards, on the first pins that its peripherals have; and the emulator's.
const BARE: Wiring = Wiring {
    crystal_mhz: 8,
    busy: at(Port::A, 8),
    serial: ([at(Port::A, 9), at(Port::A, 10)], 7),
    can: ([at(Port::B, 9), at(Port::B, 8)], 9),
};

/// Adafruit's Feather STM32F405 Express: the red LED; SCL and SDA; D10 and D9.
const FEATHER: Wiring =
    Wiring { crystal_mhz: 12, busy: at(Port::C, 1), serial: ([at(Port::B, 6), at(Port::B, 7)], 7), ..BARE };

/// MicroPython's pyboard 1.1: X1; X9 and X10; Y4 and Y3.
const PYBOARD: Wiring = Wiring { busy: at(Port::A, 0), ..FEATHER };

const fn at(port: Port, pin: u32) -> Place {
    Place { port, pin }
}
