//! What is around the chip: the crystal and the pins of the board that has it.

use crate::board::stm32::gpio::{Place, Port};

/// A board.
pub struct Wiring {
    /// The crystal, in MHz: a multiple of 8, as the CAN controller divides it by 16 for each bit of 2 µs.
    pub crystal_mhz: u32,
    /// High while a tick runs.
    pub busy: Place,
    /// The CAN transceiver, transmit and receive, and the alternate function by which these pins are FDCAN1's.
    pub can: ([Place; 2], u32),
}

/// ST's Nucleo-G474RE: D7; pins 12 and 14 of CN10. PB8, where the controller could be too, is the pin that selects the boot.
pub const WIRING: Wiring = Wiring {
    crystal_mhz: 24,
    busy: Place { port: Port::A, pin: 8 },
    can: ([Place { port: Port::A, pin: 12 }, Place { port: Port::A, pin: 11 }], 9),
};
