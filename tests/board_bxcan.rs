//! The driver of the STM32F405's own CAN controller, of which the emulator has no model, against registers as the manual has them.

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
use board::port::Port;
use board::stm32f405::can::Controller;
use board::stm32f405::mailbox;
use chips::stm32::{CLOCK_HZ, chip, controller};
use chips::{Chip, forms, same, standard};
use embedded_can::{ExtendedId, Frame};

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
    let mut port = Controller::start(chip.clone(), 16_000_000, Patterns::everything());
    assert!(!chip.is_on());
    assert!(port.left_bus() && port.left_bus());
    assert_eq!(port.load(&standard(1, &[])), None);
    assert_eq!(chip.0.borrow().timing, None);
}

#[test]
fn a_bus_that_does_not_let_the_controller_be_set_up_is_told_and_tried_again() {
    let chip = chip();
    chip.0.borrow_mut().stuck = true;
    let mut port = Controller::start(chip.clone(), CLOCK_HZ, Patterns::everything());
    assert!(port.left_bus());
    chip.0.borrow_mut().stuck = false;
    assert!(!port.left_bus());
    assert!(chip.is_on());
    assert!(port.load(&standard(1, &[])).is_some());
}
