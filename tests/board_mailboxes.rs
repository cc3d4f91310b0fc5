//! What every controller with three mailboxes has to do for the board, of which the emulator has none: that of the STM32F405 and that
//! of the STM32G474, against their registers as the manuals have them.

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

use board::outbox::{Outbox, Pass};
use board::port::{Fate, Overrun, Port};
use chips::{Chip, Mailboxes, forms, same, standard};
use embedded_can::{Frame, Id};
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

fn number(frame: &impl Frame) -> u32 {
    match frame.id() {
        Id::Standard(id) => id.as_raw().into(),
        Id::Extended(id) => id.as_raw(),
    }
}

/// A test of each of the controllers.
macro_rules! of_each {
    ($(fn $name:ident($port:ident, $chip:ident) $body:block)*) => {
        $(
            #[test]
            fn $name() {
                {
                    let (mut $port, $chip) = chips::stm32::controller();
                    $body
                }
                {
                    let (mut $port, $chip) = chips::stm32g474::controller();
                    $body
                }
            }
        )*
    };
}

of_each! {
    fn what_is_heard_is_received_in_order_and_what_finds_no_room_is_told(port, chip) {
        for part in forms().chunks(3) {
            part.iter().for_each(|frame| chip.hear(frame));
            assert!(chip.interrupts());
            part.iter().for_each(|frame| assert!(same(&port.receive().unwrap().unwrap(), frame)));
            assert!(matches!(port.receive(), Ok(None)));
            assert!(!chip.interrupts());
        }
        (0..4).for_each(|id| chip.hear(&standard(id, &[])));
        assert!(matches!(port.receive(), Err(Overrun)));
        (0..3).for_each(|_| assert!(port.receive().unwrap().is_some()));
        assert!(matches!(port.receive(), Ok(None)));
    }

    fn every_sent_frame_interrupts_and_the_next_one_follows_while_a_tick_runs(port, chip) {
        let mut outbox = Outbox::new();
        (0..20).for_each(|id| outbox.push(tick(0), &standard(0x7ff - id, &[])));
        assert_eq!(fill(&mut outbox, tick(0), &mut port), Pass::Full);
        assert_eq!(chip.pending(), 3);
        let mut sent = Vec::new();
        loop {
            sent.extend(chip.send(1));
            assert!(chip.interrupts());
            // What the handler of the interrupt does.
            let left = fill(&mut outbox, tick(0), &mut port);
            assert!(!chip.interrupts());
            if left == Pass::Nothing {
                break;
            }
        }
        let ids: Vec<_> = sent.iter().map(number).collect();
        assert_eq!(ids, (0x7ec..=0x7ff).collect::<Vec<_>>());
        assert_eq!(outbox.lost(&mut port)[0].1, 0);
    }

    fn frames_of_one_identifier_are_never_in_two_mailboxes_so_they_keep_their_order(port, chip) {
        let mut outbox = Outbox::new();
        outbox.push(tick(0), &standard(0x100, &[]));
        (0..5).for_each(|part| outbox.push(tick(0), &standard(0x492, &[part])));
        let mut parts = Vec::new();
        while fill(&mut outbox, tick(0), &mut port) != Pass::Nothing {
            assert!(chip.pending() <= 2);
            parts.extend(chip.send(1).iter().filter_map(|frame| frame.data().first().copied()));
        }
        assert_eq!(parts, [0, 1, 2, 3, 4]);
    }

    fn a_command_takes_the_place_of_status_in_full_mailboxes_and_no_frame_is_lost_or_sent_twice(port, chip) {
        let mut outbox = Outbox::new();
        (0..3).for_each(|id| outbox.push(tick(0), &standard(0x500 + id, &[])));
        fill(&mut outbox, tick(0), &mut port);
        outbox.push(tick(0), &standard(0x482, &[1]));
        fill(&mut outbox, tick(0), &mut port);
        // The mailbox that is given back interrupts, and its handler fills it.
        fill(&mut outbox, tick(0), &mut port);
        let mut ids = Vec::new();
        for _ in 0..4 {
            ids.extend(chip.send(1).iter().map(number));
            fill(&mut outbox, tick(0), &mut port);
        }
        assert_eq!(ids, [0x482, 0x500, 0x501, 0x502]);
        assert_eq!(outbox.lost(&mut port)[0].1, 0);
    }

    fn a_newer_frame_waits_for_the_older_one_that_is_on_the_bus_and_takes_its_place_when_that_fails(port, chip) {
        for is_acknowledged in [true, false] {
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

    fn after_a_bus_off_the_mailboxes_are_empty_before_the_controller_asks_for_its_way_back(port, chip) {
        let mut outbox = Outbox::new();
        (0..10).for_each(|id| outbox.push(tick(0), &standard(id, &[])));
        fill(&mut outbox, tick(0), &mut port);
        chip.go_off();
        assert_eq!(outbox.lost(&mut port), [(Incident::TransmitOverflow, 7), (Incident::BusOff, 1)]);
        assert_eq!(chip.pending(), 0);
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

    fn a_frame_that_was_sent_before_it_was_taken_back_is_told_as_sent(port, chip) {
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
}
