//! Any CAN frame, classic or CAN FD, of the catalogue or not: the frames on a [`Bus`](super::Bus) and in a log.
//!
//! The core's own frame type holds only what its catalogue uses: standard identifiers and some lengths. A real bus carries
//! other frames too, and the unit has to receive them.

use embedded_can::{ExtendedId, Id, StandardId};

/// The most bytes of a CAN FD frame, and of a classic one.
pub const MOST_BYTES: usize = 64;
const MOST_CLASSIC_BYTES: usize = 8;

/// Flags of a CAN FD frame in Linux: the data are at the higher bit rate, and the frame is CAN FD.
const FLAGS: u8 = 0x5;

/// A data or remote frame of classic CAN, or a frame of CAN FD, with a standard or extended identifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Frame {
    id: Id,
    kind: Kind,
    length: u8,
    data: [u8; MOST_BYTES], // zero beyond `length`, and in remote frames
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Kind {
    Data,
    Remote,
    /// With its flags.
    Fd(u8),
}

impl Frame {
    /// A classic data frame with a standard identifier; `None` above 0x7FF or 8 bytes.
    #[must_use]
    pub fn standard(id: u16, data: &[u8]) -> Option<Self> {
        embedded_can::Frame::new(StandardId::new(id)?, data)
    }

    /// A classic data frame with an extended identifier; `None` above 0x1FFF_FFFF or 8 bytes.
    #[must_use]
    pub fn extended(id: u32, data: &[u8]) -> Option<Self> {
        embedded_can::Frame::new(ExtendedId::new(id)?, data)
    }

    /// A CAN FD frame with the flags of Linux (1: the data are at the higher bit rate, 2: the sender is error passive, 4: the
    /// frame is CAN FD), of which the lowest four bits count. `None` above 64 bytes.
    #[must_use]
    pub fn fd(id: impl Into<Id>, flags: u8, data: &[u8]) -> Option<Self> {
        Self::of(id.into(), Kind::Fd(flags & 0xF), data)
    }

    fn of(id: Id, kind: Kind, data: &[u8]) -> Option<Self> {
        let mut bytes = [0; MOST_BYTES];
        bytes.get_mut(..data.len())?.copy_from_slice(data);
        Some(Self { id, kind, length: u8::try_from(data.len()).ok()?, data: bytes })
    }

    /// Whether it is one of CAN FD.
    #[must_use]
    pub fn is_fd(&self) -> bool {
        matches!(self.kind, Kind::Fd(_))
    }

    /// The flags of a CAN FD frame, 0 to 15; 0 of a classic one.
    #[must_use]
    pub fn flags(&self) -> u8 {
        if let Kind::Fd(flags) = self.kind { flags } else { 0 }
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

    /// The same frame with at most its first bytes.
    #[must_use]
    pub fn cut_to(&self, length: usize) -> Self {
        let data = embedded_can::Frame::data(self);
        Self::of(self.id, self.kind, data.get(..length).unwrap_or(data)).unwrap_or(*self)
    }
}

impl embedded_can::Frame for Frame {
    /// A classic frame.
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        Self::of(id.into(), Kind::Data, data).filter(|_| data.len() <= MOST_CLASSIC_BYTES)
    }

    fn new_remote(id: impl Into<Id>, dlc: usize) -> Option<Self> {
        let length = u8::try_from(dlc).ok().filter(|&dlc| usize::from(dlc) <= MOST_CLASSIC_BYTES)?;
        Some(Self { length, ..Self::of(id.into(), Kind::Remote, &[])? })
    }

    fn is_extended(&self) -> bool {
        matches!(self.id, Id::Extended(_))
    }

    fn is_remote_frame(&self) -> bool {
        self.kind == Kind::Remote
    }

    fn id(&self) -> Id {
        self.id
    }

    /// The number of bytes, also of CAN FD.
    fn dlc(&self) -> usize {
        self.length.into()
    }

    fn data(&self) -> &[u8] {
        if self.is_remote_frame() { &[] } else { &self.data[..self.length.into()] }
    }
}

/// From the frame of any implementation, by its length: above 8 bytes it is one of CAN FD with the higher bit rate. If there are
/// more than 64 nevertheless, the rest is cut off.
impl<F: embedded_can::Frame> From<&F> for Frame {
    fn from(other: &F) -> Self {
        let (id, data) = (other.id(), other.data());
        let data = data.get(..MOST_BYTES).unwrap_or(data);
        let kind = match (other.is_remote_frame(), data.len() <= MOST_CLASSIC_BYTES) {
            (true, _) => Kind::Remote,
            (false, true) => Kind::Data,
            (false, false) => Kind::Fd(FLAGS),
        };
        let mut frame = Self { id, kind, length: other.dlc().min(MOST_BYTES) as u8, data: [0; MOST_BYTES] };
        frame.data.iter_mut().zip(data).for_each(|(to, from)| *to = *from);
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
        assert!(frame.is_extended() && frame.is_data_frame() && !frame.is_fd());
        assert_eq!((frame.dlc(), frame.data()), (3, &[1, 2, 3][..]));
        assert_eq!(Frame::from(&frame), frame);
        let remote = Frame::new_remote(StandardId::new(5).unwrap(), 8).unwrap();
        assert_eq!((remote.dlc(), remote.data(), remote.is_remote_frame()), (8, &[][..], true));
        assert_eq!(Frame::from(&remote), remote);
        let long = Frame::fd(StandardId::new(5).unwrap(), 5, &[7; 64]).unwrap();
        assert_eq!((long.is_fd(), long.flags(), long.dlc(), long.data()), (true, 5, 64, &[7; 64][..]));
        assert_eq!(Frame::from(&long), long);
        assert_eq!(long.cut_to(4), Frame::fd(StandardId::new(5).unwrap(), 5, &[7; 4]).unwrap());
    }

    #[test]
    fn what_a_frame_cannot_be_is_none() {
        assert_eq!(Frame::standard(0x800, &[]), None);
        assert_eq!(Frame::extended(0x2000_0000, &[]), None);
        assert_eq!(Frame::standard(1, &[0; 9]), None);
        assert_eq!(Frame::new_remote(StandardId::ZERO, 9), None);
        assert_eq!(Frame::fd(StandardId::ZERO, 0, &[0; 65]), None);
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
