//! The driver of the STM32F405's own CAN controller, of which the emulator has no model, against registers as the manual has them.

/// The board's own sources, with the places that they have there.
#[path = "../src/board"]
#[allow(dead_code)]
mod board {
    pub mod frame;
    pub mod outbox;
    pub mod port;
    pub mod registers;
    pub mod stm32f405 {
        pub mod can;
        pub mod mailbox;
    }
    pub mod zynqmp_r5 {
        pub mod can;
        pub mod layout;
    }
}

mod chips;

use board::frame::CanFrame;
use board::outbox::{Outbox, Pass};
use board::port::{Fate, Overrun, Port};
use board::stm32f405::can::Controller;
use board::stm32f405::mailbox;
use chips::stm32::{CLOCK_HZ, chip, controller};
use chips::{Chip, forms, same, standard};
use embedded_can::{ExtendedId, Frame};
use holdover::health::Incident;
use holdover::time::{Duration, Instant};

/// The time of the tick by this number.
fn tick(number: i64) -> Instant {
    Instant::ZERO.plus(Duration::from_millis(10 * number))
}

/// Gives the controller what it takes.
fn fill(outbox: &mut Outbox, at: Instant, port: &mut impl Port) -> Pass {
    loop {
        let pass = outbox.pass(at, port);
        if pass != Pass::Taken {
            return pass;
        }
    }
}

#[test]
fn a_frame_is_the_same_after_its_words() {
    for frame in forms() {
        assert!(same(&mailbox::frame(mailbox::words(&frame)).unwrap(), &frame));
    }
}

#[test]
fn the_words_are_those_of_the_manual() {
    let data = [0x11, 0x22, 0x33, 0x44, 0x55];
    let long = CanFrame::new(ExtendedId::new(0x1234_5678).unwrap(), &data).unwrap();
    let remote = CanFrame::new_remote(ExtendedId::new(0x1234_5678).unwrap(), 5).unwrap();
    assert_eq!(mailbox::words(&standard(0x123, &data)), [0x123 << 21, 5, 0x4433_2211, 0x55]);
    assert_eq!(mailbox::words(&long), [0x1234_5678 << 3 | 1 << 2, 5, 0x4433_2211, 0x55]);
    assert_eq!(mailbox::words(&remote), [0x1234_5678 << 3 | 1 << 2 | 1 << 1, 5, 0, 0]);
    // A received word has more in it than the length, and a length above 8 says 8.
    assert_eq!(mailbox::frame([0x123 << 21, 0xabcd_0b0f, 0, 0]).unwrap().dlc(), 8);
}

#[test]
fn the_controller_is_set_up_for_500_kbit_per_second_and_bears_clocks_that_are_off_by_half_a_percent() {
    let (_, chip) = controller();
    let timing = chip.0.borrow().timing.unwrap();
    let part = |shift: u32, bits: u32| (timing >> shift & ((1 << bits) - 1)) + 1;
    let (prescaler, before, behind, jump) = (part(0, 10), part(16, 4), part(20, 3), part(24, 2));
    let quanta = 1 + before + behind;
    assert_eq!(prescaler * quanta * 500_000, CLOCK_HZ);
    assert!(jump <= behind);
    let (jump, behind, quanta) = (f64::from(jump), f64::from(behind), f64::from(quanta));
    assert!(jump / (20.0 * quanta) >= 0.005 && behind / (2.0 * (13.0 * quanta - behind)) >= 0.005);
    assert!(chip.is_on());
}

#[test]
fn a_clock_that_does_not_give_the_bit_rate_keeps_the_controller_off_the_bus_and_is_told_every_period() {
    let chip = chip();
    let mut port = Controller::start(chip.clone(), 16_000_000);
    assert!(!chip.is_on());
    assert!(port.left_bus() && port.left_bus());
    assert_eq!(port.load(&standard(1, &[])), None);
    assert_eq!(chip.0.borrow().timing, None);
}

#[test]
fn a_bus_that_does_not_let_the_controller_be_set_up_is_told_and_tried_again() {
    let chip = chip();
    chip.0.borrow_mut().stuck = true;
    let mut port = Controller::start(chip.clone(), CLOCK_HZ);
    assert!(port.left_bus());
    chip.0.borrow_mut().stuck = false;
    assert!(!port.left_bus());
    assert!(chip.is_on());
    assert!(port.load(&standard(1, &[])).is_some());
}

#[test]
fn what_is_heard_is_received_in_order_and_what_finds_no_room_is_told() {
    let (mut port, chip) = controller();
    for part in forms().chunks(3) {
        part.iter().for_each(|frame| chip.hear(frame));
        assert!(chip.0.borrow().interrupts());
        part.iter().for_each(|frame| assert!(same(&port.receive().unwrap().unwrap(), frame)));
        assert!(matches!(port.receive(), Ok(None)));
        assert!(!chip.0.borrow().interrupts());
    }
    (0..4).for_each(|id| chip.hear(&standard(id, &[])));
    assert!(matches!(port.receive(), Err(Overrun)));
    (0..3).for_each(|_| assert!(port.receive().unwrap().is_some()));
    assert!(matches!(port.receive(), Ok(None)));
}

#[test]
fn every_sent_frame_interrupts_and_the_next_one_follows_while_a_tick_runs() {
    let (mut port, chip) = controller();
    let mut outbox = Outbox::new();
    (0..20).for_each(|id| outbox.push(tick(0), &standard(0x7ff - id, &[])));
    assert_eq!(fill(&mut outbox, tick(0), &mut port), Pass::Full);
    assert_eq!(chip.0.borrow().pending(), 3);
    let mut sent = Vec::new();
    loop {
        sent.extend(chip.send(1));
        assert!(chip.0.borrow().interrupts());
        // What the handler of the interrupt does.
        let left = fill(&mut outbox, tick(0), &mut port);
        assert!(!chip.0.borrow().interrupts());
        if left == Pass::Nothing {
            break;
        }
    }
    let ids: Vec<_> = sent.iter().map(|frame| mailbox::words(frame)[0] >> 21).collect();
    assert_eq!(ids, (0x7ec..=0x7ff).collect::<Vec<_>>());
    assert_eq!(outbox.lost(&mut port)[0].1, 0);
}

#[test]
fn frames_of_one_identifier_are_never_in_two_mailboxes_so_they_keep_their_order() {
    let (mut port, chip) = controller();
    let mut outbox = Outbox::new();
    outbox.push(tick(0), &standard(0x100, &[]));
    (0..5).for_each(|part| outbox.push(tick(0), &standard(0x492, &[part])));
    let mut parts = Vec::new();
    while fill(&mut outbox, tick(0), &mut port) != Pass::Nothing {
        assert!(chip.0.borrow().pending() <= 2);
        parts.extend(chip.send(1).iter().filter_map(|frame| frame.data().first().copied()));
    }
    assert_eq!(parts, [0, 1, 2, 3, 4]);
}

#[test]
fn a_command_takes_the_place_of_status_in_full_mailboxes_and_no_frame_is_lost_or_sent_twice() {
    let (mut port, chip) = controller();
    let mut outbox = Outbox::new();
    (0..3).for_each(|id| outbox.push(tick(0), &standard(0x500 + id, &[])));
    fill(&mut outbox, tick(0), &mut port);
    outbox.push(tick(0), &standard(0x482, &[1]));
    fill(&mut outbox, tick(0), &mut port);
    // The mailbox that is given back interrupts, and its handler fills it.
    fill(&mut outbox, tick(0), &mut port);
    let mut ids = Vec::new();
    for _ in 0..4 {
        ids.extend(chip.send(1).iter().map(|frame| mailbox::words(frame)[0] >> 21));
        fill(&mut outbox, tick(0), &mut port);
    }
    assert_eq!(ids, [0x482, 0x500, 0x501, 0x502]);
    assert_eq!(outbox.lost(&mut port)[0].1, 0);
}

#[test]
fn a_newer_frame_waits_for_the_older_one_that_is_on_the_bus_and_takes_its_place_when_that_fails() {
    for is_acknowledged in [true, false] {
        let (mut port, chip) = controller();
        let mut outbox = Outbox::new();
        outbox.push(tick(0), &standard(0x482, &[0]));
        fill(&mut outbox, tick(0), &mut port);
        chip.begin();
        outbox.push(tick(1), &standard(0x482, &[1]));
        assert_eq!(fill(&mut outbox, tick(1), &mut port), Pass::Full);
        let first = if is_acknowledged { chip.send(1) } else { vec![] };
        chip.fail();
        fill(&mut outbox, tick(1), &mut port);
        let sent: Vec<u8> = first.into_iter().chain(chip.send(9)).map(|frame| frame.data()[0]).collect();
        assert_eq!(sent, if is_acknowledged { vec![0, 1] } else { vec![1] });
        fill(&mut outbox, tick(1), &mut port);
        assert_eq!(outbox.lost(&mut port)[0].1, u32::from(!is_acknowledged));
    }
}

#[test]
fn after_a_bus_off_the_mailboxes_are_empty_before_the_controller_asks_for_its_way_back() {
    let (mut port, chip) = controller();
    let mut outbox = Outbox::new();
    (0..10).for_each(|id| outbox.push(tick(0), &standard(id, &[])));
    fill(&mut outbox, tick(0), &mut port);
    chip.go_off();
    assert_eq!(outbox.lost(&mut port), [(Incident::TransmitOverflow, 7), (Incident::BusOff, 1)]);
    assert_eq!(chip.0.borrow().pending(), 0);
    chip.wait();
    assert!(!chip.is_on(), "it does not come back by itself");
    fill(&mut outbox, tick(1), &mut port);
    assert_eq!(outbox.lost(&mut port), [(Incident::TransmitOverflow, 3), (Incident::BusOff, 0)]);
    outbox.push(tick(2), &standard(0x700, &[7]));
    assert_eq!(fill(&mut outbox, tick(2), &mut port), Pass::Full);
    chip.wait();
    assert_eq!(outbox.lost(&mut port), [(Incident::TransmitOverflow, 0), (Incident::BusOff, 0)]);
    assert!(chip.is_on());
    fill(&mut outbox, tick(3), &mut port);
    assert!(same(&chip.send(9)[0], &standard(0x700, &[7])));
    chip.go_off();
    assert!(port.left_bus(), "the next one is one of its own");
}

#[test]
fn a_frame_that_was_sent_before_it_was_taken_back_is_told_as_sent() {
    let (mut port, chip) = controller();
    let place = port.load(&standard(1, &[])).unwrap();
    assert_eq!(port.fate(place), Fate::Underway);
    chip.send(1);
    port.recall(place);
    assert_eq!(port.fate(place), Fate::Sent);
    let place = port.load(&standard(1, &[])).unwrap();
    port.recall(place);
    assert_eq!(port.fate(place), Fate::Back);
    assert!(chip.send(1).is_empty());
}
