//! The listening side: messages from the channel enter as frames on a bus; the estimates of the unit and of the
//! baselines leave.
//!
//! The unit is in a vehicle that follows the recorded vehicle and is abreast of it. So positions, which are modulo 33.5
//! km on the wire, are unwrapped near the truth, however long the drive is and wherever it starts. Nothing else of the
//! ego enters the estimate of a target, and the ego is not driven by it.
//!
//! The bus has been in use before the run: a receiver trusts an identifier from its second good frame on, and these
//! frames came long ago. The messages of that time are too old to be used.

use holdover::health::Cause;
use holdover::model::Reading;
use holdover::time::{Duration, Instant};
use holdover::units::Position;
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::{Identifiers, Message, Said, Sender};
use holdover::{Config, ConfigError};

use super::timeline::seconds;
use crate::bus::Frame;
use crate::measure::baseline::{self, Baseline, Estimate};
use crate::measure::observer::Observer;
use crate::sim::channel::OLDEST_S;
use crate::sim::modem::{Relay, V2xMessage};
use crate::sim::quantities::duration;
use crate::sim::station::{request, station};
use crate::sim::time::gnss;
use crate::sim::vehicle::Unit;
use crate::sim::world::{HORIZON_S, horizon};

/// The recorded vehicle.
pub const TARGET: usize = 0;
/// The vehicle that the recorded vehicle follows.
pub const PREDECESSOR: usize = 1;
/// The vehicle with the unit.
const EGO: usize = 2;

/// Number of methods: the unit and the baselines.
pub const METHODS: usize = 7;
/// The estimates: the unit's first, then the baselines' in their order.
pub type Beliefs = [Option<Estimate>; METHODS];

/// Time from the start of the unit's clock to the run.
const CLOCK_OFFSET_US: u64 = 60_000_000;
/// Cycle of the time base.
const SYNC_EVERY_US: i64 = 500_000;
/// The longest period that the unit can be configured with.
const LONGEST_PERIOD_S: f64 = 0.1;

/// A unit and the baselines in a silence: they receive no more messages.
#[derive(Clone)]
pub struct Deaf {
    unit: Unit,
    baselines: Vec<Box<dyn Baseline>>,
}

/// A unit and the baselines, with their bus.
pub struct Listener {
    deaf: Deaf,
    vehicle: Sender<0>,
    relay: Relay,
    observer: Observer,
    synced: Option<i64>,
    driven: Option<i64>,
    sequence: u8,
    tag: u8,
    /// Refusals during the warm-up, by cause.
    expected: Vec<u64>,
}

impl Listener {
    /// A listener with this prediction step and period, on a bus that `senders` have used before: these are the
    /// senders' messages.
    /// # Errors
    /// An error of the unit's configuration.
    pub fn new(step_s: f64, senders: &[V2xMessage]) -> Result<Self, ConfigError> {
        let mut config = Config::car(station(EGO));
        config.period = duration(step_s.min(LONGEST_PERIOD_S));
        config.prediction.step = duration(step_s);
        config.prediction.horizon = horizon(HORIZON_S, step_s);
        let deaf = Deaf { unit: Unit::new(&config)?, baselines: baseline::all(TARGET, step_s) };
        let mut listener = Self {
            deaf,
            vehicle: Sender::new(config.identifiers),
            relay: Relay::new(config.identifiers),
            observer: Observer::new(Identifiers::DEFAULT),
            synced: None,
            driven: None,
            sequence: 0,
            tag: 0,
            expected: Vec::new(),
        };
        for before_us in [1_500_000, 1_000_000] {
            listener.warm_up(-before_us, senders);
        }
        listener.expected = listener.counts().collect();
        Ok(listener)
    }

    /// Sends every identifier once. The motions have stamps that are refused as stale.
    fn warm_up(&mut self, at_us: i64, senders: &[V2xMessage]) {
        self.synchronise(at_us);
        self.say(at_us, &Message::DriverRequest(request(Some(TARGET), false, 0.0, 1.0)));
        self.drive(at_us, Position::ZERO);
        for sender in senders {
            let stamp = gnss(seconds(at_us) - OLDEST_S - 1.0).stamp();
            let stale = V2xMessage { motion: Motion { stamp, ..sender.motion }, ..*sender };
            for frame in self.relayed(at_us, &stale) {
                let _ = self.deaf.unit.receive(instant(at_us), &frame); // the refusal is intended
                let _ = self.observer.observe(seconds(at_us), &frame, Position::ZERO);
            }
        }
    }

    /// Takes in a message that arrives. `near` is a position near which its position is unwrapped.
    pub fn hear(&mut self, at_us: i64, message: &V2xMessage, near: Position) {
        if self.synced.is_none_or(|synced| at_us - synced >= SYNC_EVERY_US) {
            self.synchronise(at_us);
        }
        self.drive(at_us, near);
        for frame in self.relayed(at_us, message) {
            let _ = self.deaf.unit.receive(instant(at_us), &frame); // the unit counts refusals
            if let Some(heard) = self.observer.observe(seconds(at_us), &frame, near) {
                self.deaf.baselines.iter_mut().for_each(|baseline| baseline.hear(&heard));
            }
        }
    }

    /// One period of the unit.
    pub fn tick(&mut self, at_us: i64) {
        self.deaf.tick(at_us);
    }

    /// The estimates of unit and baselines at an instant, which is a tick of the unit; `near` as above.
    pub fn beliefs(&mut self, at_us: i64, near: Position) -> Beliefs {
        self.deaf.beliefs(at_us, near)
    }

    /// The unit's refusals by cause, in the order of [`Cause::ALL`].
    #[must_use]
    pub fn refusals(&self) -> Vec<(Cause, u64)> {
        let since = self.counts().zip(&self.expected).map(|(count, expected)| count - expected);
        Cause::ALL.iter().copied().zip(since).collect()
    }

    fn counts(&self) -> impl Iterator<Item = u64> + '_ {
        Cause::ALL.iter().map(|cause| u64::from(self.deaf.unit.health().of(*cause)))
    }

    /// A copy of the unit and the baselines, which goes on without messages.
    #[must_use]
    pub fn deafened(&self) -> Deaf {
        self.deaf.clone()
    }

    fn relayed(&mut self, at_us: i64, message: &V2xMessage) -> Vec<Frame> {
        let mut frames = Vec::new();
        self.relay.hear(seconds(at_us), message, &mut frames);
        frames.iter().map(Frame::from).collect()
    }

    fn synchronise(&mut self, at_us: i64) {
        self.synced = Some(at_us);
        self.sequence = (self.sequence + 1) % 16;
        let time = gnss(seconds(at_us)).as_micros();
        // 32 bits of seconds last until 2116, and the rest is below a million.
        let (seconds, micros) = ((time / 1_000_000) as u32, (time % 1_000_000) as u32);
        self.say(at_us, &Message::Sync(Sync { sequence: self.sequence, seconds }));
        self.say(at_us, &Message::FollowUp(FollowUp { sequence: self.sequence, micros }));
    }

    /// Sends the ego's own motion, once for messages that arrive together.
    fn drive(&mut self, at_us: i64, position: Position) {
        if self.driven.replace(at_us).is_some_and(|driven| at_us - driven < 1_000) {
            return;
        }
        self.tag = (self.tag + 1) % 4;
        let motion = Motion {
            tag: self.tag,
            position: WirePosition::from_position(position),
            speed: crate::sim::quantities::speed(0.0),
            acceleration: crate::sim::quantities::acceleration(0.0),
            demand: crate::sim::quantities::acceleration(0.0),
            stamp: gnss(seconds(at_us)).stamp(),
            position_accuracy: None,
            speed_accuracy: None,
            station: station(EGO),
        };
        self.say(at_us, &Message::Ego(Said::Motion(motion)));
    }

    fn say(&mut self, at_us: i64, message: &Message) {
        let unit = &mut self.deaf.unit;
        let sent = self.vehicle.send(message, &mut |frame| {
            let _ = unit.receive(instant(at_us), &Frame::from(&frame)); // the unit counts refusals
        });
        sent.expect("the catalogue has a line for each thing that the vehicle says");
    }
}

impl Deaf {
    /// One period of the unit. Returns its target estimate after it, in its own frame of reference.
    pub fn tick(&mut self, at_us: i64) -> Option<Reading> {
        Some(self.unit.tick(instant(at_us)).estimate?.reading)
    }

    /// The estimates of unit and baselines at an instant, which is a tick of the unit. `near` is a position near which
    /// the unit's estimate is unwrapped.
    pub fn beliefs(&mut self, at_us: i64, near: Position) -> Beliefs {
        let ours = self.tick(at_us).map(|reading| Estimate {
            position_m: unwrapped(reading.position.get().to_num(), near.get().to_num()),
            speed_mps: reading.speed.get().to_num(),
        });
        let mut baselines = self.baselines.iter_mut();
        std::array::from_fn(|method| match method {
            0 => ours,
            _ => baselines.next()?.estimate(seconds(at_us)),
        })
    }
}

/// A position that is known modulo the wire's range, unwrapped near another one.
fn unwrapped(position_m: f64, near_m: f64) -> f64 {
    let range_m = f64::from(1 << WirePosition::BITS) * 1e-3;
    position_m - ((position_m - near_m) / range_m).round() * range_m
}

fn instant(at_us: i64) -> Instant {
    Instant::from_micros(CLOCK_OFFSET_US).plus(Duration::from_micros(at_us))
}
