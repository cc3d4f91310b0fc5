//! One classic CAN frame with an 11-bit identifier and 8 data bytes: what [`super::Sender`] emits.

use embedded_can::{Id, StandardId};

/// A data frame of 8 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Frame {
    /// The identifier; 0 to 0x7FF.
    pub id: u16,
    /// The data, CRC first.
    pub data: [u8; 8],
}

impl embedded_can::Frame for Frame {
    /// `None` unless the identifier is standard and there are exactly 8 bytes.
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        match id.into() {
            Id::Standard(id) => Some(Self { id: id.as_raw(), data: data.try_into().ok()? }),
            Id::Extended(_) => None,
        }
    }

    /// Always `None`: the catalogue has no remote frames.
    fn new_remote(_id: impl Into<Id>, _dlc: usize) -> Option<Self> {
        None
    }

    fn is_extended(&self) -> bool {
        false
    }

    fn is_remote_frame(&self) -> bool {
        false
    }

    /// The identifier's low 11 bits.
    fn id(&self) -> Id {
        Id::Standard(StandardId::new(self.id & 0x7FF).unwrap_or(StandardId::ZERO))
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
    use embedded_can::{ExtendedId, Frame as _};

    #[test]
    fn only_eight_bytes_on_a_standard_identifier_make_a_frame() {
        let id = StandardId::new(0x480).unwrap();
        let frame = Frame::new(id, &[1, 2, 3, 4, 5, 6, 7, 8]).unwrap();
        assert_eq!((frame.id(), frame.data(), frame.dlc()), (Id::Standard(id), &[1, 2, 3, 4, 5, 6, 7, 8][..], 8));
        assert_eq!(Frame::new(id, &[0; 7]), None);
        assert_eq!(Frame::new(ExtendedId::new(0x480).unwrap(), &[0; 8]), None);
        assert_eq!(Frame::new_remote(id, 8), None);
    }
}
