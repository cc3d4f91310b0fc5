//! Whom the driver has put ahead: the driver's choice enters at every tick; where that vehicle is for certain leaves, even after
//! another station has taken over its slot.
//!
//! A name that nobody has been heard by says nothing of where that vehicle is. So the one that was ahead before is minded until the
//! new one is heard, or until the driver says that nobody is ahead.

use super::Scene;
use crate::envelope::Obstacle;
use crate::held::Held;
use crate::model::bound::{AccelerationRange, Bound};
use crate::time::Instant;
use crate::units::Distance;
use crate::wire::Predecessor;

/// What is certain of a vehicle that has no slot any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Displaced {
    bound: Bound,
    reach: AccelerationRange,
    length: Distance,
}

/// Whom the driver has put ahead.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Named {
    /// The slot of the vehicle that was named and heard of, until another one is both.
    slot: Option<u8>,
    /// The same vehicle, once another station has its slot.
    displaced: Held<Displaced>,
}

impl Named {
    /// Nobody: all zero.
    pub(super) const NOBODY: Self = Self { slot: None, displaced: Held::Nothing };
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// Takes note of whom the driver has put ahead.
    pub fn note_named(&mut self, target: Option<usize>) {
        if target.is_some() {
            self.named.slot = target.and_then(|index| u8::try_from(index).ok());
            self.named.displaced.clear();
        } else if self.predecessor() == Predecessor::None {
            self.named.slot = None;
            self.named.displaced.clear();
        }
    }

    /// Keeps what is certain of the vehicle that the driver has put ahead, where it loses its slot: it is still there.
    pub(super) fn displace(&mut self, index: usize) {
        if self.named.slot.map(usize::from) != Some(index) {
            return;
        }
        self.named.slot = None;
        if let Some(track) = self.peers.get(index)
            && let Some(bound) = track.certainty().bound()
        {
            self.named.displaced.set(Displaced { bound: *bound, reach: track.reach(), length: track.length() });
        }
    }

    /// The rear of the vehicle that the driver has put ahead, at its near end, unless the range sensor sees that it is not there.
    pub fn named_ahead(&self, now: Instant) -> Option<Obstacle> {
        if let Some(index) = self.named.slot.map(usize::from) {
            return if self.is_seen_past(index, now) { None } else { self.obstacle(now, index) };
        }
        let Displaced { bound, reach, length } = self.named.displaced.get()?;
        Some(Obstacle::rear(&bound.after(now, &reach), length, &reach))
    }
}
