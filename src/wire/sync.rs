//! `Sync`, `FollowUp`: two-step time synchronisation on the bus, in one frame each.

use super::bits::Payload;
use super::field::Field;
use super::meaning::meaning;
use crate::time::GnssTime;

/// First step: its *reception* is the mark that the follow-up dates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sync {
    #[doc = meaning!(sequence)]
    pub sequence: u8,
    #[doc = meaning!(seconds)]
    pub seconds: u32,
}

/// Second step: when the sync message with this sequence was really on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FollowUp {
    /// As in the sync message.
    pub sequence: u8,
    #[doc = meaning!(micros)]
    ///
    /// 0 to 4,294,967,295.
    pub micros: u32,
}

impl FollowUp {
    /// The GNSS time at which the sync message was sent.
    #[must_use]
    pub const fn time_of(&self, sync: &Sync) -> GnssTime {
        GnssTime::from_micros((sync.seconds as u64).saturating_mul(1_000_000).saturating_add(self.micros as u64))
    }
}

const SEQUENCE: Field = Field::unsigned("Sequence", 12, 4);
const SECONDS: Field = Field::unsigned("Seconds", 16, 32).steps(1, "s");
const MICROS: Field = Field::unsigned("Micros", 16, 32).steps(1, "us");

/// The frame of the first step.
pub const SYNC_FIELDS: &[Field] = &[SEQUENCE, SECONDS];
/// The frame of the second step.
pub const FOLLOW_UP_FIELDS: &[Field] = &[SEQUENCE, MICROS];

impl Sync {
    /// The frame's payload.
    #[must_use]
    pub fn encode(&self) -> [Payload; 1] {
        let a = SEQUENCE.with_raw(Payload::EMPTY, i64::from(self.sequence & 15));
        [SECONDS.with_raw(a, i64::from(self.seconds))]
    }

    /// From the frame's payload; every payload is a sync message.
    #[must_use]
    pub fn decode([a]: &[Payload; 1]) -> Self {
        Self { sequence: SEQUENCE.byte(*a), seconds: SECONDS.word(*a) }
    }
}

impl FollowUp {
    /// The frame's payload.
    #[must_use]
    pub fn encode(&self) -> [Payload; 1] {
        let a = SEQUENCE.with_raw(Payload::EMPTY, i64::from(self.sequence & 15));
        [MICROS.with_raw(a, i64::from(self.micros))]
    }

    /// From the frame's payload; every payload is a follow-up.
    #[must_use]
    pub fn decode([a]: &[Payload; 1]) -> Self {
        Self { sequence: SEQUENCE.byte(*a), micros: MICROS.word(*a) }
    }
}
