//! How a frame stands in the four words of a mailbox of bxCAN, for sending and for receiving: frames enter and words leave, and
//! the other way round.

use crate::board::acceptance::Pattern;
use crate::board::frame::CanFrame;
use embedded_can::{ExtendedId, Frame, Id, StandardId};

/// Identifier, length, first and last four bytes of data, the first byte lowest.
pub type Words = [u32; 4];

/// In the word of the identifier: to be sent, a remote frame, an extended one.
pub const REQUEST: u32 = 1 << 0;
const REMOTE: u32 = 1 << 1;
const EXTENDED: u32 = 1 << 2;
const STANDARD_SHIFT: u32 = 21;
const EXTENDED_SHIFT: u32 = 3;

/// The words of a frame, without the request.
pub fn words(frame: &CanFrame) -> Words {
    let id = match frame.id() {
        Id::Standard(id) => u32::from(id.as_raw()) << STANDARD_SHIFT,
        Id::Extended(id) => id.as_raw() << EXTENDED_SHIFT | EXTENDED,
    };
    let remote = if frame.is_remote_frame() { REMOTE } else { 0 };
    let data = frame.data().iter().rev().fold(0u64, |data, &byte| data << 8 | u64::from(byte));
    [id | remote, frame.dlc() as u32, data as u32, (data >> 32) as u32]
}

/// The frame of received words; in that of the length there is more. `None` if there is no such frame.
pub fn frame([id, length, low, high]: Words) -> Option<CanFrame> {
    // A length above 8 is one that the bus knows, and says 8.
    let length = (length & 0xf).min(8) as usize;
    let name: Id = if id & EXTENDED != 0 {
        ExtendedId::new(id >> EXTENDED_SHIFT)?.into()
    } else {
        StandardId::new((id >> STANDARD_SHIFT) as u16)?.into()
    };
    if id & REMOTE != 0 {
        return CanFrame::new_remote(name, length);
    }
    let data = (u64::from(high) << 32 | u64::from(low)).to_le_bytes();
    CanFrame::new(name, data.get(..length)?)
}

/// The two words of a filter bank: the identifier, and which of its bits are asked for, as they stand in a mailbox.
pub fn filter(pattern: &Pattern) -> [u32; 2] {
    let (shift, kind) = if pattern.is_extended { (EXTENDED_SHIFT, EXTENDED) } else { (STANDARD_SHIFT, 0) };
    [pattern.bits << shift | kind, pattern.mask << shift | EXTENDED]
}
