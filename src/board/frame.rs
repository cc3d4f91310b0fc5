//! A classic CAN frame in memory, as the serial line brings it and takes it. Dozens of them wait in queues, so it is 16 bytes long.

use embedded_can::{Frame, Id};
use holdover::wire::Identifier;

/// A data or remote frame with a standard or extended identifier.
#[derive(Clone)]
pub struct CanFrame {
    id: Identifier,
    data: [u8; 8],
    /// Of the data, or what a remote frame asks for.
    length: u8,
    is_remote: bool,
}

impl Frame for CanFrame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        let mut bytes = [0; 8];
        bytes.get_mut(..data.len())?.copy_from_slice(data);
        Some(Self { id: id.into().into(), data: bytes, length: data.len() as u8, is_remote: false })
    }

    fn new_remote(id: impl Into<Id>, dlc: usize) -> Option<Self> {
        (dlc <= 8).then(|| Self { id: id.into().into(), data: [0; 8], length: dlc as u8, is_remote: true })
    }

    fn is_extended(&self) -> bool {
        self.id.is_extended()
    }

    fn is_remote_frame(&self) -> bool {
        self.is_remote
    }

    fn id(&self) -> Id {
        self.id.into()
    }

    fn dlc(&self) -> usize {
        usize::from(self.length)
    }

    fn data(&self) -> &[u8] {
        let length = if self.is_remote { 0 } else { self.dlc() };
        self.data.get(..length).unwrap_or_default()
    }
}
