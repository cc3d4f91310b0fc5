//! The driver of the ZynqMP's CAN controller, which the emulator runs without faults, against registers that have them:
//! full and overrun queues, bus-off, and both layouts of a frame.

/// The board's own sources, with the places that they have there.
#[path = "../src/board"]
mod board {
    pub mod frame;
    pub mod outbox;
    pub mod port;
    pub mod zynqmp_r5 {
        pub mod can;
        pub mod layout;
    }
}

use board::frame::CanFrame;
use board::outbox::{Outbox, Pass};
use board::port::Port;
use board::zynqmp_r5::can::{self, Controller, Overrun, Registers, offset};
use board::zynqmp_r5::layout::{Layout, Words};
use embedded_can::nb::Can;
use embedded_can::{ExtendedId, Frame, Id, StandardId};
use holdover::health::{Cause, Incident};
use holdover::time::Instant;
use holdover::wire::catalogue::Content;
use holdover::wire::sync::Sync;
use holdover::wire::{Identifier, Identifiers, Message, Sender, StationHash};
use holdover::{Config, OnboardUnit};
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::rc::Rc;

const DEPTH: usize = 64;

/// The controller as the reference manual has it, as far as the driver can tell.
#[derive(Default)]
struct Chip {
    /// In a reset that does not end.
    stuck: bool,
    /// On the bus, or ready for it; with none of it the driver may set it up.
    enabled: bool,
    timing: Option<(u32, u32)>,
    events: u32,
    /// Which of them interrupt.
    interrupts: u32,
    received: VecDeque<Words>,
    /// The words of the frame that is being queued, and the queue.
    writing: Vec<u32>,
    queued: VecDeque<Words>,
}

impl Chip {
    /// A frame comes over the bus.
    fn hear(&mut self, frame: &CanFrame) {
        if self.received.len() == DEPTH {
            self.events |= can::OVERRUN;
        } else {
            self.received.push_back(Layout::Silicon.words(frame));
            self.events |= can::RECEIVED | can::NOT_EMPTY;
        }
    }

    /// The transmitter sends what is queued. It keeps what loses arbitration, and so does this, up to `most` frames.
    fn send(&mut self, most: usize) -> Vec<CanFrame> {
        let most = most.min(self.queued.len());
        self.queued.drain(..most).map(|words| Layout::Silicon.frame(words).unwrap()).collect()
    }

    /// Whether a core that sleeps is woken, or does not fall asleep.
    fn wakes(&self) -> bool {
        self.events & self.interrupts != 0
    }

    /// Too many errors.
    fn go_off(&mut self) {
        self.events |= can::BUS_OFF;
    }
}

#[derive(Clone, Default)]
struct Mock {
    chip: Rc<RefCell<Chip>>,
    /// How many resets will not end.
    stuck: Rc<Cell<u32>>,
}

impl Registers for Mock {
    fn read(&self, place: usize) -> u32 {
        let mut chip = self.chip.borrow_mut();
        match place {
            offset::STATUS if chip.queued.len() == DEPTH => can::TRANSMIT_FULL,
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
                *chip = Chip { stuck: stuck > 0, ..Chip::default() };
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
            offset::MODE | offset::FILTERS => assert_eq!(word, 0),
            _ => {
                let at = offset::TRANSMIT
                    .iter()
                    .position(|transmit| *transmit == place)
                    .expect("a register that is written");
                assert!(chip.enabled, "a frame for a controller that is off");
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
fn controller() -> (Controller<Mock>, Mock) {
    let mock = Mock::default();
    (Controller::start(mock.clone(), Layout::Silicon), mock)
}

fn standard(id: u16, data: &[u8]) -> CanFrame {
    CanFrame::new(StandardId::new(id).unwrap(), data).unwrap()
}

fn same(a: &CanFrame, b: &CanFrame) -> bool {
    a.id() == b.id() && a.is_remote_frame() == b.is_remote_frame() && a.dlc() == b.dlc() && a.data() == b.data()
}

/// Every form that a frame can have.
fn forms() -> Vec<CanFrame> {
    let ids: [Id; 6] = [
        StandardId::ZERO.into(),
        StandardId::new(0x482).unwrap().into(),
        StandardId::MAX.into(),
        ExtendedId::ZERO.into(),
        ExtendedId::new(0x1234_5678).unwrap().into(),
        ExtendedId::MAX.into(),
    ];
    let data = [1, 2, 3, 4, 5, 6, 7, 0x80];
    let frames =
        |id| (0..=8).flat_map(move |length| [CanFrame::new(id, &data[..length]), CanFrame::new_remote(id, length)]);
    ids.into_iter().flat_map(frames).map(Option::unwrap).collect()
}

#[test]
fn a_frame_is_the_same_after_its_words_in_both_layouts() {
    for frame in forms() {
        for layout in [Layout::Silicon, Layout::Model] {
            assert!(same(&layout.frame(layout.words(&frame)).unwrap(), &frame));
        }
    }
}

#[test]
fn the_words_are_those_of_the_manual_and_of_the_emulator() {
    let data = [0x11, 0x22, 0x33, 0x44, 0x55];
    let short = standard(0x123, &data);
    let long = CanFrame::new(ExtendedId::new(0x1234_5678).unwrap(), &data).unwrap();
    let remote = CanFrame::new_remote(ExtendedId::new(0x1234_5678).unwrap(), 5).unwrap();
    // 0x12345678 is 0x48d and 0x05678 behind it: 11 and 18 bits.
    let (extended, last) = (0x48d << 21 | 1 << 20 | 1 << 19 | 0x5678 << 1, 0x5500_0000);
    assert_eq!(Layout::Silicon.words(&short), [0x123 << 21, 5 << 28, 0x1122_3344, last]);
    assert_eq!(Layout::Silicon.words(&long), [extended, 5 << 28, 0x1122_3344, last]);
    assert_eq!(Layout::Silicon.words(&remote), [extended | 1, 5 << 28, 0, 0]);
    assert_eq!(Layout::Model.words(&short), [0x123, 5 << 28, 0x4433_2211, 0x55]);
    assert_eq!(Layout::Model.words(&remote), [0xd234_5678, 5 << 28, 0, 0]);
}

#[test]
fn a_length_above_8_says_8_and_a_time_stamp_says_nothing() {
    let frame = Layout::Silicon.frame([0x123 << 21, 0xf << 28 | 0xabcd, 0, 0]).unwrap();
    assert_eq!(frame.dlc(), 8);
}

#[test]
fn the_controller_is_set_up_for_500_kbit_per_second_before_it_is_on_the_bus() {
    let (_, mock) = controller();
    let chip = mock.chip.borrow();
    let (quantum, bit) = chip.timing.unwrap();
    let quanta = 1 + (bit & 15) + 1 + (bit >> 4 & 7) + 1;
    assert!(chip.enabled);
    assert_eq!(100_000_000 / ((quantum + 1) * quanta), 500_000);
}

#[test]
fn a_unit_on_extended_identifiers_hears_and_is_heard_through_the_controller() {
    let id = |number| Identifier::extended(number).unwrap();
    let identifiers = Identifiers::DEFAULT
        .place(Content::Sync, id(0x18FF_004A))
        .and_then(|placed| placed.place(Content::Command, id(0x0CFF_022A)))
        .unwrap();
    let config = Config { identifiers, ..Config::car(StationHash(1)) };
    let mut unit = OnboardUnit::<1, 2, 400>::new(&config).unwrap();
    let (mut controller, mock) = controller();
    Sender::<0>::new(identifiers)
        .send(&Message::Sync(Sync { sequence: 0, seconds: 1 }), &mut |sent| {
            mock.chip.borrow_mut().hear(&CanFrame::new(sent.id(), sent.data()).unwrap());
        })
        .unwrap();
    let heard = controller.receive().unwrap();
    // The first frame of an identifier is not trusted; one of others is not even that.
    assert_eq!(unit.receive(Instant::ZERO, &heard), Err(Cause::NotYetTrusted));
    let mut outbox = Outbox::new();
    unit.tick(Instant::ZERO).frames.iter().for_each(|frame| outbox.push(frame));
    while outbox.pass(&mut controller) == Pass::Taken {}
    let sent = mock.chip.borrow_mut().send(DEPTH);
    assert_eq!(sent[0].id(), Id::from(id(0x0CFF_022A)));
    assert_eq!(outbox.lost(false)[0].1, 0);
}

#[test]
fn what_is_heard_is_received_in_order_until_nothing_is_left() {
    let (mut port, mock) = controller();
    let heard = forms();
    for part in heard.chunks(DEPTH) {
        part.iter().for_each(|frame| mock.chip.borrow_mut().hear(frame));
        part.iter().for_each(|frame| assert!(same(&port.receive().unwrap(), frame)));
        assert!(matches!(port.receive(), Err(nb::Error::WouldBlock)));
    }
}

#[test]
fn a_core_that_sleeps_is_woken_until_it_has_received_everything() {
    let (mut port, mock) = controller();
    assert!(!mock.chip.borrow().wakes());
    for id in 0..DEPTH as u16 + 1 {
        mock.chip.borrow_mut().hear(&standard(id, &[]));
        assert!(mock.chip.borrow().wakes());
    }
    assert!(matches!(port.receive(), Err(nb::Error::Other(Overrun))));
    for _ in 0..DEPTH {
        assert!(mock.chip.borrow().wakes());
        assert!(port.receive().is_ok());
    }
    assert!(matches!(port.receive(), Err(nb::Error::WouldBlock)));
    assert!(!mock.chip.borrow().wakes());
}

#[test]
fn an_overrun_is_told_once_and_what_was_there_before_is_received() {
    let (mut port, mock) = controller();
    for _ in 0..DEPTH + 3 {
        mock.chip.borrow_mut().hear(&standard(0x100, &[1]));
    }
    assert!(matches!(port.receive(), Err(nb::Error::Other(Overrun))));
    for _ in 0..DEPTH {
        assert!(port.receive().is_ok());
    }
    assert!(matches!(port.receive(), Err(nb::Error::WouldBlock)));
}

#[test]
fn a_full_queue_takes_no_frame_and_loses_none() {
    let (mut port, mock) = controller();
    let mut outbox = Outbox::new();
    let frames: Vec<_> = (0..DEPTH as u16 + 20).map(|id| standard(id, &[])).collect();
    for part in frames.chunks(20) {
        part.iter().for_each(|frame| outbox.push(frame));
        while outbox.pass(&mut port) == Pass::Taken {}
    }
    assert_eq!(outbox.pass(&mut port), Pass::Full);
    // Arbitration is lost but for a few frames; the rest follows when the bus is free.
    let mut sent = mock.chip.borrow_mut().send(3);
    while outbox.pass(&mut port) == Pass::Taken {}
    sent.extend(mock.chip.borrow_mut().send(DEPTH));
    while outbox.pass(&mut port) == Pass::Taken {}
    sent.extend(mock.chip.borrow_mut().send(DEPTH));
    assert_eq!(sent.len(), frames.len());
    assert!(sent.iter().zip(&frames).all(|(sent, frame)| same(sent, frame)));
    assert_eq!(outbox.pass(&mut port), Pass::Nothing);
    assert_eq!(outbox.lost(port.left_bus()), [(Incident::TransmitOverflow, 0), (Incident::BusOff, 0)]);
}

#[test]
fn what_finds_both_queues_full_is_counted() {
    let (mut port, _) = controller();
    let mut outbox = Outbox::new();
    for id in 0..DEPTH as u16 + 32 + 5 {
        outbox.push(&standard(id, &[]));
        outbox.pass(&mut port);
    }
    assert_eq!(outbox.lost(port.left_bus()), [(Incident::TransmitOverflow, 5), (Incident::BusOff, 0)]);
    assert_eq!(outbox.lost(port.left_bus()), [(Incident::TransmitOverflow, 0), (Incident::BusOff, 0)]);
}

#[test]
fn a_bus_off_is_told_once_and_nothing_that_waited_is_sent_after_it() {
    let (mut port, mock) = controller();
    let mut outbox = Outbox::new();
    for id in 0..10 {
        outbox.push(&standard(id, &[]));
    }
    for _ in 0..4 {
        outbox.pass(&mut port);
    }
    mock.chip.borrow_mut().go_off();
    let lost = outbox.lost(port.left_bus());
    assert_eq!(lost, [(Incident::TransmitOverflow, 6), (Incident::BusOff, 1)]);
    assert!(!mock.chip.borrow().enabled);
    // What the shell does with it, and where it shows.
    let mut unit = OnboardUnit::<1, 4, 400>::new(&Config::car(StationHash(1))).unwrap();
    lost.into_iter().for_each(|(incident, times)| unit.note(incident, times));
    assert_eq!(unit.health().of(Cause::BusOff), 1);
    assert_eq!(unit.health().of(Cause::TransmitOverflow), 6);

    // It keeps away for two more periods, and takes nothing.
    outbox.push(&standard(0x700, &[7]));
    for period in 1..=2 {
        assert!(!mock.chip.borrow().enabled, "{period}");
        assert_eq!(outbox.pass(&mut port), Pass::Full);
        assert_eq!(outbox.lost(port.left_bus()), [(Incident::TransmitOverflow, 0), (Incident::BusOff, 0)]);
    }
    assert!(mock.chip.borrow().enabled);
    assert_eq!(outbox.pass(&mut port), Pass::Taken);
    let sent = mock.chip.borrow_mut().send(DEPTH);
    assert_eq!(sent.len(), 1);
    assert!(same(&sent[0], &standard(0x700, &[7])));

    mock.chip.borrow_mut().hear(&standard(0x100, &[1]));
    assert!(port.receive().is_ok());
    mock.chip.borrow_mut().go_off();
    assert!(port.left_bus(), "the next one is one of its own");
}

#[test]
fn a_reset_that_does_not_end_is_counted_each_time_and_tried_again() {
    let mock = Mock::default();
    mock.stuck.set(3);
    let mut port = Controller::start(mock.clone(), Layout::Silicon);
    let mut outbox = Outbox::new();
    let mut unit = OnboardUnit::<1, 4, 400>::new(&Config::car(StationHash(1))).unwrap();
    for _ in 0..20 {
        outbox.push(&standard(0x700, &[7]));
        outbox.pass(&mut port);
        outbox.lost(port.left_bus()).into_iter().for_each(|(incident, times)| unit.note(incident, times));
    }
    assert!(mock.chip.borrow().enabled);
    assert_eq!(unit.health().of(Cause::BusOff), 3);
    // What waited meanwhile is lost, and counted too; what came after it is sent.
    let lost = unit.health().of(Cause::TransmitOverflow);
    let sent = mock.chip.borrow_mut().send(DEPTH).len();
    assert!((3..10).contains(&lost) && sent > 10, "{lost} {sent}");
    assert!(lost as usize + sent <= 20, "{lost} {sent}");
}

#[test]
fn after_a_bus_off_a_reset_that_does_not_end_is_counted_beside_it() {
    let (mut port, mock) = controller();
    mock.chip.borrow_mut().go_off();
    mock.stuck.set(1);
    let left: Vec<bool> = (0..8).map(|_| port.left_bus()).collect();
    assert_eq!(left, [true, false, true, false, false, false, false, false]);
    assert!(mock.chip.borrow().enabled);
}
