//! One classic CAN frame with 8 data bytes: what [`super::Sender`] emits.

use embedded_can::Id;

use super::identifier::Identifier;

/// A data frame of 8 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Frame {
    /// The identifier.
    pub id: Identifier,
    /// The data, CRC first.
    pub data: [u8; 8],
}

impl embedded_can::Frame for Frame {
    /// `None` unless there are exactly 8 bytes.
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        Some(Self { id: id.into().into(), data: data.try_into().ok()? })
    }

    /// Always `None`: the catalogue has no remote frames.
    fn new_remote(_id: impl Into<Id>, _dlc: usize) -> Option<Self> {
        None
    }

    fn is_extended(&self) -> bool {
        self.id.is_extended()
    }

    fn is_remote_frame(&self) -> bool {
        false
    }

    fn id(&self) -> Id {
        self.id.into()
    }

    fn dlc(&self) -> usize {
        self.data.len()
    }

    fn data(&self) -> &[u8] {
        &self.data
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_can::{ExtendedId, Frame as _, StandardId};

    #[test]
    fn only_eight_bytes_make_a_frame() {
        let id = StandardId::new(0x480).unwrap();
        let frame = Frame::new(id, &[1, 2, 3, 4, 5, 6, 7, 8]).unwrap();
        assert_eq!((frame.id(), frame.data(), frame.dlc()), (Id::Standard(id), &[1, 2, 3, 4, 5, 6, 7, 8][..], 8));
        assert_eq!(Frame::new(id, &[0; 7]), None);
        let extended = Frame::new(ExtendedId::new(0x480).unwrap(), &[0; 8]).unwrap();
        assert!(extended.is_extended() && !frame.is_extended() && extended.id != frame.id);
        assert_eq!(Frame::new_remote(id, 8), None);
    }
}
