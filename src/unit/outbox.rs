//! What the unit sends: the state of this tick enters, frames by their schedule leave. Command and estimate every tick, the
//! own motion and horizon at the link's period, the own driving parameters every fifth time and when it changes, a page of health
//! with every own motion.

use heapless::Vec;

use super::{Estimate, MAX_FRAMES, OnboardUnit};
use crate::config::Config;
use crate::controller::Mode;
use crate::dynamics::Inversion;
use crate::estimator::bound::Bound;
use crate::estimator::{Aim, Reading, State, VehicleModel};
use crate::health::Cause;
use crate::held::Held;
use crate::peers::Sample;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Speed};
use crate::wire::command::Command;
use crate::wire::driving_parameters::DrivingParameters;
use crate::wire::estimate::{Ends, TargetEstimate};
use crate::wire::horizon::{Knot, Knots};
use crate::wire::motion::{Motion, WirePosition};
use crate::wire::quantity::Quantity;
use crate::wire::route::Route;
use crate::wire::status::Status;
use crate::wire::{Frame, Message, Predecessor, Said};

/// How many own motions go by from one driving parameters to the next.
const INTENT_EVERY: u8 = 5;
/// How often driving parameters is sent at once when it changes: whoever hears the first message of an identifier trusts it from the second
/// one on.
const INTENT_AT_ONCE: u8 = 2;
/// How many own motions go by from one route to the next; tags count modulo 4.
const ROUTE_EVERY: u8 = 2;

/// When what is due.
#[derive(Clone, Debug)]
pub(super) struct Outbox {
    inversion: Inversion,
    tick: u8,
    tag: u8,
    page: u8,
    due: Option<Instant>,
    until_parameters: u8,
    /// How often the driving parameters is still to be sent at once.
    at_once: u8,
    parameters: Held<DrivingParameters>,
}

impl Outbox {
    pub(super) const fn new() -> Self {
        Self {
            inversion: Inversion::new(),
            tick: 0,
            tag: 0,
            page: 0,
            due: None,
            until_parameters: 0,
            at_once: 0,
            parameters: Held::Nothing,
        }
    }

    /// The command of this tick.
    pub(super) fn command(
        &mut self,
        config: &Config,
        acceleration: Acceleration,
        ego: Option<&State>,
        mode: Mode,
        limited: bool,
    ) -> Command {
        self.tick = self.tick.wrapping_add(1) % 64;
        let effort = self.inversion.effort(config, ego, mode != Mode::Standby, acceleration);
        Command { acceleration, effort, mode: mode.code(), limited, tick: self.tick }
    }

    /// Whether the own messages are due; a schedule that was missed starts anew.
    fn is_due(&mut self, now: Instant, period: Duration) -> bool {
        let due = self.due.unwrap_or(now);
        if now < due {
            self.due = Some(due);
            return false;
        }
        let next = due.plus(period);
        self.due = Some(if next <= now { now.plus(period) } else { next });
        true
    }

    /// Whether driving parameters is due: it is another one, or its turn has come.
    fn is_parameters_due(&mut self, parameters: DrivingParameters) -> bool {
        if self.parameters != Held::Value(parameters) {
            self.at_once = INTENT_AT_ONCE;
        }
        let is_due = self.at_once > 0 || self.until_parameters == 0;
        self.at_once = self.at_once.saturating_sub(1);
        self.until_parameters = if is_due { INTENT_EVERY } else { self.until_parameters }.saturating_sub(1);
        self.parameters.set(parameters);
        is_due
    }

    /// The next cause to report.
    fn next_page(&mut self) -> Cause {
        let cause = Cause::ALL.get(usize::from(self.page)).copied().unwrap_or(Cause::Length);
        let next = self.page.saturating_add(1);
        self.page = if usize::from(next) < Cause::ALL.len() { next } else { 0 };
        cause
    }
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// Everything that this tick sends.
    pub(super) fn send(
        &mut self,
        now: Instant,
        command: &Command,
        estimate: Option<&Estimate>,
        last_demand: Acceleration,
        target: Option<usize>,
        frames: &mut Vec<Frame, MAX_FRAMES>,
    ) {
        if !self.is_started() {
            return;
        }
        self.emit(&Message::Command(*command), frames);
        if let Some(estimate) = estimate {
            self.emit(&Message::Estimate(self.target_estimate(estimate)), frames);
        }
        if !self.outbox.is_due(now, self.config.link.period) {
            return;
        }
        if let Some(ego) = self.ego.get().filter(|ego| now.since(ego.received) <= self.config.link.ego_timeout) {
            self.send_own(now, &ego, last_demand, target, frames);
        }
        let cause = self.outbox.next_page();
        let status = Status {
            cause,
            count: self.health.of(cause),
            mode: self.mode.code(),
            detail: self.mode.detail(),
            synchronised: self.is_synchronised(now),
            links_on: self.links_on(now),
        };
        self.emit(&Message::Status(status), frames);
    }

    fn send_own(
        &mut self,
        now: Instant,
        ego: &Sample,
        last_demand: Acceleration,
        target: Option<usize>,
        frames: &mut Vec<Frame, MAX_FRAMES>,
    ) {
        self.outbox.tag = self.outbox.tag.wrapping_add(1) % 4;
        let tag = self.outbox.tag;
        // The demand in force up to the stamp: from it the receiver's model repeats the one of this tick.
        let demand = if self.mode == Mode::Standby { ego.demand } else { last_demand };
        let motion = Motion {
            tag,
            position: WirePosition::from_position(ego.position),
            speed: ego.speed,
            acceleration: ego.acceleration,
            demand,
            stamp: ego.stamp,
            position_accuracy: ego.position_accuracy,
            speed_accuracy: ego.speed_accuracy,
            station: self.config.station,
        };
        self.emit(&Message::Own(Said::Motion(motion)), frames);
        self.send_route(tag, ego, frames);
        let is_by_law = matches!(self.mode, Mode::Cooperative | Mode::Holdover { .. });
        if self.mode != Mode::Standby {
            let parameters = self.parameters(is_by_law);
            if self.outbox.is_parameters_due(parameters) {
                self.emit(&Message::Own(Said::DrivingParameters(parameters)), frames);
            }
        }
        if is_by_law {
            let sample = Sample { demand, ..*ego };
            self.foresee(now, &sample, target);
            let knots = self.own_knots(tag, ego);
            self.emit(&Message::Own(Said::Horizon(knots)), frames);
        }
    }

    /// Every other time, the way to the next crossing point, from where the ego was at the motion's stamp.
    fn send_route(&mut self, tag: u8, ego: &Sample, frames: &mut Vec<Frame, MAX_FRAMES>) {
        let (Some(crossing), Some(registration)) = (self.coordination.named(), self.coordination.registration()) else {
            return;
        };
        let Some(point) = self.coordination.crossing_point(crossing) else { return };
        if !tag.is_multiple_of(ROUTE_EVERY) {
            return;
        }
        let route = Route {
            tag,
            intersection: crossing.intersection.id,
            leg: crossing.leg,
            distance: point.ahead_of(WirePosition::from_position(ego.position).nearest_to(ego.position)),
            stamp: ego.stamp,
            arrival: registration.arrival.0,
            predecessor: self.coordination.claim(),
        };
        self.emit(&Message::Own(Said::Route(route)), frames);
    }

    /// Adds a message's frames to those of this tick. What cannot be sent is lost, and counted.
    fn emit(&mut self, message: &Message, frames: &mut Vec<Frame, MAX_FRAMES>) {
        // Named, so that the image holds the encoders of these alone.
        let is_own =
            matches!(message, Message::Command(_) | Message::Estimate(_) | Message::Status(_) | Message::Own(_));
        let mut lost = 0u32;
        let mut push = |frame| lost = lost.saturating_add(u32::from(frames.push(frame).is_err()));
        let is_sent = is_own && self.sender.send(message, &mut push).is_ok();
        self.health.add(Cause::TransmitOverflow, lost.saturating_add(u32::from(!is_sent)));
    }

    fn target_estimate(&self, estimate: &Estimate) -> TargetEstimate {
        let Reading { position, speed } = estimate.reading;
        let wire = WirePosition::from_position(position);
        // The ends are told from what the receiver will read, not from what it was rounded from.
        let told = Reading { position: wire.nearest_to(position), speed: rounded(speed) };
        TargetEstimate {
            tag: self.outbox.tick % 4,
            position: wire,
            speed: told.speed,
            age: estimate.age,
            ends: estimate.bound.as_ref().map(|bound| ends(&told, bound)),
        }
    }

    /// How the ego says that it drives. When it does not drive by its law it says so by naming no predecessor.
    fn parameters(&self, is_by_law: bool) -> DrivingParameters {
        let config = &self.config;
        let VehicleModel { aim, limits, .. } = self.driver();
        let law = &config.law;
        let (gain, damping, time_gap) = match aim {
            Aim::Follow { gain, damping, time_gap, .. } => (gain, damping, time_gap),
            Aim::Lead { .. } | Aim::Fade => (law.gain, law.damping, law.time_gap),
        };
        DrivingParameters {
            length: config.length,
            standstill: self.standstill(),
            predecessor: match self.desired.as_ref() {
                Some(_) if is_by_law => self.predecessor(),
                _ => Predecessor::Unknown,
            },
            target_speed: self.target_speed(),
            time_gap,
            gain,
            damping,
            lag: config.lag,
            limits,
            horizon_tenths: self.horizon_tenths(),
        }
    }

    /// The own horizon at its knots. The acceleration at a knot is the slope of the speeds around it.
    fn own_knots(&self, tag: u8, ego: &Sample) -> Knots {
        let start = Knot::start(ego.speed, ego.acceleration);
        let whole = Duration::from_millis(100).times(i64::from(self.horizon_tenths()));
        let half = self.estimator.grid().step.min(Duration::from_millis(50));
        let read = |at| self.estimator.read_own(at).unwrap_or(Reading { position: ego.position, speed: ego.speed });
        Knots::through(tag, start.rounded(), whole, |after| {
            let at = ego.at.plus(after);
            let reading = read(at);
            let change = read(at.plus(half)).speed.minus(read(at.minus(half)).speed);
            Knot {
                displacement: reading.position.ahead_of(ego.position),
                speed: reading.speed,
                acceleration: slope(change, half.times(2)),
                bow: Distance::ZERO,
            }
        })
    }

    /// How far the own horizon reaches, in tenths of a second.
    fn horizon_tenths(&self) -> u8 {
        let reach = self.estimator.reach().min(self.config.prediction.horizon);
        u8::try_from(reach.as_millis() / 100).unwrap_or(u8::MAX)
    }

    fn links_on(&self, now: Instant) -> u8 {
        let on = self.peers.iter().filter(|track| track.link().is_on(now, &self.config.link)).count();
        u8::try_from(on).unwrap_or(u8::MAX)
    }
}

/// The bound as distances from the estimate. An estimate outside its bound widens it. Decimals are words only to the
/// nearest bit, which two more bits make up for.
fn ends(told: &Reading, bound: &Bound) -> Ends {
    let (way, change) = (Distance::from_bits(2), Speed::from_bits(2));
    Ends {
        behind: told.position.ahead_of(bound.lowest_position()).plus(way).max(Distance::ZERO),
        ahead: bound.highest_position().ahead_of(told.position).plus(way).max(Distance::ZERO),
        slower: told.speed.minus(bound.lowest_speed()).plus(change).max(Speed::ZERO),
        faster: bound.highest_speed().minus(told.speed).plus(change).max(Speed::ZERO),
    }
}

/// A speed as the wire can say it.
fn rounded(speed: Speed) -> Speed {
    Speed::from_steps(speed.to_steps(500).clamp(0, 32_767), 500)
}

/// A change of speed over a time, saturating.
#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
pub(super) fn slope(change: Speed, time: Duration) -> Acceleration {
    // 23 to 25 fraction bits is a factor of 4; per second instead of per microsecond one of 1e6.
    let change = i64::from(change.to_bits()).saturating_mul(4_000_000);
    let slope = crate::fixed::quotient(change, time.as_micros());
    Acceleration::from_bits(crate::fixed::saturate_i32(slope))
}

#[cfg(test)]
mod tests;
