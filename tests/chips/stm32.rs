//! The CAN controller of the STM32F405, bxCAN.

use super::{Chip, Mailboxes};
use crate::board::acceptance::Patterns;
use crate::board::frame::CanFrame;
use crate::board::registers::Registers;
use crate::board::stm32f405::can::{self, Controller, offset};
use crate::board::stm32f405::mailbox::{self, Words};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

pub const CLOCK_HZ: u32 = 42_000_000;
const DEPTH: usize = 3;
const BANKS: usize = 14;
const INITIALISING: u32 = 1;
const ASLEEP: u32 = 1 << 1;

/// A mailbox: its words, and whether they are to be sent.
#[derive(Clone, Copy, Default)]
struct Mailbox {
    words: Words,
    pending: bool,
    /// Its transmission is on the bus just now.
    on_air: bool,
    abort: bool,
    done: bool,
    sent: bool,
}

pub struct State {
    initialising: bool,
    asleep: bool,
    /// The end of a frame on the bus does not come, and the controller does not get to be set up.
    pub stuck: bool,
    pub timing: Option<u32>,
    interrupts: u32,
    mailboxes: [Mailbox; 3],
    received: VecDeque<Words>,
    lost: bool,
    off: bool,
    /// It counts idle bits, to be back.
    counts: bool,
    filters_are_set_up: bool,
    /// Banks that are on, and their words.
    filters: u32,
    banks: [[u32; 2]; BANKS],
}

impl State {
    /// Whether a bank that is on, as wide as an extended identifier and with a mask, lets this identifier in.
    fn lets_in(&self, id: u32) -> bool {
        let is_on = |bank: &usize| self.filters & 1 << bank != 0;
        (0..BANKS).filter(is_on).any(|bank| (id ^ self.banks[bank][0]) & self.banks[bank][1] == 0)
    }

    /// The next one to be sent: the lowest identifier, and of the same the lowest mailbox.
    fn first(&mut self) -> Option<&mut Mailbox> {
        if self.initialising || self.asleep || self.off {
            return None;
        }
        // The first 11 bits, standard before extended, the other 18 bits.
        let order = |word: u32| (word >> 21, word >> 2 & 1, word >> 3);
        self.mailboxes.iter_mut().filter(|mailbox| mailbox.pending).min_by_key(|mailbox| order(mailbox.words[0]))
    }
}

#[derive(Clone)]
pub struct Mock(pub Rc<RefCell<State>>);

impl Mailboxes for Mock {
    fn begin(&self) {
        if let Some(mailbox) = self.0.borrow_mut().first() {
            mailbox.on_air = true;
        }
    }

    fn interrupts(&self) -> bool {
        let chip = self.0.borrow();
        let done = chip.mailboxes.iter().any(|mailbox| mailbox.done);
        done && chip.interrupts & can::ON_DONE != 0
            || !chip.received.is_empty() && chip.interrupts & can::ON_PENDING != 0
    }

    fn pending(&self) -> usize {
        self.0.borrow().mailboxes.iter().filter(|mailbox| mailbox.pending).count()
    }
}

impl Chip for Mock {
    fn send(&self, most: usize) -> Vec<CanFrame> {
        let mut sent = Vec::new();
        while sent.len() < most {
            let mut chip = self.0.borrow_mut();
            let Some(mailbox) = chip.first() else { break };
            sent.push(mailbox::frame(mailbox.words).unwrap());
            *mailbox = Mailbox { done: true, sent: true, ..Mailbox::default() };
        }
        sent
    }

    fn fail(&self) {
        self.begin();
        let mut chip = self.0.borrow_mut();
        for mailbox in &mut chip.mailboxes {
            if mailbox.on_air && mailbox.abort {
                *mailbox = Mailbox { done: true, ..Mailbox::default() };
            }
            mailbox.on_air = false;
        }
    }

    fn hear(&self, frame: &CanFrame) {
        let mut chip = self.0.borrow_mut();
        if !chip.lets_in(mailbox::words(frame)[0]) {
            return;
        }
        if chip.received.len() == DEPTH {
            chip.lost = true;
        } else {
            chip.received.push_back(mailbox::words(frame));
        }
    }

    fn go_off(&self) {
        let mut chip = self.0.borrow_mut();
        chip.off = true;
        chip.mailboxes.iter_mut().for_each(|mailbox| mailbox.on_air = false);
    }

    fn wait(&self) {
        let mut chip = self.0.borrow_mut();
        if chip.counts {
            (chip.counts, chip.off) = (false, false);
        }
    }

    fn is_on(&self) -> bool {
        let chip = self.0.borrow();
        !chip.initialising && !chip.asleep && !chip.off
    }
}

impl Registers for Mock {
    fn read(&self, place: usize) -> u32 {
        let chip = self.0.borrow();
        let flag = |is_set: bool, bit: u32| if is_set { bit } else { 0 };
        match place {
            offset::MSR => flag(chip.initialising, INITIALISING) | flag(chip.asleep, ASLEEP),
            offset::TSR => chip.mailboxes.iter().enumerate().fold(0, |word, (number, mailbox)| {
                let own =
                    flag(mailbox.done, can::DONE) | flag(mailbox.sent, can::SENT) | flag(mailbox.abort, can::ABORT);
                word | own << (8 * number) | flag(!mailbox.pending, can::EMPTY << number)
            }),
            offset::RF0R => chip.received.len() as u32 | flag(chip.lost, can::LOST),
            offset::ESR => flag(chip.off, can::BUS_OFF),
            offset::FMR => flag(chip.filters_are_set_up, 1),
            _ if (offset::RECEIVED..offset::RECEIVED + 16).contains(&place) => {
                chip.received.front().expect("the driver reads an empty queue")[(place - offset::RECEIVED) / 4]
            }
            _ => panic!("{place:#x} is read"),
        }
    }

    fn write(&mut self, place: usize, word: u32) {
        let mut chip = self.0.borrow_mut();
        match place {
            offset::MCR => {
                assert_eq!(word & !can::INITIALISE, 0, "nothing else is set in there");
                let wanted = word & can::INITIALISE != 0;
                chip.asleep = false;
                assert!(wanted || chip.timing.is_some(), "on the bus without its timing");
                chip.counts = chip.initialising && !wanted && chip.off;
                chip.initialising = wanted && !chip.stuck;
            }
            offset::BTR => {
                assert!(chip.initialising, "the timing is set while the controller is being set up");
                chip.timing = Some(word);
            }
            offset::IER => chip.interrupts = word,
            offset::FMR => chip.filters_are_set_up = word & 1 != 0,
            offset::FA1R => chip.filters = word,
            offset::FM1R | offset::FFA1R => assert!(chip.filters_are_set_up && chip.filters == 0 && word == 0),
            offset::FS1R => {
                assert!(chip.filters_are_set_up && chip.filters == 0 && word == (1 << word.count_ones()) - 1);
            }
            _ if (offset::BANK..offset::BANK + 8 * BANKS).contains(&place) => {
                assert_eq!(chip.filters, 0);
                let at = place - offset::BANK;
                chip.banks[at / 8][at % 8 / 4] = word;
            }
            offset::RF0R => {
                chip.lost &= word & can::LOST == 0;
                if word & can::RELEASE != 0 {
                    chip.received.pop_front();
                }
            }
            offset::TSR => {
                for (number, mailbox) in chip.mailboxes.iter_mut().enumerate() {
                    let own = word >> (8 * number);
                    if own & can::DONE != 0 {
                        (mailbox.done, mailbox.sent) = (false, false);
                    }
                    mailbox.abort |= own & can::ABORT != 0 && mailbox.pending;
                    if mailbox.abort && !mailbox.on_air {
                        *mailbox = Mailbox { done: true, ..Mailbox::default() };
                    }
                }
            }
            _ => {
                let at = place.checked_sub(offset::MAILBOX).filter(|at| *at < 48).expect("a register that is written");
                assert!(!chip.initialising, "a frame for a controller that is being set up");
                let mailbox = &mut chip.mailboxes[at / 16];
                assert!(!mailbox.pending, "a mailbox that waits is written");
                mailbox.words[at % 16 / 4] = word;
                if at.is_multiple_of(16) {
                    mailbox.pending = word & mailbox::REQUEST != 0;
                    (mailbox.done, mailbox.sent) = (false, false);
                }
            }
        }
    }
}

/// A chip after its reset.
pub fn chip() -> Mock {
    Mock(Rc::new(RefCell::new(State {
        initialising: false,
        asleep: true,
        stuck: false,
        timing: None,
        interrupts: 0,
        mailboxes: Default::default(),
        received: VecDeque::new(),
        lost: false,
        off: false,
        counts: false,
        filters_are_set_up: false,
        filters: 0,
        banks: Default::default(),
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
