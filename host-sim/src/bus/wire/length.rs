//! How long a frame is on the bus: a frame enters; the time of its bits leaves, with the stuff bits that its content and its
//! CRC need.
//!
//! A simulated vehicle has thousands of frames a second on its bus, so bits are counted by bytes, with a table of what a byte
//! does to the run of equal bits and one of what it does to the CRC. In CAN FD the stuff bits around the CRC are fixed, so that
//! its value does not matter.

use embedded_can::{Frame as _, Id};
use holdover::time::Duration;

use crate::bus::Frame;

/// Time of a bit at 500 kbit/s, and at 2 Mbit/s, in ns.
const BIT_NS: u32 = 2_000;
const DATA_BIT_NS: u32 = 500;
/// Delimiter of the CRC, acknowledgement with its delimiter, and end of frame. They are not stuffed.
const TAIL_BITS: u32 = 1 + 2 + 7;
/// The three bits between two frames.
pub(super) const INTERMISSION: Duration = Duration::from_micros(3 * BIT_NS as i64 / 1_000);
/// Bits of the CRC, and its polynomial without the highest term.
const CRC_BITS: u32 = 15;
const CRC_POLYNOMIAL: u16 = 0x4599;
/// After so many equal bits the opposite bit is stuffed.
const EQUAL_BITS: u8 = 5;

/// The time for which the frame is on the bus, from its first bit to the end of the end of frame.
#[must_use]
pub fn length(frame: &Frame) -> Duration {
    match frame.is_fd() {
        true => fd_length(frame),
        false => nanos(bits(frame) * BIT_NS),
    }
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
    stuffing.put_bytes(data);
    let fast = stuffing.bits - arbitration + holdover::wire::load::fd::crc_field_bits(data.len());
    let bit_ns = if switch == 1 { DATA_BIT_NS } else { BIT_NS };
    nanos((arbitration + TAIL_BITS) * BIT_NS + fast * bit_ns)
}

/// The number of bits of a frame, stuff bits among them.
fn bits(frame: &Frame) -> u32 {
    let remote = u64::from(frame.is_remote_frame());
    let dlc = frame.dlc() as u64;
    // Start of frame, identifier, remote request, two dominant bits, length.
    let (header, length) = match frame.id() {
        Id::Standard(id) => (u64::from(id.as_raw()) << 7 | remote << 6 | dlc, 19),
        Id::Extended(id) => {
            let id = u64::from(id.as_raw());
            ((id >> 18) << 27 | 0b11 << 25 | (id & 0x3_FFFF) << 7 | remote << 6 | dlc, 39)
        }
    };
    let mut stuffing = Stuffing::default();
    stuffing.put((header >> 16) as u32, length - 16);
    stuffing.put(header as u32 & 0xFFFF, 16);
    stuffing.put_bytes(frame.data());
    // Dominant bits before the first one do not change a CRC that starts with 0, so the header is one of whole bytes.
    let crc = frame.data().iter().fold(header.to_be_bytes().iter().fold(0, crc_with), crc_with);
    stuffing.put(crc.into(), CRC_BITS);
    stuffing.bits + TAIL_BITS
}

/// The CRC with one more byte.
fn crc_with(crc: u16, byte: &u8) -> u16 {
    let index = (crc >> (CRC_BITS - 8)) as u8 ^ byte;
    (crc << 8 & 0x7FFF) ^ CRC_OF[usize::from(index)]
}

/// The CRC of each byte.
const CRC_OF: [u16; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut crc = (byte as u16) << (CRC_BITS - 8);
        let mut bit = 0;
        while bit < 8 {
            let divides = crc >> (CRC_BITS - 1) & 1 == 1;
            crc = crc << 1 & 0x7FFF ^ if divides { CRC_POLYNOMIAL } else { 0 };
            bit += 1;
        }
        table[byte] = crc;
        byte += 1;
    }
    table
};

/// The end of a run of equal bits: the bit, and how many of them there are, which is 0 before the first bit.
#[derive(Clone, Copy, Default)]
struct Run {
    bit: bool,
    equal: u8,
}

impl Run {
    /// The number of states.
    const STATES: usize = 2 * EQUAL_BITS as usize;

    const fn index(self) -> usize {
        self.bit as usize * EQUAL_BITS as usize + self.equal as usize
    }

    /// With one more bit; returns the number of bits that are stuffed then.
    const fn with(self, bit: bool) -> (Self, u32) {
        let equal = if self.equal > 0 && bit == self.bit { self.equal + 1 } else { 1 };
        if equal == EQUAL_BITS { (Self { bit: !bit, equal: 1 }, 1) } else { (Self { bit, equal }, 0) }
    }

    /// With the lowest `count` bits of `value`, the highest of them first.
    const fn with_bits(self, value: u32, count: u32) -> (Self, u32) {
        let (mut run, mut stuffed, mut place) = (self, 0, count);
        while place > 0 {
            place -= 1;
            let (next, more) = run.with(value >> place & 1 == 1);
            run = next;
            stuffed += more;
        }
        (run, stuffed)
    }
}

/// For each run and each byte: the run behind that byte, and the number of bits that are stuffed in it.
static RUNS: [[(Run, u32); 256]; Run::STATES] = {
    let mut table = [[(Run { bit: false, equal: 0 }, 0); 256]; Run::STATES];
    let mut state = 0;
    while state < Run::STATES {
        let run = Run { bit: state >= EQUAL_BITS as usize, equal: (state % EQUAL_BITS as usize) as u8 };
        let mut byte = 0;
        while byte < 256 {
            table[state][byte] = run.with_bits(byte as u32, 8);
            byte += 1;
        }
        state += 1;
    }
    table
};

/// The bits of a frame up to its CRC.
#[derive(Default)]
struct Stuffing {
    /// Number of bits so far, with stuff bits.
    bits: u32,
    run: Run,
}

impl Stuffing {
    /// Puts the lowest `count` bits of `value`, the highest of them first.
    fn put(&mut self, value: u32, count: u32) {
        let (run, stuffed) = self.run.with_bits(value, count);
        (self.run, self.bits) = (run, self.bits + count + stuffed);
    }

    fn put_bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let (run, stuffed) = RUNS[self.run.index()][usize::from(*byte)];
            (self.run, self.bits) = (run, self.bits + 8 + stuffed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_can::StandardId;
    use proptest::prelude::*;

    /// The bits of a classic frame, one by one.
    fn counted(frame: &Frame) -> u32 {
        let mut sent: Vec<bool> = vec![false];
        let mut put = |value: u32, count: u32| sent.extend((0..count).rev().map(|place| value >> place & 1 == 1));
        let remote = u32::from(frame.is_remote_frame());
        match frame.id() {
            Id::Standard(id) => put(u32::from(id.as_raw()) << 3 | remote << 2, 14),
            Id::Extended(id) => {
                put((id.as_raw() >> 18) << 2 | 0b11, 13);
                put((id.as_raw() & 0x3_FFFF) << 3 | remote << 2, 21);
            }
        }
        put(frame.dlc() as u32, 4);
        frame.data().iter().for_each(|byte| put(u32::from(*byte), 8));
        let crc = sent.iter().fold(0u16, |crc, bit| {
            let divides = *bit != (crc >> 14 & 1 == 1);
            crc << 1 & 0x7FFF ^ if divides { CRC_POLYNOMIAL } else { 0 }
        });
        sent.extend((0..15).rev().map(|place| crc >> place & 1 == 1));
        let mut wire: Vec<bool> = Vec::new();
        for bit in sent {
            wire.push(bit);
            if wire.len() >= 5 && wire[wire.len() - 5..].iter().all(|other| *other == bit) {
                wire.push(!bit);
            }
        }
        wire.len() as u32 + 10
    }

    proptest! {
        #[test]
        fn bits_by_bytes_are_bits_one_by_one(
            id in 0u32..0x2000_0000,
            is_extended: bool,
            data in prop::collection::vec(prop_oneof![Just(0u8), Just(0xFF), any::<u8>()], 0..=8),
        ) {
            let frame = if is_extended { Frame::extended(id, &data) } else { Frame::standard((id & 0x7FF) as u16, &data) };
            let frame = frame.unwrap();
            prop_assert_eq!(bits(&frame), counted(&frame));
        }
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
            let took = super::length(&frame).plus(INTERMISSION).as_micros();
            assert!(took <= i64::from(worst.div_ceil(1_000)), "{length} {fill}: {took} us of {worst} ns");
        }
    }
}
