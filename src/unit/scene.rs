//! The scene: everything that the unit knows. Messages enter; what is known of the ego, of every peer and of the way ahead leaves.
//!
//! Messages change the scene ([`inbox`], [`admission`], [`places`], [`range`]). So do the two stages that bring it up to now: the review
//! of the order and the estimator. Every other stage of the tick only reads it. So a reference to the scene is the one view that the
//! rules need.

mod across;
mod actuators;
mod admission;
mod fused;
mod inbox;
mod named;
pub(super) mod passes;
mod places;
mod range;
mod sight;
mod unknown;

use super::opening::Opening;
use super::vantage::Vantage;
use crate::clock::Clock;
use crate::config::Config;
use crate::controller::Gains;
use crate::coordination::{ComfortBraking, Coordination, Entry, PeerApproach, standstill_on_way};
use crate::envelope::Obstacle;
use crate::estimator::Estimator;
use crate::held::Held;
use crate::model::bound::Bound;
use crate::model::{Aim, Consensus, Reading, Remainders, State, VehicleModel, catch_up};
use crate::parameters::{OLD_NEWS, OPENS_AFTER};
use crate::peers::{Peers, Sample, Track};
use crate::time::{Duration, Instant, Stamp};
use crate::units::{Acceleration, Distance, Position, Seconds, Speed};
use crate::wire::Predecessor;
use crate::wire::driver_request::DriverRequest;
use actuators::Actuators;
use fused::Fused;
use named::Named;
use passes::Passes;
use sight::Ranging;
use unknown::Unknown;

/// An `EgoMotion` is whole this long after it was measured (assumption A10).
const EGO_WITHIN: Duration = Duration::from_millis(20);

/// Everything that the unit knows.
#[derive(Clone, Debug)]
pub(super) struct Scene<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> {
    pub config: Config,
    pub clock: Clock,
    pub ego: Held<Sample>,
    /// What the driver wants, and when it was received last.
    pub request: Held<DriverRequest>,
    pub requested_at: Instant,
    pub peers: Peers<PEERS, SAMPLES>,
    pub estimator: Estimator<PEERS, STEPS>,
    pub coordination: Coordination<PEERS>,
    /// What the range sensor has seen.
    pub ranging: Ranging,
    /// The track of the vehicle that it sees.
    pub fused: Fused,
    /// What the actuators and the driver's feet say.
    pub actuators: Actuators,
    /// Vehicles without a slot.
    pub unknown: Unknown,
    /// The vehicle that the driver has put ahead.
    pub named: Named,
    /// The passes at the next intersection.
    pub passes: Passes,
    /// By how much the time gap is opened.
    pub opening: Opening,
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// The scene of a unit that is not started: all zero.
    pub const fn idle() -> Self {
        Self {
            config: Config::NONE,
            clock: Clock::new(),
            ego: Held::Nothing,
            request: Held::Nothing,
            requested_at: Instant::ZERO,
            peers: Peers::idle(),
            estimator: Estimator::idle(),
            coordination: Coordination::idle(),
            ranging: Ranging::new(),
            fused: Fused::NONE,
            actuators: Actuators::NONE,
            unknown: Unknown::NONE,
            named: Named::Nobody,
            passes: Passes::NONE,
            opening: Opening::NONE,
        }
    }

    /// Starts with nothing known but a checked configuration. It is set field by field, because as a whole it would pass over the stack.
    pub fn start(&mut self, config: &Config) {
        self.config = *config;
        self.clock = Clock::new();
        self.ego.clear();
        self.request.clear();
        self.requested_at = Instant::ZERO;
        self.peers.start(config.link.period);
        self.estimator.start(config, config.steps());
        self.coordination.reset();
        self.ranging = Ranging::new();
        self.fused = const { Fused::NONE };
        self.actuators = Actuators::NONE;
        self.unknown = Unknown::NONE;
        self.named = Named::Nobody;
        self.passes = const { Passes::NONE };
        self.opening.forget();
    }

    /// Whether GNSS time is known.
    pub fn is_synchronised(&self, now: Instant) -> bool {
        self.clock.is_synchronised(now, self.config.link.sync_timeout)
    }

    /// The instant of a message's stamp; `None` while GNSS time is not known.
    pub fn instant_of(&self, stamp: Stamp, at: Instant) -> Option<Instant> {
        if !self.is_synchronised(at) {
            return None;
        }
        self.clock.instant_of(stamp, at)
    }

    /// The ego's newest motion, unless it is too old.
    pub fn fresh_ego(&self, now: Instant) -> Option<&Sample> {
        self.ego.as_ref().filter(|ego| now.since(ego.received) <= self.config.link.ego_timeout)
    }

    /// How much later than its stamp says the ego's sample may have been taken, or earlier. Without GNSS time its stamp says nothing, and
    /// it counts from its reception, which is within [`EGO_WITHIN`] of the measurement.
    pub fn own_clock_error(&self, ego: &Sample) -> Duration {
        if ego.is_timed { self.config.link.clock_error } else { self.config.link.clock_error.max(EGO_WITHIN) }
    }

    /// The ego's state at now: its newest sample, moved on under the last demand if it is older than now.
    pub fn ego_at(&self, now: Instant, last_demand: Acceleration) -> Option<State> {
        let sample = self.ego.as_ref()?;
        let state = State {
            position: sample.position.ring(),
            speed: sample.speed,
            acceleration: sample.acceleration,
            demand: last_demand,
            remainders: Remainders::NONE,
        };
        let age = now.since(sample.at);
        if age <= Duration::ZERO {
            return Some(state);
        }
        let model = self.config.vehicle_model(Aim::Fade);
        Some(model.coast(state, age.min(self.config.link.ego_timeout), &self.config.prediction.model))
    }

    /// The ego's front bumper in this state, which is near its newest sample.
    pub fn front(&self, ego: &State) -> Position {
        let sample = self.ego.as_ref().map_or(Position::ZERO, |sample| sample.position);
        sample.ahead(ego.position.ahead_of(sample.ring()))
    }

    /// The ego at now, with its front bumper at `front`, at this speed.
    pub const fn vantage(&self, now: Instant, front: Position, speed: Speed) -> Vantage<'_, PEERS, SAMPLES, STEPS> {
        Vantage { scene: self, at: now, next: self.coordination.next(), front, speed }
    }

    /// `t_g`: the driver's, or else that of the configuration.
    pub fn time_gap(&self) -> Seconds {
        self.request.as_ref().and_then(|request| request.time_gap).unwrap_or(self.config.law.time_gap)
    }

    /// `v_∞`: the driver's, or else that of the configuration.
    pub fn target_speed(&self) -> Speed {
        self.request.as_ref().map_or(self.config.law.target_speed, |request| request.target_speed)
    }

    /// Whether the driver's request asks the unit to drive.
    pub fn is_asked(&self) -> bool {
        self.request.as_ref().is_some_and(|request| request.engaged)
    }

    /// Whether the unit is to drive: it is asked to, and neither pedals nor actuators forbid it.
    pub fn is_engaged(&self) -> bool {
        self.is_asked() && self.actuators.cause().is_none()
    }

    /// Whether the driver's request is too old to be obeyed.
    pub fn is_request_lost(&self, now: Instant) -> bool {
        self.request.as_ref().is_some() && now.since(self.requested_at) > self.config.link.request_timeout
    }

    /// Opens or closes the time gap from now on; without a target, it closes.
    #[inline(never)]
    pub fn note_silence(&mut self, now: Instant, target: Option<usize>) {
        let is_on_lane = self.coordination.itinerary().is_none() || self.visible() == target;
        let opens = self.opens_behind(now, target.filter(|_| is_on_lane));
        if opens || self.opening.is_opened() {
            self.opening.go_on(now, opens, self.most_opened());
        }
    }

    /// Whether the time gap opens behind this target, because there has been no news of it for too long. Ask it only of a target on the ego's
    /// lane: one that comes by another leg is none that the ego keeps a time gap to yet.
    pub fn opens_behind(&self, now: Instant, target: Option<usize>) -> bool {
        let unheard = target.and_then(|index| self.peers.get(index)?.link().silence(now));
        let is_unseen = || self.ranging.unseen(now).is_none_or(|unseen| unseen > OPENS_AFTER);
        unheard.is_some_and(|unheard| unheard > OPENS_AFTER) && is_unseen()
    }

    /// By how much the time gap that is wanted may be opened.
    pub fn most_opened(&self) -> Seconds {
        self.config.law.silent_time_gap.minus(self.time_gap())
    }

    /// How the ego drives by the law, at the time gap that is wanted: with these gains and this standstill distance behind a target, or on
    /// a free road.
    pub fn ego_model(&self, behind: Option<(Gains, Distance)>, comfort: ComfortBraking) -> VehicleModel {
        let (law, target_speed) = (&self.config.law, self.target_speed());
        let aim = match behind {
            Some((gains, standstill)) => Aim::Follow {
                law: Consensus {
                    gain: gains.gain,
                    damping: gains.damping,
                    time_gap: self.time_gap(),
                    feed_forward: law.feed_forward,
                },
                standstill: if self.config.prediction.model.standstill { standstill } else { Distance::ZERO },
                catch_up: catch_up(target_speed, law.catch_up),
            },
            None => Aim::Lead { largest: law.free_road_acceleration, target_speed },
        };
        let VehicleModel { aim, lag, mut limits } = self.config.vehicle_model(aim);
        limits.braking = comfort.limit(limits.braking);
        VehicleModel { aim, lag, limits }
    }

    /// How the ego drives now: with the gains of its association, if there is one.
    pub fn ego_model_now(&self, gains: Option<Gains>) -> VehicleModel {
        self.ego_model(gains.map(|gains| (gains, self.standstill())), self.coordination.choice().comfort)
    }

    /// The vehicle that the driver asks the ego to follow.
    fn requested(&self) -> Predecessor {
        self.request.as_ref().map_or(Predecessor::Unknown, |request| request.predecessor)
    }

    /// Whether the order at the intersections decides which vehicle the ego follows, and not the driver.
    pub fn is_decided_by_order(&self) -> bool {
        self.requested() == Predecessor::Unknown && self.coordination.registration().is_some()
    }

    /// The vehicle that the ego is to follow: the driver's choice, or the vehicle that the order has put ahead of it.
    pub fn predecessor(&self) -> Predecessor {
        if !self.is_decided_by_order() {
            return self.requested();
        }
        let Some(target) = self.coordination.choice().target else { return Predecessor::None };
        let station = self.peers.get(target.into()).and_then(Track::station);
        station.map_or(Predecessor::None, Predecessor::Station)
    }

    /// The vehicle that the ego is to follow, by the name that it has now.
    pub fn followed(&self) -> Predecessor {
        let target = self.target().and_then(|index| self.peers.get(index)?.station());
        match (self.predecessor(), target) {
            (Predecessor::Station(_), Some(name)) => Predecessor::Station(name),
            (requested, _) => requested,
        }
    }

    /// Whether the target has news from so long ago that its horizon takes long to start anew: its first news after a silence.
    pub fn has_late_news(&self, now: Instant) -> bool {
        self.target().is_some_and(|index| {
            let newest = self.peers.get(index).and_then(Track::newest);
            let is_late = newest.is_some_and(|newest| now.since(newest.at) > self.config.link.period.times(OLD_NEWS));
            is_late && self.estimator.has_news(index)
        })
    }

    /// The slot of the vehicle that the ego is to follow. Of several with the name that the driver says, it is the nearest ahead when it
    /// is named. After that another one takes its place only where it is certain to be between: the last place of a silent vehicle is
    /// soon behind the ego, and says nothing of which one is nearer.
    pub fn target(&self) -> Option<usize> {
        let Predecessor::Station(station) = self.predecessor() else { return None };
        if self.is_decided_by_order() {
            return self.coordination.choice().target.map(usize::from);
        }
        let ego = self.ego.as_ref();
        let Some(nearest) = self.peers.predecessor(station, ego.map(|ego| ego.position)) else {
            // The vehicle that the driver named has another name since. It is that vehicle until the driver names another one.
            return self.named.slot().filter(|_| self.named.is_called(station));
        };
        if self.named.is_not_in(nearest, station) {
            return None;
        }
        // It has that name, or had it when the driver named it: a vehicle may change its name, which leaves the name to others.
        let held = self.named.slot().filter(|_| self.named.is_called(station));
        let Some((held, ego)) = held.filter(|held| *held != nearest).zip(ego) else { return Some(nearest) };
        let bounds = self.bound(held, ego.at).zip(self.bound(nearest, ego.at));
        let is_replaced = bounds.is_none_or(|(held, nearest)| {
            let is_between = nearest.highest_position() < held.lowest_position();
            held.highest_position() < ego.position || is_between && nearest.lowest_position() > ego.position
        });
        Some(if is_replaced { nearest } else { held })
    }

    /// The slot of the vehicle ahead that a sensor would see. On a way through intersections it is one that is ahead for certain: where a
    /// silent vehicle is estimated to be is no reason to take what is seen for that vehicle.
    pub fn visible(&self) -> Option<usize> {
        let choice = self.coordination.choice();
        match self.coordination.itinerary() {
            Some(_) => choice.lane.map(usize::from).filter(|index| choice.leading.contains(*index)),
            None => self.target(),
        }
    }

    /// Where a peer is estimated to be, inside what is certain of it at that instant.
    pub fn estimated(&self, index: usize, at: Instant) -> Option<Reading> {
        self.estimator.read_inside(index, at, &self.peers)
    }

    /// The same, and its rear bumper.
    pub fn rear(&self, index: usize, at: Instant) -> Option<(Reading, Position)> {
        let reading = self.estimated(index, at)?;
        Some((reading, reading.position.ahead(self.peers.length_of(index).negated())))
    }

    /// What is certain of a peer at an instant, now or later.
    pub fn bound(&self, index: usize, at: Instant) -> Option<Bound> {
        self.peers.get(index)?.bound(at)
    }

    /// The rear bumper of a peer at its near end, and the bound.
    pub fn near_rear(&self, index: usize, at: Instant) -> Option<(Position, Bound)> {
        let bound = self.bound(index, at)?;
        Some((bound.lowest_position().ahead(self.peers.length_of(index).negated()), bound))
    }

    /// The rear of a peer at its near end, as the obstacle that the ego has to stay behind.
    pub fn obstacle(&self, now: Instant, index: usize) -> Option<Obstacle> {
        let reach = self.peers.get(index)?.reach();
        Some(Obstacle::rear(&self.bound(index, now)?, self.peers.length_of(index), &reach))
    }

    /// Whether a peer was heard recently enough for its estimate to be driven by.
    pub fn is_in_reach(&self, index: usize, at: Instant) -> bool {
        let silence = self.peers.get(index).and_then(|track| track.link().silence(at));
        silence.is_some_and(|silence| silence <= self.config.link.holdover)
    }

    /// The entry of a peer in the order.
    pub fn entry(&self, index: usize, approach: &PeerApproach) -> Option<Entry> {
        let station = self.peers.get(index).and_then(Track::station)?;
        Some(Entry { station, arrival: approach.arrival, claim: approach.claim, leg: approach.movement.leg })
    }

    /// Whether a peer comes by another leg and takes the ego's exit.
    pub fn joins(&self, index: usize) -> bool {
        self.coordination.approach(index).is_some_and(|approach| self.coordination.joins(approach))
    }

    /// The standstill distance behind the vehicle that the ego follows.
    pub fn standstill(&self) -> Distance {
        let target = self.coordination.choice().target.map(usize::from);
        target.map_or(self.config.law.standstill, |index| self.standstill_at(self.coordination.next(), index))
    }

    /// The standstill distance behind a peer, with `next` as the ego's next crossing.
    pub fn standstill_at(&self, next: usize, index: usize) -> Distance {
        let law = self.config.law.standstill;
        let Some(itinerary) = self.coordination.itinerary() else { return law };
        let approach = self.coordination.approach(index).filter(|approach| approach.crossing == next);
        let crossing = approach.and_then(|approach| {
            let crossing = itinerary.crossings.get(next)?;
            crossing.intersection.conflict(crossing.movement, approach.movement).then_some(crossing)
        });
        standstill_on_way(law, crossing, self.config.range_sensor)
    }

    /// Where the next conflict area begins.
    pub fn area_begins(&self) -> Option<Position> {
        let crossing = self.coordination.crossing()?;
        Some(self.coordination.crossing_point(crossing)?.ahead(crossing.intersection.half.negated()))
    }
}
