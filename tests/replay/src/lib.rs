//! A log enters a unit, and every frame that the unit sends leaves as a record: the same code on the host and on the ECU, so that all
//! that can differ is the core.
//!
//! ```text
//! log:  head (configuration, map)  ->  OnboardUnit::{start, set_out}
//!       record, record, ...        ->  OnboardUnit::{receive, tick}  ->  record, record, ...
//! ```
//! A head is a series of [words]. What is in it is what the recorded unit has, so the recorder alone says what is replayed.
#![no_std]

mod config;
mod map;
mod record;
pub mod words;

pub use map::Room;
pub use record::{Event, Frame, RECORD, decode, encode};

use embedded_can::{Id, StandardId};
use holdover::coordination::Itinerary;
use holdover::health::Cause;
use holdover::time::Instant;
use holdover::{Answer, Config, OnboardUnit};
use words::{Put, Take};

/// The unit of the replay: as large as the firmware's.
pub type Unit = OnboardUnit<8, 8, 400>;

/// What a unit has before the first record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Head {
    /// Its configuration.
    pub config: Config,
    /// Its way through intersections, if it has one.
    pub itinerary: Option<&'static Itinerary>,
}

impl Head {
    /// The words of the head. Of the configuration only what [`Head::take`] gives back is in it; the recorder holds that it is all.
    pub fn put(&self, put: Put) {
        config::put(&self.config, put);
        put(self.itinerary.is_some().into());
        if let Some(itinerary) = self.itinerary {
            map::put(itinerary, put);
        }
    }

    /// The head of these words. `None`: they are no head, or the map needs more room.
    pub fn take(take: Take, room: &'static mut Room) -> Option<Self> {
        let config = config::take(take)?;
        let itinerary = if take()? == 0 { None } else { Some(map::take(take, room)?) };
        Some(Self { config, itinerary })
    }

    /// Starts a unit with it. `None`: the unit refuses it.
    pub fn start(&self, unit: &mut Unit) -> Option<()> {
        unit.start(&self.config).ok()?;
        self.itinerary.map_or(Some(()), |itinerary| unit.set_out(itinerary).ok())
    }
}

/// Lets a unit live through an event; every frame that it sends is emitted with its time. A tick has an answer.
///
/// # Errors
/// The cause for which the unit refuses a frame, which it has counted.
pub fn live(
    unit: &mut Unit,
    at: Instant,
    event: &Event,
    mut emit: impl FnMut([u8; RECORD]),
) -> Result<Option<Answer>, Cause> {
    match event {
        Event::Frame(frame) => unit.receive(at, frame).map(|_| None),
        Event::Tick => {
            let answer = unit.tick(at);
            for sent in &answer.frames {
                if let Ok(data) = sent.data[..].try_into() {
                    emit(encode(at, &Event::Frame(Frame { id: sent.id.into(), length: 8, data })));
                }
            }
            Ok(Some(answer))
        }
    }
}

/// What a unit refused in all, cause after cause: the last records of a replay.
pub fn refusals(unit: &Unit) -> impl Iterator<Item = [u8; RECORD]> {
    Cause::ALL.into_iter().map(|cause| {
        let count = u64::from(unit.health().of(cause)).to_le_bytes();
        let id = Id::Standard(StandardId::new(cause as u16).unwrap_or(StandardId::ZERO));
        encode(Instant::ZERO, &Event::Frame(Frame { id, length: 8, data: count }))
    })
}
