//! The order at an intersection: first come, first served. What the stations at the intersection say of themselves enters; who is ahead of
//! whom, and how others regard the ego, leave.
//!
//! Every station tells when it arrived, and which station it takes to be just ahead of it, of those whose ways conflict with its own or
//! that are ahead on its leg (its *claim*). Each station tells its own arrival. So all stations that heard the same stations agree,
//! whenever they heard them. Equal arrivals are decided by the number of the station, and between stations of the same number by the number
//! of the leg. The ego yields to a station that does not say when it arrived.
//!
//! Stations that heard different stations do not agree, and their claims show it. Take a station that arrived later than the ego. If it
//! claims no station, or one that is before the ego, it has not heard of the ego and heads for the ego's place. If it claims a station that
//! is not here, by what the ego has heard, it may head for that place, unless the modem hears stations without a slot. If this lasts, the
//! ego yields: it tells a new arrival, just after the arrival of the other station. So a station only ever moves back. The order is that of
//! the told arrivals at all times. As soon as every station hears every other one again, there is one order, whatever happened before.

use core::cmp::Ordering;

use crate::wire::{Predecessor, StationHash};

/// When a station arrived: GNSS time in steps of 10 ms, modulo 2²⁰ (2.9 h). Of two arrivals, the earlier is the one from which the other
/// is reached within half of that range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Arrival(pub u32);

impl Arrival {
    /// Number of bits.
    const BITS: u32 = 20;

    /// The arrival of a GNSS time in microseconds.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // masked
    pub const fn of_micros(micros: u64) -> Self {
        Self((micros / 10_000) as u32 & ((1 << Self::BITS) - 1))
    }

    /// The next arrival, 10 ms later.
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
    /// The station.
    pub station: StationHash,
    /// When it arrived; `None` if it does not say.
    pub arrival: Option<Arrival>,
    /// The station that it takes to be just ahead of it, of those that conflict with it or are ahead on its leg.
    pub claim: Predecessor,
    /// The leg by which it comes, which decides where two stations have the same name and arrival.
    pub leg: u8,
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
        by_arrival.then(self.station.0.cmp(&other.station.0)).then(self.leg.cmp(&other.leg)) == Ordering::Less
    }

    fn claims(&self, other: &Self) -> bool {
        self.claim == Predecessor::Station(other.station)
    }
}

/// What the claim of another station means for the ego's place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Regard {
    /// It arrived before the ego, or it claims the ego or a station that arrived after the ego.
    Heeds,
    /// It arrived after the ego, and claims a station that is not at this crossing by what the ego has heard. That station may be between
    /// the two, or before the ego. It counts only while the modem hears no station without a slot.
    Unclear,
    /// It arrived after the ego and ignores the ego: it claims no station, or one that was there before the ego.
    Overlooks,
}

impl Regard {
    /// How another station regards the ego. `all` are the stations that the ego has heard of; among them is the claimed one, if the ego
    /// knows it.
    #[must_use]
    pub fn of<'a>(other: &Entry, own: &Entry, mut all: impl Iterator<Item = &'a Entry>) -> Self {
        if other.is_before(own) || other.claims(own) {
            return Self::Heeds;
        }
        match other.claim {
            Predecessor::None => Self::Overlooks,
            Predecessor::Unknown => Self::Heeds, // the station has not arrived yet
            Predecessor::Station(claimed) => match all.find(|entry| entry.station == claimed) {
                None => Self::Unclear,
                Some(claimed) if claimed.is_before(own) => Self::Overlooks,
                Some(_) => Self::Heeds,
            },
        }
    }
}
