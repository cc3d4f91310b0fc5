//! What stands in a frame, without a check of its protection: a frame of either kind of bus enters; its line of the catalogue, its
//! payloads or the vehicle's motion leave; and a frame once more with another counter.

use embedded_can::Frame as _;
use holdover::wire::bits::Payload;
use holdover::wire::catalogue::{self, About, Content, Line, Speaker};
use holdover::wire::fd::{self, layout};
use holdover::wire::motion::Motion;
use holdover::wire::{Data, Frame as WireFrame, Identifiers, Transport, e2e};

use crate::bus::Frame;

/// The line of the catalogue for a frame: on a bus of CAN FD, the one that the frame begins with.
#[must_use]
pub fn line_of(identifiers: &Identifiers, frame: &Frame) -> Option<&'static Line> {
    catalogue::find(identifiers.offset_of(frame.id().into())?).map(|(_, line, _)| line)
}

/// The first two payloads of a frame, of which a classic one has only the first; those of a frame with another length than its
/// line's are empty.
#[must_use]
pub fn payloads(identifiers: &Identifiers, frame: &Frame) -> [Payload; 2] {
    let read = || {
        let (place, ..) = catalogue::find(identifiers.offset_of(frame.id().into())?)?;
        let [first, second, ..] = layout::of(place)?.read(frame.data()).ok()?;
        Some([first.unwrap_or_default(), second.unwrap_or_default()])
    };
    if frame.is_fd() {
        return read().unwrap_or_default();
    }
    [frame.data().try_into().map_or(Payload::EMPTY, Payload::from_bytes), Payload::EMPTY]
}

/// The frame with that counter, and a checksum that fits.
#[must_use]
pub fn recounted(identifiers: &Identifiers, frame: &WireFrame, counter: u8) -> WireFrame {
    let data_id = catalogue::data_id(identifiers.offset_of(frame.id).unwrap_or(0));
    let data = match <[u8; 8]>::try_from(&frame.data[..]) {
        Ok(data) => e2e::protect(data, data_id, counter).into(),
        Err(_) => {
            let mut data: Data = frame.data;
            fd::e2e::protect(&mut data, data_id, counter);
            data
        }
    };
    WireFrame { id: frame.id, data }
}

/// The counter of a frame.
#[must_use]
pub fn counter_of(frame: &Frame) -> u8 {
    let byte = |place: usize| frame.data().get(place).copied().unwrap_or(0);
    if frame.is_fd() { byte(2) } else { byte(1) & 15 }
}

/// The kind of bus that the frames are of.
#[must_use]
pub fn transport_of(frames: &[WireFrame]) -> Transport {
    if frames.iter().any(|frame| frame.data.len() > 8) { Transport::Fd } else { Transport::Classic }
}

/// Puts the vehicle's motion together.
#[derive(Clone, Copy, Debug, Default)]
pub struct EgoMotion {
    /// The first half, of classic CAN.
    first: Payload,
}

impl EgoMotion {
    /// Takes in a frame; the motion that it completes.
    pub fn take(&mut self, identifiers: &Identifiers, frame: &Frame) -> Option<Motion> {
        let Content::Said(Speaker::Ego, about) = line_of(identifiers, frame)?.content else { return None };
        let [first, second] = payloads(identifiers, frame);
        match about {
            About::MotionA if frame.is_fd() => Some(Motion::decode(&[first, second])),
            About::MotionA => {
                self.first = first;
                None
            }
            About::MotionB => Some(Motion::decode(&[self.first, first])),
            _ => None,
        }
    }
}
