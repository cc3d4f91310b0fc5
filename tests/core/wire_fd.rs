//! Facts about the bus over CAN FD: what is sent is received, a message in a frame; no byte is a panic; what is refused leaves no
//! trace; neither kind of bus takes the other's frames for its own.
#![cfg(feature = "fd")]

use crate::messages::{from_unit, knots, motion, parameters, to_unit};
use embedded_can::Id;
use holdover::health::Cause;
use holdover::time::Instant;
use holdover::wire::catalogue::{CATALOGUE, Node, data_id};
use holdover::wire::fd::{State, e2e, layout};
use holdover::wire::{
    Data, Frame, Identifier, Identifiers, Message, Received, Receiver, Role, Said, Sender, Slot, Transport, Unsent,
};
use proptest::prelude::*;

const BASE: Identifiers = Identifiers::DEFAULT;

fn sender() -> Sender<8> {
    Sender::new(BASE).over(Transport::Fd)
}

fn receiver(role: Role) -> Receiver<8> {
    Receiver::new(BASE, role).over(Transport::Fd)
}

fn frame_of(sender: &mut Sender<8>, message: &Message) -> Frame {
    let mut frames = Vec::new();
    sender.send(message, &mut |frame| frames.push(frame)).unwrap();
    assert_eq!(frames.len(), 1, "{message:?}");
    frames[0]
}

/// A receiver that has heard a frame with the counter before a sender's first on every identifier, but none for other buses.
fn acquainted(role: Role) -> Receiver<8> {
    let mut receiver = receiver(role);
    for (place, line) in CATALOGUE.iter().enumerate() {
        let Some(layout) = layout::of(place) else { continue };
        for slot in 0..if line.is_per_slot() { 8 } else { 1 } {
            let offset = line.offset_for(Slot(slot));
            let mut data = vec![0; layout.bytes.into()];
            e2e::protect(&mut data, data_id(offset), 255);
            let heard =
                receiver.receive(Instant::ZERO, &Frame { id: BASE.at(offset), data: Data::new(&data).unwrap() });
            assert!(matches!(heard, Err(Cause::NotYetTrusted) | Ok(Received::Foreign)), "{heard:?}");
        }
    }
    receiver
}

/// The message as CAN FD has it: what a vehicle says of its motion, its horizon and how it drives is one.
fn whole(message: Message, extra: (Said, Said)) -> Message {
    let (mut state, (motion, rest)) = (None, extra);
    let mut of = |said: Said| {
        let mut made = match motion {
            Said::Motion(motion) => State { motion, parameters: None, horizon: None },
            _ => unreachable!(),
        };
        for said in [rest, said] {
            match said {
                Said::Motion(motion) => made.motion = motion,
                Said::DrivingParameters(parameters) => made.parameters = Some(parameters),
                Said::Horizon(knots) => made.horizon = Some(knots),
                _ => return said,
            }
        }
        *state.insert(Said::State(made))
    };
    match message {
        Message::Peer(slot, said) => Message::Peer(slot, of(said)),
        Message::Own(said) => Message::Own(of(said)),
        other => other,
    }
}

/// The message with this tag wherever it has one.
fn tagged(mut message: Message, tag: u8) -> Message {
    let of = |said: &mut Said| match said {
        Said::Motion(motion) => motion.tag = tag,
        Said::Horizon(knots) => knots.tag = tag,
        Said::Geo(position) => position.tag = tag,
        Said::Route(route) => route.tag = tag,
        Said::State(state) => {
            state.motion.tag = tag;
            if let Some(knots) = &mut state.horizon {
                knots.tag = tag;
            }
        }
        Said::DrivingParameters(_) => {}
    };
    match &mut message {
        Message::Ego(said) | Message::Own(said) | Message::Peer(_, said) => of(said),
        Message::Estimate(estimate) => estimate.tag = tag,
        Message::OwnPass(pass) | Message::PeerPass(pass) => pass.tag = tag,
        _ => {}
    }
    message
}

fn extra() -> impl Strategy<Value = (Said, Said)> {
    let rest = prop_oneof![
        motion().prop_map(Said::Motion),
        parameters().prop_map(Said::DrivingParameters),
        knots().prop_map(Said::Horizon)
    ];
    (motion().prop_map(Said::Motion), rest)
}

fn sent_is_received(role: Role, sent: &[(Message, (Said, Said))]) {
    let (mut sender, mut receiver) = (sender(), acquainted(role));
    for (message, extra) in sent {
        let message = whole(*message, *extra);
        let frame = frame_of(&mut sender, &message);
        let expected = tagged(message, frame.data[2] & 3);
        assert_eq!(receiver.receive(Instant::ZERO, &frame), Ok(Received::Whole(expected)));
        assert_eq!(receiver.receive(Instant::ZERO, &frame), Err(Cause::Repeated));
    }
}

/// Identifiers of the block, and data of every length.
fn noise() -> impl Strategy<Value = (u16, Vec<u8>, bool)> {
    let length = prop_oneof![0usize..=64, proptest::sample::select(vec![12, 16, 64, 64])];
    let data = length.prop_flat_map(|length| proptest::collection::vec(any::<u8>(), length));
    (0u16..0xC0, data, proptest::bool::weighted(0.1))
}

/// A frame of any length.
struct Odd(Identifier, Vec<u8>, bool);

impl embedded_can::Frame for Odd {
    fn new(_: impl Into<Id>, _: &[u8]) -> Option<Self> {
        None
    }
    fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
        None
    }
    fn is_extended(&self) -> bool {
        false
    }
    fn is_remote_frame(&self) -> bool {
        self.2
    }
    fn id(&self) -> Id {
        self.0.into()
    }
    fn dlc(&self) -> usize {
        self.1.len()
    }
    fn data(&self) -> &[u8] {
        &self.1
    }
}

proptest! {
    #[test]
    fn what_the_modem_and_the_vehicle_send_the_unit_receives_in_a_frame_each(
        sent in proptest::collection::vec((to_unit(8), extra()), 1..20),
    ) {
        sent_is_received(Role::Unit, &sent);
    }

    #[test]
    fn what_the_unit_sends_the_modem_receives_in_a_frame_each(
        sent in proptest::collection::vec((from_unit(), extra()), 1..20),
    ) {
        sent_is_received(Role::Modem, &sent);
    }

    #[test]
    fn no_frame_is_a_panic_and_a_refused_one_does_not_disturb_the_next(
        noise in proptest::collection::vec(noise(), 1..100), sent in to_unit(8), extra in extra(),
    ) {
        let mut receiver = acquainted(Role::Unit);
        for (offset, data, remote) in noise {
            let before = receiver.clone();
            match receiver.receive(Instant::ZERO, &Odd(BASE.at(offset), data, remote)) {
                Ok(Received::Foreign) | Err(Cause::Length | Cause::Checksum | Cause::UnknownSlot) => {
                    prop_assert_eq!(&before, &receiver);
                }
                // One frame of noise in 65,536 has the right CRC.
                _ => receiver = before,
            }
        }
        let message = whole(sent, extra);
        let frame = frame_of(&mut sender(), &message);
        prop_assert_eq!(receiver.receive(Instant::ZERO, &frame), Ok(Received::Whole(tagged(message, 0))));
    }

    #[test]
    fn protected_noise_on_any_identifier_is_a_value_or_a_named_cause_and_a_value_is_sent_as_it_was_heard(
        line in 0..CATALOGUE.len(), slot in 0u8..8, data in proptest::collection::vec(any::<[u8; 32]>(), 2..40),
    ) {
        let of = &CATALOGUE[line];
        let role = if of.sender == Node::Unit { Role::Modem } else { Role::Unit };
        let (mut receiver, offset) = (receiver(role), of.offset_for(Slot(slot)));
        for (counter, pair) in (0..).zip(data.windows(2)) {
            let Some(layout) = layout::of(line) else { continue };
            let mut data = pair.concat();
            data.truncate(layout.bytes.into());
            e2e::protect(&mut data, data_id(offset), counter);
            match receiver.receive(Instant::ZERO, &Frame { id: BASE.at(offset), data: Data::new(&data).unwrap() }) {
                Ok(Received::Whole(message)) => {
                    let again = frame_of(&mut sender(), &message);
                    let heard = acquainted(role).receive(Instant::ZERO, &again);
                    prop_assert_eq!(heard, Ok(Received::Whole(tagged(message, 0))));
                }
                Ok(other) => prop_assert!(false, "{:?}", other),
                Err(cause) => prop_assert!(matches!(cause, Cause::NotYetTrusted | Cause::Range), "{:?}", cause),
            }
        }
    }

    #[test]
    fn one_lost_frame_is_one_lost_message(sent in proptest::collection::vec((motion(), parameters(), knots()), 12), lost in 1usize..10) {
        let (mut sender, mut receiver) = (sender(), acquainted(Role::Unit));
        for (number, (motion, parameters, horizon)) in sent.into_iter().enumerate() {
            let state = State { motion, parameters: Some(parameters), horizon: Some(horizon) };
            let message = Message::Peer(Slot(7), Said::State(state));
            let frame = frame_of(&mut sender, &message);
            if number != lost {
                let expected = tagged(message, number as u8 & 3);
                prop_assert_eq!(receiver.receive(Instant::ZERO, &frame), Ok(Received::Whole(expected)));
            }
        }
    }

    #[test]
    fn neither_bus_takes_a_frame_of_the_other(message in to_unit(8), extra in extra()) {
        let mut classic = Receiver::<8>::new(BASE, Role::Unit);
        let before = classic.clone();
        let frame = frame_of(&mut sender(), &whole(message, extra));
        prop_assert_eq!(classic.receive(Instant::ZERO, &frame), Err(Cause::Length));
        prop_assert_eq!(&classic, &before);
        let (mut over_fd, mut result) = (receiver(Role::Unit), Vec::new());
        let before = over_fd.clone();
        let mut emit = |frame: Frame| result.push(over_fd.receive(Instant::ZERO, &frame));
        Sender::<8>::new(BASE).send(&message, &mut emit).unwrap();
        let is_refused = |heard: &Result<Received, Cause>| matches!(heard, Err(Cause::Length) | Ok(Received::Foreign));
        prop_assert!(result.iter().all(is_refused), "{:?}", result);
        prop_assert_eq!(&over_fd, &before);
    }

    #[test]
    fn a_state_over_classic_can_is_its_parts(motion in motion(), parameters in parameters(), horizon in knots()) {
        let mut frames = [Vec::new(), Vec::new()];
        let parts = [Said::Motion(motion), Said::DrivingParameters(parameters), Said::Horizon(horizon)];
        let state = Said::State(State { motion, parameters: Some(parameters), horizon: Some(horizon) });
        Sender::<8>::new(BASE).send(&Message::Peer(Slot(2), state), &mut |frame| frames[0].push(frame)).unwrap();
        let mut sender = Sender::<8>::new(BASE);
        for said in parts {
            sender.send(&Message::Peer(Slot(2), said), &mut |frame| frames[1].push(frame)).unwrap();
        }
        prop_assert_eq!(&frames[0], &frames[1]);
        prop_assert_eq!(frames[0].len(), 10);
        prop_assert_eq!(sender.send(&Message::Ego(state), &mut |_| {}), Err(Unsent::NoLine));
    }

    #[test]
    fn over_fd_no_part_of_a_state_is_sent_alone_but_the_motion(motion in motion(), parameters in parameters(), horizon in knots()) {
        let mut sender = sender();
        let mut count = 0;
        for said in [Said::DrivingParameters(parameters), Said::Horizon(horizon)] {
            prop_assert_eq!(sender.send(&Message::Peer(Slot(0), said), &mut |_| count += 1), Err(Unsent::NoLine));
        }
        prop_assert_eq!(count, 0);
        let alone = State { motion, parameters: None, horizon: None };
        let frame = frame_of(&mut sender, &Message::Peer(Slot(0), Said::Motion(motion)));
        prop_assert_eq!(frame, frame_of(&mut self::sender(), &Message::Peer(Slot(0), Said::State(alone))));
    }
}
