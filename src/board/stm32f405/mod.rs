//! The STM32F405, a Cortex-M4F: its clock tree, its pins, and its port to the bus.
//!
//! Its CAN traffic goes over a serial CAN adapter on USART1 ([`slcan`]), or with the feature `bxcan` over the chip's own
//! controller; both are a [`Port`](crate::board::port::Port) to the rest.

#[cfg(feature = "bxcan")]
mod bxcan;
#[cfg(feature = "bxcan")]
mod can;
pub mod clocks;
#[cfg(not(feature = "bxcan"))]
mod line;
#[cfg(feature = "bxcan")]
mod mailbox;
pub mod registers;
#[cfg(not(feature = "bxcan"))]
mod serial;
#[cfg(not(feature = "bxcan"))]
mod slcan;
pub mod wiring;

#[cfg(feature = "bxcan")]
pub type Selected = can::Controller<bxcan::Can1>;
#[cfg(not(feature = "bxcan"))]
pub type Selected = slcan::Slcan;
