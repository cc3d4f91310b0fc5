//! The CAN controller of the ZynqMP.

use super::Chip;
use crate::board::acceptance::Patterns;
use crate::board::frame::CanFrame;
use crate::board::registers::Registers;
use crate::board::zynqmp_r5::can::{self, Controller, offset};
use crate::board::zynqmp_r5::layout::{Layout, Words};
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;

pub const DEPTH: usize = 64;

#[derive(Default)]
pub struct State {
    /// In a reset that does not end.
    stuck: bool,
    /// On the bus, or ready for it; with none of it the driver may set it up.
    pub enabled: bool,
    pub timing: Option<(u32, u32)>,
    /// Filters that are on, and their words: mask and identifier.
    filters: u32,
    filter: [[u32; 2]; can::ACCEPTANCE],
    events: u32,
    /// Which of them interrupt.
    interrupts: u32,
    received: VecDeque<Words>,
    /// The words of the frame that is being queued, and the queue.
    writing: Vec<u32>,
    queued: VecDeque<Words>,
}

impl State {
    /// Without a filter it lets everything in.
    fn lets_in(&self, id: u32) -> bool {
        let is_on = |number: &usize| self.filters & 1 << number != 0;
        let mut used = (0..can::ACCEPTANCE).filter(is_on).peekable();
        used.peek().is_none() || used.any(|number| (id ^ self.filter[number][1]) & self.filter[number][0] == 0)
    }

    /// Whether a core that sleeps is woken, or does not fall asleep.
    pub fn wakes(&self) -> bool {
        self.events & self.interrupts != 0
    }
}

#[derive(Clone, Default)]
pub struct Mock {
    pub chip: Rc<RefCell<State>>,
    /// How many resets will not end.
    pub stuck: Rc<Cell<u32>>,
    /// How many there have been.
    pub resets: Rc<Cell<u32>>,
}

impl Chip for Mock {
    /// In the order in which they were queued. What loses arbitration is kept.
    fn send(&self, most: usize) -> Vec<CanFrame> {
        let mut chip = self.chip.borrow_mut();
        if !chip.enabled || chip.events & can::BUS_OFF != 0 {
            return Vec::new();
        }
        let most = most.min(chip.queued.len());
        let sent: Vec<_> = chip.queued.drain(..most).map(|words| Layout::Silicon.frame(words).unwrap()).collect();
        if !sent.is_empty() && chip.queued.is_empty() {
            chip.events |= can::EMPTIED;
        }
        sent
    }

    fn fail(&self) {}

    fn hear(&self, frame: &CanFrame) {
        let mut chip = self.chip.borrow_mut();
        if !chip.lets_in(Layout::Silicon.words(frame)[0]) {
            return;
        }
        if chip.received.len() == DEPTH {
            chip.events |= can::OVERRUN;
        } else {
            chip.received.push_back(Layout::Silicon.words(frame));
            chip.events |= can::RECEIVED | can::NOT_EMPTY;
        }
    }

    fn go_off(&self) {
        self.chip.borrow_mut().events |= can::BUS_OFF;
    }

    fn wait(&self) {}

    fn is_on(&self) -> bool {
        let chip = self.chip.borrow();
        chip.enabled && chip.events & can::BUS_OFF == 0
    }
}

impl Registers for Mock {
    fn read(&self, place: usize) -> u32 {
        let mut chip = self.chip.borrow_mut();
        match place {
            offset::STATUS if !chip.enabled && !chip.stuck => can::CONFIGURING,
            offset::STATUS => 0,
            offset::EVENTS => chip.events,
            _ => {
                let word =
                    offset::RECEIVE.iter().position(|receive| *receive == place).expect("a register that is read");
                let oldest = *chip.received.front().expect("the driver reads an empty queue");
                if word == 3 {
                    chip.received.pop_front();
                }
                oldest[word]
            }
        }
    }

    fn write(&mut self, place: usize, word: u32) {
        let mut chip = self.chip.borrow_mut();
        match place {
            offset::CONTROL if word & can::RESET != 0 => {
                let stuck = self.stuck.get();
                self.stuck.set(stuck.saturating_sub(1));
                self.resets.set(self.resets.get() + 1);
                *chip = State { stuck: stuck > 0, ..State::default() };
            }
            offset::CONTROL => {
                assert!(!chip.stuck, "put onto the bus out of a reset that has not ended");
                assert!(chip.timing.is_some(), "on the bus without its timing");
                chip.enabled = word & can::ENABLE != 0;
            }
            offset::PRESCALER | offset::TIMING => {
                assert!(!chip.enabled, "the timing of a controller that is on the bus does not change");
                let (quantum, bit) = chip.timing.unwrap_or_default();
                chip.timing = Some(if place == offset::TIMING { (quantum, word) } else { (word, bit) });
            }
            offset::CLEAR => {
                chip.events &= !word;
                if !chip.received.is_empty() {
                    chip.events |= can::NOT_EMPTY;
                }
            }
            offset::INTERRUPTS => chip.interrupts = word,
            offset::MODE => assert_eq!(word, 0),
            offset::FILTERS => chip.filters = word,
            _ if (offset::FILTER..offset::FILTER + 8 * can::ACCEPTANCE).contains(&place) => {
                let at = place - offset::FILTER;
                assert_eq!(chip.filters & 1 << (at / 8), 0, "a filter that is on does not change");
                chip.filter[at / 8][at % 8 / 4] = word;
            }
            _ => {
                let at = offset::TRANSMIT
                    .iter()
                    .position(|transmit| *transmit == place)
                    .expect("a register that is written");
                assert!(chip.enabled, "a frame for a controller that is off");
                assert!(chip.queued.len() < DEPTH, "a frame for a queue that is full");
                assert_eq!(chip.writing.len(), at, "the words of a frame in their order");
                chip.writing.push(word);
                if at == 3 {
                    let words = std::mem::take(&mut chip.writing).try_into().unwrap();
                    chip.queued.push_back(words);
                }
            }
        }
    }
}

/// A controller in operation, and the chip behind it.
pub fn controller() -> (Controller<Mock>, Mock) {
    listening(Patterns::everything())
}

/// One that lets this in.
pub fn listening(wanted: Patterns) -> (Controller<Mock>, Mock) {
    let mock = Mock::default();
    (Controller::start(mock.clone(), Layout::Silicon, wanted), mock)
}
