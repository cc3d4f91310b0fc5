//! How a frame stands in the message RAM of FDCAN, for sending and for receiving, and how a filter does: frames and patterns enter
//! and words leave, and the other way round.

use crate::board::acceptance::Pattern;
use crate::board::frame::CanFrame;
use embedded_can::{ExtendedId, Frame, Id, StandardId};

/// Identifier, length, first and last four bytes of data, the first byte lowest.
pub type Words = [u32; 4];

/// In the word of the identifier: an extended one, a remote frame.
const EXTENDED: u32 = 1 << 30;
const REMOTE: u32 = 1 << 29;
/// A standard identifier stands where the first bits of an extended one do.
const STANDARD_SHIFT: u32 = 18;
/// In the word of the length.
const LENGTH_SHIFT: u32 = 16;

/// The words of a frame. All else in them is 0: a classic frame, of which no event is stored.
pub fn words(frame: &CanFrame) -> Words {
    let id = match frame.id() {
        Id::Standard(id) => u32::from(id.as_raw()) << STANDARD_SHIFT,
        Id::Extended(id) => id.as_raw() | EXTENDED,
    };
    let remote = if frame.is_remote_frame() { REMOTE } else { 0 };
    let data = frame.data().iter().rev().fold(0u64, |data, &byte| data << 8 | u64::from(byte));
    [id | remote, (frame.dlc() as u32) << LENGTH_SHIFT, data as u32, (data >> 32) as u32]
}

/// The frame of received words; in that of the length there is more. `None` if there is no such frame.
pub fn frame([id, length, low, high]: Words) -> Option<CanFrame> {
    // A length above 8 is one that the bus knows, and says 8.
    let length = (length >> LENGTH_SHIFT & 0xf).min(8) as usize;
    let name: Id = if id & EXTENDED != 0 {
        ExtendedId::new(id & 0x1fff_ffff)?.into()
    } else {
        StandardId::new((id >> STANDARD_SHIFT & 0x7ff) as u16)?.into()
    };
    if id & REMOTE != 0 {
        return CanFrame::new_remote(name, length);
    }
    let data = (u64::from(high) << 32 | u64::from(low)).to_le_bytes();
    CanFrame::new(name, data.get(..length)?)
}

/// Filters: identifier and mask, into the first queue.
const STANDARD_MASKED: u32 = 0b10 << 30 | 0b001 << 27;
const EXTENDED_QUEUE: u32 = 0b001 << 29;
const EXTENDED_MASKED: u32 = 0b10 << 30;

/// The word of a filter for standard identifiers.
pub fn standard_filter(pattern: &Pattern) -> u32 {
    STANDARD_MASKED | (pattern.bits & 0x7ff) << 16 | pattern.mask & 0x7ff
}

/// The two words of a filter for extended ones.
pub fn extended_filter(pattern: &Pattern) -> [u32; 2] {
    [EXTENDED_QUEUE | pattern.bits & 0x1fff_ffff, EXTENDED_MASKED | pattern.mask & 0x1fff_ffff]
}
