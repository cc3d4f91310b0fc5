//! What the unit sends. The state of this tick enters; frames by their schedule leave. The command and the estimate are sent every tick,
//! and the own motion and horizon at the link's period. The own driving parameters are sent with every fifth own motion and when they
//! change. A page of health is sent with every own motion.

use heapless::Vec;

use super::scene::Scene;
use super::{Estimate, MAX_FRAMES};
use crate::controller::{Gains, Mode};
use crate::health::{Cause, Health};
use crate::held::Held;
use crate::model::bound::Bound;
use crate::model::{Aim, Reading, VehicleModel};
use crate::peers::Sample;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Speed};
#[cfg(feature = "fd")]
use crate::wire::Transport;
use crate::wire::command::{Command, TICKS};
use crate::wire::driving_parameters::DrivingParameters;
use crate::wire::estimate::{Ends, TargetEstimate};
#[cfg(feature = "fd")]
use crate::wire::fd::State;
use crate::wire::horizon::{Knot, Knots};
use crate::wire::motion::{Motion, WirePosition};
use crate::wire::pass::Pass;
use crate::wire::quantity::Quantity;
use crate::wire::route::Route;
use crate::wire::status::{INTERFACE, Status};
use crate::wire::{Frame, Identifiers, Message, Predecessor, Said, Sender};

/// The driving parameters are sent once in this many own motions.
const PARAMETERS_EVERY: u8 = 5;
/// How often the driving parameters are sent at once when they change. A receiver that hears the first message of an identifier trusts
/// that identifier only from the second message on.
const PARAMETERS_AT_ONCE: u8 = 2;
/// The route is sent once in this many own motions. Tags count modulo 4.
const ROUTE_EVERY: u8 = 2;

/// The own messages of a tick.
pub(super) struct Report<'a> {
    pub mode: Mode,
    pub gains: Option<Gains>,
    /// The ego's motion, with the demand in force up to its stamp. From it the model of a receiver computes the demand of this tick
    /// again. `None` if the motion is too old.
    pub ego: Option<&'a Sample>,
    /// What it says of its passes.
    pub pass: Option<Pass>,
}

/// When which message is sent with the own messages, and the end-to-end state of each message.
#[derive(Clone, Debug)]
pub(super) struct Outbox {
    sender: Sender<0>,
    tick: u8,
    tag: u8,
    page: u8,
    until_parameters: u8,
    /// How many more times the driving parameters are sent at once.
    at_once: u8,
    parameters: Held<DrivingParameters>,
}

impl Outbox {
    pub(super) const fn new(identifiers: Identifiers) -> Self {
        Self {
            sender: Sender::new(identifiers),
            tick: 0,
            tag: 0,
            page: 0,
            until_parameters: 0,
            at_once: 0,
            parameters: Held::Nothing,
        }
    }

    pub(super) fn set_identifiers(&mut self, identifiers: &Identifiers) {
        self.sender.set_identifiers(identifiers);
    }

    #[cfg(feature = "fd")]
    pub(super) fn set_transport(&mut self, transport: Transport) {
        self.sender.set_transport(transport);
    }

    /// The number of this tick's command.
    pub(super) fn next_tick(&mut self) -> u8 {
        self.tick = self.tick.wrapping_add(1) % TICKS;
        self.tick
    }

    /// The tag of the next own motion, and of what comes with it.
    pub(super) fn next_tag(&self) -> u8 {
        self.tag.wrapping_add(1) % 4
    }

    /// Whether the route is sent with an own motion of this tag.
    pub(super) fn is_route_due(tag: u8) -> bool {
        tag.is_multiple_of(ROUTE_EVERY)
    }

    /// Whether the driving parameters are due: because they have changed, or because their turn has come.
    fn are_parameters_due(&mut self, parameters: DrivingParameters) -> bool {
        if self.parameters != Held::Value(parameters) {
            self.at_once = PARAMETERS_AT_ONCE;
        }
        let is_due = self.at_once > 0 || self.until_parameters == 0;
        self.at_once = self.at_once.saturating_sub(1);
        self.until_parameters = if is_due { PARAMETERS_EVERY } else { self.until_parameters }.saturating_sub(1);
        self.parameters.set(parameters);
        is_due
    }

    /// The next cause whose count is reported.
    fn next_page(&mut self) -> Cause {
        let cause = Cause::ALL.get(usize::from(self.page)).copied().unwrap_or(Cause::Length);
        let next = self.page.saturating_add(1);
        self.page = if usize::from(next) < Cause::ALL.len() { next } else { 0 };
        cause
    }
}

impl Outbox {
    /// Sends the command and the estimate, which every tick sends.
    pub(super) fn send_answer(
        &mut self,
        command: &Command,
        estimate: Option<&Estimate>,
        health: &mut Health,
        frames: &mut Vec<Frame, MAX_FRAMES>,
    ) {
        self.emit(&Message::Command(*command), health, frames);
        if let Some(estimate) = estimate {
            let estimate = self.target_estimate(estimate);
            self.emit(&Message::Estimate(estimate), health, frames);
        }
    }

    /// Sends the own messages, when they are due.
    pub(super) fn send_own<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        &mut self,
        scene: &Scene<PEERS, SAMPLES, STEPS>,
        now: Instant,
        report: &Report<'_>,
        health: &mut Health,
        frames: &mut Vec<Frame, MAX_FRAMES>,
    ) {
        if let Some(ego) = report.ego {
            self.send_motion(scene, ego, report, health, frames);
        }
        let cause = self.next_page();
        let status = Status {
            cause,
            count: health.of(cause),
            mode: report.mode.code(),
            detail: detail(scene, report.mode),
            synchronised: scene.is_synchronised(now),
            links_on: links_on(scene, now),
            interface: INTERFACE,
        };
        self.emit(&Message::Status(status), health, frames);
    }

    fn send_motion<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        &mut self,
        scene: &Scene<PEERS, SAMPLES, STEPS>,
        ego: &Sample,
        report: &Report<'_>,
        health: &mut Health,
        frames: &mut Vec<Frame, MAX_FRAMES>,
    ) {
        self.tag = self.next_tag();
        let tag = self.tag;
        let motion = Motion {
            tag,
            position: WirePosition::from_position(ego.position),
            speed: ego.speed,
            acceleration: ego.acceleration,
            demand: ego.demand,
            stamp: ego.stamp,
            position_accuracy: ego.position_accuracy,
            speed_accuracy: ego.speed_accuracy,
            station: scene.config.station,
        };
        #[cfg(feature = "fd")]
        if scene.config.transport == Transport::Fd {
            return self.send_state(scene, ego, motion, report, health, frames);
        }
        self.emit(&Message::Own(Said::Motion(motion)), health, frames);
        if let Some(route) = route(scene, tag, ego) {
            self.emit(&Message::Own(Said::Route(route)), health, frames);
        }
        self.send_pass(report, health, frames);
        if let Some(parameters) = self.due_parameters(scene, report) {
            self.emit(&Message::Own(Said::DrivingParameters(parameters)), health, frames);
        }
        if report.mode.is_by_law() {
            let knots = own_knots(scene, tag, ego);
            self.emit(&Message::Own(Said::Horizon(knots)), health, frames);
        }
    }

    /// Sends the same over CAN FD: what the motion begins is one message.
    #[cfg(feature = "fd")]
    fn send_state<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        &mut self,
        scene: &Scene<PEERS, SAMPLES, STEPS>,
        ego: &Sample,
        motion: Motion,
        report: &Report<'_>,
        health: &mut Health,
        frames: &mut Vec<Frame, MAX_FRAMES>,
    ) {
        let parameters = self.due_parameters(scene, report);
        let horizon = report.mode.is_by_law().then(|| own_knots(scene, motion.tag, ego));
        self.emit(&Message::Own(Said::State(State { motion, parameters, horizon })), health, frames);
        if let Some(route) = route(scene, motion.tag, ego) {
            self.emit(&Message::Own(Said::Route(route)), health, frames);
        }
        self.send_pass(report, health, frames);
    }

    fn send_pass(&mut self, report: &Report<'_>, health: &mut Health, frames: &mut Vec<Frame, MAX_FRAMES>) {
        if let Some(pass) = report.pass {
            self.emit(&Message::OwnPass(pass), health, frames);
        }
    }

    /// The driving parameters, when they are due.
    fn due_parameters<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        &mut self,
        scene: &Scene<PEERS, SAMPLES, STEPS>,
        report: &Report<'_>,
    ) -> Option<DrivingParameters> {
        let parameters = (report.mode != Mode::Standby).then(|| parameters(scene, report))?;
        self.are_parameters_due(parameters).then_some(parameters)
    }

    /// Adds the frames of a message to those of this tick. A frame that cannot be sent is lost, and counted.
    #[inline(never)] // one place that encodes
    fn emit(&mut self, message: &Message, health: &mut Health, frames: &mut Vec<Frame, MAX_FRAMES>) {
        let mut lost = 0u32;
        let mut push = |frame| lost = lost.saturating_add(u32::from(frames.push(frame).is_err()));
        let is_sent = self.sender.send_as_unit(message, &mut push).is_ok();
        health.add(Cause::TransmitOverflow, lost.saturating_add(u32::from(!is_sent)));
    }

    fn target_estimate(&self, estimate: &Estimate) -> TargetEstimate {
        let Reading { position, speed } = estimate.reading;
        let wire = WirePosition::from_position(position);
        // The ends are relative to what the receiver will read, not to the value before its rounding.
        let told = Reading { position: wire.nearest_to(position), speed: rounded(speed) };
        TargetEstimate {
            tag: self.tick % 4,
            position: wire,
            speed: told.speed,
            age: estimate.age,
            ends: estimate.bound.as_ref().map(|bound| ends(&told, bound)),
        }
    }
}

/// The route, every other time: the way to the next crossing point, from where the ego was at the motion's stamp.
fn route<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    tag: u8,
    ego: &Sample,
) -> Option<Route> {
    let (crossing, registration) = (scene.coordination.named()?, scene.coordination.registration()?);
    let point = scene.coordination.crossing_point(crossing)?;
    Outbox::is_route_due(tag).then(|| Route {
        tag,
        intersection: crossing.intersection.id,
        movement: crossing.movement,
        distance: point.ahead_of(WirePosition::from_position(ego.position).nearest_to(ego.position)),
        stamp: ego.stamp,
        arrival: registration.arrival.0,
        predecessor: scene.coordination.claim(),
    })
}

/// The cause of a fallback or a fault; in Standby, why a unit that is asked to drive does not.
fn detail<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    mode: Mode,
) -> u8 {
    match scene.actuators.cause().filter(|_| mode == Mode::Standby && scene.is_asked()) {
        Some(cause) => cause as u8,
        None => mode.detail(),
    }
}

/// The driving parameters of the ego. When it does not drive by its law, it says so by naming no predecessor.
fn parameters<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    report: &Report<'_>,
) -> DrivingParameters {
    let (config, law) = (&scene.config, &scene.config.law);
    let VehicleModel { aim, limits, .. } = scene.ego_model_now(report.gains);
    let consensus = match aim {
        Aim::Follow { law, .. } => law,
        Aim::Lead { .. } | Aim::Fade => law.consensus(),
    };
    DrivingParameters {
        length: config.length,
        standstill: scene.standstill(),
        predecessor: match scene.request.as_ref() {
            Some(_) if report.mode.is_by_law() => scene.followed(),
            _ => Predecessor::Unknown,
        },
        target_speed: scene.target_speed(),
        catch_up: law.catch_up,
        time_gap: scene.time_gap().plus(scene.opening.told()),
        gain: consensus.gain,
        damping: consensus.damping,
        feed_forward: consensus.feed_forward,
        lag: config.lag,
        limits,
        horizon_tenths: horizon_tenths(scene),
    }
}

/// The own horizon at its knots. The acceleration at a knot is the slope of the speeds around the knot.
fn own_knots<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    tag: u8,
    ego: &Sample,
) -> Knots {
    let start = Knot::start(ego.speed, ego.acceleration);
    let whole = Duration::from_millis(100).times(i64::from(horizon_tenths(scene)));
    let half = scene.estimator.grid().step.min(Duration::from_millis(50));
    let read = |at| scene.estimator.read_own(at).unwrap_or(Reading { position: ego.position, speed: ego.speed });
    let path = |after| {
        let reading = read(ego.at.plus(after));
        (reading.position.ahead_of(ego.position), reading.speed)
    };
    Knots::through(tag, start.rounded(), whole, path, |after| {
        let at = ego.at.plus(after);
        let change = read(at.plus(half)).speed.minus(read(at.minus(half)).speed);
        Acceleration::of_change(change, half.times(2).as_micros())
    })
}

/// How far the own horizon reaches, in tenths of a second.
fn horizon_tenths<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
) -> u8 {
    let length = scene.estimator.horizon_length().min(scene.config.prediction.horizon);
    u8::try_from(length.as_millis() / 100).unwrap_or(u8::MAX)
}

fn links_on<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
) -> u8 {
    let on = scene.peers.iter().filter(|track| track.link().is_on(now, &scene.config.link)).count();
    u8::try_from(on).unwrap_or(u8::MAX)
}

/// The bound as distances from the estimate. An estimate outside its bound widens the bound. Decimals are words only to the nearest bit,
/// which two more bits make up for.
fn ends(told: &Reading, bound: &Bound) -> Ends {
    let (way, change) = (Distance::from_bits(2), Speed::from_bits(2));
    Ends {
        behind: told.position.ahead_of(bound.lowest_position()).plus(way).max(Distance::ZERO),
        ahead: bound.highest_position().ahead_of(told.position).plus(way).max(Distance::ZERO),
        slower: told.speed.minus(bound.lowest_speed()).plus(change).max(Speed::ZERO),
        faster: bound.highest_speed().minus(told.speed).plus(change).max(Speed::ZERO),
    }
}

/// A speed rounded to what the wire can say.
fn rounded(speed: Speed) -> Speed {
    Speed::from_steps(speed.to_steps(500).clamp(0, 32_767), 500)
}

#[cfg(test)]
mod tests;
