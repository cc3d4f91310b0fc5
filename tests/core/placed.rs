//! Identifiers placed one by one: a unit answers as one on the block does, bit for bit but for the identifiers, whichever lines are
//! placed and however many bits their identifiers have; and what cannot be told apart is refused by the names of its messages.

#[allow(dead_code)] // shared with the tests of the messages
use crate::messages;
use std::collections::BTreeSet;

use crate::rig::junction::WAYS;
use crate::traffic::{EGO, PEERS, Traffic, Unit, drop_result};
#[cfg(feature = "fd")]
use crate::traffic::{TARGET, leads};
use embedded_can::Frame as _;
use holdover::config::{Config, ConfigError};
use holdover::time::Instant;
use holdover::wire::catalogue::{About, CATALOGUE, Content, Line, Node, Speaker};
#[cfg(feature = "fd")]
use holdover::wire::fd::State;
use holdover::wire::geo::GeoPosition;
use holdover::wire::{Frame, Identifier, IdentifierError, Identifiers, Message, MessageName, Said, Slot, Transport};
use holdover::{Answer, Reception};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;

const BLOCK: Identifiers = Identifiers::DEFAULT;

fn extended(number: u32) -> Identifier {
    Identifier::extended(number).unwrap()
}

/// With this line there, and for each slot, if it has slots, 0x100 further, or with 11 bits the next one.
fn with(identifiers: Identifiers, line: &Line, id: Identifier) -> Identifiers {
    match line.content {
        Content::Said(Speaker::Peer, about) => {
            identifiers.place_peers(about, id, if id.is_extended() { 0x100 } else { 1 })
        }
        content => identifiers.place(content, id).unwrap(),
    }
}

/// Everything as J1939 has it: priority 6, a group of Proprietary B for each message and slot, a source address for each sender.
fn all_extended() -> Identifiers {
    let mut group = 0x18FF_0000;
    CATALOGUE.iter().fold(BLOCK, |identifiers, line| {
        let source = match line.sender {
            Node::Unit => 0x2A,
            Node::Modem => 0x4A,
            Node::Vehicle => 0x00,
        };
        let placed = with(identifiers, line, extended(group | source));
        group += if line.is_per_slot() { 0x1000 } else { 0x100 };
        placed
    })
}

fn config(identifiers: Identifiers, transport: Transport) -> Config {
    Config { identifiers, transport, ..Config::car(EGO) }
}

/// When the unit sets out on a way through a junction: it tells its route only then.
const SET_OUT: usize = 300;

fn unit(identifiers: Identifiers, transport: Transport) -> Unit {
    Unit::new(&config(identifiers, transport)).unwrap()
}

/// A drive on the block: what the unit hears, and what it answers.
struct Drive {
    transport: Transport,
    heard: Vec<(Instant, Vec<Frame>)>,
    answers: Vec<Answer>,
}

impl Drive {
    /// Behind a target, and from the third second on with any message at any time.
    fn new(transport: Transport) -> Self {
        let (mut unit, mut traffic) = (unit(BLOCK, transport), Traffic::new());
        #[cfg(feature = "fd")]
        if transport == Transport::Fd {
            // Its peers speak classic CAN; a state of the target stands in for them.
            traffic = Traffic { sender: traffic.sender.over(transport), target: false, behind: false, ..traffic };
        }
        let (mut runner, any) = (TestRunner::deterministic(), messages::to_unit(PEERS as u8));
        let (mut heard, mut answers) = (Vec::new(), Vec::new());
        for period in 0..500 {
            let (now, mut frames) = traffic.next();
            if period == SET_OUT {
                unit.set_out(&WAYS[0]).unwrap();
            }
            #[cfg(feature = "fd")]
            if transport == Transport::Fd && period % 10 == 0 {
                let motion = traffic.motion(TARGET, 17_000, now);
                let state = State { motion, parameters: Some(leads()), horizon: None };
                frames.extend(traffic.peer(0, Said::State(state)));
            }
            if period % 10 == 5 {
                let stamp = traffic.gnss(now).stamp();
                let latitude = 20_000 - 10 * period as i32; // at 10 m/s towards the junction
                let any = messages::geo().new_tree(&mut runner).unwrap().current();
                let geo = GeoPosition { latitude, longitude: 0, heading: 0, stamp, ..any };
                frames.extend(traffic.frames(&Message::Ego(Said::Geo(geo))));
            }
            if period > 250 {
                let message = any.new_tree(&mut runner).unwrap().current();
                let sent = traffic.sender.send(&message, &mut |frame| frames.push(frame));
                assert!(sent.is_ok() || transport == Transport::Fd, "what is no message by itself over CAN FD");
            }
            frames.iter().for_each(|frame| drop_result(unit.receive(now, frame)));
            heard.push((now, frames));
            answers.push(unit.tick(now));
        }
        Self { transport, heard, answers }
    }

    /// All that a unit with these identifiers does is the same.
    fn is_the_same_on(&self, identifiers: Identifiers, what: &str) {
        let moved = |frame: &Frame| Frame { id: identifiers.at(BLOCK.offset_of(frame.id).unwrap()), ..*frame };
        let mut unit = unit(identifiers, self.transport);
        for (period, ((now, frames), expected)) in self.heard.iter().zip(&self.answers).enumerate() {
            if period == SET_OUT {
                unit.set_out(&WAYS[0]).unwrap();
            }
            frames.iter().for_each(|frame| drop_result(unit.receive(*now, &moved(frame))));
            let answer = unit.tick(*now);
            let sent: Vec<_> = expected.frames.iter().map(moved).collect();
            assert_eq!(answer.frames[..], sent[..], "{what}");
            let values = |answer: &Answer| (answer.command, answer.mode, answer.estimate);
            assert_eq!(values(&answer), values(expected), "{what}");
        }
    }
}

fn each_line_alone_and_all_together(drive: &Drive) {
    let mut seen = BTreeSet::new();
    let sent = drive.answers.iter().flat_map(|answer| &answer.frames);
    for frame in drive.heard.iter().flat_map(|(_, frames)| frames).chain(sent) {
        seen.insert(BLOCK.offset_of(frame.id).unwrap());
    }
    for line in &CATALOGUE {
        let extended = with(BLOCK, line, extended(0x0CFF_0210));
        let is_there = (0..PEERS as u8).any(|slot| seen.contains(&line.offset_for(Slot(slot))));
        // The unit does not tell its position by this message, and over CAN FD a frame is of several lines.
        // Nor does one without the envelope tell of passes.
        let is_never_there = [Content::Said(Speaker::Own, About::Geo), Content::Pass(Speaker::Own)]
            .contains(&line.content)
            || drive.transport == Transport::Fd;
        assert!(is_there || is_never_there, "{} is in the drive", line.name);
        drive.is_the_same_on(extended, line.name);
    }
    for line in CATALOGUE.iter().filter(|line| !line.is_per_slot()) {
        drive.is_the_same_on(with(BLOCK, line, Identifier::standard(0x7FF).unwrap()), line.name);
    }
    let peers = |identifiers: Identifiers, about| {
        identifiers.place_peers(about, Identifier::standard(about as u16).unwrap(), 6)
    };
    let abouts = [About::MotionA, About::MotionB, About::Horizon, About::DrivingParameters, About::Geo, About::Route];
    drive.is_the_same_on(abouts.into_iter().fold(BLOCK, peers), "peers' lines slot by slot");
    drive.is_the_same_on(all_extended(), "all");
}

#[test]
fn a_unit_answers_as_on_the_block_whichever_lines_are_placed() {
    each_line_alone_and_all_together(&Drive::new(Transport::Classic));
}

#[cfg(feature = "fd")]
#[test]
fn a_unit_on_can_fd_answers_as_on_the_block_whichever_lines_are_placed() {
    each_line_alone_and_all_together(&Drive::new(Transport::Fd));
}

#[test]
fn where_a_line_lay_before_and_the_same_number_with_other_bits_are_foreign() {
    let drive = Drive::new(Transport::Classic);
    let (now, frames) = &drive.heard[0];
    for frame in frames {
        let offset = BLOCK.offset_of(frame.id).unwrap();
        let (_, line, _) = holdover::wire::catalogue::find(offset).unwrap();
        let number = frame.id.number();
        for (id, others) in [
            (extended(0x0CFF_0210), vec![frame.id, extended(number)]),
            (extended(0x123), vec![frame.id, Identifier::standard(0x123).unwrap()]),
            (Identifier::standard(0x023).unwrap(), vec![frame.id, extended(0x023)]),
        ] {
            let mut unit = Unit::new(&config(with(BLOCK, line, id), Transport::Classic)).unwrap();
            for other in others {
                let frame = Frame { id: other, ..*frame };
                assert_eq!(unit.receive(*now, &frame), Ok(Reception::Foreign), "{} {other} {id}", line.name);
                assert_eq!(frame.is_extended(), other.is_extended());
            }
            let placed = Frame { id, ..*frame };
            assert_ne!(unit.receive(*now, &placed), Ok(Reception::Foreign), "{}", line.name);
        }
        // On the block, too, the number alone is not enough.
        let mut unit = Unit::new(&config(BLOCK, Transport::Classic)).unwrap();
        assert_eq!(unit.receive(*now, &Frame { id: extended(number), ..*frame }), Ok(Reception::Foreign));
    }
}

fn refused(identifiers: Identifiers) -> String {
    match config(identifiers, Transport::Classic).check(400) {
        Err(error @ ConfigError::Identifiers(_)) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn two_messages_on_one_identifier_are_refused_by_their_names() {
    let id = extended(0x18FF_0201);
    for (place, line) in CATALOGUE.iter().enumerate() {
        for other in &CATALOGUE[..place] {
            let said = refused(with(with(BLOCK, line, id), other, id));
            for name in [line.name, other.name].map(|name| name.replace("{slot}", "0")) {
                assert!(said.contains(&name), "{name}: {said}");
            }
        }
    }
    let health = |id| BLOCK.place(Content::Status, Identifier::standard(id).unwrap()).unwrap();
    assert_eq!(refused(health(0x480)), "TimeSync and Health have the same identifier");
    assert_eq!(refused(health(0x4C9)), "Peer1MotionB and Health have the same identifier");
    // Where the catalogue has nothing, and beside the block.
    for free in [0x47F, 0x498, 0x48C, 0x4C6, 0x540] {
        assert_eq!(config(health(free), Transport::Classic).check(400), Ok(()), "{free:#x}");
    }
    // The tenth slot of one is the first of the other.
    let peers = BLOCK.place_peers(About::Geo, id, 0x100).place_peers(About::Route, extended(0x18FF_0B01), 0x1000);
    assert_eq!(refused(peers), "Peer9Position and Peer0Route have the same identifier");
    // Without a distance all slots are one.
    assert_eq!(
        refused(BLOCK.place_peers(About::Geo, id, 0)),
        "Peer0Position and Peer1Position have the same identifier"
    );
    let shared = IdentifierError::Shared(MessageName::at(0), MessageName::at(0x18));
    assert_eq!(health(0x480).check(Transport::Classic), Err(shared));
}

#[test]
fn slots_beyond_the_bits_are_refused_by_the_name_of_their_message() {
    let check = |first, stride| BLOCK.place_peers(About::Horizon, first, stride).check(Transport::Classic);
    let error = IdentifierError::Range(MessageName::at(0x42));
    let beyond = Err(error);
    let standard = |number| Identifier::standard(number).unwrap();
    assert_eq!(check(standard(0x7FF - 15), 1), Ok(()));
    assert_eq!(check(standard(0x7FF - 14), 1), beyond);
    assert_ne!(check(standard(0), 0x7FF / 15), beyond);
    assert_eq!(check(standard(0), 0x7FF / 15 + 1), beyond);
    assert_eq!(check(extended(0x1FFF_FFFF - 15 * 0x100), 0x100), Ok(()));
    assert_eq!(check(extended(0x1FFF_FFFF - 15 * 0x100 + 1), 0x100), beyond);
    for stride in [u32::MAX, u32::MAX / 15, 1 << 31, 1 << 29] {
        assert_eq!(check(extended(0), stride), beyond, "{stride:#x}");
    }
    assert!(error.to_string().contains("Peer0Horizon"));
}
