//! A CAN FD frame, to be recorded. The units speak classic CAN, so no node sends one.

use embedded_can::Id;

/// The most bytes of a CAN FD frame.
pub const MOST_BYTES: usize = 64;

/// A CAN FD frame with a standard or extended identifier and up to 64 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct FdFrame {
    id: Id,
    flags: u8,
    length: u8,
    data: [u8; MOST_BYTES], // zero beyond `length`
}

impl FdFrame {
    /// A frame with the flags of Linux (1: the data are at the higher bit rate, 2: the sender is error passive, 4: the
    /// frame is CAN FD), of which the lowest four bits count. `None` above 64 bytes.
    #[must_use]
    pub fn new(id: impl Into<Id>, flags: u8, data: &[u8]) -> Option<Self> {
        let mut bytes = [0; MOST_BYTES];
        bytes.get_mut(..data.len())?.copy_from_slice(data);
        Some(Self { id: id.into(), flags: flags & 0xF, length: u8::try_from(data.len()).ok()?, data: bytes })
    }

    /// Its identifier.
    #[must_use]
    pub fn id(&self) -> Id {
        self.id
    }

    /// Its flags, 0 to 15.
    #[must_use]
    pub fn flags(&self) -> u8 {
        self.flags
    }

    /// Its data.
    #[must_use]
    pub fn data(&self) -> &[u8] {
        &self.data[..self.length.into()]
    }
}
