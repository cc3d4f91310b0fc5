//! The onboard unit: frames and ticks enter by its two doors, a command and frames leave. The only file that names every
//! stage.
//!
//! ```text
//!  frame -> Receiver -> message -> Scene: all that is known, changed by messages and by the first two stages of a tick
//!                                    |
//!  tick:  look     at what the range sensor saw                                 scene
//!         review   whom the ego follows, by the order at the intersections        coordinate
//!         update   every horizon, brought up to now                               estimator
//!         decide   the mode, and the gains of a new association                   course, mode, association
//!         drive    the demand, by the course of the mode                          course, stopping, room, controller
//!         limit    the command: the demand, or what the limits leave of it        gate, lane, envelope
//!         actuate  the force or torque that brings the command about              dynamics
//!         foresee  the own horizon                                                ego_horizon
//!         plan     the passes to claim                                            pass
//!         send     frames                                                         outbox
//! ```
//!
//! Not every tick reviews, foresees and plans (`schedule`). From `decide` on the scene is only looked at, but `foresee` writes the opening
//! of the time gap and the own horizon into it, and `plan` the passes. ARCHITECTURE.md explains the order.

use embedded_can::Frame as CanFrame;
use heapless::Vec;

use crate::config::{Config, ConfigError};
use crate::controller::{Controller, Mode};
use crate::coordination::{Itinerary, MapError};
use crate::dynamics::Inversion;
use crate::health::{Cause, Health, Incident};
use crate::model::{Reading, State};
use crate::peers::Sample;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Speed};
use crate::wire::command::{ACCELERATION_STEPS, Command};
use crate::wire::quantity::Quantity;
use crate::wire::{Frame, Identifiers, Received, Receiver, Role};
use association::Association;
use gate::{Gate, Last};
use outbox::{Outbox, Report};
use pass::Range;
use scene::Scene;
use schedule::{Schedule, Tasks};

mod answer;
mod association;
mod coordinate;
mod course;
mod ego_horizon;
mod gate;
mod lane;
mod opening;
mod outbox;
mod pass;
mod room;
mod scene;
mod schedule;
mod stopping;
mod vantage;
mod view;

pub use answer::{Answer, Estimate, MAX_FRAMES, Reception};

/// The onboard unit for up to `PEERS` peers with a history of `SAMPLES` samples each and horizons of up to `STEPS` steps.
/// It is `Clone`, holds no pointer, and may live in a `static`.
#[derive(Clone, Debug)]
pub struct OnboardUnit<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> {
    receiver: Receiver<PEERS>,
    scene: Scene<PEERS, SAMPLES, STEPS>,
    association: Association,
    mode: Mode,
    controller: Controller,
    gate: Gate,
    dynamics: Inversion,
    schedule: Schedule,
    outbox: Outbox,
    health: Health,
    last_tick: Option<Instant>,
    /// The demand of the tick before the last one.
    demand_before: Acceleration,
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// A unit that is not started: it refuses to hear anything and says nothing. Every byte of it is zero, so a `static`
    /// that begins with it takes no room in flash, and [`start`](Self::start) starts it where it lies.
    #[must_use]
    pub const fn idle() -> Self {
        Self {
            receiver: Receiver::new(Identifiers::NONE, Role::Unit),
            scene: Scene::idle(),
            association: Association::NONE,
            mode: Mode::Standby,
            controller: Controller::idle(),
            gate: Gate::new(),
            dynamics: Inversion::new(),
            outbox: Outbox::new(Identifiers::NONE),
            health: Health::new(),
            last_tick: None,
            demand_before: Acceleration::ZERO,
            schedule: Schedule::NEW,
        }
    }

    /// Starts the unit, or starts it anew: it has not heard anything yet.
    ///
    /// # Errors
    /// The first value of the configuration that is out of its documented range; nothing is changed then.
    #[inline(never)] // what it needs on the stack is not to stay there
    pub fn start(&mut self, config: &Config) -> Result<(), ConfigError> {
        config.check(STEPS)?;
        // Field by field, because the whole of it would pass over the stack. A constant of zeros is written in place.
        self.receiver = const { Receiver::new(Identifiers::NONE, Role::Unit) };
        self.receiver.set_identifiers(&config.identifiers);
        #[cfg(feature = "fd")]
        self.receiver.set_transport(config.transport);
        self.scene.start(config);
        self.association = Association::NONE;
        self.mode = Mode::Standby;
        self.controller = Controller::new(config.period);
        self.gate = Gate::new();
        self.dynamics = Inversion::new();
        self.outbox = const { Outbox::new(Identifiers::NONE) };
        self.outbox.set_identifiers(&config.identifiers);
        #[cfg(feature = "fd")]
        self.outbox.set_transport(config.transport);
        self.health = Health::new();
        self.last_tick = None;
        self.demand_before = Acceleration::ZERO;
        self.schedule = Schedule::NEW;
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

    /// Sets out on a way through intersections: from now on, and until the unit is started anew, positions of peers are taken on
    /// the virtual lane, and where `DriverRequest` names no predecessor the order at the intersections decides whom to follow.
    ///
    /// # Errors
    /// What is wrong with the map; nothing is changed then.
    pub fn set_out(&mut self, itinerary: &'static Itinerary) -> Result<(), MapError> {
        self.scene.coordination.set_out(itinerary, self.scene.config.length)?;
        self.scene.passes = const { scene::passes::Passes::NONE };
        self.gate.begin();
        Ok(())
    }

    /// A configuration that was checked has a period.
    fn is_started(&self) -> bool {
        self.scene.config.period > Duration::ZERO
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
            Ok(Received::Whole(message)) => self.scene.take(at, &message, &mut self.health).map(|()| Reception::Taken),
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

    /// The stages in the order of the diagram above.
    #[inline(never)]
    fn answer(&mut self, now: Instant, answer: &mut Answer) {
        let (now, last) = self.begin(now);
        let tasks = self.tasks(now, last);
        let Tasks { reviews, plans, speaks, waits } = tasks;
        self.scene.look(&mut self.health);
        let target = self.review(now, last, reviews);
        let fused = if waits { None } else { self.scene.fuse() };
        let (before, reading) = self.update(now, target, tasks.besides(), fused.as_ref());
        self.decide(now, target, before, reading);
        let ego = self.scene.ego_at(now, last.demand);
        let demand = self.drive(now, target, ego.as_ref());
        let (acceleration, limited) = self.limit(now, demand, last, ego.as_ref());
        answer.command = self.actuate(now, acceleration, limited, ego.as_ref());
        answer.mode = self.mode;
        answer.estimate = target.zip(reading).and_then(|(index, reading)| self.estimate(now, index, reading));
        if self.is_started() {
            let own = speaks.then(|| self.foresee(now, last, target));
            if plans {
                self.plan(now, ego.as_ref());
            }
            self.send(now, own.as_ref().map(Option::as_ref), answer);
        }
        self.demand_before = last.demand;
    }

    /// The time of this tick, and the demand of the last one with its age.
    fn begin(&mut self, now: Instant) -> (Instant, Last) {
        let last_tick = self.last_tick;
        let now = self.monotonic(now);
        let age = last_tick.map_or(Duration::ZERO, |last_tick| now.since(last_tick));
        (now, Last { demand: self.controller.last_demand(), age })
    }

    /// What this tick does of what is not done in every tick. It has much else to do after a pause, in a review that was asked for, and
    /// when its target's news ends a silence.
    fn tasks(&mut self, now: Instant, last: Last) -> Tasks {
        let (period, between) = (self.scene.config.period, self.scene.config.link.period);
        let (scene, coordination) = (&self.scene, &self.scene.coordination);
        let is_busy = || last.age > between || coordination.is_asked_at_once() || scene.has_late_news(now);
        let tasks = self.schedule.tasks(now, period, between, is_busy);
        let may_review = !tasks.waits || coordination.is_asked_at_once();
        Tasks { reviews: may_review && coordination.is_due(now), ..tasks }
    }

    /// The vehicle that the ego follows, by the order at the intersections or by the driver's word.
    fn review(&mut self, now: Instant, last: Last, reviews: bool) -> Option<usize> {
        if self.scene.coordination.itinerary().is_some() {
            self.scene.peers.carry(now); // all of them are asked for
        }
        if reviews {
            coordinate::review(&mut self.scene, now, last.demand, &mut self.health);
        }
        self.scene.passes.turn_to(self.scene.coordination.next());
        self.scene.note_others(now);
        let target = self.scene.target();
        self.scene.note_named(target);
        if let Some(track) = target.and_then(|index| self.scene.peers.get_index_mut(index)) {
            track.carry(now);
        }
        target
    }

    fn monotonic(&mut self, now: Instant) -> Instant {
        let Some(last) = self.last_tick else {
            self.scene.estimator.start_grid(now);
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

    /// Brings every horizon up to now. The target's reading of now by the horizon as it was, in a holdover, and as it is.
    fn update(
        &mut self,
        now: Instant,
        target: Option<usize>,
        besides: usize,
        fused: Option<&(usize, Sample)>,
    ) -> (Option<Reading>, Option<Reading>) {
        let before = match self.mode {
            Mode::Holdover { .. } => target.and_then(|index| self.scene.estimated(index, now)),
            _ => None,
        };
        let Scene { estimator, peers, .. } = &mut self.scene;
        let unreachable = estimator.update(now, peers, target, besides, fused);
        self.health.add(Cause::Unreachable, unreachable);
        (before, target.and_then(|index| self.scene.estimated(index, now)))
    }

    /// Decides the mode and the gains. After a silence the controller is led from the old reading to the new one.
    fn decide(&mut self, now: Instant, target: Option<usize>, before: Option<Reading>, reading: Option<Reading>) {
        let facts = course::facts(&self.scene, now, target, reading.is_some());
        let before_mode = self.mode;
        self.mode = self.mode.next(&facts, now);
        if self.mode.hands_back() && !before_mode.hands_back() {
            self.health.count(Cause::RequestLost);
        }
        if let (Mode::Cooperative, Some(before), Some(after)) = (self.mode, before, reading)
            && self.scene.config.prediction.model.smooth
        {
            self.controller.blend_from(before, after);
        }
        self.association.update(&self.scene, reading);
    }

    /// The demand of the controller.
    fn drive(&mut self, now: Instant, target: Option<usize>, ego: Option<&State>) -> Acceleration {
        let course = course::course(&self.scene, now, self.mode, target, self.association.gains(), ego);
        self.controller.drive(&self.scene.config, now, ego, &course)
    }

    /// The command that the last gate lets through, and whether the gate changed the demand.
    fn limit(&mut self, now: Instant, demand: Acceleration, last: Last, ego: Option<&State>) -> (Acceleration, bool) {
        let (acceleration, limited) = match &self.scene.config.envelope {
            Some(limits) if self.mode != Mode::Standby => {
                self.gate.command(limits, &self.scene, now, demand, last, ego)
            }
            _ => {
                self.gate.forget();
                (demand, false)
            }
        };
        self.controller.correct(acceleration);
        (acceleration, limited)
    }

    /// The command with the force or the torque that brings it about.
    fn actuate(&mut self, now: Instant, acceleration: Acceleration, limited: bool, ego: Option<&State>) -> Command {
        let is_driving = self.mode != Mode::Standby;
        // A vehicle moves off when its sensors say so, and not when it is commanded to: its brakes may be held.
        let stands = self.scene.ego.as_ref().is_some_and(|ego| ego.speed <= Speed::ZERO);
        let ego = ego.map(|ego| if stands { State { speed: Speed::ZERO, ..*ego } } else { *ego });
        let effort = self.dynamics.effort(&self.scene.config, ego.as_ref(), is_driving, acceleration);
        let hold = is_driving && stands && acceleration.to_steps(ACCELERATION_STEPS) <= 0;
        let (mode, tick) = (self.mode.code(), self.outbox.next_tick());
        self.scene.actuators.note_command(tick);
        // Since the first tick, so that it does not matter where the clock began.
        let since = now.since(self.scene.estimator.grid().origin);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 10 bits
        let time_ms = (since.as_millis() & 1023) as u16;
        Command { acceleration, effort, mode, limited, tick, hold, time_ms }
    }

    /// What is believed of the target.
    fn estimate(&self, now: Instant, index: usize, reading: Reading) -> Option<Estimate> {
        let track = self.scene.peers.get(index)?;
        let age = now.since(track.newest()?.at);
        let link_on = track.link().is_on(now, &self.scene.config.link);
        Some(Estimate { reading, age, link_on, bound: self.scene.bound(index, now) })
    }

    /// The ego's motion as it is to be told, with its own horizon computed from it; `None` if the motion is too old. Its demand is
    /// the one in force up to its stamp: from that one a receiver's model repeats the demand that came into force then.
    fn foresee(&mut self, now: Instant, last: Last, target: Option<usize>) -> Option<Sample> {
        match self.mode {
            Mode::Standby => self.scene.opening.forget(),
            _ => self.scene.note_silence(now, target),
        }
        let ego = self.scene.fresh_ego(now)?;
        // The last demand came into force at the last tick, as well as the two clocks can tell.
        let in_force = now.minus(last.age).plus(self.scene.config.link.clock_error);
        let demand = if ego.at > in_force { last.demand } else { self.demand_before };
        let own = if self.mode == Mode::Standby { *ego } else { Sample { demand, ..*ego } };
        if self.mode.is_by_law() {
            ego_horizon::foresee(&mut self.scene, now, &own, target, self.association.gains());
        }
        Some(own)
    }

    /// Plans the passes that are claimed at the next intersection.
    #[inline(never)] // apart from the stack of the horizon
    fn plan(&mut self, now: Instant, ego: Option<&State>) {
        self.scene.passes.keeps = self.gate.keeps_out();
        if let Some(range) = ego.filter(|_| self.keeps_passes(now)).and_then(|ego| Range::of(&self.scene, now, ego)) {
            pass::plan(&mut self.scene, &range, self.mode.is_by_law(), self.gate.is_committed());
        }
    }

    fn keeps_passes(&self, now: Instant) -> bool {
        self.scene.may_claim() && self.scene.fresh_ego(now).is_some()
    }

    /// Sends the answer, and the own messages if they are due: then `own` is the ego's motion as far as it is known.
    fn send(&mut self, now: Instant, own: Option<Option<&Sample>>, answer: &mut Answer) {
        let Answer { command, estimate, frames, .. } = answer;
        self.outbox.send_answer(command, estimate.as_ref(), &mut self.health, frames);
        if let Some(own) = own {
            self.send_own(now, own, frames);
        }
    }

    fn send_own(&mut self, now: Instant, own: Option<&Sample>, frames: &mut Vec<Frame, MAX_FRAMES>) {
        let tag = self.outbox.next_tag();
        let says = Outbox::is_route_due(tag) && self.keeps_passes(now);
        let pass = if says { self.scene.say_passes(now, tag, self.gate.is_committed()) } else { None };
        let report = Report { mode: self.mode, gains: self.association.gains(), ego: own, pass };
        self.outbox.send_own(&self.scene, now, &report, &mut self.health, frames);
    }
}
