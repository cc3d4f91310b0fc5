//! The chip's own CAN controller as a CAN port: `PB9` transmits, `PB8` receives, over a transceiver. It builds and is
//! linted; it has run on no chip, and the emulator has no model of it.

use super::clocks::Clocks;
use super::port::Select;
use super::registers::{CAN1_ESR, CAN1_MCR, GPIOB_AFRH, GPIOB_MODER, RCC_AHB1ENR, RCC_APB1ENR};
use crate::board::port::Port;
use bxcan::filter::Mask32;
use bxcan::{Can, Fifo, FilterOwner, Instance, Interrupt, RegisterBlock};
use embedded_can::nb;

/// 500 kbit/s; 14 time quanta a bit, sampled after 12 of them (86 %).
const BIT_RATE: u32 = 500_000;
const QUANTA: u32 = 14;
/// Before and after the sample point, less one each; a resynchronisation moves by one quantum.
const SEGMENTS: u32 = (11 - 1) << 16 | (2 - 1) << 20;

/// Leaves the bus after 256 errors and comes back by itself after 128 idle times, as ISO 11898-1 has it.
const AUTOMATIC_BUS_OFF: u32 = 1 << 6;
const BUS_OFF: u32 = 1 << 2;

/// CAN1.
struct Can1;

// SAFETY: `Can1` is private to this module and made once, by `Bxcan::start`, which the board calls once; nothing else
// accesses the register block but for two registers of which the driver and this module own different bits.
unsafe impl Instance for Can1 {
    const REGISTERS: *mut RegisterBlock = 0x4000_6400 as *mut RegisterBlock;
}

// SAFETY: CAN1 owns the 28 filter banks, and CAN2, which could share them, is not used.
unsafe impl FilterOwner for Can1 {
    const NUM_FILTER_BANKS: u8 = 28;
}

/// The controller as a port.
pub struct Bxcan {
    can: Can<Can1>,
    was_off: bool,
}

impl nb::Can for Bxcan {
    type Frame = bxcan::Frame;
    type Error = bxcan::OverrunError;

    fn transmit(&mut self, frame: &bxcan::Frame) -> ::nb::Result<Option<bxcan::Frame>, bxcan::OverrunError> {
        nb::Can::transmit(&mut self.can, frame)
    }

    fn receive(&mut self) -> ::nb::Result<bxcan::Frame, bxcan::OverrunError> {
        nb::Can::receive(&mut self.can)
    }
}

impl Select for Bxcan {
    /// CAN1_RX0.
    const INTERRUPT: i16 = 20;

    fn start(clocks: &Clocks) -> Self {
        RCC_AHB1ENR.set(0, 1 << 1); // port B
        RCC_APB1ENR.set(0, 1 << 25); // CAN1
        GPIOB_MODER.set(0b11_11 << 16, 0b10_10 << 16); // pins 8 and 9: alternate function
        GPIOB_AFRH.set(0xff, 0x99); // which is number 9
        let prescaler = (clocks.slow_bus_hz / (BIT_RATE * QUANTA)).max(1);
        let mut can = Can::builder(Can1).set_bit_timing(SEGMENTS | (prescaler - 1)).leave_disabled();
        CAN1_MCR.set(0, AUTOMATIC_BUS_OFF);
        can.modify_filters().enable_bank(0, Fifo::Fifo0, Mask32::accept_all());
        can.enable_interrupt(Interrupt::Fifo0MessagePending);
        // It joins the bus when that has been idle for a moment; the unit does not wait for it.
        let _ = can.enable_non_blocking();
        Self { can, was_off: false }
    }

    /// The mailboxes send by themselves.
    fn pump(&mut self) -> bool {
        false
    }
}

impl Port for Bxcan {
    /// An absence that begins and ends between two calls is not seen: it lasts 2.8 ms at least.
    fn left_bus(&mut self) -> bool {
        let is_off = CAN1_ESR.read() & BUS_OFF != 0;
        let left = is_off && !self.was_off;
        self.was_off = is_off;
        left
    }
}
