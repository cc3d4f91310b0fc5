//! The STM32's own CAN controller, bxCAN: its registers enter, a CAN port leaves. Names, offsets and bits are those of ST's
//! reference manual RM0090. It has run against a model of its registers, and on no chip.
//!
//! Three mailboxes send by themselves, the lowest identifier first. A frame whose transmission fails stays in its mailbox until it is
//! taken back. After too many errors the controller leaves the bus, and comes back only when the driver asks for it: so the
//! mailboxes are empty by then.

use super::mailbox;
use crate::board::acceptance::{Pattern, Patterns};
use crate::board::bit_time::{ASKED, tolerance};
use crate::board::frame::CanFrame;
use crate::board::port::{Fate, Overrun, Port};
use crate::board::registers::Registers;
use heapless::Vec;

/// Byte offsets.
pub mod offset {
    /// Master control, and its echo.
    pub const MCR: usize = 0x000;
    pub const MSR: usize = 0x004;
    /// What the mailboxes do.
    pub const TSR: usize = 0x008;
    /// The queue of received frames.
    pub const RF0R: usize = 0x00c;
    /// What interrupts.
    pub const IER: usize = 0x014;
    /// Errors.
    pub const ESR: usize = 0x018;
    /// Bit timing.
    pub const BTR: usize = 0x01c;
    /// The four words of the first mailbox; the others follow.
    pub const MAILBOX: usize = 0x180;
    /// The four words of the oldest received frame.
    pub const RECEIVED: usize = 0x1b0;
    /// Filters: being set up, kind, width, queue, on, and the words of the first bank.
    pub const FMR: usize = 0x200;
    pub const FM1R: usize = 0x204;
    pub const FS1R: usize = 0x20c;
    pub const FFA1R: usize = 0x214;
    pub const FA1R: usize = 0x21c;
    pub const BANK: usize = 0x240;
}

/// MCR: to be set up. MSR: is being set up.
pub const INITIALISE: u32 = 1 << 0;
/// TSR, of the first mailbox; the others follow by eight bits. Done, sent, and "abort".
pub const DONE: u32 = 1 << 0;
pub const SENT: u32 = 1 << 1;
pub const ABORT: u32 = 1 << 7;
const PER_MAILBOX: usize = 8;
/// TSR: the first mailbox is empty; the others follow bit by bit.
pub const EMPTY: u32 = 1 << 26;
/// RF0R: how many frames wait, one was lost, "the oldest is taken".
pub const PENDING: u32 = 0b11;
pub const LOST: u32 = 1 << 4;
pub const RELEASE: u32 = 1 << 5;
/// IER: a mailbox is done, a frame waits.
pub const ON_DONE: u32 = 1 << 0;
pub const ON_PENDING: u32 = 1 << 1;
/// ESR.
pub const BUS_OFF: u32 = 1 << 2;

const MAILBOXES: usize = 3;
/// Filter banks that are this controller's while the chip's second one, which shares them, is not used.
const BANKS: usize = 14;

const BIT_RATE: u32 = 500_000;
/// Of a bit: one, then these before and behind the sample point, at 86 % of it. A resynchronisation moves it by up to `JUMP`.
const BEFORE: u32 = 11;
const BEHIND: u32 = 2;
const JUMP: u32 = 2;
const QUANTA: u32 = 1 + BEFORE + BEHIND;

const _: () = assert!(tolerance(QUANTA, BEHIND, JUMP) >= ASKED);

/// The controller as a port.
pub struct Controller<R> {
    registers: R,
    filters: Vec<Pattern, BANKS>,
    /// `None` if the clock does not give the bit rate: then it keeps away from the bus.
    timing: Option<u32>,
    bus: Bus,
}

/// Where the controller stands to the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bus {
    /// On it.
    On,
    /// It has left; the set-up that begins its way back is asked for.
    Leaving,
    /// It counts 128 times 11 idle bits, and is on the bus then.
    Returning,
    /// It could not be set up.
    Stuck,
}

impl<R: Registers> Controller<R> {
    /// Puts it into operation, by a clock of this many hertz; it lets in what is wanted, at least.
    pub fn start(registers: R, clock_hz: u32, wanted: Patterns) -> Self {
        let filters = wanted.at_most();
        let mut controller = Self { registers, filters, timing: timing(clock_hz), bus: Bus::Stuck };
        controller.join();
        controller
    }

    /// From a reset onto the bus, which it joins when that has been idle for a moment.
    fn join(&mut self) {
        let Some(timing) = self.timing else { return };
        self.registers.write(offset::MCR, INITIALISE);
        // It takes until the end of a frame on the bus, 0.3 ms. If it takes longer it is tried again.
        if !(0..20_000).any(|_| self.is_initialising()) {
            return;
        }
        self.registers.write(offset::BTR, timing);
        self.registers.write(offset::IER, ON_DONE | ON_PENDING);
        self.filter();
        self.registers.write(offset::MCR, 0);
        self.bus = Bus::On;
    }

    fn is_initialising(&self) -> bool {
        self.registers.read(offset::MSR) & INITIALISE != 0
    }

    /// A filter bank of an identifier and a mask for each pattern, into the first queue. Remote frames pass like others: the unit
    /// refuses them by name.
    fn filter(&mut self) {
        let begin = self.registers.read(offset::FMR) | 1;
        self.registers.write(offset::FMR, begin);
        self.registers.write(offset::FA1R, 0);
        self.registers.write(offset::FM1R, 0);
        self.registers.write(offset::FFA1R, 0);
        let mut used = 0;
        for (number, pattern) in self.filters.iter().enumerate() {
            for (word, place) in mailbox::filter(pattern).into_iter().zip([0, 4]) {
                self.registers.write(offset::BANK + 8 * number + place, word);
            }
            used |= 1 << number;
        }
        self.registers.write(offset::FS1R, used);
        self.registers.write(offset::FA1R, used);
        self.registers.write(offset::FMR, begin & !1);
    }
}

impl<R: Registers> Port for Controller<R> {
    const TAKES_BACK: bool = true;

    fn receive(&mut self) -> Result<Option<CanFrame>, Overrun> {
        loop {
            let queue = self.registers.read(offset::RF0R);
            if queue & LOST != 0 {
                self.registers.write(offset::RF0R, LOST);
                return Err(Overrun);
            }
            if queue & PENDING == 0 {
                return Ok(None);
            }
            let words = [0, 4, 8, 12].map(|word| self.registers.read(offset::RECEIVED + word));
            self.registers.write(offset::RF0R, RELEASE);
            if let Some(frame) = mailbox::frame(words) {
                return Ok(Some(frame));
            }
        }
    }

    fn load(&mut self, frame: &CanFrame) -> Option<usize> {
        if self.bus != Bus::On {
            return None;
        }
        let status = self.registers.read(offset::TSR);
        // One that is done is empty too, but its fate has not been told.
        let is_free = |place: &usize| status & EMPTY << place != 0 && status & DONE << (PER_MAILBOX * place) == 0;
        let place = (0..MAILBOXES).find(is_free)?;
        let base = offset::MAILBOX + 16 * place;
        let [id, length, low, high] = mailbox::words(frame);
        self.registers.write(base + 4, length);
        self.registers.write(base + 8, low);
        self.registers.write(base + 12, high);
        self.registers.write(base, id | mailbox::REQUEST);
        Some(place)
    }

    fn fate(&mut self, place: usize) -> Fate {
        let status = self.registers.read(offset::TSR) >> (PER_MAILBOX * place);
        if status & DONE == 0 {
            return Fate::Underway;
        }
        // This clears `SENT` and what it interrupts by, too. To write a 0 changes nothing.
        self.registers.write(offset::TSR, DONE << (PER_MAILBOX * place));
        if status & SENT != 0 { Fate::Sent } else { Fate::Back }
    }

    fn recall(&mut self, place: usize) {
        self.registers.write(offset::TSR, ABORT << (PER_MAILBOX * place));
    }

    /// A step on the way back to the bus a period: so it is away for a period, and for 128 times 11 bits after it, as ISO 11898-1 asks.
    fn left_bus(&mut self) -> bool {
        let is_off = self.registers.read(offset::ESR) & BUS_OFF != 0;
        match self.bus {
            Bus::On if is_off => {
                for place in 0..MAILBOXES {
                    self.recall(place);
                }
                self.registers.write(offset::MCR, INITIALISE);
                self.bus = Bus::Leaving;
                return true;
            }
            Bus::Leaving if self.is_initialising() => {
                self.registers.write(offset::MCR, 0);
                self.bus = Bus::Returning;
            }
            Bus::Returning if !is_off => self.bus = Bus::On,
            Bus::On | Bus::Leaving | Bus::Returning => {}
            Bus::Stuck => {
                self.join();
                return self.bus == Bus::Stuck;
            }
        }
        false
    }
}

/// The word of the bit timing, if this clock gives the bit rate exactly.
fn timing(clock_hz: u32) -> Option<u32> {
    let prescaler = clock_hz / (BIT_RATE * QUANTA);
    let is_exact = (1..=1024).contains(&prescaler) && prescaler * BIT_RATE * QUANTA == clock_hz;
    is_exact.then(|| (prescaler - 1) | (BEFORE - 1) << 16 | (BEHIND - 1) << 20 | (JUMP - 1) << 24)
}
