//! A wire: frames enter with the instants at which their senders want to send them; they leave one after the other, each with
//! the instant of its end on a bus of 500 kbit/s, classic CAN or CAN FD; the data phase of CAN FD has 2 Mbit/s.
//!
//! One frame is on the bus at a time. Of the frames that wait, the one with the dominant identifier is next; frames of one
//! identifier stay in order. Every frame takes its own bits ([`length`]), and three bits of intermission follow. Neither
//! errors nor full mailboxes are modelled.

use std::collections::{BTreeMap, VecDeque};

use embedded_can::{Frame as _, Id};
use holdover::time::Instant;

use super::Frame;
use length::INTERMISSION;

mod length;

pub use length::length;

/// A frame that is to be sent, and the number of the node that sends it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// The node.
    pub from: usize,
    /// The frame.
    pub frame: Frame,
}

/// A wire.
#[derive(Clone, Debug)]
pub struct Wire {
    /// Frames whose time has not come, in the order of their times.
    coming: VecDeque<(Instant, Wanted)>,
    /// Frames that wait for the wire, by arbitration and then in the order in which they came.
    waiting: BTreeMap<(u32, u64), Wanted>,
    came: u64,
    /// When the last frame and its intermission are over.
    free: Instant,
}

impl Wire {
    /// A wire that is at rest.
    #[must_use]
    pub fn new() -> Self {
        Self { coming: VecDeque::new(), waiting: BTreeMap::new(), came: 0, free: Instant::from_micros(0) }
    }

    /// A node wants to send a frame from `at` on.
    pub fn want(&mut self, at: Instant, wanted: Wanted) {
        // That is nearly always the end, so the search starts there.
        let later = self.coming.iter().rev().take_while(|(other, _)| *other > at).count();
        self.coming.insert(self.coming.len() - later, (at, wanted));
    }

    /// Whether this frame still waits for the wire.
    #[must_use]
    pub fn waits(&self, wanted: &Wanted) -> bool {
        self.waiting.values().any(|other| other == wanted) || self.coming.iter().any(|(_, other)| other == wanted)
    }

    /// The next frame that starts before `upto`, and the instant of its end. What is wanted later on, but from an earlier time, comes
    /// after it.
    pub fn next_before(&mut self, upto: Instant) -> Option<(Instant, Wanted)> {
        let next = if self.waiting.is_empty() { self.coming.front()?.0 } else { self.free };
        let starts = self.free.max(next);
        if starts >= upto {
            return None;
        }
        while let Some((_, wanted)) = self.coming.pop_front_if(|(at, _)| *at <= starts) {
            self.waiting.insert((arbitration(&wanted.frame), self.came), wanted);
            self.came += 1;
        }
        let (_, wanted) = self.waiting.pop_first()?;
        let end = starts.plus(length(&wanted.frame));
        self.free = end.plus(INTERMISSION);
        Some((end, wanted))
    }
}

impl Default for Wire {
    fn default() -> Self {
        Self::new()
    }
}

/// The bits by which a frame wins the bus; the lower number wins.
fn arbitration(frame: &Frame) -> u32 {
    let remote = u32::from(frame.is_remote_frame());
    match frame.id() {
        Id::Standard(id) => u32::from(id.as_raw()) << 21 | remote << 20,
        Id::Extended(id) => {
            let id = id.as_raw();
            (id >> 18) << 21 | 0b11 << 19 | (id & 0x3_FFFF) << 1 | remote
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_can::StandardId;

    fn at(micros: u64) -> Instant {
        Instant::from_micros(micros)
    }

    fn frame(id: u16) -> Frame {
        Frame::standard(id, &[0x55]).unwrap()
    }

    /// The frames in the order in which they are on the wire, each with the instant of its end.
    fn on_wire(wanted: Vec<(Instant, Frame)>) -> Vec<(Instant, Frame)> {
        let mut wire = Wire::new();
        wanted.into_iter().for_each(|(at, frame)| wire.want(at, Wanted { from: 0, frame }));
        std::iter::from_fn(|| wire.next_before(Instant::from_micros(u64::MAX)))
            .map(|(end, wanted)| (end, wanted.frame))
            .collect()
    }

    #[test]
    fn of_the_frames_that_wait_the_dominant_identifier_is_next_and_equals_stay_in_order() {
        let (first, second) = (Frame::standard(5, &[1]).unwrap(), Frame::standard(5, &[2]).unwrap());
        let wanted = vec![(at(0), frame(9)), (at(1), frame(7)), (at(2), first), (at(3), second), (at(9000), frame(1))];
        let sent = on_wire(wanted);
        let order: Vec<Frame> = sent.iter().map(|(_, frame)| *frame).collect();
        assert_eq!(order, [frame(9), first, second, frame(7), frame(1)]);
        assert_eq!(sent[0].0, at(0).plus(length(&frame(9))));
        assert_eq!(sent[1].0, sent[0].0.plus(INTERMISSION).plus(length(&first)));
        assert_eq!(sent[4].0, at(9000).plus(length(&frame(1))));
    }

    #[test]
    fn a_data_frame_wins_over_its_remote_frame_and_a_standard_one_over_an_extended_one() {
        let id = StandardId::new(0x123).unwrap();
        let data = Frame::standard(0x123, &[]).unwrap();
        let remote = Frame::new_remote(id, 0).unwrap();
        let long = Frame::extended(0x123 << 18, &[]).unwrap();
        let higher = Frame::standard(0x124, &[]).unwrap();
        let order = [data, remote, long, higher];
        assert!(order.is_sorted_by_key(arbitration));
        let mut sent = on_wire(order.iter().rev().map(|frame| (at(0), *frame)).collect());
        assert_eq!(sent.drain(..).map(|(_, frame)| frame).collect::<Vec<_>>(), order);
    }

    #[test]
    fn a_frame_that_starts_later_is_not_decided_upon_yet() {
        let mut wire = Wire::new();
        assert_eq!(wire.next_before(at(1_000)), None);
        wire.want(at(10), Wanted { from: 1, frame: frame(7) });
        wire.want(at(10), Wanted { from: 2, frame: frame(9) });
        assert_eq!(wire.next_before(at(10)), None);
        let (end, first) = wire.next_before(at(11)).unwrap();
        assert_eq!((end, first.from), (at(10).plus(length(&frame(7))), 1));
        // The second one would start after the first one and its intermission. Until then another one may come.
        let start = end.plus(INTERMISSION);
        assert_eq!(wire.next_before(start), None);
        wire.want(start, Wanted { from: 3, frame: frame(8) });
        let later = Instant::from_micros(start.as_micros() + 1);
        assert_eq!(wire.next_before(later).unwrap().1.from, 3);
        assert_eq!(wire.next_before(later), None);
    }
}
