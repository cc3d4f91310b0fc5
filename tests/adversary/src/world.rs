//! A drive on one lane: a scenario enters, the findings leave. In each step of ten milliseconds the events that are due
//! happen, bodies move, stations send, modem and sensors put frames on the bus, the unit ticks, and its output is
//! judged.

mod happen;

use crate::body::safe_gap;
use crate::broken::Assumption;
use crate::judge;
use crate::peer::{Message, Motion, Other, parameter_frames};
use crate::random::Random;
use crate::scenario::{Family, Scenario, Sensor};
use crate::vehicle::{Vehicle, Verdict, error, largest};
use crate::verdict::{Fault, Outcome};
use crate::wire::SLOTS;

/// Length of a step, s.
pub const STEP: f64 = 0.01;
/// Time after which the modem gives a slot to another station, and a station another slot, s.
const SLOT_REUSE: f64 = 2.05;

/// Runs a drive.
pub fn run(scenario: &Scenario) -> Outcome {
    if scenario.family == Family::Crossing {
        return crate::crossing::run(scenario);
    }
    let mut world = World::new(scenario);
    let steps = (scenario.length / STEP).round() as u64;
    for step in 0..steps {
        world.step(step as f64 * STEP);
        if world.outcome.of(Fault::Collision).is_some() {
            break;
        }
    }
    world.end(scenario.length);
    world.outcome
}

/// A measurement of the range sensor on its way: time of arrival, distance, difference of speeds, age.
type View = (f64, f64, f64, f64);

/// The world.
pub struct World<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The vehicle with the unit.
    pub ego: Vehicle,
    /// The other vehicles.
    pub others: Vec<Other>,
    /// The station that the unit was told to follow, as far as it accepted that.
    pub followed: u8,
    /// The driver's target speed; and the highest speed before the last change, with the time of that change.
    pub wanted: f64,
    pub(crate) wanted_before: (f64, f64),
    /// The findings.
    pub outcome: Outcome,
    /// The last time at which the unit drove cooperatively.
    pub cooperative: f64,
    /// Time since which no fault is injected; `None` while faults may be injected.
    pub well: Option<f64>,
    engaged: bool,
    /// The station that the driver wants to follow, and the station that the driver names. A station is named once the
    /// unit knows its motion and its length.
    follow: u8,
    names: u8,
    next_event: usize,
    cutting_in: Vec<usize>,
    slot_requests: Vec<(usize, u8)>,
    /// Time at which the modem last used each slot, and the station.
    slot_used: [(f64, u8); SLOTS],
    deaf_until: f64,
    timeless_until: f64,
    blind_until: f64,
    egoless_until: f64,
    missed: u32,
    sync_off: f64,
    torn: Option<(usize, u8, u32)>,
    overtaken: Option<(usize, u8, Option<Motion>)>,
    copies: Option<(usize, u32, f64)>,
    forged: Option<(usize, u32, f64)>,
    intruder: Option<(usize, u8, u32)>,
    views: Vec<View>,
    random: Random,
    range_random: Random,
    bus_random: Random,
}

impl<'a> World<'a> {
    fn new(scenario: &'a Scenario) -> Self {
        let others = scenario.peer.iter().enumerate();
        let front = scenario.ego.position;
        Self {
            ego: Vehicle::new(&scenario.ego, &scenario.bus, scenario.epoch, scenario.seed, 1),
            others: others.map(|(number, peer)| Other::new(peer, front, scenario.seed, number)).collect(),
            scenario,
            followed: 0,
            wanted: scenario.ego.wanted,
            wanted_before: (scenario.ego.wanted.max(scenario.ego.speed), 0.0),
            outcome: Outcome::default(),
            cooperative: f64::NEG_INFINITY,
            well: None,
            engaged: false,
            follow: scenario.follow,
            names: scenario.follow,
            next_event: 0,
            cutting_in: Vec::new(),
            slot_requests: Vec::new(),
            slot_used: [(f64::NEG_INFINITY, 0); SLOTS],
            deaf_until: 0.0,
            timeless_until: 0.0,
            blind_until: 0.0,
            egoless_until: 0.0,
            missed: 0,
            sync_off: 0.0,
            torn: None,
            overtaken: None,
            copies: None,
            forged: None,
            intruder: None,
            views: Vec::new(),
            random: Random::new(scenario.seed, 1),
            range_random: Random::new(scenario.seed, 2),
            bus_random: Random::new(scenario.seed, 4),
        }
    }

    /// The factor of an error if the assumption is broken; 1 otherwise.
    fn times(&self, assumption: Assumption) -> f64 {
        if self.scenario.broken == Some(assumption) { self.scenario.amount } else { 1.0 }
    }

    fn step(&mut self, now: f64) {
        while let Some(event) = self.scenario.event.get(self.next_event).filter(|event| event.at <= now) {
            self.next_event += 1;
            self.happen(now, event.what);
        }
        if !self.ego.runs && now >= self.scenario.ego.starts {
            self.ego.start(None);
        }
        self.cut_in(now);
        self.make_way();
        self.change_slots(now);
        self.ego.ticks_at(now + STEP);
        let is_well = self.well.is_some();
        let braking = self.times(Assumption::PeerBraking);
        for other in &mut self.others {
            other.limit(braking);
            if is_well {
                other.demand = (8.0 - other.body.speed).clamp(-2.0, 1.0);
            }
            other.drive(now, STEP);
        }
        let demand = if self.ego.said.mode == 0 { self.driver() } else { self.ego.said.acceleration };
        let before = self.ego.body;
        self.ego.body.drive(demand, STEP);
        self.put_own(now, &before, demand);
        let (end, accuracy) = (now + STEP, self.times(Assumption::PeerAccuracy));
        for number in 0..self.others.len() {
            let scenario = self.scenario;
            self.others[number].speak(end, scenario.epoch, &scenario.radio, accuracy, is_well);
            while let Some((at, message)) = self.others[number].arriving(end) {
                self.deliver(at.max(now), number, message);
            }
        }
        self.put_views(end);
        if self.missed > 0 {
            self.missed -= 1;
            self.ego.said.told = None;
        } else {
            self.ego.tick(end);
        }
        judge::judge(self, end);
    }

    /// The driver's demand while the unit is in standby.
    fn driver(&self) -> f64 {
        if self.is_near() { -8.0 } else { (self.scenario.ego.speed - self.ego.body.speed).clamp(-1.0, 0.5) }
    }

    /// Whether any vehicle on the lane is so near that following it may not be safe.
    fn is_near(&self) -> bool {
        let (body, lag) = (&self.ego.body, self.scenario.ego.lag * self.scenario.ego.lag_factor);
        self.others.iter().filter(|other| other.on_lane).any(|other| {
            let gap = other.rear() - body.position;
            let braking = if other.station == 0 { 12.0 } else { other.limits.braking };
            gap > 0.0 && gap < safe_gap(body.speed, other.body.speed, braking, 8.0, lag, 0.15)
        })
    }

    /// Puts the frames of the vehicle itself and of its driver on the bus in a step.
    fn put_own(&mut self, now: f64, before: &crate::body::Body, demand: f64) {
        let tick = (now / STEP).round() as u64;
        if tick.is_multiple_of(50) && now >= self.timeless_until {
            let late =
                if self.scenario.broken == Some(Assumption::SyncError) { self.scenario.amount } else { self.sync_off };
            self.sync_off = 0.0;
            self.ego.synchronise(now + 0.0003, late);
        }
        if now >= self.egoless_until {
            let sensed = 0.007;
            let body = before.after(demand, sensed);
            let times = self.times(Assumption::EgoAccuracy);
            self.ego.sense(now + sensed, &body, times);
        }
        if tick % 10 == 3 {
            // The driver drives carefully until the unit is engaged, and engages it where that is safe.
            let is_known = self.is_known(self.follow);
            if !self.engaged && now >= self.scenario.ego.engages && is_known && !self.is_near() {
                self.engaged = true;
                self.note_wanted_before(now);
            }
            if is_known {
                self.names = self.follow;
            }
            if self.ego.request(now + 0.0085, self.engaged, Some(self.names), self.wanted, self.scenario.ego.gap) {
                self.followed = self.names;
            }
        }
        if self.scenario.range.fitted && tick.is_multiple_of(2) && now >= self.blind_until {
            self.look(now + STEP);
        }
    }

    /// Whether the unit knows a station; false for no station.
    fn is_known(&self, station: u8) -> bool {
        station == 0 || self.others.iter().any(|other| other.station == station && other.is_known())
    }

    /// The vehicle with the nearest rear bumper ahead on the lane.
    pub fn nearest(&self) -> Option<&Other> {
        let front = self.ego.body.position;
        let ahead = self.others.iter().filter(|other| other.on_lane && other.body.position > front);
        ahead.min_by(|a, b| a.rear().total_cmp(&b.rear()))
    }

    fn look(&mut self, at: f64) {
        let range = &self.scenario.range;
        let Some((rear, speed)) = self.nearest().map(|other| (other.rear(), other.body.speed)) else { return };
        let distance = rear - self.ego.body.position;
        if distance > range.sees || distance < 0.0 || self.range_random.chance(range.misses) {
            return;
        }
        let times = self.times(Assumption::RangeAccuracy);
        let difference = speed - self.ego.body.speed;
        let Sensor { position, speed, error: kind, speed_error } = range.sensor;
        let random = &mut self.range_random;
        let distance = distance + error(kind, random) * largest(position, 0.0, random) * times;
        let difference = difference + error(speed_error, random) * largest(speed, 0.0, random) * times;
        // From the controller to the end of the frame (A12).
        let on_bus = self.bus_random.between(0.0, 0.0029);
        self.views.push((at + range.age + on_bus, distance.max(0.0), difference, range.age));
    }

    fn put_views(&mut self, until: f64) {
        while let Some((at, distance, difference, age)) = self.views.first().copied().filter(|view| view.0 <= until) {
            self.views.remove(0);
            self.ego.view(at, &self.scenario.range.sensor, distance, difference, age);
        }
    }

    fn deliver(&mut self, at: f64, number: usize, message: Message) {
        if at < self.deaf_until {
            return;
        }
        let slot = self.others[number].slot;
        if usize::from(slot) >= SLOTS {
            return;
        }
        let station = match message {
            Message::Motion(motion) => motion.station,
            Message::DrivingParameters { .. } => self.others[number].station,
        };
        // The modem gives a slot to another station when the slot has been free for long enough.
        let (used, by) = self.slot_used[usize::from(slot)];
        if by != station && at - used < SLOT_REUSE {
            return;
        }
        self.others[number].delivered = at;
        self.slot_used[usize::from(slot)] = (at, station);
        match message {
            Message::Motion(motion) => self.deliver_motion(at, number, slot, motion),
            Message::DrivingParameters { tag, limits, length } => {
                let frames = parameter_frames(slot, &mut self.ego.modem, tag, &limits, length);
                let mut verdict = Verdict::Lost;
                for (part, frame) in frames.iter().enumerate() {
                    verdict = self.ego.put(at + 0.0003 * part as f64, frame);
                }
                if verdict == Verdict::Taken {
                    self.others[number].known.push((at, limits));
                    self.others[number].has_told = true;
                }
            }
        }
    }

    fn deliver_motion(&mut self, at: f64, number: usize, slot: u8, motion: Motion) {
        let age = at - motion.at;
        if age > 12.0 && self.scenario.broken != Some(Assumption::OldMessages) {
            return; // the modem drops the frame
        }
        if self.is_overtaken(at, number, slot, &motion) {
            return;
        }
        let frames = motion.frames(slot, &mut self.ego.modem);
        let lost = match &mut self.torn {
            Some((torn, half, messages)) if *torn == number => {
                let half = usize::from(*half);
                let seconds = f64::from(*messages) * 0.1;
                self.torn = None;
                self.others[number].mute_until = self.others[number].mute_until.max(motion.at + seconds + 0.05);
                Some(half)
            }
            _ => None,
        };
        let mut verdicts = [Verdict::Lost; 2];
        for (half, frame) in frames.iter().enumerate() {
            if lost != Some(half) {
                verdicts[half] = self.ego.put(at + 0.0003 * half as f64, frame);
            }
        }
        self.others[number].is_heard |= verdicts[1] == Verdict::Taken && motion.station == self.others[number].station;
        judge::note_motion(self, at, number, &motion, verdicts);
        self.misuse(at, number, slot, &motion, verdicts[1] == Verdict::Taken);
    }

    fn cut_in(&mut self, now: f64) {
        let ego = self.ego.body;
        let lag = self.scenario.ego.lag * self.scenario.ego.lag_factor;
        for place in (0..self.cutting_in.len()).rev() {
            let number = self.cutting_in[place];
            let other = &self.others[number];
            let braking = if other.station == 0 { 12.0 } else { other.limits.braking };
            let speed = ego.speed + ego.acceleration.max(0.0) * 0.5;
            let room = safe_gap(speed, other.body.speed, braking, 8.0, lag, 0.4) + 3.0;
            // A vehicle does not cut into another one, and it must not be out of sight.
            let gap = other.rear() - ego.position;
            let ahead = self.nearest().map_or(f64::MAX, |nearest| nearest.rear() - other.body.position);
            let is_seen = other.station != 0 && other.is_known()
                || gap < self.scenario.range.sees - 5.0 && now >= self.blind_until;
            let is_forced = self.scenario.broken == Some(Assumption::Unseen);
            if (gap > room && is_seen && ahead > 2.0) || is_forced && gap > 2.0 && ahead > 2.0 {
                self.cutting_in.swap_remove(place);
                self.others[number].on_lane = true;
                if self.others[number].station != 0 {
                    self.follow = self.others[number].station;
                }
            }
        }
    }

    /// No vehicle drives through another one: a vehicle that is about to be hit from behind leaves the lane.
    fn make_way(&mut self) {
        for number in 0..self.others.len() {
            let (position, on_lane) = (self.others[number].body.position, self.others[number].on_lane);
            for ahead in &mut self.others {
                let is_hit = on_lane && ahead.body.position > position && ahead.rear() < position + 0.5;
                ahead.on_lane &= !is_hit;
            }
        }
    }

    /// Changes slots by the modem's rules: the station has been silent in its slot for two seconds, and the new slot
    /// has been free for as long.
    fn change_slots(&mut self, now: f64) {
        for place in (0..self.slot_requests.len()).rev() {
            let (number, slot) = self.slot_requests[place];
            let is_silent = now - self.others[number].delivered > SLOT_REUSE;
            let is_free = now - self.slot_used[usize::from(slot)].0 > SLOT_REUSE;
            let is_taken = self.others.iter().enumerate().any(|(other, peer)| other != number && peer.slot == slot);
            if is_silent && is_free && !is_taken {
                self.slot_requests.swap_remove(place);
                self.others[number].slot = slot;
            }
        }
    }

    fn end(&mut self, at: f64) {
        judge::end(self, at);
    }
}
