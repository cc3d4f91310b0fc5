//! Whom a vehicle follows, as two fields: what it says of it, and the station if it names one.

use super::bits::Payload;
use super::field::Field;
use super::{Predecessor, StationHash};

/// The two fields.
pub(super) struct Fields {
    kind: Field,
    station: Field,
}

const KINDS: &[(i64, &str)] = &[(0, "unknown"), (1, "nobody"), (2, "station")];

/// Where the two fields start, and in which part.
pub(super) const fn fields(start: u32) -> Fields {
    Fields {
        kind: Field::unsigned("PredecessorKind", start, 2).named(KINDS),
        station: Field::unsigned("PredecessorStation", start.wrapping_add(2), 8),
    }
}

impl Fields {
    /// Both only in this part.
    pub(super) const fn part(self, part: u8) -> Self {
        Self { kind: self.kind.part(part), station: self.station.part(part) }
    }

    pub(super) const fn kind(&self) -> Field {
        self.kind
    }

    pub(super) const fn station(&self) -> Field {
        self.station
    }

    /// The station is 0 where there is none.
    #[inline(always)] // the fields would be passed, with their names
    pub(super) fn with(&self, payload: Payload, predecessor: Predecessor) -> Payload {
        let (kind, station) = match predecessor {
            Predecessor::Unknown => (0, 0),
            Predecessor::None => (1, 0),
            Predecessor::Station(StationHash(station)) => (2, station),
        };
        self.station.with_raw(self.kind.with_raw(payload, kind), i64::from(station))
    }

    /// The station is ignored where the kind is not `station`.
    #[inline(always)]
    pub(super) fn get(&self, payload: Payload) -> Predecessor {
        match self.kind.raw(payload) {
            1 => Predecessor::None,
            2 => Predecessor::Station(StationHash(self.station.byte(payload))),
            _ => Predecessor::Unknown,
        }
    }
}
