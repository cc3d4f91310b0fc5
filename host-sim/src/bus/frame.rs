//! Any classic CAN frame, of the catalogue or not: the frames on a [`Bus`](super::Bus) and in a log.
//!
//! The core's own frame type holds only what its catalogue uses: standard identifiers and 8 bytes. A real bus carries
//! other frames too, and the unit has to receive them.

use embedded_can::{ExtendedId, Id, StandardId};

/// A data or remote frame with a standard or extended identifier and 0 to 8 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Frame {
    id: Id,
    remote: bool,
    dlc: u8,
    data: [u8; 8], // zero beyond `dlc`, and in remote frames
}

impl Frame {
    /// A data frame with a standard identifier; `None` above 0x7FF or 8 bytes.
    #[must_use]
    pub fn standard(id: u16, data: &[u8]) -> Option<Self> {
        embedded_can::Frame::new(StandardId::new(id)?, data)
    }

    /// A data frame with an extended identifier; `None` above 0x1FFF_FFFF or 8 bytes.
    #[must_use]
    pub fn extended(id: u32, data: &[u8]) -> Option<Self> {
        embedded_can::Frame::new(ExtendedId::new(id)?, data)
    }

    /// The same frame with one bit of its data flipped. Bits are counted from the lowest bit of the first byte, modulo
    /// their number. A frame without data is unchanged.
    #[must_use]
    pub fn with_flipped_bit(mut self, bit: usize) -> Self {
        let bits = embedded_can::Frame::data(&self).len() * 8;
        if bits > 0 {
            let bit = bit % bits;
            self.data[bit / 8] ^= 1 << (bit % 8);
        }
        self
    }
}

impl embedded_can::Frame for Frame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        let mut frame = Self::new_remote(id, data.len())?;
        frame.remote = false;
        frame.data.get_mut(..data.len())?.copy_from_slice(data);
        Some(frame)
    }

    fn new_remote(id: impl Into<Id>, dlc: usize) -> Option<Self> {
        let dlc = u8::try_from(dlc).ok().filter(|&dlc| dlc <= 8)?;
        Some(Self { id: id.into(), remote: true, dlc, data: [0; 8] })
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
        self.dlc.into()
    }

    fn data(&self) -> &[u8] {
        if self.remote { &[] } else { &self.data[..self.dlc.into()] }
    }
}

/// From the classic frame of any implementation. By the trait's contract its lengths and identifiers are legal. If
/// there are more than 8 bytes nevertheless, the rest is cut off.
impl<F: embedded_can::Frame> From<&F> for Frame {
    fn from(other: &F) -> Self {
        let dlc = other.dlc().min(8);
        let mut frame = Self { id: other.id(), remote: other.is_remote_frame(), dlc: dlc as u8, data: [0; 8] };
        if !frame.remote {
            for (to, from) in frame.data.iter_mut().zip(&other.data()[..dlc]) {
                *to = *from;
            }
        }
        frame
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_can::Frame as _;

    #[test]
    fn a_frame_is_what_it_was_made_from() {
        let frame = Frame::extended(0x1234_5678, &[1, 2, 3]).unwrap();
        assert!(frame.is_extended() && frame.is_data_frame());
        assert_eq!((frame.dlc(), frame.data()), (3, &[1, 2, 3][..]));
        assert_eq!(Frame::from(&frame), frame);
        let remote = Frame::new_remote(StandardId::new(5).unwrap(), 8).unwrap();
        assert_eq!((remote.dlc(), remote.data(), remote.is_remote_frame()), (8, &[][..], true));
        assert_eq!(Frame::from(&remote), remote);
    }

    #[test]
    fn what_a_classic_frame_cannot_be_is_none() {
        assert_eq!(Frame::standard(0x800, &[]), None);
        assert_eq!(Frame::extended(0x2000_0000, &[]), None);
        assert_eq!(Frame::standard(1, &[0; 9]), None);
        assert_eq!(Frame::new_remote(StandardId::ZERO, 9), None);
    }

    #[test]
    fn a_flipped_bit_is_one_bit_of_the_data_that_there_is() {
        let frame = Frame::standard(1, &[0, 0]).unwrap();
        assert_eq!(frame.with_flipped_bit(9).data(), [0, 2]);
        assert_eq!(frame.with_flipped_bit(16).data(), [1, 0]);
        let empty = Frame::standard(1, &[]).unwrap();
        assert_eq!(empty.with_flipped_bit(3), empty);
    }
}
