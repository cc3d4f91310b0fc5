//! Algorithm 1: the peers' tracks and the ego's own state enter, a horizon for every peer and for the ego leaves.
//!
//! Theory of operation, once a tick:
//!
//! * *News* of a peer (a newer sample, a horizon of its own, other driving parameters) re-anchors its horizon. Source (a) is the horizon
//!   that the peer computed itself and sent: it is resampled onto the unit's grid, and the unit's model carries it on from its end.
//!   Otherwise source (b) is the unit's own model of the peer, from the peer's state at the stamp: Algorithm 2 for a leader, Algorithm 4
//!   for a follower whose predecessor is known, the fading acceleration for any other peer.
//! * *No news:* the step that has passed is dropped, and one more is computed at the far end by the same model. So a horizon never runs
//!   out.
//!
//! The state that a horizon starts from, and every reading of it, is inside what is certain of the vehicle (`certain`).
//!
//! The peers are taken in the order of the chain `0..j`: each peer after the peer that it follows.

pub mod certain;
mod chain;
mod delay;
mod forecast;
mod horizon;
mod interpolation;

pub use horizon::{Anchor, Grid, Horizon};

use chain::Chain;
use forecast::{Ahead, Forecast, News, steps};

use crate::config::Prediction;
use crate::held::Held;
use crate::model::{Model, Reading, Stride, VehicleModel};
use crate::peers::{Peers, Sample, Track};
use crate::time::{Duration, Instant};
use crate::units::Distance;
use crate::wire::{Predecessor, StationHash};

/// What a horizon is brought up to now from.
enum Source<'a> {
    /// The peer's newest sample, which is new.
    Heard(&'a Sample),
    /// The peer's state by its messages and another sensor together.
    Fused(&'a Sample),
    /// No news.
    Nothing,
}

/// How the ego drives, over a step of its own horizon.
#[derive(Clone, Copy, Debug)]
pub struct Manner {
    /// The slot of the vehicle that the ego follows.
    pub target: Option<usize>,
    vehicle: VehicleModel,
    length_ahead: Distance,
    stride: Stride,
}

/// All horizons of one unit.
#[derive(Clone, Debug)]
pub struct Estimator<const PEERS: usize, const STEPS: usize> {
    grid: Grid,
    model: Model,
    /// Number of steps that a horizon keeps.
    length: usize,
    horizons: [Horizon<STEPS>; PEERS],
    /// The prediction step of each peer, until its driving parameters or its predecessor changes.
    strides: [Held<Stride>; PEERS],
    /// The vehicle that each peer follows.
    aheads: [Held<Ahead>; PEERS],
    news: [bool; PEERS],
    /// The state of a peer by its messages and another sensor together, until it is used.
    track: Held<(usize, Sample)>,
    own: Horizon<STEPS>,
    station: StationHash,
    own_length: Distance,
    chain: Chain<PEERS>,
}

impl<const PEERS: usize, const STEPS: usize> Estimator<PEERS, STEPS> {
    /// Not started: all zero.
    pub(crate) const fn idle() -> Self {
        Self {
            grid: Grid { origin: Instant::ZERO, step: Duration::ZERO },
            model: Model::PAPER,
            length: 0,
            horizons: [const { Horizon::empty() }; PEERS],
            strides: [Held::Nothing; PEERS],
            aheads: [Held::Nothing; PEERS],
            news: [false; PEERS],
            track: Held::Nothing,
            own: Horizon::empty(),
            station: StationHash(0),
            own_length: Distance::ZERO,
            chain: Chain::NONE,
        }
    }

    /// Starts with nothing known. `length` is the number of steps that a horizon keeps.
    pub fn start(&mut self, prediction: &Prediction, length: usize, station: StationHash, own_length: Distance) {
        self.grid = Grid { origin: Instant::ZERO, step: prediction.step };
        self.model = prediction.model;
        self.length = length.min(STEPS);
        self.horizons.iter_mut().for_each(Horizon::clear);
        self.strides = [Held::Nothing; PEERS];
        self.aheads = [Held::Nothing; PEERS];
        self.news = [false; PEERS];
        self.track.clear();
        self.own.clear();
        self.station = station;
        self.own_length = own_length;
        self.chain = Chain::new();
    }

    /// Puts step 0 of the grid at the instant of the first tick, so that ticks are on steps.
    pub fn start_grid(&mut self, origin: Instant) {
        self.grid.origin = origin;
    }

    /// Notes that there is news of a peer.
    pub fn note_news(&mut self, index: usize) {
        if let Some(news) = self.news.get_mut(index) {
            *news = true;
        }
    }

    /// Notes a peer's state by its messages and another sensor together. What the peer itself says of how it will drive takes
    /// precedence in the same tick.
    pub fn note_track(&mut self, index: usize, sample: Sample) {
        self.track.set((index, sample));
    }

    /// Whether a peer said how it will drive, and its predecessor is known.
    #[must_use]
    pub fn is_foreseen<const SAMPLES: usize>(&self, index: usize, peers: &Peers<PEERS, SAMPLES>) -> bool {
        let ahead = self.aheads.get(index).and_then(Held::get);
        peers.get(index).is_some_and(|track| track.knots().is_some() || is_known(track, ahead))
    }

    /// Notes that a peer drives by another law, or behind another vehicle.
    pub fn note_change<const SAMPLES: usize>(&mut self, peers: &Peers<PEERS, SAMPLES>) {
        self.strides = [Held::Nothing; PEERS];
        self.aheads = core::array::from_fn(|index| self.ahead(peers, index).into());
        self.chain = Chain::of(self.aheads.map(|ahead| match ahead {
            Held::Value(Ahead::Peer(ahead)) => Some(ahead),
            _ => None,
        }));
    }

    /// Moves a peer's horizon ahead by this way, because another sensor sees the peer there.
    pub fn move_horizon(&mut self, index: usize, way: Distance) {
        if let Some(horizon) = self.horizons.get_mut(index) {
            horizon.shift(way);
        }
    }

    /// Moves what is held of a peer's place ahead by this way, because the peer's axis moved.
    pub fn shift(&mut self, index: usize, way: Distance) {
        self.move_horizon(index, way);
        if let Held::Value((fused, sample)) = &mut self.track
            && *fused == index
        {
            sample.position = sample.position.ahead(way);
        }
    }

    /// Forgets a peer.
    pub fn forget(&mut self, index: usize) {
        if let Some(horizon) = self.horizons.get_mut(index) {
            horizon.clear();
        }
        self.strides = [Held::Nothing; PEERS];
    }

    /// Brings every peer's horizon up to now. Returns how many sent horizons were not used, because their senders cannot drive them.
    pub fn update<const SAMPLES: usize>(&mut self, now: Instant, peers: &Peers<PEERS, SAMPLES>) -> u32 {
        let mut unreachable = 0u32;
        let present = self.grid.at_or_before(now);
        let fused = match &self.track {
            Held::Nothing => None, // without a sensor always, and then nothing is copied
            Held::Value(_) => core::mem::take(&mut self.track).get(),
        };
        for place in 0..PEERS {
            let Some(index) = self.chain.at(place) else { continue };
            let Some(track) = peers.get(index) else { continue };
            let (Some(sample), Some(news)) = (track.newest(), self.news.get_mut(index)) else { continue };
            let is_news = core::mem::take(news);
            let ahead = self.aheads.get(index).and_then(Held::get);
            let says_how = track.knots().is_some() || is_known(track, ahead);
            let source = match &fused {
                Some((fused, sample)) if *fused == index && !(is_news && says_how) => Source::Fused(sample),
                _ if is_news => Source::Heard(sample),
                _ => Source::Nothing,
            };
            let is_used = self.update_one(present, peers, index, track, &source);
            unreachable = unreachable.saturating_add(u32::from(!is_used));
        }
        unreachable
    }

    fn update_one<const SAMPLES: usize>(
        &mut self,
        present: i64,
        peers: &Peers<PEERS, SAMPLES>,
        index: usize,
        track: &Track<SAMPLES>,
        source: &Source<'_>,
    ) -> bool {
        let Self { grid, model, length, horizons, strides, own, own_length, aheads, .. } = self;
        let ahead = aheads.get(index).and_then(Held::get);
        // How the peer drives is needed only when its prediction step is made, or when its horizon starts anew.
        let course = || {
            let length_ahead = match ahead {
                Some(Ahead::Peer(other)) => peers.length_of(other),
                Some(Ahead::Own) => *own_length,
                None => Distance::ZERO,
            };
            let known = track.parameters().filter(|_| is_known(track, ahead));
            let vehicle = known.map_or(VehicleModel::UNKNOWN, |known| VehicleModel::of_parameters(known, model));
            (vehicle, length_ahead)
        };
        if let Some(stride @ Held::Nothing) = strides.get_mut(index) {
            let (vehicle, length_ahead) = course();
            stride.set(vehicle.over(grid.step, length_ahead, model));
        }
        let Some(stride) = strides.get(index).and_then(Held::as_ref) else { return true };
        // The horizon and the one that it is computed from are borrowed from the array together.
        let (horizon, ahead) = match ahead {
            Some(Ahead::Peer(other)) => pair(horizons, index, other),
            Some(Ahead::Own) => (horizons.get_mut(index), Some(&*own)),
            None => (horizons.get_mut(index), None),
        };
        let Some(horizon) = horizon else { return true };
        let ahead = ahead.filter(|ahead| !ahead.is_empty());
        let delay = if model.stamped { None } else { Some(track.link().delay()) };
        let forecast = Forecast { grid, length: *length, model, stride, ahead, delay };
        let (sample, received) = match source {
            Source::Heard(sample) => (sample, track.knots().filter(|_| model.received).zip(track.parameters())),
            Source::Fused(sample) => (sample, None),
            Source::Nothing => {
                forecast.extend(horizon, present);
                return true;
            }
        };
        // Without stamps, which is for reproducing the paper, nothing is limited to what is certain.
        let bound = track.certainty().bound().filter(|_| model.stamped);
        let reach = track.reach();
        let moved = bound.and_then(|bound| certain::moved(sample, bound, &reach));
        let sample = moved.as_ref().unwrap_or(sample);
        let usable = received.filter(|(knots, parameters)| {
            bound.is_none_or(|bound| certain::is_reachable(knots, parameters.horizon_tenths, sample, bound, &reach))
        });
        let (vehicle, length_ahead) = course();
        forecast.anchor(horizon, present, &News { sample, received: usable, vehicle, length_ahead });
        usable.is_some() == received.is_some()
    }

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

    /// Carries the ego's own horizon on up to an instant, but no farther than a horizon that begins now reaches.
    pub fn carry_own_on(&mut self, now: Instant, until: Instant, manner: &Manner) {
        let end = self.grid.at_or_before(until).min(self.end(now));
        self.own_forecast(manner, self.length, |forecast, own| forecast.carry(own, end));
    }

    /// Whether the ego's own horizon ends earlier than a horizon that begins now.
    #[must_use]
    pub fn is_own_short(&self, now: Instant) -> bool {
        !self.own.is_empty() && self.own.last() < self.end(now)
    }

    /// The last step of a horizon that begins now.
    fn end(&self, now: Instant) -> i64 {
        self.grid.at_or_before(now).saturating_add(steps(self.length)).saturating_sub(1)
    }

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

    /// Where a peer is at an instant, inside what is certain of it then.
    #[must_use]
    pub fn read_inside<const SAMPLES: usize>(
        &self,
        index: usize,
        at: Instant,
        peers: &Peers<PEERS, SAMPLES>,
    ) -> Option<Reading> {
        let (reading, track) = (self.read(index, at)?, peers.get(index)?);
        let bound = track.certainty().bound().filter(|bound| self.model.stamped && at >= bound.at());
        Some(bound.map_or(reading, |bound| certain::limited(reading, &bound.after(at, &track.reach()))))
    }

    /// Where a peer is at an instant by its horizon.
    #[must_use]
    pub fn read(&self, index: usize, at: Instant) -> Option<Reading> {
        self.horizons.get(index)?.read(at, &self.grid, self.model.interpolate)
    }

    /// Where the ego will be at an instant, by its newest own horizon.
    #[must_use]
    pub fn read_own(&self, at: Instant) -> Option<Reading> {
        self.own.read(at, &self.grid, true)
    }

    /// The horizon of a peer.
    #[must_use]
    pub fn horizon(&self, index: usize) -> Option<&Horizon<STEPS>> {
        self.horizons.get(index)
    }

    /// The grid.
    #[must_use]
    pub const fn grid(&self) -> &Grid {
        &self.grid
    }

    /// How far ahead a horizon reaches at any time, for the unit's own horizon. Two of its steps are needed for interpolation.
    #[must_use]
    pub fn horizon_length(&self) -> Duration {
        self.grid.step.times(i64::try_from(self.length.saturating_sub(2)).unwrap_or(0))
    }

    fn ahead<const SAMPLES: usize>(&self, peers: &Peers<PEERS, SAMPLES>, index: usize) -> Option<Ahead> {
        match peers.get(index)?.parameters()?.predecessor {
            Predecessor::Station(station) if station == self.station => {
                // A peer with the ego's name may be meant as well as the ego.
                peers.named(station).next().is_none().then_some(Ahead::Own)
            }
            Predecessor::Station(station) => {
                let here = peers.get(index)?.newest().map(|newest| newest.position);
                peers.predecessor(station, here).filter(|other| *other != index).map(Ahead::Peer)
            }
            Predecessor::None | Predecessor::Unknown => None,
        }
    }
}

/// Whether a peer said by which law it drives, and behind whom.
fn is_known<const SAMPLES: usize>(track: &Track<SAMPLES>, ahead: Option<Ahead>) -> bool {
    track.parameters().is_some_and(|known| ahead.is_some() || known.predecessor == Predecessor::None)
}

/// One element to be changed, and another one to be read.
fn pair<T>(all: &mut [T], one: usize, other: usize) -> (Option<&mut T>, Option<&T>) {
    match all.split_at_mut_checked(one.max(other)) {
        Some((low, high)) if one < other => (low.get_mut(one), high.first()),
        Some((low, high)) => (high.first_mut(), low.get(other)),
        None => (None, None),
    }
}

#[cfg(test)]
pub(crate) mod tests;
