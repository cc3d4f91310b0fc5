//! The STM32G4's CAN controller, FDCAN, as a controller of classic CAN: its registers and its message RAM enter, a CAN port leaves.
//! Names, offsets and bits are those of ST's reference manual RM0440. It has run against a model of its registers, and on no chip.
//!
//! Its three transmit buffers are a queue that sends the lowest identifier first. The controller says which of them is the next to be
//! filled. A frame whose transmission fails stays in its buffer until it is taken back. After too many errors the controller leaves
//! the bus, and comes back when the driver asks for it: the buffers are empty by then, and so is the queue of received frames.

use super::element;
use crate::board::acceptance::{Pattern, Patterns};
use crate::board::bit_time::{ASKED, tolerance};
use crate::board::frame::CanFrame;
use crate::board::port::{Fate, Overrun, Port};
use crate::board::registers::Registers;
use heapless::Vec;

/// Byte offsets.
pub mod offset {
    /// Control.
    pub const CCCR: usize = 0x018;
    /// Bit timing.
    pub const NBTP: usize = 0x01c;
    /// State of the protocol.
    pub const PSR: usize = 0x044;
    /// What has happened, until it is cleared; what of it interrupts; by which of two lines; which lines are on.
    pub const IR: usize = 0x050;
    pub const IE: usize = 0x054;
    pub const ILS: usize = 0x058;
    pub const ILE: usize = 0x05c;
    /// How many filters there are, and what becomes of what passes none.
    pub const RXGFC: usize = 0x080;
    /// The queue of received frames, and "this one has been read".
    pub const RXF0S: usize = 0x090;
    pub const RXF0A: usize = 0x094;
    /// What the transmit buffers are.
    pub const TXBC: usize = 0x0c0;
    /// Which is the next one.
    pub const TXFQS: usize = 0x0c4;
    /// Of each buffer a bit: it waits; "send it"; "take it back"; it has been sent; its end interrupts, and its coming back.
    pub const TXBRP: usize = 0x0c8;
    pub const TXBAR: usize = 0x0cc;
    pub const TXBCR: usize = 0x0d0;
    pub const TXBTO: usize = 0x0d4;
    pub const TXBTIE: usize = 0x0dc;
    pub const TXBCIE: usize = 0x0e0;
    /// What the controller's clock is divided by.
    pub const CKDIV: usize = 0x100;

    /// The message RAM, which lies behind the registers: filters for standard and for extended identifiers, received frames,
    /// and frames to be sent.
    pub const RAM: usize = 0x4000;
    pub const STANDARD: usize = RAM;
    pub const EXTENDED: usize = RAM + 0x070;
    pub const RECEIVED: usize = RAM + 0x0b0;
    pub const TRANSMIT: usize = RAM + 0x278;
}

/// CCCR: off the bus; its settings can be changed. With all else 0 it is one of classic CAN that sends again by itself.
pub const INITIALISE: u32 = 1 << 0;
pub const CHANGE: u32 = 1 << 1;
/// PSR.
pub const BUS_OFF: u32 = 1 << 7;
/// IR and IE: a frame has come, one was lost, one has been sent, one has come back.
pub const ARRIVED: u32 = 1 << 0;
pub const LOST: u32 = 1 << 2;
pub const SENT: u32 = 1 << 7;
pub const BACK: u32 = 1 << 8;
/// RXGFC: what no filter lets in is refused, of either kind; and where the numbers of filters stand.
pub const REFUSE_OTHERS: u32 = 0b10 << 4 | 0b10 << 2;
pub const STANDARD_COUNT_SHIFT: u32 = 16;
pub const EXTENDED_COUNT_SHIFT: u32 = 24;
/// RXF0S: how many frames wait, and which is the oldest.
pub const WAITING: u32 = 0b1111;
pub const OLDEST_SHIFT: u32 = 8;
/// TXBC: the lowest identifier first.
pub const QUEUE: u32 = 1 << 24;
/// TXFQS: which buffer is the next to be filled; none.
pub const NEXT_SHIFT: u32 = 16;
pub const FULL: u32 = 1 << 21;

/// The parts of the message RAM.
pub const STANDARD_FILTERS: usize = 28;
pub const EXTENDED_FILTERS: usize = 8;
pub const BUFFERS: usize = 3;
/// Bytes of a buffer, for sending or receiving.
pub const BUFFER: usize = 72;
const ALL_BUFFERS: u32 = (1 << BUFFERS) - 1;

const BIT_RATE: u32 = 500_000;
/// Of a bit: one, then these before and behind the sample point, at 81 % of it. A resynchronisation moves it by up to `JUMP`.
/// Sixteen quanta fit every crystal that is a multiple of 8 MHz.
const BEFORE: u32 = 12;
const BEHIND: u32 = 3;
const JUMP: u32 = 3;
const QUANTA: u32 = 1 + BEFORE + BEHIND;

const _: () = assert!(tolerance(QUANTA, BEHIND, JUMP) >= ASKED);

/// The controller as a port.
pub struct Controller<R> {
    registers: R,
    /// `None` if the clock does not give the bit rate: then it keeps away from the bus.
    timing: Option<u32>,
    /// What the global filter is: it refuses what these many filters do not let in.
    filters: u32,
    bus: Bus,
    /// What became of what is in the buffers; `None` where there is nothing, or its fate has been told.
    fates: [Option<Fate>; BUFFERS],
}

/// Where the controller stands to the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bus {
    /// On it.
    On,
    /// It has left, and empties its buffers.
    Leaving,
    /// It counts 129 times 11 idle bits, and is on the bus then.
    Returning,
    /// It could not be set up.
    Stuck,
}

impl<R: Registers> Controller<R> {
    /// Puts it into operation, by a clock of this many hertz; it lets in what is wanted, at least.
    pub fn start(mut registers: R, clock_hz: u32, wanted: Patterns) -> Self {
        let filters = filter(&mut registers, wanted);
        let fates = [None; BUFFERS];
        let mut controller = Self { registers, timing: timing(clock_hz), filters, bus: Bus::Stuck, fates };
        controller.join();
        controller
    }

    /// From a reset onto the bus, which it joins when that has been idle for a moment.
    fn join(&mut self) {
        let Some(timing) = self.timing else { return };
        self.registers.write(offset::CCCR, INITIALISE);
        // Two clocks have to agree on it, which takes some cycles of either. If it takes longer it is tried again.
        if !(0..20_000).any(|_| self.registers.read(offset::CCCR) & INITIALISE != 0) {
            return;
        }
        self.registers.write(offset::CCCR, INITIALISE | CHANGE);
        for (place, word) in [
            (offset::CKDIV, 0),
            (offset::NBTP, timing),
            (offset::RXGFC, self.filters),
            (offset::TXBC, QUEUE),
            (offset::TXBTIE, ALL_BUFFERS),
            (offset::TXBCIE, ALL_BUFFERS),
            (offset::IE, ARRIVED | LOST | SENT | BACK),
            (offset::ILS, 0),
            (offset::ILE, 1),
            (offset::CCCR, 0),
        ] {
            self.registers.write(place, word);
        }
        self.bus = Bus::On;
    }

    /// Takes note of what became of the buffers. What interrupts is cleared before it looks: what is done after that interrupts
    /// anew.
    fn settle(&mut self) {
        self.registers.write(offset::IR, SENT | BACK);
        let (waiting, sent) = (self.registers.read(offset::TXBRP), self.registers.read(offset::TXBTO));
        for (place, fate) in self.fates.iter_mut().enumerate() {
            if *fate == Some(Fate::Underway) && waiting & 1 << place == 0 {
                *fate = Some(if sent & 1 << place != 0 { Fate::Sent } else { Fate::Back });
            }
        }
    }

    /// Off the bus: the buffers are emptied by what allows to change the settings.
    fn leave(&mut self) {
        self.settle();
        self.registers.write(offset::CCCR, INITIALISE | CHANGE);
        for fate in &mut self.fates {
            *fate = fate.map(|fate| if fate == Fate::Underway { Fate::Back } else { fate });
        }
        self.bus = Bus::Leaving;
    }
}

impl<R: Registers> Port for Controller<R> {
    const TAKES_BACK: bool = true;

    fn receive(&mut self) -> Result<Option<CanFrame>, Overrun> {
        loop {
            if self.registers.read(offset::IR) & LOST != 0 {
                self.registers.write(offset::IR, LOST);
                return Err(Overrun);
            }
            // Before it looks whether there is one: what comes after that interrupts anew.
            self.registers.write(offset::IR, ARRIVED);
            let queue = self.registers.read(offset::RXF0S);
            if queue & WAITING == 0 {
                return Ok(None);
            }
            let oldest = queue >> OLDEST_SHIFT & 0b11;
            let base = offset::RECEIVED + BUFFER * oldest as usize;
            let words = [0, 4, 8, 12].map(|word| self.registers.read(base + word));
            self.registers.write(offset::RXF0A, oldest);
            if let Some(frame) = element::frame(words) {
                return Ok(Some(frame));
            }
        }
    }

    fn load(&mut self, frame: &CanFrame) -> Option<usize> {
        if self.bus != Bus::On {
            return None;
        }
        let queue = self.registers.read(offset::TXFQS);
        let place = (queue >> NEXT_SHIFT & 0b11) as usize;
        // One that has just been sent is the next one too, but its fate has not been told.
        let free = self.fates.get_mut(place).filter(|fate| queue & FULL == 0 && fate.is_none())?;
        *free = Some(Fate::Underway);
        let base = offset::TRANSMIT + BUFFER * place;
        for (word, place) in element::words(frame).into_iter().zip([0, 4, 8, 12]) {
            self.registers.write(base + place, word);
        }
        self.registers.write(offset::TXBAR, 1 << place);
        Some(place)
    }

    fn fate(&mut self, place: usize) -> Fate {
        self.settle();
        match self.fates.get_mut(place) {
            Some(told @ Some(Fate::Sent | Fate::Back)) => told.take().unwrap_or(Fate::Underway),
            _ => Fate::Underway,
        }
    }

    fn recall(&mut self, place: usize) {
        self.registers.write(offset::TXBCR, 1 << place);
    }

    /// A step on the way back to the bus a period: so it is away for a period, and for 129 times 11 bits after it, as ISO 11898-1 asks.
    fn left_bus(&mut self) -> bool {
        let is_off = self.registers.read(offset::PSR) & BUS_OFF != 0;
        match self.bus {
            Bus::On if is_off => {
                self.leave();
                return true;
            }
            Bus::Leaving => {
                self.registers.write(offset::CCCR, 0);
                self.bus = Bus::Returning;
            }
            Bus::Returning if !is_off => self.bus = Bus::On,
            Bus::On | Bus::Returning => {}
            Bus::Stuck => {
                self.join();
                return self.bus == Bus::Stuck;
            }
        }
        false
    }
}

/// Writes the filters into the message RAM; the word of the global filter that goes with them.
fn filter(registers: &mut impl Registers, wanted: Patterns) -> u32 {
    let (standard, extended): (Vec<Pattern, STANDARD_FILTERS>, Vec<Pattern, EXTENDED_FILTERS>) =
        wanted.at_most_of_each();
    for (number, pattern) in standard.iter().enumerate() {
        registers.write(offset::STANDARD + 4 * number, element::standard_filter(pattern));
    }
    for (number, pattern) in extended.iter().enumerate() {
        for (word, place) in element::extended_filter(pattern).into_iter().zip([0, 4]) {
            registers.write(offset::EXTENDED + 8 * number + place, word);
        }
    }
    let counts = (standard.len() as u32) << STANDARD_COUNT_SHIFT | (extended.len() as u32) << EXTENDED_COUNT_SHIFT;
    REFUSE_OTHERS | counts
}

/// The word of the bit timing, if this clock gives the bit rate exactly.
fn timing(clock_hz: u32) -> Option<u32> {
    let prescaler = clock_hz / (BIT_RATE * QUANTA);
    let is_exact = (1..=512).contains(&prescaler) && prescaler * BIT_RATE * QUANTA == clock_hz;
    is_exact.then(|| (BEHIND - 1) | (BEFORE - 1) << 8 | (prescaler - 1) << 16 | (JUMP - 1) << 25)
}
