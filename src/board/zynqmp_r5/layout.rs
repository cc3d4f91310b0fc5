//! How a frame stands in the four words of the CAN controller's queues: frames enter and words leave, and the other way
//! round. The chip and the emulator's model of it do it differently, and here alone is what the difference is.

use crate::board::acceptance::Pattern;
use crate::board::frame::CanFrame;
use embedded_can::{ExtendedId, Frame, Id, StandardId};

/// Identifier, length, first and last four bytes of data.
pub type Words = [u32; 4];

/// Whose words they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// The chip's (UG1087): identifier from the highest bit on, as it is sent; the first byte of data is the highest.
    Silicon,
    /// The emulator's: the identifier word is that of Linux, and the first byte of data is the lowest.
    Model,
}

/// The length stands in the highest four bits; on reception a time stamp in the lowest sixteen.
const LENGTH_SHIFT: u32 = 28;

/// A standard identifier, or the first eleven bits of an extended one, on the chip.
const STANDARD_SHIFT: u32 = 21;
/// The other eighteen.
const EXTENDED_SHIFT: u32 = 1;
const EXTENDED_BITS: u32 = 18;
/// A standard remote frame; always set in an extended one.
const STANDARD_REMOTE: u32 = 1 << 20;
const EXTENDED: u32 = 1 << 19;
const EXTENDED_REMOTE: u32 = 1;

/// Linux's flags.
const LINUX_EXTENDED: u32 = 1 << 31;
const LINUX_REMOTE: u32 = 1 << 30;

impl Layout {
    /// The words of a frame.
    pub fn words(self, frame: &CanFrame) -> Words {
        let remote = frame.is_remote_frame();
        let id = match (self, frame.id()) {
            (Self::Silicon, Id::Standard(id)) => {
                u32::from(id.as_raw()) << STANDARD_SHIFT | if remote { STANDARD_REMOTE } else { 0 }
            }
            (Self::Silicon, Id::Extended(id)) => {
                let (high, low) = (id.as_raw() >> EXTENDED_BITS, id.as_raw() & ((1 << EXTENDED_BITS) - 1));
                let flags = STANDARD_REMOTE | EXTENDED | if remote { EXTENDED_REMOTE } else { 0 };
                high << STANDARD_SHIFT | low << EXTENDED_SHIFT | flags
            }
            (Self::Model, Id::Standard(id)) => u32::from(id.as_raw()) | if remote { LINUX_REMOTE } else { 0 },
            (Self::Model, Id::Extended(id)) => id.as_raw() | LINUX_EXTENDED | if remote { LINUX_REMOTE } else { 0 },
        };
        let mut data = [0; 8];
        for (place, byte) in data.iter_mut().zip(frame.data()) {
            *place = *byte;
        }
        let [a, b, c, d, e, f, g, h] = data;
        let [first, last] = [[a, b, c, d], [e, f, g, h]].map(|bytes| match self {
            Self::Silicon => u32::from_be_bytes(bytes),
            Self::Model => u32::from_le_bytes(bytes),
        });
        [id, (frame.dlc() as u32) << LENGTH_SHIFT, first, last]
    }

    /// The frame of these words. A length above 8 says 8, as on the bus.
    pub fn frame(self, [id, length, first, last]: Words) -> Option<CanFrame> {
        let length = (length >> LENGTH_SHIFT).min(8) as usize;
        let (id, remote): (Id, bool) = match self {
            Self::Silicon if id & EXTENDED != 0 => {
                let low = id >> EXTENDED_SHIFT & ((1 << EXTENDED_BITS) - 1);
                let raw = id >> STANDARD_SHIFT << EXTENDED_BITS | low;
                (ExtendedId::new(raw)?.into(), id & EXTENDED_REMOTE != 0)
            }
            Self::Silicon => (StandardId::new((id >> STANDARD_SHIFT) as u16)?.into(), id & STANDARD_REMOTE != 0),
            Self::Model if id & LINUX_EXTENDED != 0 => {
                (ExtendedId::new(id & 0x1fff_ffff)?.into(), id & LINUX_REMOTE != 0)
            }
            Self::Model => (StandardId::new((id & 0x7ff) as u16)?.into(), id & LINUX_REMOTE != 0),
        };
        if remote {
            return CanFrame::new_remote(id, length);
        }
        let [[a, b, c, d], [e, f, g, h]] = [first, last].map(|word| match self {
            Self::Silicon => word.to_be_bytes(),
            Self::Model => word.to_le_bytes(),
        });
        CanFrame::new(id, [a, b, c, d, e, f, g, h].get(..length)?)
    }

    /// The two words of an acceptance filter: which bits of the identifier word are asked for, and what they have to be. Remote frames
    /// pass like others: the unit refuses them by name.
    pub fn filter(self, pattern: &Pattern) -> [u32; 2] {
        let word = |bits: u32| match (self, pattern.is_extended) {
            (Self::Silicon, false) => bits << STANDARD_SHIFT,
            (Self::Silicon, true) => {
                bits >> EXTENDED_BITS << STANDARD_SHIFT | (bits & ((1 << EXTENDED_BITS) - 1)) << EXTENDED_SHIFT
            }
            (Self::Model, _) => bits,
        };
        let flag = if self == Self::Silicon { EXTENDED } else { LINUX_EXTENDED };
        [word(pattern.mask) | flag, word(pattern.bits) | if pattern.is_extended { flag } else { 0 }]
    }
}
