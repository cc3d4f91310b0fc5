//! A wire: frames enter with the instants at which their senders want to send them; they leave one after the other, each with
//! the instant of its end on a bus of 500 kbit/s, classic CAN or CAN FD; the data phase of CAN FD has 2 Mbit/s.
//!
//! One frame is on the bus at a time. Of the frames that wait, the one with the dominant identifier is next; frames of one
//! identifier stay in order. Every frame takes its own bits, with the stuff bits that its content and its CRC need, and
//! three bits of intermission follow. In CAN FD the stuff bits around the CRC are fixed, so that its value does not matter.
//! Neither errors nor full mailboxes are modelled.

use std::collections::{BTreeMap, VecDeque};

use embedded_can::{Frame as _, Id};
use holdover::time::{Duration, Instant};

use super::Frame;

/// Time of a bit at 500 kbit/s, and at 2 Mbit/s, in ns.
const BIT_NS: u32 = 2_000;
const DATA_BIT_NS: u32 = 500;
/// Delimiter of the CRC, acknowledgement with its delimiter, and end of frame. They are not stuffed.
const TAIL_BITS: u32 = 1 + 2 + 7;
/// Bits between two frames.
const INTERMISSION_BITS: u32 = 3;
/// Bits of the CRC, and its polynomial without the highest term.
const CRC_BITS: u32 = 15;
const CRC_POLYNOMIAL: u16 = 0x4599;
/// After so many equal bits the opposite bit is stuffed.
const EQUAL_BITS: u32 = 5;

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
        self.free = end.plus(micros(INTERMISSION_BITS));
        Some((end, wanted))
    }
}

impl Default for Wire {
    fn default() -> Self {
        Self::new()
    }
}

/// The time for which the frame is on the bus, from its first bit to the end of the end of frame.
#[must_use]
pub fn length(frame: &Frame) -> Duration {
    match frame.is_fd() {
        true => fd_length(frame),
        false => micros(bits(frame)),
    }
}

fn micros(bits: u32) -> Duration {
    nanos(bits * BIT_NS)
}

/// To the next microsecond.
fn nanos(nanos: u32) -> Duration {
    Duration::from_micros(i64::from(nanos.div_ceil(1_000)))
}

/// The time of a frame of CAN FD: with the higher bit rate, if its flags say so, from the error state indicator to the CRC.
fn fd_length(frame: &Frame) -> Duration {
    const BIT_RATE_SWITCH: u8 = 1;
    let switch = u32::from(frame.flags() & BIT_RATE_SWITCH);
    let mut stuffing = Stuffing::default();
    stuffing.put(0, 1); // start of frame
    match frame.id() {
        // Identifier, no remote request, standard, CAN FD, reserved, bit rate switch.
        Id::Standard(id) => stuffing.put(u32::from(id.as_raw()) << 5 | 0b0_0100 | switch, 16),
        Id::Extended(id) => {
            stuffing.put((id.as_raw() >> 18) << 2 | 0b11, 13);
            stuffing.put((id.as_raw() & 0x3_FFFF) << 4 | 0b0100 | switch, 22);
        }
    }
    let arbitration = stuffing.bits;
    let data = frame.data();
    let code = holdover::wire::load::fd::code_of(data.len());
    stuffing.put(code, 5); // error state indicator, length
    data.iter().for_each(|byte| stuffing.put(u32::from(*byte), 8));
    let fast = stuffing.bits - arbitration + holdover::wire::load::fd::crc_field_bits(data.len());
    let bit_ns = if switch == 1 { DATA_BIT_NS } else { BIT_NS };
    nanos((arbitration + TAIL_BITS) * BIT_NS + fast * bit_ns)
}

/// The number of bits of a frame, stuff bits among them.
fn bits(frame: &Frame) -> u32 {
    let mut stuffing = Stuffing::default();
    let dlc = frame.dlc() as u32;
    let remote = u32::from(frame.is_remote_frame());
    stuffing.put(0, 1); // start of frame
    match frame.id() {
        // Identifier, remote request, two dominant bits.
        Id::Standard(id) => stuffing.put(u32::from(id.as_raw()) << 3 | remote << 2, 14),
        Id::Extended(id) => {
            stuffing.put((id.as_raw() >> 18) << 2 | 0b11, 13);
            stuffing.put((id.as_raw() & 0x3_FFFF) << 3 | remote << 2, 21);
        }
    }
    stuffing.put(dlc, 4);
    frame.data().iter().for_each(|byte| stuffing.put(u32::from(*byte), 8));
    stuffing.put(stuffing.crc.into(), CRC_BITS);
    stuffing.bits + TAIL_BITS
}

/// The bits of a frame up to its CRC.
#[derive(Default)]
struct Stuffing {
    /// Number of bits so far, with stuff bits.
    bits: u32,
    crc: u16,
    /// The last bit, and the number of its equals up to it.
    last: bool,
    equal: u32,
}

impl Stuffing {
    /// Puts the lowest `count` bits of `value`, the highest of them first.
    fn put(&mut self, value: u32, count: u32) {
        for place in (0..count).rev() {
            let bit = value >> place & 1 == 1;
            let divides = bit != (self.crc >> (CRC_BITS - 1) & 1 == 1);
            self.crc = self.crc << 1 & 0x7FFF ^ if divides { CRC_POLYNOMIAL } else { 0 };
            self.put_bit(bit);
            if self.equal == EQUAL_BITS {
                self.put_bit(!bit);
            }
        }
    }

    fn put_bit(&mut self, bit: bool) {
        self.equal = if self.bits > 0 && bit == self.last { self.equal + 1 } else { 1 };
        self.last = bit;
        self.bits += 1;
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

    #[test]
    fn a_frame_has_the_bits_that_can_utils_count() {
        let standard = |id: u16, data: &[u8]| bits(&Frame::standard(id, data).unwrap());
        let extended = |id: u32, data: &[u8]| bits(&Frame::extended(id, data).unwrap());
        assert_eq!(standard(0x123, &[]), 45);
        assert_eq!(standard(0, &[]), 50);
        assert_eq!(standard(0x7FF, &[0; 8]), 123);
        assert_eq!(standard(0x480, &[0x3C; 8]), 126);
        assert_eq!(standard(0x482, &[0, 1, 2, 3, 4, 5, 6, 7]), 118);
        assert_eq!(standard(0x555, &[0x55; 8]), 109);
        assert_eq!(extended(0x1234_5678, &[1, 2, 3]), 92);
        assert_eq!(extended(0, &[0; 8]), 147);
        assert_eq!(extended(0x1FFF_FFFF, &[0xFF; 8]), 146);
    }

    #[test]
    fn a_frame_of_can_fd_has_its_bits_at_two_rates() {
        let micros = |flags, length| {
            let frame = Frame::fd(StandardId::new(0x555).unwrap(), flags, &[0x55; 64][..length]).unwrap();
            super::length(&frame).as_micros()
        };
        // 17 bits of arbitration and 10 at the end; without stuff bits in 0x55: 5 and 8 N bits, 27 or 32 of the CRC. 0b10100 of
        // the header, then the code of the length, has no five equal bits at 8 and 64 bytes.
        assert_eq!(micros(5, 8), 27 * 2 + (5 + 64 + 27) / 2);
        assert_eq!(micros(4, 8), (27 + 5 + 64 + 27) * 2);
        assert!((27 * 2 + (5 + 512 + 32) / 2..27 * 2 + (5 + 512 + 32) / 2 + 3).contains(&micros(5, 64)));
    }

    #[test]
    fn no_frame_of_the_catalogue_takes_longer_than_the_worst_case() {
        for (length, fill) in
            [12, 16, 64].into_iter().flat_map(|length| [0, 0xFF, 0x3C, 0x0F].map(|fill| (length, fill)))
        {
            let frame = Frame::fd(StandardId::ZERO, 5, &[fill; 64][..length]).unwrap();
            let worst = holdover::wire::load::fd::worst_nanos(500_000, 2_000_000, false, length);
            let took = super::length(&frame).plus(super::micros(INTERMISSION_BITS)).as_micros();
            assert!(took <= i64::from(worst.div_ceil(1_000)), "{length} {fill}: {took} us of {worst} ns");
        }
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
        assert_eq!(sent[1].0, sent[0].0.plus(micros(INTERMISSION_BITS)).plus(length(&first)));
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
        let start = end.plus(micros(INTERMISSION_BITS));
        assert_eq!(wire.next_before(start), None);
        wire.want(start, Wanted { from: 3, frame: frame(8) });
        let later = Instant::from_micros(start.as_micros() + 1);
        assert_eq!(wire.next_before(later).unwrap().1.from, 3);
        assert_eq!(wire.next_before(later), None);
    }
}
