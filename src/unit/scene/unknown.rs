//! Unknown vehicles. What the modem tells of vehicles for which it has no slot enters; where the ego stops for them leaves.
//!
//! An unknown vehicle on a leg that crosses the ego's may be ahead in the order, so that the ego does not enter the conflict area. An
//! unknown vehicle ahead on the ego's own leg is taken to stand where it was.

use super::Scene;
use crate::held::Held;
use crate::time::{Duration, Instant};
use crate::units::Position;
use crate::wire::unserved::Unserved;

/// For how long the last message holds: three of its cycles.
const HOLDS: Duration = Duration::from_millis(600);

/// What the modem told last, and when.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::unit) struct Unknown(Held<(Instant, Unserved)>);

impl Unknown {
    /// Nothing was told: all zero.
    pub(super) const NONE: Self = Self(Held::Nothing);

    /// Takes in what the modem tells.
    pub(super) fn take(&mut self, at: Instant, unserved: Unserved) {
        self.0.set((at, unserved));
    }

    fn told(&self, now: Instant) -> Option<&Unserved> {
        let (at, unserved) = self.0.as_ref()?;
        (now.since(*at) <= HOLDS).then_some(unserved)
    }
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// Whether an unknown vehicle is in the next conflict area, or comes into it as the first vehicle of its leg.
    pub fn is_crossed_by_unknown(&self, now: Instant) -> bool {
        let (Some(crossing), Some(told)) = (self.coordination.crossing(), self.unknown.told(now)) else { return false };
        let crosses = |leg: &u8| told.legs & (1 << leg) != 0 && crossing.intersection.crosses(crossing.movement, *leg);
        told.intersection == crossing.intersection.id && (0..8).any(|leg| crosses(&leg))
    }

    /// Whether every vehicle that is heard on the way to the next intersection has a slot, as far as the modem says.
    pub fn has_slot_for_all(&self, now: Instant) -> bool {
        let next = self.coordination.crossing().map(|crossing| crossing.intersection.id);
        self.unknown.told(now).is_none_or(|told| Some(told.intersection) != next || told.stations == 0)
    }

    /// Where the ego, as far back as it may be, has to be able to stop for an unknown vehicle: before the next conflict area, unless the
    /// ego could not stop there any more when it learned of the vehicle, and behind an unknown vehicle ahead.
    pub fn stop_for_unknown(&self, now: Instant, rearmost: Position) -> Option<Position> {
        let is_barred = self.coordination.choice().is_held && self.is_crossed_by_unknown(now);
        let line = self.area_begins().filter(|begins| is_barred && rearmost <= *begins);
        let ahead = self.unknown_ahead(now).filter(|rear| rearmost <= *rear);
        [line, ahead].into_iter().flatten().min()
    }

    /// The rear bumper of the nearest unknown vehicle ahead on the ego's own leg, where that vehicle was.
    pub fn unknown_ahead(&self, now: Instant) -> Option<Position> {
        let (crossing, told) = (self.coordination.crossing()?, self.unknown.told(now)?);
        let ahead = told.ahead.filter(|_| told.intersection == crossing.intersection.id)?;
        Some(self.coordination.crossing_point(crossing)?.ahead(ahead.negated()))
    }
}
