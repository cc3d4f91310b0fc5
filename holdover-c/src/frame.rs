//! CAN frames: what a C driver received enters as the core's frame, and what the core sends leaves as C's.

use embedded_can::{ExtendedId, Id, StandardId};

use crate::status::Status;

/// A classic CAN frame. The library sends frames with 8 bytes only.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Frame {
    /// The identifier; up to 0x7FF, or 0x1FFFFFFF if it is an extended one.
    pub id: u32,
    /// Not 0: the identifier has 29 bits.
    pub extended: u8,
    /// Not 0: a remote frame.
    pub remote: u8,
    /// Bytes of data; up to 8.
    pub length: u8,
    /// The data; what lies behind its length is ignored.
    pub data: [u8; 8],
}

impl From<&holdover::wire::Frame> for Frame {
    fn from(frame: &holdover::wire::Frame) -> Self {
        let mut data = [0; 8];
        data.iter_mut().zip(frame.data.iter()).for_each(|(to, from)| *to = *from);
        Self { id: frame.id.number(), extended: u8::from(frame.id.is_extended()), remote: 0, length: 8, data }
    }
}

/// A frame that can have been on a bus.
pub struct Heard {
    id: Id,
    remote: bool,
    length: u8,
    data: [u8; 8],
}

impl TryFrom<&Frame> for Heard {
    type Error = Status;

    /// Of C's frame.
    fn try_from(frame: &Frame) -> Result<Self, Status> {
        let id = if frame.extended != 0 {
            ExtendedId::new(frame.id).map(Id::Extended)
        } else {
            u16::try_from(frame.id).ok().and_then(StandardId::new).map(Id::Standard)
        };
        let id = id.ok_or(Status::FrameId)?;
        if frame.length > 8 {
            return Err(Status::FrameLength);
        }
        Ok(Self { id, remote: frame.remote != 0, length: frame.length, data: frame.data })
    }
}

impl embedded_can::Frame for Heard {
    /// `None` for more than 8 bytes.
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        let mut held = [0; 8];
        held.get_mut(..data.len())?.copy_from_slice(data);
        Some(Self { id: id.into(), remote: false, length: u8::try_from(data.len()).ok()?, data: held })
    }

    /// `None` for more than 8 bytes.
    fn new_remote(id: impl Into<Id>, dlc: usize) -> Option<Self> {
        let length = u8::try_from(dlc).ok().filter(|length| *length <= 8)?;
        Some(Self { id: id.into(), remote: true, length, data: [0; 8] })
    }

    fn is_extended(&self) -> bool {
        matches!(self.id, Id::Extended(_))
    }

    fn is_remote_frame(&self) -> bool {
        self.remote
    }

    fn id(&self) -> Id {
        self.id
    }

    fn dlc(&self) -> usize {
        usize::from(self.length)
    }

    /// Nothing for a remote frame.
    fn data(&self) -> &[u8] {
        let length = if self.remote { 0 } else { usize::from(self.length) };
        self.data.get(..length).unwrap_or_default()
    }
}
