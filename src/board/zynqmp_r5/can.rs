//! The CAN controller of the ZynqMP: its registers enter, a CAN port leaves. It is polled. What is there to
//! receive interrupts, for a core that sleeps until then. The controller sends again by itself what lost arbitration or was not
//! acknowledged.
//!
//! Its transmit queue would hold 64 frames, sends them in their order, and gives none back. So it gets one at a time: the next
//! one is chosen when the bus is there for it. A frame that is too old comes back by a reset of the whole controller.

use super::layout::Layout;
use crate::board::acceptance::{Pattern, Patterns};
use crate::board::bit_time::{ASKED, tolerance};
use crate::board::frame::CanFrame;
use crate::board::port::{Fate, Overrun, Port};
use crate::board::registers::Registers;
use heapless::Vec;

/// Byte offsets.
pub mod offset {
    /// Reset and enable.
    pub const CONTROL: usize = 0x00;
    /// Nothing, sleep, loop back, or listen only.
    pub const MODE: usize = 0x04;
    /// The quantum, in periods of the controller's clock less one.
    pub const PRESCALER: usize = 0x08;
    /// Quanta of a bit.
    pub const TIMING: usize = 0x0c;
    /// What is so now.
    pub const STATUS: usize = 0x18;
    /// What has happened, until it is cleared.
    pub const EVENTS: usize = 0x1c;
    /// Which of that interrupts.
    pub const INTERRUPTS: usize = 0x20;
    /// Clears events.
    pub const CLEAR: usize = 0x24;
    /// The four words of a frame to send; the last one sends it.
    pub const TRANSMIT: [usize; 4] = [0x30, 0x34, 0x38, 0x3c];
    /// The four words of the oldest received frame; the last one takes it away.
    pub const RECEIVE: [usize; 4] = [0x50, 0x54, 0x58, 0x5c];
    /// Which acceptance filters are on; with none everything is received.
    pub const FILTERS: usize = 0x60;
    /// The two words of the first one, mask and identifier; the others follow.
    pub const FILTER: usize = 0x64;
}

/// Bits of the control register.
pub const RESET: u32 = 1 << 0;
pub const ENABLE: u32 = 1 << 1;
/// The status register's: the reset is over, and the controller can be set up.
pub const CONFIGURING: u32 = 1 << 0;
/// The events'.
pub const RECEIVED: u32 = 1 << 4;
pub const OVERRUN: u32 = 1 << 6;
pub const NOT_EMPTY: u32 = 1 << 7;
pub const BUS_OFF: u32 = 1 << 9;
/// The last frame of the transmit queue has been sent.
pub const EMPTIED: u32 = 1 << 14;

/// 500 kbit/s from the 100 MHz that the boot loader gives the controller: quanta of 0.1 µs, 20 a bit, sampled after 17 (85 %).
const QUANTUM: u32 = 10 - 1;
/// Before and after the sample point, and how far a resynchronisation moves it; each less one.
const BIT: u32 = (BEFORE - 1) | (BEHIND - 1) << 4 | (JUMP - 1) << 7;
const BEFORE: u32 = 16;
const BEHIND: u32 = 3;
const JUMP: u32 = 3;
const QUANTA: u32 = 1 + BEFORE + BEHIND;
const _: () = assert!(tolerance(QUANTA, BEHIND, JUMP) >= ASKED);

/// Periods to stay away after a bus-off. ISO 11898-1 asks for 128 times 11 bits, which are 2.8 ms. The calls of two periods can
/// be closer together than that, if the first one is late; those of three cannot.
const ABSENCE: u32 = 2;

/// Acceptance filters that it has.
pub const ACCEPTANCE: usize = 4;

/// The controller as a port.
pub struct Controller<R> {
    registers: R,
    layout: Layout,
    filters: Vec<Pattern, ACCEPTANCE>,
    /// How many periods it still keeps away from the bus.
    absent: u32,
    /// A reset did not end, and nobody has been told.
    is_stuck: bool,
    /// What became of the frame in the transmit queue, if it has not been told.
    sending: Option<Fate>,
}

impl<R: Registers> Controller<R> {
    /// Puts it into operation; it lets in what is wanted, at least.
    pub fn start(registers: R, layout: Layout, wanted: Patterns) -> Self {
        let filters = wanted.at_most();
        let mut controller = Self { registers, layout, filters, absent: 0, is_stuck: false, sending: None };
        controller.leave();
        controller.join();
        controller
    }

    /// Resets the controller: it is off the bus, and its queues are empty.
    fn leave(&mut self) {
        self.settle();
        self.sending = self.sending.map(|fate| if fate == Fate::Underway { Fate::Back } else { fate });
        self.registers.write(offset::CONTROL, RESET);
        self.absent = ABSENCE;
    }

    /// From a reset onto the bus. The controller joins when that has been idle for a moment. If the reset does not end, the
    /// controller takes no settings, so it keeps away and is reset anew.
    fn join(&mut self) {
        // A reset takes some of the controller's clocks, which are slower than the core's.
        if !(0..1000).any(|_| self.registers.read(offset::STATUS) & CONFIGURING != 0) {
            self.is_stuck = true;
            self.leave();
            return;
        }
        self.absent = 0;
        self.registers.write(offset::PRESCALER, QUANTUM);
        self.registers.write(offset::TIMING, BIT);
        self.filter();
        self.registers.write(offset::INTERRUPTS, NOT_EMPTY | OVERRUN);
        self.registers.write(offset::MODE, 0);
        self.registers.write(offset::CONTROL, ENABLE);
    }

    /// Sets the filters up, while the controller is. All are off after its reset, and so not busy.
    fn filter(&mut self) {
        let mut used = 0;
        for (number, pattern) in self.filters.iter().enumerate() {
            for (word, place) in self.layout.filter(pattern).into_iter().zip([0, 4]) {
                self.registers.write(offset::FILTER + 8 * number + place, word);
            }
            used |= 1 << number;
        }
        self.registers.write(offset::FILTERS, used);
    }

    /// Takes note that the frame in the transmit queue has been sent.
    fn settle(&mut self) {
        if self.sending == Some(Fate::Underway) && self.registers.read(offset::EVENTS) & EMPTIED != 0 {
            self.sending = Some(Fate::Sent);
        }
    }
}

impl<R: Registers> Port for Controller<R> {
    const TAKES_BACK: bool = false;

    fn receive(&mut self) -> Result<Option<CanFrame>, Overrun> {
        loop {
            let events = self.registers.read(offset::EVENTS);
            if events & OVERRUN != 0 {
                self.registers.write(offset::CLEAR, OVERRUN);
                return Err(Overrun);
            }
            if events & NOT_EMPTY == 0 {
                return Ok(None);
            }
            let words = offset::RECEIVE.map(|place| self.registers.read(place));
            // It is set again at once if there are more.
            self.registers.write(offset::CLEAR, NOT_EMPTY | RECEIVED);
            if let Some(frame) = self.layout.frame(words) {
                return Ok(Some(frame));
            }
        }
    }

    fn load(&mut self, frame: &CanFrame) -> Option<usize> {
        if self.absent > 0 || self.sending.is_some() {
            return None;
        }
        // Before the frame is there: cleared behind it, the event that it has been sent could be lost.
        self.registers.write(offset::CLEAR, EMPTIED);
        for (place, word) in offset::TRANSMIT.into_iter().zip(self.layout.words(frame)) {
            self.registers.write(place, word);
        }
        self.sending = Some(Fate::Underway);
        Some(0)
    }

    fn fate(&mut self, _: usize) -> Fate {
        self.settle();
        match self.sending {
            Some(fate @ (Fate::Sent | Fate::Back)) => {
                self.sending = None;
                fate
            }
            _ => Fate::Underway,
        }
    }

    /// Resets the controller, so what it received in this moment is lost; a frame that blocked the bus until it was too old is worth
    /// it. After a bus-off it keeps away, and [`Port::left_bus`] resets it.
    fn recall(&mut self, _: usize) {
        let is_off = self.registers.read(offset::EVENTS) & BUS_OFF != 0;
        if self.sending == Some(Fate::Underway) && self.absent == 0 && !is_off {
            self.leave();
            self.join();
        }
    }

    /// After a bus-off the controller has to be reset, and then it would join at once; so it is kept away for as long as a
    /// node has to be. Its own queue is empty then, since what waited there has been overtaken. A reset that does not end is
    /// told likewise, each time that it is tried.
    fn left_bus(&mut self) -> bool {
        if self.absent > 0 {
            self.absent -= 1;
            if self.absent == 0 {
                self.join();
            }
            return core::mem::take(&mut self.is_stuck);
        }
        let left = self.registers.read(offset::EVENTS) & BUS_OFF != 0;
        if left {
            self.registers.write(offset::CLEAR, BUS_OFF);
            self.leave();
        }
        left
    }
}
