//! Algorithm 1: the peers' tracks and the ego's own state enter, a horizon for every peer and for the ego leaves.
//!
//! Theory of operation, once a tick:
//!
//! * *News* of a peer (a newer sample, a horizon of its own, other driving parameters) re-anchors its horizon. Source (a) is the horizon
//!   that the peer computed itself and sent: it is resampled onto the unit's grid, and the unit's model carries it on from its end.
//!   Otherwise source (b) is the unit's own model of the peer, from the peer's state at the stamp: Algorithm 2 for a leader, Algorithm 4
//!   for a follower whose predecessor is known, the fading acceleration for any other peer.
//! * *News of many at once* is spread over ticks, that of the target first (`turns`).
//! * *After missed ticks*, every horizon starts anew in the same way.
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
mod own;
mod turns;

pub use horizon::{Anchor, End, Grid, Horizon};
pub use own::Manner;

use chain::Chain;
use forecast::{Ahead, Forecast, News, steps};
use turns::{Room, Turn, Turns, steps_a_tick, steps_sent};

use crate::config::Config;
use crate::held::Held;
use crate::model::{Model, Reading, Stride, VehicleModel};
use crate::parameters::OLD_NEWS;
use crate::peers::{Peers, Sample, Track};
use crate::time::{Duration, Instant};
use crate::units::Distance;
use crate::wire::{Predecessor, StationHash};

/// Ticks that are missed are made up for by extending every horizon, up to so many steps, or four periods if that is more. After a longer
/// pause the horizons start anew in turns, which is bounded.
const PAUSE: i64 = 32;

/// What a horizon is brought up to now from.
enum Source<'a> {
    /// The peer's newest sample, which is new.
    Heard(&'a Sample),
    /// The same again, because news of others had to wait when it was new.
    Again(&'a Sample),
    /// The peer's state by its messages and another sensor together.
    Fused(&'a Sample),
    /// No news.
    Nothing,
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
    turns: Turns<PEERS>,
    /// How many steps of horizons that start anew a tick has room for.
    room: usize,
    /// News that is older than so many steps is old.
    old: usize,
    /// The step of the last tick.
    present: Held<i64>,
    /// If more steps than this lie between two ticks, horizons start anew.
    pause: i64,
    /// Where the peers are at an instant, and that instant, if all were read since the horizons changed.
    readings: [Held<Reading>; PEERS],
    read_at: Held<Instant>,
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
            turns: Turns::NONE,
            room: 0,
            old: 0,
            present: Held::Nothing,
            pause: 0,
            readings: [Held::Nothing; PEERS],
            read_at: Held::Nothing,
            own: Horizon::empty(),
            station: StationHash(0),
            own_length: Distance::ZERO,
            chain: Chain::NONE,
        }
    }

    /// Starts with nothing known. `length` is the number of steps that a horizon keeps.
    pub fn start(&mut self, config: &Config, length: usize) {
        self.grid = Grid { origin: Instant::ZERO, step: config.prediction.step };
        self.model = config.prediction.model;
        self.length = length.min(STEPS);
        self.horizons.iter_mut().for_each(Horizon::clear);
        self.strides = [Held::Nothing; PEERS];
        self.aheads = [Held::Nothing; PEERS];
        self.turns = Turns::NONE;
        self.room = steps_a_tick(config.period);
        let old = config.link.period.times(OLD_NEWS).as_micros().checked_div(self.grid.step.as_micros()).unwrap_or(0);
        self.old = usize::try_from(old).unwrap_or(usize::MAX);
        self.present.clear();
        self.pause = config.period.times(4).as_micros().checked_div(self.grid.step.as_micros()).unwrap_or(0).max(PAUSE);
        self.read_at.clear();
        self.own.clear();
        self.station = config.station;
        self.own_length = config.length;
        self.chain = Chain::new();
    }

    /// Puts step 0 of the grid at the instant of the first tick, so that ticks are on steps.
    pub fn start_grid(&mut self, origin: Instant) {
        self.grid.origin = origin;
    }

    /// Notes that there is news of a peer.
    pub fn note_news(&mut self, index: usize) {
        self.turns.note(index);
    }

    /// Whether there is news of a peer that its horizon does not have yet.
    #[must_use]
    pub fn has_news(&self, index: usize) -> bool {
        self.turns.has_news(index)
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

    /// Moves a peer's horizon ahead by this way, because another sensor sees the peer there, or because the peer's axis moved.
    pub fn move_horizon(&mut self, index: usize, way: Distance) {
        self.read_at.clear();
        if let Some(horizon) = self.horizons.get_mut(index) {
            horizon.shift(way);
        }
    }

    /// Forgets a peer.
    pub fn forget(&mut self, index: usize) {
        self.read_at.clear();
        if let Some(horizon) = self.horizons.get_mut(index) {
            horizon.clear();
        }
        self.strides = [Held::Nothing; PEERS];
    }

    /// Brings every peer's horizon up to now. News is used in turns: that of the target at once, that of others as there is room for
    /// it in a tick: what else the tick does takes as long as so many horizons `besides`. `fused` is a peer's state by its messages and
    /// another sensor together, which is news of that peer; what the peer itself says of how it will drive takes precedence. Returns how
    /// many sent horizons were not used, because their senders cannot drive them.
    pub fn update<const SAMPLES: usize>(
        &mut self,
        now: Instant,
        peers: &Peers<PEERS, SAMPLES>,
        target: Option<usize>,
        besides: usize,
        fused: Option<&(usize, Sample)>,
    ) -> u32 {
        self.read_at.clear();
        let mut unreachable = 0u32;
        let present = self.grid.at_or_before(now);
        let corrected = fused.map(|(index, _)| *index);
        // A horizon that ends is for reproducing the paper, and need not keep to what an ECU can do in a tick.
        let room = if self.model.endless {
            Room::of(self.room, self.length, steps_sent(self.grid.step, STEPS), besides)
        } else {
            Room::ENDLESS
        };
        if self.present.get().is_some_and(|last| present.saturating_sub(last) > self.pause) {
            (0..PEERS).for_each(|index| self.turns.note(index));
        }
        self.present.set(present);
        let late = |index| {
            let newest = peers.get(index).and_then(Track::newest);
            newest.map_or(0, |newest| {
                usize::try_from(present.saturating_sub(self.grid.at_or_before(newest.at))).unwrap_or(0)
            })
        };
        self.turns.take(room, &self.chain, target, corrected, self.old, late);
        for place in 0..PEERS {
            let Some(index) = self.chain.at(place) else { continue };
            let Some(track) = peers.get(index) else { continue };
            let Some(sample) = track.newest() else { continue };
            let says_how = self.is_foreseen(index, peers);
            let source = match (self.turns.of(index), fused) {
                (Turn::News, _) if says_how => Source::Heard(sample),
                (_, Some((fused, sample))) if *fused == index => Source::Fused(sample),
                (Turn::News, _) => Source::Heard(sample),
                (Turn::Again, _) => Source::Again(sample),
                (Turn::None, _) => Source::Nothing,
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
        let Self { grid, model, length, horizons, strides, own, own_length, aheads, pause, .. } = self;
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
            Source::Heard(sample) | Source::Again(sample) => {
                (sample, track.knots().filter(|_| model.received).zip(track.parameters()))
            }
            Source::Fused(sample) => (sample, None),
            Source::Nothing => {
                // One that waits since a pause is read as it is until its turn comes.
                let behind = present.saturating_sub(horizon.first());
                if behind <= *pause || behind > steps(STEPS) {
                    forecast.extend(horizon, present);
                }
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
        usable.is_some() == received.is_some() || matches!(source, Source::Again(_))
    }

    /// Where a peer is at an instant, inside what is certain of it then.
    #[must_use]
    pub fn read_inside<const SAMPLES: usize>(
        &self,
        index: usize,
        at: Instant,
        peers: &Peers<PEERS, SAMPLES>,
    ) -> Option<Reading> {
        let track = peers.get(index)?;
        if self.read_at.get() == Some(at)
            && track.is_carried_to(at)
            && let Some(reading) = self.readings.get(index).and_then(Held::get)
        {
            return Some(reading);
        }
        let reading = self.read(index, at)?;
        let is_limited = track.certainty().bound().is_some_and(|bound| self.model.stamped && at >= bound.at());
        let bound = track.bound(at).filter(|_| is_limited);
        Some(bound.map_or(reading, |bound| certain::limited(reading, &bound)))
    }

    /// Reads where all peers are at an instant, for all who ask for it until the horizons change.
    pub fn read_all<const SAMPLES: usize>(&mut self, at: Instant, peers: &Peers<PEERS, SAMPLES>) {
        self.read_at.clear();
        self.readings = core::array::from_fn(|index| self.read_inside(index, at, peers).into());
        self.read_at.set(at);
    }

    /// Where a peer is at an instant by its horizon.
    #[must_use]
    pub fn read(&self, index: usize, at: Instant) -> Option<Reading> {
        self.horizons.get(index)?.read(at, &self.grid, self.model.interpolate)
    }

    /// Where a peer is at a step of the grid, by its horizon: without interpolation, and whatever is certain of it.
    #[must_use]
    pub fn read_step(&self, index: usize, step: i64) -> Option<Reading> {
        self.horizons.get(index)?.held(step)
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
