//! Another vehicle, driven by events: its body and limits, its messages, and those of them that are still on their way.

use crate::body::Body;
use crate::random::Random;
use crate::scenario::{Peer, Radio, Sensor};
use crate::vehicle::{measured, published};
use crate::wire::{BOOK, Can, Counters, stamp, wrapped};

/// Time for which harder limits are published before they are used, s.
const ANNOUNCED: f64 = 10.0;

/// Published limits, m/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Hardest braking.
    pub braking: f64,
    /// Hardest acceleration.
    pub pulling: f64,
}

impl Limits {
    /// The limits as the bus can represent them. A vehicle that keeps its published limits keeps these.
    pub fn new(braking: f64, pulling: f64) -> Self {
        let steps = |value: f64| (value * 50.0).round() / 50.0;
        Self { braking: steps(braking), pulling: steps(pulling) }
    }
}

/// A message on its way.
#[derive(Clone, Copy, Debug)]
pub enum Message {
    /// Tag, and values as measured.
    Motion(Motion),
    /// The driving parameters.
    DrivingParameters {
        /// Tag of the message.
        tag: u8,
        /// Hardest braking and acceleration.
        limits: Limits,
        /// Length, bumper to bumper, m.
        length: f64,
    },
}

/// A motion on its way.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Tag of the message.
    pub tag: u8,
    /// Its station.
    pub station: u8,
    /// Time of measurement, s of true time.
    pub at: f64,
    /// Time of measurement by the sender's clock, µs.
    pub stamp: i64,
    /// As measured.
    pub position: f64,
    pub speed: f64,
    pub acceleration: f64,
    pub demand: f64,
    /// The sensor with its published accuracies.
    pub sensor: Sensor,
}

impl Motion {
    /// The two frames in a slot.
    pub fn frames(&self, slot: u8, counters: &mut Counters) -> [Can; 2] {
        let layout = &BOOK.peers[usize::from(slot)].0;
        let tag = f64::from(self.tag);
        let a = [tag, wrapped(self.position), stamp(self.stamp), f64::from(self.station)];
        let accuracies = published(&self.sensor);
        let b = [tag, self.speed, self.acceleration, self.demand, accuracies.0, accuracies.1];
        [layout.a.seal(counters, &a), layout.b.seal(counters, &b)]
    }
}

/// The three frames in a slot.
pub fn parameter_frames(slot: u8, counters: &mut Counters, tag: u8, limits: &Limits, length: f64) -> [Can; 3] {
    let layout = &BOOK.peers[usize::from(slot)].1;
    let tag = f64::from(tag);
    [
        layout.who.seal(counters, &[tag, 0.0, length, 2.0, 1.0, 0.0, 30.0]),
        layout.law.seal(counters, &[tag, 1.0, 1.6, 0.5, 2.0, 0.3]),
        layout.limits.seal(counters, &[tag, 2.0, limits.pulling, limits.braking.min(4.0), 5.0, limits.braking, 0.0]),
    ]
}

/// The vehicle.
pub struct Other {
    /// The scenario's peer.
    pub set_up: Peer,
    /// Its motion, its motion a step before, and the time of that.
    pub body: Body,
    before: Body,
    since: f64,
    /// Its demand, m/s².
    pub demand: f64,
    /// Its present station and slot.
    pub station: u8,
    pub slot: u8,
    /// Whether it is on the ego's lane.
    pub on_lane: bool,
    /// The limits and the length that it publishes.
    pub limits: Limits,
    pub length: f64,
    /// The limits that the unit accepted, with the times.
    pub known: Vec<(f64, Limits)>,
    /// Whether the unit has accepted a motion of this station, and its driving parameters.
    pub is_heard: bool,
    pub has_told: bool,
    /// It is silent until this time.
    pub mute_until: f64,
    /// Time of its last frames on the bus.
    pub delivered: f64,
    /// Messages on their way, with their times of arrival.
    pub air: Vec<(f64, Message)>,
    /// Stamp of the newest delivered motion; and since when honest motions are refused, and how many.
    pub newest: i64,
    pub refused: Option<(f64, u32)>,
    tag: u8,
    parameters_tag: u8,
    next_motion: f64,
    next_parameters: f64,
    losing: u32,
    last_parameters: f64,
    random: Random,
}

impl Other {
    /// The scenario's peer. The ego's front bumper is at `front`.
    pub fn new(set_up: &Peer, front: f64, seed: u64, number: usize) -> Self {
        let mut random = Random::new(seed, 2000 + number as u64);
        let limits = Limits::new(set_up.braking, set_up.pulling);
        let body = Body {
            position: front + set_up.ahead,
            speed: set_up.speed,
            acceleration: 0.0,
            lag: 0.0,
            braking: limits.braking,
            pulling: limits.pulling,
            top: 33.0,
        };
        Self {
            set_up: *set_up,
            body,
            before: body,
            since: 0.0,
            demand: set_up.demand,
            station: set_up.station,
            slot: set_up.slot,
            on_lane: set_up.on_lane,
            limits,
            length: set_up.length,
            known: Vec::new(),
            is_heard: false,
            has_told: !set_up.intends,
            mute_until: 0.0,
            delivered: f64::NEG_INFINITY,
            air: Vec::new(),
            newest: i64::MIN,
            refused: None,
            tag: random.below(4) as u8,
            parameters_tag: random.below(4) as u8,
            next_motion: set_up.phase,
            next_parameters: set_up.phase + 0.02,
            losing: 0,
            last_parameters: 0.0,
            random,
        }
    }

    /// Takes another station, which the unit does not know yet.
    pub fn rename(&mut self, station: u8) {
        self.station = station;
        (self.is_heard, self.has_told) = (false, !self.set_up.intends);
    }

    /// Whether the unit knows the station's motion and length.
    pub fn is_known(&self) -> bool {
        self.is_heard && self.has_told
    }

    /// Rear bumper.
    pub fn rear(&self) -> f64 {
        self.body.position - self.set_up.length
    }

    /// Moves on from an instant for a time.
    pub fn drive(&mut self, since: f64, time: f64) {
        (self.before, self.since) = (self.body, since);
        self.body.drive(self.demand, time);
    }

    /// Sets its limits: at most those that it publishes, those that the unit has accepted, and those in messages that
    /// are still on their way to the unit. `times` is the factor on its braking if that assumption is broken.
    pub fn limit(&mut self, times: f64) {
        let mut least = self.limits;
        let in_air = self.air.iter().filter_map(|(_, message)| match message {
            Message::DrivingParameters { limits, .. } => Some(*limits),
            Message::Motion(_) => None,
        });
        // Harder limits are used only when they have been known for a while. Of the older ones, the last still counts.
        let now = self.since;
        if let Some(old) = self.known.iter().rposition(|(since, _)| now - since > ANNOUNCED) {
            self.known.drain(..old);
        }
        for limits in in_air.chain(self.known.iter().map(|(_, limits)| *limits)) {
            least.braking = least.braking.min(limits.braking);
            least.pulling = least.pulling.min(limits.pulling);
        }
        (self.body.braking, self.body.pulling) = (least.braking * times, least.pulling);
    }

    /// Sends the messages that are due until then.
    pub fn speak(&mut self, until: f64, epoch: i64, radio: &Radio, times: f64, is_well: bool) {
        while self.next_motion <= until && self.station != 0 {
            let at = self.next_motion;
            self.next_motion += 0.1;
            let body = self.before.after(self.demand, (at - self.since).max(0.0));
            self.tag = (self.tag + 1) % 4;
            let (position, speed) = measured(&self.set_up.sensor, &body, times, &mut self.random);
            let stamp = epoch + (at * 1e6).round() as i64 + self.set_up.clock.round() as i64;
            let motion = Motion {
                tag: self.tag,
                station: self.station,
                at,
                stamp,
                position,
                speed,
                acceleration: body.acceleration,
                demand: self.demand.clamp(-self.body.braking, self.body.pulling),
                sensor: self.set_up.sensor,
            };
            if let Some(arrives) = self.carry(at, radio, is_well) {
                self.air.push((arrives, Message::Motion(motion)));
            }
        }
        while self.next_parameters <= until && self.station != 0 {
            let at = self.next_parameters;
            self.next_parameters += 0.5;
            self.parameters_tag = (self.parameters_tag + 1) % 4;
            if !self.set_up.intends {
                continue;
            }
            if let Some(arrives) = self.carry(at, radio, is_well) {
                // Driving parameters have no stamp. The modem passes them on in the order of sending.
                self.last_parameters = self.last_parameters.max(arrives) + 1e-4;
                let parameters =
                    Message::DrivingParameters { tag: self.parameters_tag, limits: self.limits, length: self.length };
                self.air.push((self.last_parameters, parameters));
            }
        }
    }

    /// Time of arrival of a message that is sent now; `None` if it is lost.
    fn carry(&mut self, at: f64, radio: &Radio, is_well: bool) -> Option<f64> {
        if at < self.mute_until {
            return None;
        }
        if is_well {
            return Some(at + radio.delay.min(0.05));
        }
        if self.losing > 0 {
            self.losing -= 1;
            return None;
        }
        if self.random.chance(radio.loss / radio.burst.max(1.0)) {
            self.losing = self.random.exponential(radio.burst - 0.5).round().max(0.0) as u32;
            return None;
        }
        let late = if self.random.chance(radio.tails) {
            self.random.between(0.0, radio.tail)
        } else {
            self.random.exponential(radio.jitter)
        };
        Some(at + (radio.delay + late).min(radio.delay + radio.tail.max(radio.jitter * 6.0)))
    }

    /// The next message that arrives until then, in order.
    pub fn arriving(&mut self, until: f64) -> Option<(f64, Message)> {
        let next = (0..self.air.len()).min_by(|a, b| self.air[*a].0.total_cmp(&self.air[*b].0))?;
        (self.air[next].0 <= until).then(|| self.air.swap_remove(next))
    }
}
