//! One CAN frame: what [`super::Sender`] emits. On classic CAN it has 8 data bytes; with the feature
//! `fd` there may be as many as a frame of CAN FD has.

use core::ops::{Deref, DerefMut};

use embedded_can::Id;

use super::identifier::Identifier;

/// The most bytes that a frame's data can have here.
pub const MOST_BYTES: usize = if cfg!(feature = "fd") { 64 } else { 8 };

/// The data of a frame: 8 bytes, or on CAN FD 8, 12, 16, 20, 24, 32, 48 or 64.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Data {
    /// 0 beyond the length.
    bytes: [u8; MOST_BYTES],
    #[cfg(feature = "fd")]
    length: u8,
}

impl Data {
    /// `None` if no frame has so many bytes.
    #[must_use]
    pub fn new(data: &[u8]) -> Option<Self> {
        let is_length =
            data.len() == 8 || cfg!(feature = "fd") && matches!(data.len(), 12 | 16 | 20 | 24 | 32 | 48 | 64);
        let mut bytes = [0; MOST_BYTES];
        bytes.get_mut(..data.len()).filter(|_| is_length)?.copy_from_slice(data);
        Some(Self {
            bytes,
            #[cfg(feature = "fd")]
            length: u8::try_from(data.len()).ok()?,
        })
    }
}

impl From<[u8; 8]> for Data {
    #[cfg(not(feature = "fd"))]
    fn from(bytes: [u8; 8]) -> Self {
        Self { bytes }
    }

    #[cfg(feature = "fd")]
    fn from(data: [u8; 8]) -> Self {
        let mut bytes = [0; MOST_BYTES];
        bytes.iter_mut().zip(data).for_each(|(to, from)| *to = from);
        Self { bytes, length: 8 }
    }
}

impl Deref for Data {
    type Target = [u8];

    #[cfg(not(feature = "fd"))]
    fn deref(&self) -> &[u8] {
        &self.bytes
    }

    #[cfg(feature = "fd")]
    fn deref(&self) -> &[u8] {
        self.bytes.get(..usize::from(self.length)).unwrap_or_default()
    }
}

impl DerefMut for Data {
    #[cfg(not(feature = "fd"))]
    fn deref_mut(&mut self) -> &mut [u8] {
        &mut self.bytes
    }

    #[cfg(feature = "fd")]
    fn deref_mut(&mut self) -> &mut [u8] {
        self.bytes.get_mut(..usize::from(self.length)).unwrap_or_default()
    }
}

/// A data frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Frame {
    /// The identifier.
    pub id: Identifier,
    /// The data, CRC first.
    pub data: Data,
}

impl embedded_can::Frame for Frame {
    /// `None` unless the data have a length that there is ([`Data`]).
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        Some(Self { id: id.into().into(), data: Data::new(data)? })
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

    /// The number of bytes, also of more than 8: not the code that stands for it in a frame of CAN FD.
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
    fn only_lengths_that_there_are_make_a_frame() {
        let id = StandardId::new(0x480).unwrap();
        let frame = Frame::new(id, &[1, 2, 3, 4, 5, 6, 7, 8]).unwrap();
        assert_eq!((frame.id(), frame.data(), frame.dlc()), (Id::Standard(id), &[1, 2, 3, 4, 5, 6, 7, 8][..], 8));
        let extended = Frame::new(ExtendedId::new(0x480).unwrap(), &[0; 8]).unwrap();
        assert!(extended.is_extended() && !frame.is_extended() && extended.id != frame.id);
        assert_eq!(Frame::new_remote(id, 8), None);
        for length in (0..=70).filter(|length| *length != 8) {
            let is_of_fd = cfg!(feature = "fd") && [12, 16, 20, 24, 32, 48, 64].contains(&length);
            assert_eq!(Frame::new(id, &[3; 70][..length]).map(|frame| frame.dlc()), is_of_fd.then_some(length));
        }
    }
}
