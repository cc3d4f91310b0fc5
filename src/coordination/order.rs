//! The order at an intersection: first come, first served. What the stations at it say of themselves enters; the one that the
//! ego has to let pass just before itself leaves.
//!
//! Every station tells when it arrived and whom it takes to be just ahead of it (its *claim*). Arrivals are told by those who
//! arrived, so all who heard the same stations agree, whenever they heard them; equal arrivals are decided by the station's
//! number. A station that does not say when it arrived is let pass.
//!
//! Those who heard different stations do not agree, and it shows: one that arrived later than the ego and yet claims somebody
//! from before the ego, or nobody, has not heard of the ego and heads for the ego's place; one that claims somebody who is not
//! here, by what the ego has heard, may. If that lasts, the ego gives way: it tells a new arrival, just after that one's. So a station only ever moves back, the order is that of the arrivals told
//! at all times, and as soon as everyone hears everyone again there is one order, whatever happened before.

use core::cmp::Ordering;

use crate::wire::{Predecessor, StationHash};

/// When a station arrived: GNSS time by 10 ms, modulo 2²⁰ (2.9 h). Of two, the earlier is the one from which the other is
/// reached within half of that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Arrival(pub u32);

impl Arrival {
    /// Bits of it.
    const BITS: u32 = 20;

    /// Of GNSS time in microseconds.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // masked
    pub const fn of_micros(micros: u64) -> Self {
        Self((micros / 10_000) as u32 & ((1 << Self::BITS) - 1))
    }

    /// The next one.
    #[must_use]
    pub const fn next(self) -> Self {
        Self(self.0.wrapping_add(1) & ((1 << Self::BITS) - 1))
    }

    /// Whether it is earlier than the other.
    #[must_use]
    pub fn is_before(self, other: Self) -> bool {
        self.compare(other) == Ordering::Less
    }

    fn compare(self, other: Self) -> Ordering {
        let ahead = self.0.wrapping_sub(other.0) & ((1 << Self::BITS) - 1);
        match ahead {
            0 => Ordering::Equal,
            _ if ahead < 1 << (Self::BITS - 1) => Ordering::Greater,
            _ => Ordering::Less,
        }
    }
}

/// A station at an intersection, by what it says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Entry {
    /// Who.
    pub station: StationHash,
    /// When it arrived; `None`: it does not say.
    pub arrival: Option<Arrival>,
    /// Whom it takes to be just ahead of it.
    pub claim: Predecessor,
}

impl Entry {
    /// Whether it arrived before the other.
    #[must_use]
    pub fn is_before(&self, other: &Self) -> bool {
        let by_arrival = match (self.arrival, other.arrival) {
            (Some(a), Some(b)) => a.compare(b),
            (None, Some(_)) => Ordering::Less,
            (Some(_), None) => Ordering::Greater,
            (None, None) => Ordering::Equal,
        };
        by_arrival.then(self.station.0.cmp(&other.station.0)) == Ordering::Less
    }

    fn claims(&self, other: &Self) -> bool {
        self.claim == Predecessor::Station(other.station)
    }
}

/// What becomes of the ego's place by what another station claims.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Regard {
    /// It arrived before the ego, or goes after the ego or somebody who does.
    Heeds,
    /// It arrived after the ego and claims somebody who is not at this crossing by what the ego has heard: one between the
    /// two, or one before the ego.
    Unclear,
    /// It arrived after the ego and acts as if the ego were not there: it claims nobody, or somebody who was there before the ego.
    Overlooks,
}

impl Regard {
    /// How another station regards the ego; all that the ego has heard of are there to tell whom it claims.
    #[must_use]
    pub fn of<'a>(other: &Entry, own: &Entry, mut all: impl Iterator<Item = &'a Entry>) -> Self {
        if other.is_before(own) || other.claims(own) {
            return Self::Heeds;
        }
        match other.claim {
            Predecessor::None => Self::Overlooks,
            Predecessor::Unknown => Self::Heeds, // it has not arrived yet
            Predecessor::Station(claimed) => match all.find(|entry| entry.station == claimed) {
                None => Self::Unclear,
                Some(claimed) if claimed.is_before(own) => Self::Overlooks,
                Some(_) => Self::Heeds,
            },
        }
    }
}
