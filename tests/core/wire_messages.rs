//! Facts about every message on the bus: what is sent is received; no byte is a panic; what is refused leaves no trace.

use crate::messages::{from_unit, geo, knots, motion, parameters, to_unit};
use crate::traffic::AnyFrame;
use embedded_can::{ExtendedId, Id, StandardId};
use holdover::health::Cause;
use holdover::time::Instant;
use holdover::wire::catalogue::{CATALOGUE, data_id};
use holdover::wire::{Frame, Identifiers, Message, Received, Receiver, Role, Said, Sender, Slot, Unsent, e2e};
use proptest::prelude::*;

const BASE: Identifiers = Identifiers::DEFAULT;

fn frames_of<const PEERS: usize>(sender: &mut Sender<PEERS>, message: &Message) -> Vec<Frame> {
    let mut frames = Vec::new();
    sender.send(message, &mut |frame| frames.push(frame)).unwrap();
    frames
}

/// A sender and a receiver that trust one another on every identifier.
fn acquainted<const PEERS: usize>(role: Role) -> (Sender<PEERS>, Receiver<PEERS>) {
    let mut receiver = Receiver::<PEERS>::new(BASE, role);
    // a frame with the counter before the sender's first, on every identifier; the receiver knows it by it
    for line in &CATALOGUE {
        for slot in 0..if line.is_per_slot() { PEERS as u8 } else { 1 } {
            let offset = line.offset_for(Slot(slot));
            let frame = Frame { id: BASE.at(offset), data: e2e::protect([0; 8], data_id(offset), 14).into() };
            let heard = receiver.receive(Instant::ZERO, &frame);
            assert!(matches!(heard, Err(Cause::NotYetTrusted) | Ok(Received::Foreign)), "{heard:?}");
        }
    }
    (Sender::new(BASE), receiver)
}

fn sent_is_received(role: Role, sent: &[Message]) {
    let (mut sender, mut receiver) = acquainted::<8>(role);
    for message in sent {
        let frames = frames_of(&mut sender, message);
        let (last, before) = frames.split_last().unwrap();
        for frame in before {
            assert_eq!(receiver.receive(Instant::ZERO, frame), Ok(Received::Pending));
        }
        assert_eq!(receiver.receive(Instant::ZERO, last), Ok(Received::Whole(*message)));
    }
}

fn odd() -> impl Strategy<Value = AnyFrame> {
    let id = prop_oneof![
        (0x478u16..0x548).prop_map(|id| Id::Standard(StandardId::new(id).unwrap())),
        (0u16..0x800).prop_map(|id| Id::Standard(StandardId::new(id).unwrap())),
        (0x478u32..0x548).prop_map(|id| Id::Extended(ExtendedId::new(id).unwrap())),
    ];
    let data =
        prop_oneof![4 => proptest::collection::vec(any::<u8>(), 8), 1 => proptest::collection::vec(any::<u8>(), 0..=8)];
    (id, proptest::bool::weighted(0.1), data).prop_map(|(id, remote, data)| AnyFrame { id, remote, data })
}

proptest! {
    #[test]
    fn what_the_modem_and_the_vehicle_send_the_unit_receives(sent in proptest::collection::vec(to_unit(8), 1..20)) {
        sent_is_received(Role::Unit, &sent);
    }

    #[test]
    fn what_the_unit_sends_the_modem_receives(sent in proptest::collection::vec(from_unit(), 1..20)) {
        sent_is_received(Role::Modem, &sent);
    }

    #[test]
    fn no_frame_is_a_panic_and_a_refused_one_does_not_disturb_the_messages_under_way(
        noise in proptest::collection::vec(odd(), 1..200), sent in to_unit(8),
    ) {
        let (mut sender, mut receiver) = acquainted::<8>(Role::Unit);
        let mut whole = None;
        let mut noise = noise.iter();
        for frame in frames_of(&mut sender, &sent) {
            for odd in noise.by_ref().take(20) {
                let before = receiver.clone();
                match receiver.receive(Instant::ZERO, odd) {
                    Ok(Received::Foreign) => prop_assert_eq!(&before, &receiver),
                    // one frame of noise in 256 has the right CRC; it may be trusted if its counter fits too
                    Ok(_) | Err(Cause::Torn) => receiver = before,
                    Err(Cause::Length | Cause::UnknownSlot | Cause::CounterRange) => {
                        prop_assert_eq!(&before, &receiver);
                    }
                    Err(Cause::Checksum) => {}
                    Err(_) => receiver = before,
                }
            }
            whole = Some(receiver.receive(Instant::ZERO, &frame));
        }
        prop_assert_eq!(whole, Some(Ok(Received::Whole(sent))));
    }

    #[test]
    fn protected_noise_on_any_identifier_is_a_value_or_a_refusal_and_a_value_is_sent_as_it_was_heard(
        offset in 0u16..0xC0, words in proptest::collection::vec(any::<[u8; 8]>(), 1..40), role in any::<bool>(),
    ) {
        let role = if role { Role::Unit } else { Role::Modem };
        let mut receiver = Receiver::<16>::new(BASE, role);
        let mut counter = 0;
        for word in words {
            let frame = Frame { id: BASE.at(offset), data: e2e::protect(word, data_id(offset), counter).into() };
            counter = e2e::next(counter);
            match receiver.receive(Instant::ZERO, &frame) {
                Ok(Received::Whole(message)) => {
                    let (mut sender, mut other) = acquainted::<16>(role);
                    let heard = frames_of(&mut sender, &message).iter().map(|frame| other.receive(Instant::ZERO, frame)).last();
                    prop_assert_eq!(heard, Some(Ok(Received::Whole(message))));
                }
                Ok(Received::Foreign | Received::Pending) => {}
                Err(refusal) => prop_assert!(
                    matches!(refusal, Cause::NotYetTrusted | Cause::Range | Cause::Torn), "{:?}", refusal
                ),
            }
        }
    }

    #[test]
    fn a_lost_part_costs_its_message_and_is_counted_once(
        first in knots(), second in knots(), lost in 0usize..5,
    ) {
        prop_assume!(first.tag != second.tag);
        let (mut sender, mut receiver) = acquainted::<8>(Role::Unit);
        let mut frames = frames_of(&mut sender, &Message::Peer(Slot(3), Said::Horizon(first)));
        frames.remove(lost);
        frames.extend(frames_of(&mut sender, &Message::Peer(Slot(3), Said::Horizon(second))));
        let heard: Vec<_> = frames.iter().map(|frame| receiver.receive(Instant::ZERO, frame)).collect();
        prop_assert_eq!(heard.iter().filter(|heard| **heard == Err(Cause::Torn)).count(), 1);
        prop_assert_eq!(heard.last(), Some(&Ok(Received::Whole(Message::Peer(Slot(3), Said::Horizon(second))))));
    }

    #[test]
    fn halves_of_two_motions_are_never_one(first in motion(), second in motion()) {
        prop_assume!(first.tag != second.tag);
        let (mut sender, mut receiver) = acquainted::<8>(Role::Unit);
        let a = frames_of(&mut sender, &Message::Ego(Said::Motion(first)));
        let b = frames_of(&mut sender, &Message::Ego(Said::Motion(second)));
        prop_assert_eq!(receiver.receive(Instant::ZERO, &a[0]), Ok(Received::Pending));
        prop_assert_eq!(receiver.receive(Instant::ZERO, &b[1]), Err(Cause::Torn));
        prop_assert_eq!(receiver.receive(Instant::ZERO, &b[0]), Ok(Received::Whole(Message::Ego(Said::Motion(second)))));
    }

    #[test]
    fn driving_parameters_in_a_row_carry_tags_that_differ(messages in proptest::collection::vec(parameters(), 5)) {
        let mut sender = Sender::<0>::new(BASE);
        let tags: Vec<_> = messages
            .iter()
            .map(|parameters| {
                let frames = frames_of(&mut sender, &Message::Own(Said::DrivingParameters(*parameters)));
                let tags: Vec<_> = frames.iter().map(|frame| frame.data[1] >> 4 & 3).collect();
                assert!(tags.windows(2).all(|pair| pair[0] == pair[1]));
                tags[0]
            })
            .collect();
        prop_assert!(tags.windows(2).all(|pair| pair[0] != pair[1]), "{:?}", tags);
    }

    #[test]
    fn what_the_catalogue_does_not_have_is_not_sent(parameters in parameters(), position in geo()) {
        let mut sender = Sender::<2>::new(BASE);
        let mut emitted = 0;
        let mut emit = |_| emitted += 1;
        prop_assert_eq!(sender.send(&Message::Ego(Said::DrivingParameters(parameters)), &mut emit), Err(Unsent::NoLine));
        let beyond = Message::Peer(Slot(2), Said::Geo(position));
        prop_assert_eq!(sender.send(&beyond, &mut emit), Err(Unsent::UnknownSlot));
        prop_assert_eq!(emitted, 0);
    }
}

#[test]
fn frames_that_are_not_ours_to_read_are_told_apart_from_bad_ones() {
    let id = |id| Id::Standard(StandardId::new(id).unwrap());
    let odd = |id, remote, length| AnyFrame { id, remote, data: vec![0; length] };
    let mut receiver = Receiver::<2>::new(BASE, Role::Unit);
    let mut heard = |frame: AnyFrame| receiver.receive(Instant::ZERO, &frame);
    assert_eq!(heard(odd(id(0x47F), false, 8)), Ok(Received::Foreign));
    assert_eq!(heard(odd(id(0x540), false, 8)), Ok(Received::Foreign));
    assert_eq!(heard(odd(id(0x53F), false, 8)), Ok(Received::Foreign), "an identifier without a line");
    assert_eq!(heard(odd(id(0x482), false, 8)), Ok(Received::Foreign), "the unit's own command");
    assert_eq!(heard(odd(Id::Extended(ExtendedId::new(0x480).unwrap()), false, 8)), Ok(Received::Foreign));
    assert_eq!(heard(odd(id(0x480), true, 8)), Err(Cause::Length));
    assert_eq!(heard(odd(id(0x480), false, 7)), Err(Cause::Length));
    assert_eq!(heard(odd(id(0x4C8), false, 8)), Err(Cause::Checksum), "slot 1 of 2, a checksum of 0");
    assert_eq!(heard(odd(id(0x4D0), false, 8)), Err(Cause::UnknownSlot), "slot 2 of 2");
}
