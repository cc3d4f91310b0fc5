//! The records of a log: what happened at an instant enters, as many bytes for each leave; and the other way round.

use embedded_can::{ExtendedId, Id, StandardId};
use holdover::time::Instant;

/// Bytes of a record: 7 of time, the length, 4 of identifier, 8 of data.
pub const RECORD: usize = 20;
/// The identifier that stands for a tick.
const TICK: u32 = u32::MAX;
/// Above the 29 bits of an extended identifier.
const STANDARD: u32 = 1 << 31;

/// What happens at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A frame arrives; its data count up to the length.
    Frame(Frame),
    /// The unit ticks.
    Tick,
}

/// A frame of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// The identifier.
    pub id: Id,
    /// Bytes of data.
    pub length: u8,
    /// The data.
    pub data: [u8; 8],
}

impl embedded_can::Frame for Frame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        let mut bytes = [0; 8];
        bytes.get_mut(..data.len())?.copy_from_slice(data);
        Some(Self { id: id.into(), length: data.len() as u8, data: bytes })
    }

    fn new_remote(_: impl Into<Id>, _: usize) -> Option<Self> {
        None
    }

    fn is_extended(&self) -> bool {
        matches!(self.id, Id::Extended(_))
    }

    fn is_remote_frame(&self) -> bool {
        false
    }

    fn id(&self) -> Id {
        self.id
    }

    fn dlc(&self) -> usize {
        self.length.into()
    }

    fn data(&self) -> &[u8] {
        self.data.get(..self.length.into()).unwrap_or_default()
    }
}

/// The record of an event. Times have 56 bits: two thousand years.
pub fn encode(at: Instant, event: &Event) -> [u8; RECORD] {
    let (id, length, data) = match event {
        Event::Tick => (TICK, 0, [0; 8]),
        Event::Frame(frame) => {
            let id = match frame.id {
                Id::Standard(id) => STANDARD | u32::from(id.as_raw()),
                Id::Extended(id) => id.as_raw(),
            };
            (id, frame.length, frame.data)
        }
    };
    let [t0, t1, t2, t3, t4, t5, t6, _] = at.as_micros().to_le_bytes();
    let [i0, i1, i2, i3] = id.to_le_bytes();
    let [d0, d1, d2, d3, d4, d5, d6, d7] = data;
    [t0, t1, t2, t3, t4, t5, t6, length, i0, i1, i2, i3, d0, d1, d2, d3, d4, d5, d6, d7]
}

/// The event of a record; `None` of what is none.
pub fn decode(record: &[u8; RECORD]) -> Option<(Instant, Event)> {
    let [t0, t1, t2, t3, t4, t5, t6, length, i0, i1, i2, i3, data @ ..] = *record;
    let at = Instant::from_micros(u64::from_le_bytes([t0, t1, t2, t3, t4, t5, t6, 0]));
    let id = u32::from_le_bytes([i0, i1, i2, i3]);
    let event = match id {
        TICK => Event::Tick,
        id if id & STANDARD != 0 => {
            Event::Frame(Frame { id: StandardId::new((id & 0x7ff) as u16)?.into(), length, data })
        }
        id => Event::Frame(Frame { id: ExtendedId::new(id)?.into(), length, data }),
    };
    Some((at, event))
}
