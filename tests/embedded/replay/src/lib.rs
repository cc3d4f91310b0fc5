//! The records of a log enter a unit, and every frame that the unit sends leaves as a record: the same code on the host and
//! on the ECU, so that all that can differ is the core.
#![no_std]

use embedded_can::{ExtendedId, Id, StandardId};
use holdover::config::Envelope;
use holdover::health::Cause;
use holdover::time::{Duration, Instant};
use holdover::wire::StationHash;
use holdover::{Config, OnboardUnit};

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

/// What a unit of the replay is configured with: a car with its envelope engaged and a horizon of so many steps.
pub fn config(steps: usize) -> Config {
    let mut config = Config::car(EGO);
    config.envelope = Some(Envelope::CAR);
    let steps = steps.min(392).saturating_sub(2) as i64;
    config.prediction.horizon = Duration::from_millis(10).times(steps);
    config
}

/// The station of the vehicle whose log it is.
pub const EGO: StationHash = StationHash(4);

/// Lets a unit live through an event; every frame that it sends is emitted with its time.
pub fn live<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    unit: &mut OnboardUnit<PEERS, SAMPLES, STEPS>,
    at: Instant,
    event: &Event,
    mut emit: impl FnMut([u8; RECORD]),
) {
    match event {
        Event::Frame(frame) => {
            let _ = unit.receive(at, frame); // a refusal is counted
        }
        Event::Tick => {
            for sent in &unit.tick(at).frames {
                if let Ok(data) = sent.data[..].try_into() {
                    emit(encode(at, &Event::Frame(Frame { id: sent.id.into(), length: 8, data })));
                }
            }
        }
    }
}

/// What a unit refused in all, cause after cause: the last records of a replay.
pub fn refusals<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    unit: &OnboardUnit<PEERS, SAMPLES, STEPS>,
) -> impl Iterator<Item = [u8; RECORD]> {
    Cause::ALL.into_iter().map(|cause| {
        let count = u64::from(unit.health().of(cause)).to_le_bytes();
        let id = Id::Standard(StandardId::new(cause as u16).unwrap_or(StandardId::ZERO));
        encode(Instant::ZERO, &Event::Frame(Frame { id, length: 8, data: count }))
    })
}
