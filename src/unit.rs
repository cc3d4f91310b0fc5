//! The onboard unit: frames and ticks enter by its two doors, a command and frames leave. The only file that names every
//! stage.

use embedded_can::Frame as CanFrame;
use heapless::Vec;

use crate::clock::Clock;
use crate::config::{Config, ConfigError};
use crate::controller::{Controller, Course, Facts, FallbackCause, FaultCause, Gains, Mode, TargetFact};
use crate::coordination::{ComfortBraking, Coordination};
use crate::envelope::Reckoning;
use crate::estimator::{Aim, Estimator, Reading, Remainders, State, VehicleModel};
use crate::health::{Cause, Health, Incident};
use crate::held::Held;
use crate::peers::{Peers, Sample};
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Seconds, Speed};
use crate::wire::command::Command;
use crate::wire::driver_request::DriverRequest;
use crate::wire::{BaseId, Predecessor, Received, Receiver, Role, Sender};
use gate::Displaced;

mod admission;
mod answer;
mod coordinate;
mod ego_horizon;
mod gate;
mod inbox;
mod lane;
mod outbox;
mod range;
mod room;
mod sight;
mod unknown;
mod view;

pub use answer::{Answer, Estimate, MAX_FRAMES, Reception};

/// The onboard unit for up to `PEERS` peers with a history of `SAMPLES` samples each and horizons of up to `STEPS` steps.
///
/// It is `Clone`, holds no pointer, and may live in a `static`.
#[derive(Clone, Debug)]
pub struct OnboardUnit<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> {
    config: Config,
    receiver: Receiver<PEERS>,
    sender: Sender<0>,
    clock: Clock,
    ego: Held<Sample>,
    desired: Held<DriverRequest>,
    peers: Peers<PEERS, SAMPLES>,
    estimator: Estimator<PEERS, STEPS>,
    /// Whom the ego follows, with the gains looked up when that began.
    association: Option<(crate::wire::StationHash, Gains)>,
    controller: Controller,
    mode: Mode,
    health: Health,
    outbox: outbox::Outbox,
    ranging: sight::Ranging,
    unknown: unknown::Unknown,
    /// The ego as the last gate sees it.
    reckoning: Held<Reckoning>,
    /// The slot of whom the driver named and who was heard of, until another one is both.
    named: Option<u8>,
    /// The same, once somebody else has its slot.
    displaced: Held<Displaced>,
    coordination: Coordination<PEERS>,
    last_tick: Option<Instant>,
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// A unit that is not started: it refuses to hear anything and says nothing. Every byte of it is zero, so a `static`
    /// that begins with it takes no room in flash, and [`start`](Self::start) starts it where it lies.
    #[must_use]
    pub const fn idle() -> Self {
        Self {
            config: Config::NONE,
            receiver: Receiver::new(BaseId::NONE, Role::Unit),
            sender: Sender::new(BaseId::NONE),
            clock: Clock::new(),
            ego: Held::Nothing,
            desired: Held::Nothing,
            peers: Peers::idle(),
            estimator: Estimator::idle(),
            association: None,
            controller: Controller::idle(),
            mode: Mode::Standby,
            health: Health::new(),
            outbox: outbox::Outbox::new(),
            ranging: sight::Ranging::new(),
            unknown: unknown::Unknown::NONE,
            reckoning: Held::Nothing,
            named: None,
            displaced: Held::Nothing,
            coordination: Coordination::idle(),
            last_tick: None,
        }
    }

    /// Starts the unit, or starts it anew: it has not heard anything yet.
    ///
    /// # Errors
    /// The first value of the configuration that is out of its documented range; nothing is changed then.
    #[inline(never)] // what it needs on the stack is not to stay there
    pub fn start(&mut self, config: &Config) -> Result<(), ConfigError> {
        config.check(STEPS)?;
        // Field by field, because the whole of it would pass over the stack.
        self.config = *config;
        self.receiver = Receiver::new(config.base_id, Role::Unit);
        self.sender = Sender::new(config.base_id);
        self.clock = Clock::new();
        self.ego.clear();
        self.desired.clear();
        self.peers.start(config.link.period);
        self.estimator.start(&config.prediction, config.steps(), config.station, config.length);
        self.association = None;
        self.controller = Controller::new(config.period);
        self.mode = Mode::Standby;
        self.health = Health::new();
        self.outbox = outbox::Outbox::new();
        self.ranging = sight::Ranging::new();
        self.unknown = unknown::Unknown::NONE;
        self.reckoning.clear();
        self.named = None;
        self.displaced.clear();
        self.coordination.reset();
        self.last_tick = None;
        Ok(())
    }

    /// A unit that is started, by value: for those who have tens of kilobytes of stack.
    ///
    /// # Errors
    /// As for [`start`](Self::start).
    pub fn new(config: &Config) -> Result<Self, ConfigError> {
        let mut unit = Self::idle();
        unit.start(config)?;
        Ok(unit)
    }

    /// A configuration that was checked has a period.
    fn is_started(&self) -> bool {
        self.config.period > Duration::ZERO
    }

    /// Takes in one frame received at `at`. Bounded time; frames may come in any order and at any time.
    ///
    /// # Errors
    /// The named cause for which the frame, or the message that it completes, is refused. It is counted, and nothing else
    /// is changed by it but the end-to-end state of its identifier.
    #[inline(never)] // neither door is to hold the stack of the other
    pub fn receive(&mut self, at: Instant, frame: &impl CanFrame) -> Result<Reception, Cause> {
        if !self.is_started() {
            return Ok(Reception::Foreign);
        }
        let result = match self.receiver.receive_as_unit(at, frame) {
            Ok(Received::Foreign) => Ok(Reception::Foreign),
            Ok(Received::Pending) => Ok(Reception::Pending),
            Ok(Received::Whole(message)) => self.take(at, &message).map(|()| Reception::Taken),
            Err(cause) => Err(cause),
        };
        if let Err(cause) = result {
            self.health.count(cause);
        }
        result
    }

    /// Takes note of what the platform around the unit met with, so many times since it last said so.
    pub fn note(&mut self, incident: Incident, times: u32) {
        self.health.add(incident.cause(), times);
    }

    /// The task of one period: always answers, and takes bounded time. A `now` before the last one is counted and taken as
    /// the last one.
    #[inline(always)] // so that the answer is made where it is wanted, and not copied there
    pub fn tick(&mut self, now: Instant) -> Answer {
        let mut answer = Answer { command: Command::NONE, mode: Mode::Standby, estimate: None, frames: Vec::new() };
        self.answer(now, &mut answer);
        answer
    }

    #[inline(never)]
    fn answer(&mut self, now: Instant, answer: &mut Answer) {
        let before = self.last_tick;
        let now = self.monotonic(now);
        let since = before.map_or(Duration::ZERO, |before| now.since(before));
        self.coordinate(now);
        let target = self.target();
        self.note_named(target);
        let before = match self.mode {
            Mode::Holdover { .. } => target.and_then(|index| self.estimated(index, now)),
            _ => None,
        };
        let unreachable = self.estimator.update(now, &self.peers);
        self.health.add(Cause::Unreachable, unreachable);
        let reading = target.and_then(|index| self.estimated(index, now));

        let facts = self.facts(now, target, reading.is_some());
        self.mode = self.mode.next(&facts, now);
        if let (Mode::Cooperative, Some(before), Some(after)) = (self.mode, before, reading)
            && self.config.prediction.model.smooth
        {
            self.controller.blend_from(before, after);
        }
        self.associate(reading);

        let ego = self.ego_at(now);
        let last = self.controller.last_demand();
        let course = self.course(now, target, ego.as_ref());
        let demand = self.controller.drive(&self.config, now, ego.as_ref(), &course);
        let (acceleration, limited) = match self.config.envelope {
            Some(limits) if self.mode != Mode::Standby => {
                self.gate(&limits, now, demand, last, ego.as_ref(), &facts, since)
            }
            _ => {
                // Of what somebody else commands nothing is known.
                self.reckoning.clear();
                (demand, false)
            }
        };
        self.controller.correct(acceleration);
        answer.command = self.outbox.command(&self.config, acceleration, ego.as_ref(), self.mode, limited);
        answer.mode = self.mode;
        answer.estimate = target.zip(reading).and_then(|(index, reading)| self.estimate(now, index, reading));
        self.send(now, &answer.command, answer.estimate.as_ref(), last, target, &mut answer.frames);
    }

    fn monotonic(&mut self, now: Instant) -> Instant {
        let Some(last) = self.last_tick else {
            self.estimator.start_grid(now);
            self.last_tick = Some(now);
            return now;
        };
        if now < last {
            self.health.count(Cause::ClockBackwards);
            return last;
        }
        self.last_tick = Some(now);
        now
    }

    /// The slot of whom the ego is to follow.
    fn target(&self) -> Option<usize> {
        match self.predecessor() {
            Predecessor::Station(station) => self.peers.index_of(station),
            Predecessor::None | Predecessor::Unknown => None,
        }
    }

    fn facts(&self, now: Instant, target: Option<usize>, readable: bool) -> Facts {
        let ego = match self.ego.as_ref() {
            None => Err(FaultCause::EgoMissing),
            Some(ego) if now.since(ego.received) > self.config.link.ego_timeout => Err(FaultCause::EgoStale),
            Some(_) => Ok(()),
        };
        let track = target.and_then(|index| self.peers.get(index));
        let target = match (self.predecessor(), track) {
            (Predecessor::None, _) => TargetFact::NotNeeded,
            (Predecessor::Unknown, _) => TargetFact::Lost(FallbackCause::NotAssociated),
            (Predecessor::Station(_), Some(track)) if readable => {
                let silence = track.link().silence(now).unwrap_or(Duration::MAX);
                if track.link().is_on(now, &self.config.link) {
                    TargetFact::On
                } else if silence <= self.config.link.holdover {
                    TargetFact::Off
                } else {
                    TargetFact::Lost(FallbackCause::Silent)
                }
            }
            (Predecessor::Station(_), _) => TargetFact::Lost(FallbackCause::NeverHeard),
        };
        // Whoever is seen ahead is driven by then, and not what is heard.
        let is_contradicted = self.visible().is_some_and(|index| self.is_contradicted(index, now));
        let target = match target {
            TargetFact::Lost(_) => target,
            _ if is_contradicted => TargetFact::Lost(FallbackCause::RangeDisagrees),
            _ => target,
        };
        Facts { engaged: self.desired.as_ref().is_some_and(|desired| desired.engaged), ego, target }
    }

    /// Looks the gains up when the target changes.
    fn associate(&mut self, reading: Option<Reading>) {
        let Predecessor::Station(station) = self.predecessor() else {
            self.association = None;
            return;
        };
        if self.association.is_some_and(|(associated, _)| associated == station) {
            return;
        }
        let (Some(target), Some(ego)) = (reading, self.ego.as_ref()) else { return };
        let headway = target.position.ahead_of(ego.position);
        self.association = Some((station, Gains::look_up(&self.config.law, ego.speed, target.speed, headway)));
    }

    /// The ego's state at now: its newest sample, moved on under the last demand if it is older.
    fn ego_at(&self, now: Instant) -> Option<State> {
        let sample = self.ego.as_ref()?;
        let state = State {
            position: sample.position.ring(),
            speed: sample.speed,
            acceleration: sample.acceleration,
            demand: self.controller.last_demand(),
            remainders: Remainders::NONE,
        };
        let age = now.since(sample.at);
        if age <= Duration::ZERO {
            return Some(state);
        }
        let driver = VehicleModel::of_config(&self.config, Aim::Fade);
        Some(driver.coast(state, age.min(self.config.link.ego_timeout), &self.config.prediction.model))
    }

    /// How the ego itself drives: the law of its mode.
    fn driver(&self) -> VehicleModel {
        let association = self.association.map(|(_, gains)| (gains, self.standstill()));
        self.driver_with(association, self.coordination.choice().comfort)
    }

    /// How it drives with these gains and this standstill distance behind somebody, or behind nobody.
    fn driver_with(&self, association: Option<(Gains, Distance)>, comfort: ComfortBraking) -> VehicleModel {
        let (law, target_speed) = (&self.config.law, self.target_speed());
        let aim = match association {
            Some((gains, standstill)) => Aim::Follow {
                gain: gains.gain,
                damping: gains.damping,
                time_gap: self.time_gap(),
                standstill: if self.config.prediction.model.standstill { standstill } else { Distance::ZERO },
                target_speed,
            },
            None => Aim::Lead { largest: law.free_road_acceleration, target_speed },
        };
        let VehicleModel { aim, lag, mut limits } = VehicleModel::of_config(&self.config, aim);
        limits.braking = comfort.limit(limits.braking);
        VehicleModel { aim, lag, limits }
    }

    /// `t_g`: the driver's, or else the configuration's.
    fn time_gap(&self) -> Seconds {
        self.desired.as_ref().and_then(|desired| desired.time_gap).unwrap_or(self.config.law.time_gap)
    }

    /// `v_∞` likewise.
    fn target_speed(&self) -> Speed {
        self.desired.as_ref().map_or(self.config.law.target_speed, |desired| desired.target_speed)
    }

    fn course(&self, now: Instant, target: Option<usize>, ego: Option<&State>) -> Course {
        match self.mode {
            Mode::Standby => Course::Yield { demand: self.ego.as_ref().map_or(Acceleration::ZERO, |ego| ego.demand) },
            Mode::Cooperative | Mode::Holdover { .. } => {
                let next = now.plus(self.config.period);
                let reading = target.and_then(|index| {
                    let length = self.peers.get(index)?.parameters().map(|parameters| parameters.length);
                    Some((self.estimated(index, next)?, length))
                });
                let cap = ego.map_or(Acceleration::MAX, |ego| self.careful(now, ego));
                Course::Law { driver: self.driver(), target: reading, cap }
            }
            Mode::Fallback { .. } => match self.still_known(now, target) {
                Some(ahead) => Course::Cruise { ahead, target_speed: self.target_speed() },
                None => Course::Caution,
            },
            Mode::Fault { .. } => Course::Brake,
        }
    }

    fn estimate(&self, now: Instant, index: usize, reading: Reading) -> Option<Estimate> {
        let track = self.peers.get(index)?;
        let age = now.since(track.newest()?.at);
        let link_on = track.link().is_on(now, &self.config.link);
        Some(Estimate { reading, age, link_on, bound: self.bound(index, now) })
    }
}
