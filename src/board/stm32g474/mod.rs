//! The STM32G474, a Cortex-M4F with FDCAN: its clock tree, its pins, and its port to the bus, over a transceiver. It has run on no
//! chip, and no emulator has it.

mod can1;
pub mod clocks;
mod element;
mod fdcan;
pub mod registers;
pub mod wiring;

pub type Selected = fdcan::Controller<can1::Can1>;
