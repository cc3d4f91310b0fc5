//! The vehicle that the driver has put ahead. The driver's choice enters at every tick; where that vehicle is for certain leaves, even
//! after another station has taken over its slot.
//!
//! If no station with the named hash has been heard, nothing is known of where that vehicle is. So the vehicle that was named before is
//! minded until the new one is heard, or until the driver says that no vehicle is ahead.

use super::Scene;
use crate::coordination::Slots;
use crate::envelope::Obstacle;
use crate::model::bound::{AccelerationRange, Bound};
use crate::time::Instant;
use crate::units::Distance;
use crate::wire::{Predecessor, StationHash};

/// What is certain of a vehicle that does not have a slot any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::unit) struct Displaced {
    station: StationHash,
    /// The slots of vehicles with the same name that were certain to be other ones at some time since.
    others: Slots,
    bound: Bound,
    reach: AccelerationRange,
    length: Distance,
}

/// The vehicle that the driver has put ahead.
#[derive(Clone, Copy, Debug)]
#[repr(u32)] // with a tag in which zero is `Nobody`, as in [`crate::held`]
pub(in crate::unit) enum Named {
    /// No vehicle, as far as is known.
    Nobody = 0,
    /// The vehicle in this slot, which was heard since it was named by this name. It may have another one since.
    InSlot(u8, StationHash),
    /// The vehicle that was in the slot before another station took the slot over.
    Displaced(Displaced),
}

impl Named {
    /// The slot of the vehicle, while it has one.
    pub fn slot(&self) -> Option<usize> {
        match self {
            Self::InSlot(slot, _) => Some(usize::from(*slot)),
            Self::Nobody | Self::Displaced(_) => None,
        }
    }

    /// Whether this is the name by which the driver named it.
    pub fn is_called(&self, station: StationHash) -> bool {
        matches!(self, Self::InSlot(_, name) if *name == station)
    }

    /// Whether the vehicle has lost its slot, and the vehicle with this name in a slot is certain to be another one.
    pub fn is_not_in(&self, slot: usize, station: StationHash) -> bool {
        matches!(self, Self::Displaced(held) if held.station == station && held.others.contains(slot))
    }
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// Notes the vehicle that the driver has put ahead.
    pub fn note_named(&mut self, target: Option<usize>) {
        match target {
            Some(index) => {
                let Predecessor::Station(name) = self.predecessor() else { return };
                self.named = u8::try_from(index).map_or(Named::Nobody, |slot| Named::InSlot(slot, name));
            }
            None if self.predecessor() == Predecessor::None => self.named = Named::Nobody,
            None => {}
        }
    }

    /// Notes which vehicles with the name of a vehicle without a slot are certain to be other ones now. Later what is certain of that
    /// one may reach as far as they are.
    pub fn note_others(&mut self, now: Instant) {
        let Named::Displaced(mut displaced) = self.named else { return };
        let held = displaced.bound.after(now, &displaced.reach);
        for index in self.peers.named(displaced.station) {
            if self.bound(index, now).is_some_and(|bound| bound.is_apart_from(&held, &displaced.reach)) {
                displaced.others.set(index, true);
            }
        }
        self.named = Named::Displaced(displaced);
    }

    /// Keeps what is certain of the vehicle that the driver has put ahead, when it loses its slot: the vehicle is still there.
    pub(super) fn displace(&mut self, index: usize) {
        if !matches!(self.named, Named::InSlot(slot, _) if usize::from(slot) == index) {
            return;
        }
        let certain = self.peers.get(index).and_then(|track| {
            let (station, bound) = (track.station()?, *track.certainty().bound()?);
            Some(Displaced { station, others: Slots::NONE, bound, reach: track.reach(), length: track.length() })
        });
        self.named = certain.map_or(Named::Nobody, Named::Displaced);
    }

    /// The rear of the vehicle that the driver has put ahead, at its near end; `None` if the range sensor sees that it is not there.
    pub fn named_ahead(&self, now: Instant) -> Option<Obstacle> {
        match &self.named {
            Named::Nobody => None,
            Named::InSlot(slot, _) => {
                let index = usize::from(*slot);
                if self.is_seen_past(index, now) { None } else { self.obstacle(now, index) }
            }
            Named::Displaced(Displaced { bound, reach, length, .. }) => {
                Some(Obstacle::rear(&bound.after(now, reach), *length, reach))
            }
        }
    }
}
