//! What gets into each controller: all that the unit takes in, and as little else as its filters can keep away.

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
use board::zynqmp_r5::layout::Layout;
use chips::Chip;
use embedded_can::{Frame, Id, StandardId};
use holdover::time::Instant;
use holdover::wire::catalogue::{About, CATALOGUE, Node};
use holdover::wire::{BaseId, Identifier, Identifiers, Received, Receiver, Role};
use proptest::prelude::*;

fn standard() -> impl Iterator<Item = Identifier> {
    (0..0x800).map(|number| Identifier::standard(number).unwrap())
}

/// Of these, what gets into a controller.
fn let_in<P: Port>((mut port, chip): (P, impl Chip), sent: impl Iterator<Item = Identifier>) -> Vec<Identifier> {
    let is_in = |id: &Identifier| {
        chip.hear(&CanFrame::new(Id::from(*id), &[1]).unwrap());
        let frame = port.receive().unwrap();
        assert!(frame.as_ref().is_none_or(|frame| frame.id() == Id::from(*id)));
        frame.is_some()
    };
    sent.filter(is_in).collect()
}

/// Those that a unit that hears everything does not take for somebody else's.
fn taken_in(identifiers: Identifiers, sent: impl Iterator<Item = Identifier>) -> Vec<Identifier> {
    let mut receiver = Receiver::<16>::new(identifiers, Role::Unit);
    let is_own = |id: &Identifier| {
        let frame = CanFrame::new(Id::from(*id), &[0; 8]).unwrap();
        !matches!(receiver.receive(Instant::ZERO, &frame), Ok(Received::Foreign))
    };
    sent.filter(is_own).collect()
}

fn wanted(identifiers: &Identifiers) -> Patterns {
    Patterns::of(identifiers.heard_by_unit())
}

/// Some messages elsewhere, as on a bus with J1939.
fn placed() -> Identifiers {
    let mut identifiers = Identifiers::DEFAULT;
    for (number, line) in (0x0cff_0210..).step_by(0x1_0117).zip(&CATALOGUE).take(10) {
        identifiers = identifiers.place(line.content, Identifier::extended(number).unwrap()).unwrap();
    }
    let first = Identifier::extended(0x18ff_404a).unwrap();
    identifiers.place_peers(About::MotionA, first, 0x100)
}

#[test]
fn what_is_wanted_is_what_the_receiver_takes_in() {
    let heard: Vec<_> = Identifiers::DEFAULT.heard_by_unit().collect();
    assert_eq!(heard, taken_in(Identifiers::DEFAULT, standard()));
    let lines = CATALOGUE.iter().filter(|line| line.sender != Node::Unit);
    assert_eq!(heard.len(), lines.map(|line| if line.is_per_slot() { 16 } else { 1 }).sum::<usize>());
    // Where messages are placed, in the order of the catalogue.
    let placed = placed();
    let elsewhere: Vec<_> = placed.heard_by_unit().collect();
    assert_eq!(elsewhere.len(), heard.len());
    assert_eq!(taken_in(placed, elsewhere.iter().copied()), elsewhere);
}

#[test]
fn the_block_gets_into_the_controllers_of_the_stm32_and_nothing_else_does() {
    let identifiers = Identifiers::DEFAULT;
    let heard: Vec<_> = identifiers.heard_by_unit().collect();
    assert_eq!(let_in(chips::stm32::listening(wanted(&identifiers)), standard()), heard);
    assert_eq!(let_in(chips::stm32g474::listening(wanted(&identifiers)), standard()), heard);
    let extended = || (0..1 << 29).step_by(0x1235).map(|number| Identifier::extended(number).unwrap());
    assert_eq!(let_in(chips::stm32::listening(wanted(&identifiers)), extended()), []);
    assert_eq!(let_in(chips::stm32g474::listening(wanted(&identifiers)), extended()), []);
}

#[test]
fn the_zynqmp_has_four_filters_so_some_of_the_block_that_is_not_wanted_gets_in_and_nothing_outside_it() {
    let identifiers = Identifiers::DEFAULT;
    let heard: Vec<_> = identifiers.heard_by_unit().collect();
    let inside = let_in(chips::zynqmp::listening(wanted(&identifiers)), standard());
    assert!(heard.iter().all(|id| inside.contains(id)));
    let block = 0x480..0x540;
    assert!(inside.iter().all(|id| block.contains(&id.number())));
    assert_eq!((heard.len(), inside.len()), (106, 146));
}

#[test]
fn everything_that_is_placed_elsewhere_gets_into_every_controller_and_most_else_does_not() {
    let identifiers = placed();
    let heard: Vec<_> = identifiers.heard_by_unit().collect();
    let others: Vec<_> = (0..1 << 29)
        .step_by(0x1235)
        .map(|number| Identifier::extended(number).unwrap())
        .filter(|id| !heard.contains(id))
        .collect();
    let share = |inside: Vec<Identifier>| inside.len() as f64 / others.len() as f64;
    let all = || heard.iter().copied();
    let some = || others.iter().copied();
    assert_eq!(let_in(chips::stm32::listening(wanted(&identifiers)), all()), heard);
    assert_eq!(let_in(chips::stm32g474::listening(wanted(&identifiers)), all()), heard);
    assert_eq!(let_in(chips::zynqmp::listening(wanted(&identifiers)), all()), heard);
    let shares = [
        share(let_in(chips::stm32::listening(wanted(&identifiers)), some())),
        share(let_in(chips::stm32g474::listening(wanted(&identifiers)), some())),
        share(let_in(chips::zynqmp::listening(wanted(&identifiers)), some())),
    ];
    assert!(shares[0] < 0.01 && shares[1] < 0.01 && shares[2] < 0.05, "{shares:?}");
}

#[test]
fn a_remote_frame_gets_in_for_the_unit_refuses_it_by_name() {
    let remote = CanFrame::new_remote(StandardId::new(0x484).unwrap(), 8).unwrap();
    let wanted = wanted(&Identifiers::DEFAULT);
    let mut received = Vec::new();
    let (mut port, chip) = chips::stm32::listening(wanted.clone());
    chip.hear(&remote);
    received.push(port.receive());
    let (mut port, chip) = chips::stm32g474::listening(wanted.clone());
    chip.hear(&remote);
    received.push(port.receive());
    let (mut port, chip) = chips::zynqmp::listening(wanted);
    chip.hear(&remote);
    received.push(port.receive());
    assert!(received.iter().all(|frame| matches!(frame, Ok(Some(frame)) if frame.is_remote_frame())));
}

proptest! {
    /// Both ways in which the words of a ZynqMP stand.
    #[test]
    fn a_filter_of_the_zynqmp_lets_in_what_its_pattern_does(
        standard in prop::collection::vec(0u16..0x800, 1..9),
        extended in prop::collection::vec(0u32..1 << 29, 1..9),
        bit in 0u32..29,
    ) {
        let short = standard.iter().map(|number| Identifier::standard(*number).unwrap());
        let long = extended.iter().map(|number| Identifier::extended(*number).unwrap());
        let wanted: Vec<_> = short.chain(long).collect();
        let filters = Patterns::of(wanted.iter().copied()).at_most::<4>();
        let near = |id: Identifier| match id.is_extended() {
            true => Identifier::extended(id.number() ^ 1 << bit).unwrap(),
            false => Identifier::standard(id.number() as u16 ^ 1 << (bit % 11)).unwrap(),
        };
        for id in wanted.iter().flat_map(|id| [*id, near(*id)]) {
            for layout in [Layout::Silicon, Layout::Model] {
                let [word, ..] = layout.words(&CanFrame::new(Id::from(id), &[]).unwrap());
                for pattern in &filters {
                    let [mask, bits] = layout.filter(pattern);
                    prop_assert_eq!((word ^ bits) & mask == 0, pattern.takes(Id::from(id)));
                }
            }
        }
    }

    /// Whatever the identifiers and however few the filters.
    #[test]
    fn what_is_wanted_gets_in(
        base in 0u16..0x741,
        standard in prop::collection::vec(0u16..0x800, 0..80),
        extended in prop::collection::vec(0u32..1 << 29, 0..80),
    ) {
        let block = Identifiers::block(BaseId::new(base).unwrap());
        let wanted: Vec<_> = block
            .heard_by_unit()
            .chain(standard.into_iter().map(|number| Identifier::standard(number).unwrap()))
            .chain(extended.into_iter().map(|number| Identifier::extended(number).unwrap()))
            .collect();
        let patterns = Patterns::of(wanted.iter().copied());
        let few = patterns.clone().at_most::<4>();
        let (short, long) = patterns.clone().at_most_of_each::<28, 8>();
        for id in &wanted {
            prop_assert!(few.iter().any(|pattern| pattern.takes(Id::from(*id))));
            prop_assert!(short.iter().chain(&long).any(|pattern| pattern.takes(Id::from(*id))));
        }
    }

    /// As long as the block begins at a multiple of 8, as slots do, nothing else does.
    #[test]
    fn a_block_is_let_in_exactly(eighth in 0u16..=0x740 / 8) {
        let block = Identifiers::block(BaseId::new(8 * eighth).unwrap());
        let filters = Patterns::of(block.heard_by_unit()).at_most::<28>();
        let inside = |id: &Identifier| filters.iter().any(|pattern| pattern.takes(Id::from(*id)));
        prop_assert_eq!(standard().filter(inside).collect::<Vec<_>>(), block.heard_by_unit().collect::<Vec<_>>());
    }
}
