//! A classic CAN frame in memory, as the serial line brings it and takes it.

use embedded_can::{Frame, Id};
use heapless::Vec;

/// A data or remote frame with a standard or extended identifier.
#[derive(Clone)]
pub struct CanFrame {
    id: Id,
    data: Vec<u8, 8>,
    /// The length that a remote frame asks for; such a frame has no data.
    remote: Option<usize>,
}

impl Frame for CanFrame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        Some(Self { id: id.into(), data: Vec::from_slice(data).ok()?, remote: None })
    }

    fn new_remote(id: impl Into<Id>, dlc: usize) -> Option<Self> {
        (dlc <= 8).then(|| Self { id: id.into(), data: Vec::new(), remote: Some(dlc) })
    }

    fn is_extended(&self) -> bool {
        matches!(self.id, Id::Extended(_))
    }

    fn is_remote_frame(&self) -> bool {
        self.remote.is_some()
    }

    fn id(&self) -> Id {
        self.id
    }

    fn dlc(&self) -> usize {
        self.remote.unwrap_or(self.data.len())
    }

    fn data(&self) -> &[u8] {
        &self.data
    }
}
