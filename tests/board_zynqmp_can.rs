//! The driver of the ZynqMP's CAN controller, which the emulator runs without faults, against registers that have them:
//! full and overrun queues, bus-off, and both layouts of a frame.

/// The board's own sources, with the places that they have there.
#[path = "../src/board"]
#[allow(dead_code)]
mod board {
    pub mod acceptance;
    pub mod bit_time;
    pub mod frame;
    pub mod outbox;
    pub mod port;
    pub mod registers;
    pub mod stm32f405 {
        pub mod can;
        pub mod mailbox;
    }
    pub mod stm32g474 {
        pub mod element;
        pub mod fdcan;
    }
    pub mod zynqmp_r5 {
        pub mod can;
        pub mod layout;
    }
}

mod chips;

use board::acceptance::Patterns;
use board::frame::CanFrame;
use board::outbox::{Outbox, Pass};
use board::port::{Fate, Overrun, Port};
use board::zynqmp_r5::can::Controller;
use board::zynqmp_r5::layout::Layout;
use chips::zynqmp::{DEPTH, Mock, controller};
use chips::{Chip, forms, same, standard};
use embedded_can::{ExtendedId, Frame, Id};
use holdover::health::{Cause, Incident};
use holdover::time::{Duration, Instant};
use holdover::wire::catalogue::Content;
use holdover::wire::sync::Sync;
use holdover::wire::{Identifier, Identifiers, Message, Sender, StationHash};
use holdover::{Config, OnboardUnit};

/// The time of the tick by this number.
fn tick(number: i64) -> Instant {
    Instant::ZERO.plus(Duration::from_millis(10 * number))
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
            mock.hear(&CanFrame::new(sent.id(), sent.data()).unwrap());
        })
        .unwrap();
    let heard = controller.receive().unwrap().unwrap();
    // The first frame of an identifier is not trusted; one of others is not even that.
    assert_eq!(unit.receive(Instant::ZERO, &heard), Err(Cause::NotYetTrusted));
    let mut outbox = Outbox::new();
    unit.tick(Instant::ZERO).frames.iter().for_each(|frame| outbox.push(tick(0), frame));
    while outbox.pass(tick(0), &mut controller) == Pass::Taken {}
    let sent = mock.send(DEPTH);
    assert_eq!(sent[0].id(), Id::from(id(0x0CFF_022A)));
    assert_eq!(outbox.lost(&mut controller)[0].1, 0);
}

#[test]
fn what_is_heard_is_received_in_order_until_nothing_is_left() {
    let (mut port, mock) = controller();
    let heard = forms();
    for part in heard.chunks(DEPTH) {
        part.iter().for_each(|frame| mock.hear(frame));
        part.iter().for_each(|frame| assert!(same(&port.receive().unwrap().unwrap(), frame)));
        assert!(matches!(port.receive(), Ok(None)));
    }
}

#[test]
fn a_core_that_sleeps_is_woken_until_it_has_received_everything() {
    let (mut port, mock) = controller();
    assert!(!mock.chip.borrow().wakes());
    for id in 0..DEPTH as u16 + 1 {
        mock.hear(&standard(id, &[]));
        assert!(mock.chip.borrow().wakes());
    }
    assert!(matches!(port.receive(), Err(Overrun)));
    for _ in 0..DEPTH {
        assert!(mock.chip.borrow().wakes());
        assert!(port.receive().unwrap().is_some());
    }
    assert!(matches!(port.receive(), Ok(None)));
    assert!(!mock.chip.borrow().wakes());
}

#[test]
fn an_overrun_is_told_once_and_what_was_there_before_is_received() {
    let (mut port, mock) = controller();
    for _ in 0..DEPTH + 3 {
        mock.hear(&standard(0x100, &[1]));
    }
    assert!(matches!(port.receive(), Err(Overrun)));
    for _ in 0..DEPTH {
        assert!(port.receive().unwrap().is_some());
    }
    assert!(matches!(port.receive(), Ok(None)));
}

#[test]
fn the_controller_has_one_frame_at_a_time_and_the_others_wait_and_are_not_lost() {
    let (mut port, mock) = controller();
    let mut outbox = Outbox::new();
    let frames: Vec<_> = (0..20).map(|id| standard(id, &[])).collect();
    frames.iter().rev().for_each(|frame| outbox.push(tick(0), frame));
    let mut sent = Vec::new();
    while outbox.pass(tick(0), &mut port) != Pass::Nothing {
        assert_eq!(outbox.pass(tick(0), &mut port), Pass::Full);
        let next = mock.send(DEPTH);
        assert_eq!(next.len(), 1);
        sent.extend(next);
    }
    assert_eq!(sent.len(), frames.len());
    assert!(sent.iter().zip(&frames).all(|(sent, frame)| same(sent, frame)), "the most urgent first");
    assert_eq!(outbox.lost(&mut port), [(Incident::TransmitOverflow, 0), (Incident::BusOff, 0)]);
}

#[test]
fn a_frame_that_is_taken_back_has_not_been_sent_and_one_that_has_been_is_not_taken_back() {
    let (mut port, mock) = controller();
    assert_eq!(port.load(&standard(1, &[])), Some(0));
    assert_eq!(port.load(&standard(2, &[])), None);
    assert_eq!(port.fate(0), Fate::Underway);
    port.recall(0);
    assert_eq!(port.fate(0), Fate::Back);
    assert!(mock.send(DEPTH).is_empty() && mock.is_on());
    assert_eq!(port.load(&standard(2, &[])), Some(0));
    assert_eq!(mock.send(DEPTH).len(), 1);
    let resets = mock.resets.get();
    mock.go_off();
    port.recall(0);
    assert_eq!(mock.resets.get(), resets, "after a bus-off it keeps away first");
    assert!(port.left_bus());
    assert_eq!(port.fate(0), Fate::Sent);
}

#[test]
fn what_finds_the_queue_full_is_counted() {
    let (mut port, _) = controller();
    let mut outbox = Outbox::new();
    (0..32 + 5).for_each(|id| outbox.push(tick(0), &standard(id, &[])));
    assert_eq!(outbox.lost(&mut port), [(Incident::TransmitOverflow, 5), (Incident::BusOff, 0)]);
    assert_eq!(outbox.lost(&mut port), [(Incident::TransmitOverflow, 0), (Incident::BusOff, 0)]);
}

#[test]
fn a_bus_off_is_told_once_and_nothing_that_waited_is_sent_after_it() {
    let (mut port, mock) = controller();
    let mut outbox = Outbox::new();
    (0..10).for_each(|id| outbox.push(tick(0), &standard(id, &[])));
    outbox.pass(tick(0), &mut port);
    mock.go_off();
    let lost = outbox.lost(&mut port);
    // One more comes back from the controller.
    assert_eq!(lost, [(Incident::TransmitOverflow, 9), (Incident::BusOff, 1)]);
    assert!(!mock.is_on());
    // What the shell does with it, and where it shows.
    let mut unit = OnboardUnit::<1, 4, 400>::new(&Config::car(StationHash(1))).unwrap();
    lost.into_iter().for_each(|(incident, times)| unit.note(incident, times));
    assert_eq!(unit.health().of(Cause::BusOff), 1);
    assert_eq!(unit.health().of(Cause::TransmitOverflow), 9);

    // It keeps away for two more periods, and takes nothing.
    outbox.push(tick(1), &standard(0x700, &[7]));
    for (period, back) in [(1, 1), (2, 0)] {
        assert!(!mock.is_on(), "{period}");
        assert_eq!(outbox.pass(tick(1), &mut port), Pass::Full);
        assert_eq!(outbox.lost(&mut port), [(Incident::TransmitOverflow, back), (Incident::BusOff, 0)]);
    }
    assert!(mock.is_on());
    assert_eq!(outbox.pass(tick(3), &mut port), Pass::Taken);
    let sent = mock.send(DEPTH);
    assert_eq!(sent.len(), 1);
    assert!(same(&sent[0], &standard(0x700, &[7])));

    mock.hear(&standard(0x100, &[1]));
    assert!(port.receive().unwrap().is_some());
    mock.go_off();
    assert!(port.left_bus(), "the next one is one of its own");
}

#[test]
fn a_reset_that_does_not_end_is_counted_each_time_and_tried_again() {
    let mock = Mock::default();
    mock.stuck.set(3);
    let mut port = Controller::start(mock.clone(), Layout::Silicon, Patterns::everything());
    let mut outbox = Outbox::new();
    let mut unit = OnboardUnit::<1, 4, 400>::new(&Config::car(StationHash(1))).unwrap();
    let mut sent = 0;
    for number in 0..20 {
        outbox.push(tick(number), &standard(0x700, &[7]));
        outbox.pass(tick(number), &mut port);
        sent += mock.send(DEPTH).len() as u32;
        outbox.lost(&mut port).into_iter().for_each(|(incident, times)| unit.note(incident, times));
    }
    assert!(mock.is_on());
    assert_eq!(unit.health().of(Cause::BusOff), 3);
    // What waited meanwhile is lost, and counted too; what came after it is sent.
    let lost = unit.health().of(Cause::TransmitOverflow);
    assert!((3..10).contains(&lost) && sent > 10 && lost + sent == 20, "{lost} {sent}");
}

#[test]
fn after_a_bus_off_a_reset_that_does_not_end_is_counted_beside_it() {
    let (mut port, mock) = controller();
    mock.go_off();
    mock.stuck.set(1);
    let left: Vec<bool> = (0..8).map(|_| port.left_bus()).collect();
    assert_eq!(left, [true, false, true, false, false, false, false, false]);
    assert!(mock.is_on());
}
