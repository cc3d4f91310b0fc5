//! The driver of the STM32G474's CAN controller, which no emulator has, against registers and message RAM as the manual has them.

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
use board::port::{Fate, Port};
use board::stm32g474::element;
use board::stm32g474::fdcan::Controller;
use chips::stm32g474::{CLOCK_HZ, chip, controller};
use chips::{Chip, Mailboxes, forms, same, standard};
use embedded_can::{ExtendedId, Frame};

#[test]
fn a_frame_is_the_same_after_its_words() {
    for frame in forms() {
        assert!(same(&element::frame(element::words(&frame)).unwrap(), &frame));
    }
}

#[test]
fn the_words_are_those_of_the_manual() {
    let data = [0x11, 0x22, 0x33, 0x44, 0x55];
    let long = CanFrame::new(ExtendedId::new(0x1234_5678).unwrap(), &data).unwrap();
    let remote = CanFrame::new_remote(ExtendedId::new(0x1234_5678).unwrap(), 5).unwrap();
    assert_eq!(element::words(&standard(0x123, &data)), [0x123 << 18, 5 << 16, 0x4433_2211, 0x55]);
    assert_eq!(element::words(&long), [0x1234_5678 | 1 << 30, 5 << 16, 0x4433_2211, 0x55]);
    assert_eq!(element::words(&remote), [0x1234_5678 | 1 << 30 | 1 << 29, 5 << 16, 0, 0]);
    // A received word has more in it than the length, and a length above 8 says 8.
    assert_eq!(element::frame([0x123 << 18 | 1 << 31, 0xab0b_1234, 0, 0]).unwrap().dlc(), 8);
}

#[test]
fn the_controller_is_set_up_for_500_kbit_per_second_and_bears_clocks_that_are_off_by_half_a_percent() {
    for clock_hz in [8_000_000, CLOCK_HZ, 48_000_000] {
        let chip = chip();
        Controller::start(chip.clone(), clock_hz, Patterns::everything());
        let timing = chip.0.borrow().timing.unwrap();
        let part = |shift: u32, bits: u32| (timing >> shift & ((1 << bits) - 1)) + 1;
        let (prescaler, before, behind, jump) = (part(16, 9), part(8, 8), part(0, 7), part(25, 7));
        let quanta = 1 + before + behind;
        assert_eq!(prescaler * quanta * 500_000, clock_hz);
        assert!(jump <= behind);
        let (jump, behind, quanta) = (f64::from(jump), f64::from(behind), f64::from(quanta));
        assert!(jump / (20.0 * quanta) >= 0.005 && behind / (2.0 * (13.0 * quanta - behind)) >= 0.005);
        assert!(chip.is_on());
    }
}

#[test]
fn a_clock_that_does_not_give_the_bit_rate_keeps_the_controller_off_the_bus_and_is_told_every_period() {
    for clock_hz in [0, 12_000_000, 170_000_000] {
        let chip = chip();
        let mut port = Controller::start(chip.clone(), clock_hz, Patterns::everything());
        assert!(!chip.is_on());
        assert!(port.left_bus() && port.left_bus());
        assert_eq!(port.load(&standard(1, &[])), None);
        assert_eq!(chip.0.borrow().timing, None);
    }
}

#[test]
fn a_controller_that_cannot_be_set_up_is_told_and_tried_again() {
    let chip = chip();
    chip.0.borrow_mut().stuck = true;
    let mut port = Controller::start(chip.clone(), CLOCK_HZ, Patterns::everything());
    assert!(port.left_bus());
    chip.0.borrow_mut().stuck = false;
    assert!(!port.left_bus());
    assert!(chip.is_on());
    assert!(port.load(&standard(1, &[])).is_some());
}

#[test]
fn a_buffer_whose_fate_has_not_been_told_is_not_filled() {
    let (mut port, chip) = controller();
    let place = port.load(&standard(1, &[])).unwrap();
    chip.send(1);
    assert_eq!(port.load(&standard(2, &[])), None);
    assert_eq!(port.fate(place), Fate::Sent);
    assert_eq!(port.load(&standard(2, &[])), Some(place));
}

#[test]
fn what_ends_between_two_fates_is_told_and_interrupts_no_more() {
    let (mut port, chip) = controller();
    let places = [1, 2, 3].map(|id| port.load(&standard(id, &[])).unwrap());
    assert_eq!(port.fate(places[2]), Fate::Underway);
    chip.send(2);
    assert!(chip.interrupts());
    assert_eq!(port.fate(places[2]), Fate::Underway);
    assert!(!chip.interrupts());
    assert_eq!([places[0], places[1]].map(|place| port.fate(place)), [Fate::Sent; 2]);
}

#[test]
fn a_frame_that_was_sent_just_before_a_bus_off_is_told_as_sent() {
    let (mut port, chip) = controller();
    let places = [1, 2].map(|id| port.load(&standard(id, &[])).unwrap());
    chip.send(1);
    chip.go_off();
    assert!(port.left_bus());
    assert_eq!(places.map(|place| port.fate(place)), [Fate::Sent, Fate::Back]);
}
