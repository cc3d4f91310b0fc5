//! The queue of what waits to be sent, with a port that takes one frame at a time.

/// The board's own sources, with the places that they have there.
#[path = "../src/board"]
#[allow(dead_code)]
mod board {
    pub mod frame;
    pub mod outbox;
    pub mod port;
}

use board::frame::CanFrame;
use board::outbox::{MOST_AGE, Outbox, Pass};
use board::port::{Fate, Overrun, Port};
use embedded_can::{ExtendedId, Frame, Id, StandardId};
use holdover::Config;
use holdover::health::Incident;
use holdover::time::{Duration, Instant};
use holdover::wire::StationHash;

/// A port on a bus that is free, or is not.
#[derive(Default)]
struct Line {
    is_blocked: bool,
    sent: Vec<(Id, u8)>,
}

impl Port for Line {
    const TAKES_BACK: bool = false;

    fn receive(&mut self) -> Result<Option<CanFrame>, Overrun> {
        Ok(None)
    }

    fn load(&mut self, frame: &CanFrame) -> Option<usize> {
        (!self.is_blocked).then(|| self.sent.push((frame.id(), frame.data()[0])))?;
        Some(0)
    }

    fn fate(&mut self, _: usize) -> Fate {
        Fate::Sent
    }

    fn recall(&mut self, _: usize) {}

    fn left_bus(&mut self) -> bool {
        false
    }
}

fn at(millis: i64) -> Instant {
    Instant::from_micros(1_000_000).plus(Duration::from_millis(millis))
}

fn standard(id: u16) -> Id {
    StandardId::new(id).unwrap().into()
}

fn extended(id: u32) -> Id {
    ExtendedId::new(id).unwrap().into()
}

fn push(outbox: &mut Outbox, tick: Instant, id: Id, data: u8) {
    outbox.push(tick, &CanFrame::new(id, &[data]).unwrap());
}

/// Sends all that can be sent, and says what was sent and how many were lost.
fn sent(outbox: &mut Outbox, now: Instant) -> (Vec<(Id, u8)>, u32) {
    let mut line = Line::default();
    while outbox.pass(now, &mut line) == Pass::Taken {}
    let [(incident, lost), _] = outbox.lost(&mut line);
    assert_eq!(incident, Incident::TransmitOverflow);
    (line.sent, lost)
}

#[test]
fn frames_leave_in_the_order_in_which_the_bus_would_let_them() {
    let order = [standard(0x123), extended(0x123 << 18), extended(0x123 << 18 | 1), standard(0x124), standard(0x7ff)];
    let mut outbox = Outbox::new();
    order.iter().rev().for_each(|&id| push(&mut outbox, at(0), id, 0));
    assert_eq!(sent(&mut outbox, at(0)), (order.map(|id| (id, 0)).to_vec(), 0));
}

#[test]
fn a_message_of_a_later_tick_takes_the_place_of_all_parts_of_the_one_before() {
    let mut outbox = Outbox::new();
    (0..5).for_each(|part| push(&mut outbox, at(0), standard(0x492), part));
    push(&mut outbox, at(0), standard(0x493), 9);
    (10..15).for_each(|part| push(&mut outbox, at(10), standard(0x492), part));
    let expected: Vec<_> = (10..15).map(|part| (standard(0x492), part)).chain([(standard(0x493), 9)]).collect();
    assert_eq!(sent(&mut outbox, at(10)), (expected, 5));
}

#[test]
fn a_frame_that_no_newer_one_replaces_is_dropped_when_it_is_too_old() {
    for (age, is_sent) in [(MOST_AGE, true), (MOST_AGE.plus(Duration::from_micros(1)), false)] {
        let mut outbox = Outbox::new();
        let mut line = Line { is_blocked: true, ..Line::default() };
        push(&mut outbox, at(0), standard(0x495), 1);
        assert_eq!(outbox.pass(at(0), &mut line), Pass::Full);
        let expected = if is_sent { (vec![(standard(0x495), 1)], 0) } else { (vec![], 1) };
        assert_eq!(sent(&mut outbox, at(0).plus(age)), expected);
    }
}

#[test]
fn the_age_is_what_the_envelope_lets_a_command_stay_in_force_beyond_its_period() {
    assert_eq!(Config::car(StationHash(1)).envelope.unwrap().delay, MOST_AGE);
}

#[test]
fn for_a_harness_everything_leaves_in_the_order_in_which_it_came() {
    let mut outbox = Outbox::in_order();
    let frames = [(0, 0x498, 1), (0, 0x482, 2), (10, 0x482, 3), (20, 0x498, 4)];
    frames.iter().for_each(|&(tick, id, data)| push(&mut outbox, at(tick), standard(id), data));
    assert_eq!(sent(&mut outbox, at(5_000)), (frames.map(|(_, id, data)| (standard(id), data)).to_vec(), 0));
}
