//! The peers: messages from the slots enter, one track per slot leaves.
//!
//! Which samples of a slot were heard is kept in the order of their stamps, and of the newest all. [`timely`] and [`Track::judge`] refuse a
//! sample that comes too late for that, comes twice, or is from the future. The unit refuses a sample from another station or from too far
//! away. Judging changes nothing. Only [`Track::admit`] changes a track by a sample.

mod drift;
mod limits;
mod link;
pub mod plausibility;
mod sample;
mod sender_clock;
mod track;

pub use link::{LOSS_ONE, Link};
pub use sample::{Heard, Sample, excess, largest_error, largest_speed_error, timely};
pub use sender_clock::Off;
pub use track::{Admission, Track};

use crate::health::Cause;
use crate::parameters::DEFAULT_LENGTH;
use crate::time::{Duration, Instant};
use crate::units::{Distance, Position};
use crate::wire::{Slot, StationHash};

/// All slots.
#[derive(Clone, Debug)]
pub struct Peers<const PEERS: usize, const SAMPLES: usize> {
    tracks: [Track<SAMPLES>; PEERS],
}

impl<const PEERS: usize, const SAMPLES: usize> Peers<PEERS, SAMPLES> {
    /// Not started: all zero.
    pub(crate) const fn idle() -> Self {
        Self { tracks: [const { Track::new(Duration::ZERO) }; PEERS] }
    }

    /// Starts with all slots free. Messages are expected with this period until the period of a peer is measured.
    pub fn start(&mut self, period: Duration) {
        self.tracks.iter_mut().for_each(|track| *track = Track::new(period));
    }

    /// The track of a slot, to be changed.
    ///
    /// # Errors
    /// [`Cause::UnknownSlot`] beyond the capacity.
    pub fn get_mut(&mut self, slot: Slot) -> Result<&mut Track<SAMPLES>, Cause> {
        self.tracks.get_mut(usize::from(slot.0)).ok_or(Cause::UnknownSlot)
    }

    /// The track of a slot by its index.
    #[must_use]
    pub fn get(&self, index: usize) -> Option<&Track<SAMPLES>> {
        self.tracks.get(index)
    }

    /// The length of the vehicle in a slot, published or by default.
    #[must_use]
    pub fn length_of(&self, index: usize) -> Distance {
        self.get(index).map_or(DEFAULT_LENGTH, Track::length)
    }

    /// The track of a slot by its index, to be changed.
    pub fn get_index_mut(&mut self, index: usize) -> Option<&mut Track<SAMPLES>> {
        self.tracks.get_mut(index)
    }

    /// Computes what is certain of all of them at this instant.
    pub fn carry(&mut self, at: Instant) {
        self.tracks.iter_mut().for_each(|track| track.carry(at));
    }

    /// The station of the slot `from` is in the slot `to` now.
    pub fn follow_on(&mut self, from: usize, to: usize) {
        if let Ok([before, now]) = self.tracks.get_disjoint_mut([from, to]) {
            now.follow_on(before);
        }
    }

    /// All slots in their order.
    pub fn iter(&self) -> impl Iterator<Item = &Track<SAMPLES>> {
        self.tracks.iter()
    }

    /// The slots in which a station of this name is. Names are 8 bits long, so that two vehicles may have the same one; each is
    /// known by its slot.
    pub fn named(&self, station: StationHash) -> impl Iterator<Item = usize> {
        let is_named = move |(_, track): &(usize, &Track<SAMPLES>)| track.station() == Some(station);
        self.tracks.iter().enumerate().filter(is_named).map(|(index, _)| index)
    }

    /// The slot of the station that a vehicle here follows: of several with that name, the nearest ahead of it.
    #[must_use]
    pub fn predecessor(&self, station: StationHash, here: Option<Position>) -> Option<usize> {
        self.named(station).min_by_key(|index| {
            let ahead = here.zip(self.get(*index).and_then(Track::newest));
            let way = ahead.map_or(Distance::ZERO, |(here, newest)| newest.position.ahead_of(here));
            (way < Distance::ZERO, way.magnitude())
        })
    }
}

#[cfg(test)]
mod tests;
