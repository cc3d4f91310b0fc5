//! The ego's own horizon. The ego's state and how it drives enter; its horizon, all of it or piece by piece, leaves.

use super::forecast::{Forecast, News, steps};
use super::{End, Estimator, Horizon};
use crate::model::{Reading, Stride, VehicleModel};
use crate::peers::{Peers, Sample};
use crate::time::Instant;
use crate::units::{Distance, Position, Seconds};

/// How the ego drives, over a step of its own horizon.
#[derive(Clone, Copy, Debug)]
pub struct Manner {
    /// The slot of the vehicle that the ego follows.
    pub target: Option<usize>,
    vehicle: VehicleModel,
    length_ahead: Distance,
    stride: Stride,
}

impl<const PEERS: usize, const STEPS: usize> Estimator<PEERS, STEPS> {
    /// How the ego drives behind this peer, or without a target, for the ego's own horizon.
    pub fn manner<const SAMPLES: usize>(
        &self,
        vehicle: VehicleModel,
        target: Option<usize>,
        peers: &Peers<PEERS, SAMPLES>,
    ) -> Manner {
        let length_ahead = target.map_or(Distance::ZERO, |index| peers.length_of(index));
        Manner { target, vehicle, length_ahead, stride: vehicle.over(self.grid.step, length_ahead, &self.model) }
    }

    /// Gives this manner another time gap, if the ego follows.
    #[cold]
    #[inline(never)]
    pub fn keep_time_gap(&self, manner: &mut Manner, time_gap: Seconds) {
        manner.vehicle.keep_time_gap(time_gap);
        manner.stride.keep_time_gap(&manner.vehicle, self.grid.step, time_gap, &self.model);
    }

    /// Computes the ego's own horizon from the ego's state: all of it, or up to an instant.
    pub fn foresee_own(&mut self, now: Instant, until: Option<Instant>, sample: &Sample, manner: &Manner) {
        let present = self.grid.at_or_before(now);
        let whole = steps(self.length);
        let length = until.map_or(whole, |until| {
            self.grid.at_or_before(until).saturating_sub(present).saturating_add(1).min(whole).max(1)
        });
        let (vehicle, length_ahead) = (manner.vehicle, manner.length_ahead);
        self.own_forecast(manner, usize::try_from(length).unwrap_or(0), |forecast, own| {
            forecast.anchor(own, present, &News { sample, received: None, vehicle, length_ahead });
        });
    }

    /// Carries the ego's own horizon on up to an instant, but no farther than this step.
    #[inline(always)]
    pub fn carry_own_on(&mut self, until: Instant, end: i64, manner: &Manner) {
        let end = self.grid.at_or_before(until).min(end);
        self.own_forecast(manner, self.length, |forecast, own| forecast.carry(own, end));
    }

    /// Whether the ego's own horizon ends before this step.
    #[must_use]
    pub fn is_own_short(&self, end: i64) -> bool {
        !self.own.is_empty() && self.own.last() < end
    }

    /// The last step of a horizon that begins now.
    #[must_use]
    pub fn own_end_of(&self, now: Instant) -> i64 {
        self.grid.at_or_before(now).saturating_add(steps(self.length)).saturating_sub(1)
    }

    #[inline(always)]
    fn own_forecast(
        &mut self,
        manner: &Manner,
        length: usize,
        act: impl FnOnce(&Forecast<'_, STEPS>, &mut Horizon<STEPS>),
    ) {
        let ahead = manner.target.and_then(|index| self.horizons.get(index)).filter(|horizon| !horizon.is_empty());
        let (grid, model, stride) = (&self.grid, &self.model, &manner.stride);
        act(&Forecast { grid, length, model, stride, ahead, delay: None }, &mut self.own);
    }

    /// The end of the ego's own horizon so far, to go back to.
    #[must_use]
    pub const fn own_mark(&self) -> End {
        self.own.mark()
    }

    /// Takes back what the ego's own horizon was carried on by since it ended there.
    pub fn cut_own(&mut self, end: &End) {
        self.own.cut(end);
    }

    /// The last step of the ego's own horizon so far, and where the ego is then.
    #[must_use]
    pub fn own_end(&self) -> Option<(i64, Reading)> {
        Some((self.own.last(), self.own.end()?))
    }

    /// Whether the ego will be at a place at an instant, by its newest own horizon: asked of the steps around the instant, and read between
    /// them only where they do not agree. It never moves backwards.
    #[must_use]
    pub fn is_own_there(&self, at: Instant, place: Position) -> bool {
        let index = self.grid.at_or_before(at);
        let is_there = |index| self.own.held(index).is_none_or(|reading| reading.position >= place);
        if index >= self.own.first() && is_there(index) == is_there(index.saturating_add(1)) {
            return is_there(index);
        }
        self.read_own(at).is_none_or(|reading| reading.position >= place)
    }

    /// Where the ego will be at an instant, by its newest own horizon.
    #[must_use]
    pub fn read_own(&self, at: Instant) -> Option<Reading> {
        self.own.read(at, &self.grid, true)
    }
}
