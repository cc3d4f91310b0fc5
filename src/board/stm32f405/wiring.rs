//! What is around the chip, and what another board with the same chip has different: the crystal and the pins.

use super::gpio::{Place, Port};

/// The crystal, in MHz: an even number, as the PLL takes 2 MHz of it.
pub const CRYSTAL_MHZ: u32 = 8;

/// High while a tick runs.
pub const BUSY: Place = Place { port: Port::A, pin: 8 };

/// The serial line to the adapter, and the alternate function by which these pins are USART1's.
#[cfg(not(feature = "bxcan"))]
pub const SERIAL: ([Place; 2], u32) = ([Place { port: Port::A, pin: 9 }, Place { port: Port::A, pin: 10 }], 7);

/// The CAN transceiver, transmit and receive, and the alternate function by which these pins are CAN1's.
#[cfg(feature = "bxcan")]
pub const CAN: ([Place; 2], u32) = ([Place { port: Port::B, pin: 9 }, Place { port: Port::B, pin: 8 }], 9);
