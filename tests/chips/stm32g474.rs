//! The CAN controller of the STM32G474, FDCAN, with its message RAM.

use super::{Chip, Mailboxes};
use crate::board::acceptance::Patterns;
use crate::board::frame::CanFrame;
use crate::board::registers::Registers;
use crate::board::stm32g474::element;
use crate::board::stm32g474::fdcan::{self, BUFFER, BUFFERS, Controller, offset};
use std::cell::{Cell, RefCell};
use std::rc::Rc;

pub const CLOCK_HZ: u32 = 24_000_000;
const WORDS: usize = 0x350 / 4;

/// A transmit buffer, besides its words.
#[derive(Clone, Copy, Default)]
struct Buffer {
    pending: bool,
    /// Its transmission is on the bus just now.
    on_air: bool,
    cancelled: bool,
    sent: bool,
}

pub struct State {
    control: u32,
    /// The two clocks do not agree, and the controller does not get to be set up.
    pub stuck: bool,
    pub timing: Option<u32>,
    ram: [u32; WORDS],
    global: u32,
    queue: u32,
    events: Cell<u32>,
    enabled: u32,
    lines: u32,
    /// Which ends of a transmission interrupt.
    ends: [u32; 2],
    buffers: [Buffer; BUFFERS],
    /// How many frames wait, and the place of the oldest.
    waiting: u32,
    oldest: u32,
    off: bool,
    /// It counts idle bits, to be back.
    counts: bool,
}

impl State {
    fn raise(&self, event: u32) {
        self.events.set(self.events.get() | event);
    }

    fn word(&self, place: usize) -> u32 {
        self.ram[(place - offset::RAM) / 4]
    }

    fn transmitted(&self, number: usize) -> element::Words {
        [0, 4, 8, 12].map(|word| self.word(offset::TRANSMIT + BUFFER * number + word))
    }

    /// The next one to be sent: the lowest identifier, and of the same the lowest buffer.
    fn first(&self) -> Option<usize> {
        if self.control & fdcan::INITIALISE != 0 || self.off {
            return None;
        }
        let order = |number: &usize| {
            let id = self.transmitted(*number)[0];
            (id >> 18 & 0x7ff, id >> 30 & 1, id & 0x3_ffff)
        };
        (0..BUFFERS).filter(|number| self.buffers[*number].pending).min_by_key(order)
    }

    /// The lowest buffer that does not wait.
    fn next(&self) -> Option<usize> {
        self.buffers.iter().position(|buffer| !buffer.pending)
    }

    fn end(&mut self, number: usize, sent: bool) {
        let cancelled = self.buffers[number].cancelled;
        self.buffers[number] = Buffer { sent, ..Buffer::default() };
        if sent && self.ends[0] & 1 << number != 0 {
            self.raise(fdcan::SENT);
        }
        if cancelled && self.ends[1] & 1 << number != 0 {
            self.raise(fdcan::BACK);
        }
    }

    /// Whether a filter lets the identifier in: of either kind the first ones, as many as the global filter says.
    fn lets_in(&self, id: u32, is_extended: bool) -> bool {
        assert_eq!(self.global & 0b11_1111, fdcan::REFUSE_OTHERS, "what no filter lets in is refused");
        if is_extended {
            let count = self.global >> fdcan::EXTENDED_COUNT_SHIFT & 0xf;
            assert!(count <= 8);
            return (0..count as usize).any(|number| {
                let [first, second] = [0, 4].map(|word| self.word(offset::EXTENDED + 8 * number + word));
                assert_eq!((first >> 29, second >> 30), (0b001, 0b10), "into the first queue, by a mask");
                (id ^ first) & second & 0x1fff_ffff == 0
            });
        }
        let count = self.global >> fdcan::STANDARD_COUNT_SHIFT & 0x1f;
        assert!(count <= 28);
        (0..count as usize).any(|number| {
            let word = self.word(offset::STANDARD + 4 * number);
            assert_eq!(word >> 27, 0b10_001, "into the first queue, by a mask");
            (id ^ word >> 16) & word & 0x7ff == 0
        })
    }

    /// The registers that lose what they had when the settings may be changed.
    fn forget(&mut self) {
        self.buffers = Default::default();
        (self.waiting, self.oldest) = (0, 0);
    }

    fn control(&mut self, word: u32) {
        assert_eq!(word & !(fdcan::INITIALISE | fdcan::CHANGE), 0, "classic CAN, and nothing else is set in there");
        let was = self.control;
        let initialises = word & fdcan::INITIALISE != 0 && !self.stuck;
        let changes = word & fdcan::CHANGE != 0 && was & fdcan::INITIALISE != 0 && initialises;
        self.control = u32::from(initialises) | if changes { fdcan::CHANGE } else { 0 };
        if changes {
            self.forget();
        }
        if was & fdcan::INITIALISE != 0 && !initialises {
            assert!(
                self.timing.is_some() && self.queue == fdcan::QUEUE || self.stuck,
                "on the bus without its settings"
            );
            self.counts = self.off;
        }
    }

    fn may_change(&self) -> bool {
        self.control & fdcan::CHANGE != 0
    }
}

#[derive(Clone)]
pub struct Mock(pub Rc<RefCell<State>>);

impl Mailboxes for Mock {
    fn begin(&self) {
        let mut chip = self.0.borrow_mut();
        if let Some(number) = chip.first() {
            chip.buffers[number].on_air = true;
        }
    }

    fn interrupts(&self) -> bool {
        let chip = self.0.borrow();
        chip.lines & 1 != 0 && chip.events.get() & chip.enabled != 0
    }

    fn pending(&self) -> usize {
        self.0.borrow().buffers.iter().filter(|buffer| buffer.pending).count()
    }
}

impl Chip for Mock {
    fn send(&self, most: usize) -> Vec<CanFrame> {
        let mut sent = Vec::new();
        while sent.len() < most {
            let mut chip = self.0.borrow_mut();
            let Some(number) = chip.first() else { break };
            sent.push(element::frame(chip.transmitted(number)).unwrap());
            chip.end(number, true);
        }
        sent
    }

    fn fail(&self) {
        self.begin();
        let mut chip = self.0.borrow_mut();
        for number in 0..BUFFERS {
            if chip.buffers[number].on_air && chip.buffers[number].cancelled {
                chip.end(number, false);
            }
            chip.buffers[number].on_air = false;
        }
    }

    fn hear(&self, frame: &CanFrame) {
        let mut chip = self.0.borrow_mut();
        let [id, length, low, high] = element::words(frame);
        let is_extended = id >> 30 & 1 != 0;
        if chip.control & fdcan::INITIALISE != 0
            || !chip.lets_in(if is_extended { id & 0x1fff_ffff } else { id >> 18 & 0x7ff }, is_extended)
        {
            return;
        }
        if chip.waiting == 3 {
            chip.raise(fdcan::LOST);
            return;
        }
        let base = offset::RECEIVED - offset::RAM + BUFFER * ((chip.oldest + chip.waiting) % 3) as usize;
        // The error state of the sender, which filter it was, and a time.
        for (word, text) in [id | 1 << 31, length | 0x0100_1234, low, high].into_iter().enumerate() {
            chip.ram[base / 4 + word] = text;
        }
        chip.waiting += 1;
        chip.raise(fdcan::ARRIVED);
    }

    fn go_off(&self) {
        let mut chip = self.0.borrow_mut();
        chip.off = true;
        chip.control |= fdcan::INITIALISE;
        chip.buffers.iter_mut().for_each(|buffer| buffer.on_air = false);
    }

    fn wait(&self) {
        let mut chip = self.0.borrow_mut();
        if chip.counts {
            (chip.counts, chip.off) = (false, false);
        }
    }

    fn is_on(&self) -> bool {
        let chip = self.0.borrow();
        chip.control & fdcan::INITIALISE == 0 && !chip.off
    }
}

impl Registers for Mock {
    fn read(&self, place: usize) -> u32 {
        let chip = self.0.borrow();
        let bits = |is_set: fn(&Buffer) -> bool| {
            (0..BUFFERS).fold(0, |word, number| word | u32::from(is_set(&chip.buffers[number])) << number)
        };
        match place {
            offset::CCCR => chip.control,
            offset::PSR => {
                if chip.off {
                    fdcan::BUS_OFF
                } else {
                    0
                }
            }
            offset::IR => chip.events.get(),
            offset::RXF0S => chip.waiting | chip.oldest << fdcan::OLDEST_SHIFT,
            offset::TXFQS => match chip.next() {
                Some(next) => (next as u32) << fdcan::NEXT_SHIFT,
                None => fdcan::FULL,
            },
            offset::TXBRP => bits(|buffer| buffer.pending),
            offset::TXBTO => bits(|buffer| buffer.sent),
            _ => {
                let received = offset::RECEIVED..offset::RECEIVED + 3 * BUFFER;
                assert!(received.contains(&place) && chip.waiting > 0, "{place:#x} is read");
                assert_eq!((place - offset::RECEIVED) / BUFFER, chip.oldest as usize, "the oldest is read");
                chip.word(place)
            }
        }
    }

    fn write(&mut self, place: usize, word: u32) {
        let mut chip = self.0.borrow_mut();
        match place {
            offset::CCCR => chip.control(word),
            offset::NBTP | offset::RXGFC | offset::TXBC | offset::CKDIV => {
                assert!(chip.may_change(), "{place:#x} is written while the settings are protected");
                match place {
                    offset::NBTP => chip.timing = Some(word),
                    offset::RXGFC => chip.global = word,
                    offset::TXBC => chip.queue = word,
                    _ => assert_eq!(word, 0, "the clock is not divided"),
                }
            }
            offset::IR => chip.events.set(chip.events.get() & !word),
            offset::IE => chip.enabled = word,
            offset::ILS => assert_eq!(word, 0, "all interrupts by the first line"),
            offset::ILE => chip.lines = word,
            offset::TXBTIE => chip.ends[0] = word,
            offset::TXBCIE => chip.ends[1] = word,
            offset::RXF0A => {
                assert_eq!(word, chip.oldest);
                chip.oldest = (chip.oldest + 1) % 3;
                chip.waiting -= 1;
            }
            offset::TXBAR => {
                assert!(!chip.may_change(), "a frame for a controller that is being set up");
                assert_eq!(Some(word), chip.next().map(|next| 1 << next), "the next buffer is filled");
                let number = word.trailing_zeros() as usize;
                chip.buffers[number] = Buffer { pending: true, ..Buffer::default() };
            }
            offset::TXBCR => {
                let asked = |number: &usize| word & 1 << number != 0;
                for number in (0..BUFFERS).filter(asked) {
                    chip.buffers[number].cancelled |= chip.buffers[number].pending;
                    if chip.buffers[number].cancelled && !chip.buffers[number].on_air {
                        chip.end(number, false);
                    }
                }
            }
            _ => {
                let at =
                    place.checked_sub(offset::RAM).filter(|at| *at < 4 * WORDS).expect("a register that is written");
                if let Some(at) = place.checked_sub(offset::TRANSMIT) {
                    assert!(!chip.buffers[at / BUFFER].pending, "a buffer that waits is written");
                }
                chip.ram[at / 4] = word;
            }
        }
    }
}

/// A chip after its reset.
pub fn chip() -> Mock {
    Mock(Rc::new(RefCell::new(State {
        control: fdcan::INITIALISE,
        stuck: false,
        timing: None,
        ram: [0xdead_beef; WORDS],
        global: 0,
        queue: 0,
        events: Cell::new(0),
        enabled: 0,
        lines: 0,
        ends: [0; 2],
        buffers: Default::default(),
        waiting: 0,
        oldest: 0,
        off: false,
        counts: false,
    })))
}

/// A controller in operation, and the chip behind it.
pub fn controller() -> (Controller<Mock>, Mock) {
    listening(Patterns::everything())
}

/// One that lets this in.
pub fn listening(wanted: Patterns) -> (Controller<Mock>, Mock) {
    let mock = chip();
    (Controller::start(mock.clone(), CLOCK_HZ, wanted), mock)
}
