//! A vehicle with a unit. Its sensors, its driver and its modem put frames on its bus, and the bus loses or doubles
//! some. The unit receives them and answers, and the answers are read from its frames. The unit is used through
//! `receive` and `tick` alone.

use embedded_can::Frame;
use holdover::config::Envelope;
use holdover::coordination::Itinerary;
use holdover::time::{Duration, Instant};
use holdover::units::FineSeconds;
use holdover::wire::StationHash;
use holdover::{Answer, Config, OnboardUnit};

use crate::body::Body;
use crate::random::Random;
use crate::scenario::{Bus, Ego, Error, Sensor};
use crate::wire::{BOOK, Can, Counters, stamp, wrapped};

/// The functions of a unit, whatever its capacities.
trait Doors: Send {
    fn start(&mut self, config: &Config);
    fn set_out(&mut self, way: &'static Itinerary);
    fn receive(&mut self, at: Instant, frame: &Can) -> Verdict;
    fn tick(&mut self, at: Instant) -> Answer;
}

impl<const STEPS: usize> Doors for OnboardUnit<8, 8, STEPS> {
    fn start(&mut self, config: &Config) {
        OnboardUnit::start(self, config).expect("a configuration within its ranges");
    }
    fn set_out(&mut self, way: &'static Itinerary) {
        OnboardUnit::set_out(self, way).expect("a sound map");
    }
    fn receive(&mut self, at: Instant, frame: &Can) -> Verdict {
        match OnboardUnit::receive(self, at, frame) {
            Ok(holdover::Reception::Taken) => Verdict::Taken,
            Ok(_) => Verdict::Waits,
            Err(_) => Verdict::Refused,
        }
    }
    fn tick(&mut self, at: Instant) -> Answer {
        OnboardUnit::tick(self, at)
    }
}

#[inline(never)] // the unit passes over the stack on its way to the heap, and must not stay there
fn doors<const STEPS: usize>() -> Box<dyn Doors> {
    Box::new(OnboardUnit::<8, 8, STEPS>::idle())
}

/// What became of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The bus lost it.
    Lost,
    /// The unit refused it, or the message that it completes.
    Refused,
    /// The message is not complete yet.
    Waits,
    /// The unit accepted the message that it completes.
    Taken,
}

/// The unit's target estimate, and its bound: how far behind and ahead, and how much slower and faster, the target may
/// be.
#[derive(Clone, Copy, Debug)]
pub struct Told {
    /// m; a position on the bus, which wraps.
    pub position: f64,
    pub behind: f64,
    pub ahead: f64,
    /// m/s.
    pub speed: f64,
    pub slower: f64,
    pub faster: f64,
}

/// The last output of the unit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Said {
    /// m/s².
    pub acceleration: f64,
    /// 0 standby, 1 cooperative, 2 holdover, 3 fallback, 4 fault.
    pub mode: u8,
    /// The target, with its bound.
    pub told: Option<Told>,
    /// Distance by which the estimate is outside of the unit's own bound, m.
    pub estimate_outside: f64,
}

/// The vehicle.
pub struct Vehicle {
    /// Its motion.
    pub body: Body,
    /// The last output of its unit.
    pub said: Said,
    /// The `Own*` frames in its unit's last answer.
    pub own: Vec<holdover::wire::Frame>,
    /// Whether the unit runs.
    pub runs: bool,
    doors: Box<dyn Doors>,
    config: Config,
    sensors: Counters,
    /// Counters of its modem.
    pub modem: Counters,
    set_up: Ego,
    bus: Bus,
    epoch: i64,
    random: Random,
    sequence: u8,
    tag: u8,
    command: f64,
    next_tick: f64,
    station: u8,
}

/// A number in the core's fixed-point format.
fn milli(value: f64) -> i32 {
    (value * 1000.0).round() as i32
}

impl Vehicle {
    /// The vehicle of a scenario. The unit is not started.
    pub fn new(ego: &Ego, bus: &Bus, epoch: i64, seed: u64, station: u8) -> Self {
        let mut config = Config::car(StationHash(station));
        config.lag = FineSeconds::from_millis(milli(ego.lag));
        config.envelope = ego.envelope.then_some(Envelope::CAR);
        if !ego.long {
            config.prediction.horizon = Duration::from_millis(600);
        }
        let body = Body {
            position: ego.position,
            speed: ego.speed,
            acceleration: 0.0,
            lag: ego.lag * ego.lag_factor,
            braking: ego.road,
            pulling: 3.5,
            top: 70.0,
        };
        let mut random = Random::new(seed, 1000 + u64::from(station));
        Self {
            body,
            said: Said::default(),
            own: Vec::new(),
            runs: false,
            doors: if ego.long { doors::<400>() } else { doors::<64>() },
            config,
            sensors: Counters::new(random.below(15) as u8),
            modem: Counters::new(random.below(15) as u8),
            set_up: *ego,
            bus: *bus,
            epoch,
            sequence: random.below(16) as u8,
            tag: random.below(4) as u8,
            random,
            command: 0.0,
            next_tick: f64::MAX,
            station,
        }
    }

    /// Starts the unit, with its way if it has one.
    pub fn start(&mut self, way: Option<&'static Itinerary>) {
        self.doors.start(&self.config);
        if let Some(way) = way {
            self.doors.set_out(way);
        }
        self.runs = true;
    }

    /// GNSS time, µs.
    pub fn gnss(&self, at: f64) -> i64 {
        self.epoch + (at * 1e6).round() as i64
    }

    /// The unit's own clock at a true time.
    fn clock(&self, at: f64) -> Instant {
        let micros = (at - self.set_up.starts) * 1e6 * (1.0 + self.set_up.drift * 1e-6);
        Instant::from_micros(self.set_up.clock.saturating_add_signed(micros.round() as i64))
    }

    /// No frame is received later than the tick before which it is passed on.
    pub fn ticks_at(&mut self, at: f64) {
        self.next_tick = at;
    }

    /// Puts a frame on the bus. Most frames reach the unit.
    pub fn put(&mut self, at: f64, frame: &Can) -> Verdict {
        if !self.runs || self.bus.loss > 0.0 && self.random.chance(self.bus.loss) {
            return Verdict::Lost;
        }
        let clock = self.clock(at.min(self.next_tick));
        let verdict = self.doors.receive(clock, frame);
        if self.bus.twice > 0.0 && self.random.chance(self.bus.twice) {
            self.doors.receive(clock, frame);
        }
        verdict
    }

    /// From now on the bus loses and doubles no frames.
    pub fn heal(&mut self) {
        (self.bus.loss, self.bus.twice) = (0.0, 0.0);
    }

    /// Sends one time synchronisation, which is received `late` later than it says.
    pub fn synchronise(&mut self, at: f64, late: f64) {
        self.sequence = (self.sequence + 1) % 16;
        let sequence = f64::from(self.sequence);
        let sent = self.gnss(at);
        let jitter = self.random.signed() * self.bus.jitter * 1e-6;
        let sync = BOOK.sync.seal(&mut self.sensors, &[sequence, (sent.div_euclid(1_000_000)) as f64]);
        let follow_up = BOOK.follow_up.seal(&mut self.sensors, &[sequence, (sent.rem_euclid(1_000_000)) as f64]);
        self.put(at + jitter + late, &sync);
        self.put(at + jitter + late + 0.0004, &follow_up);
    }

    /// Sends the ego's own motion as its sensors measure it now. `times` is the error relative to the published
    /// accuracy.
    pub fn sense(&mut self, at: f64, body: &Body, times: f64) {
        self.tag = (self.tag + 1) % 4;
        let sensor = self.set_up.sensor;
        let (position, speed) = measured(&sensor, body, times, &mut self.random);
        let stamped = stamp(self.gnss(at));
        let tag = f64::from(self.tag);
        let values = [tag, wrapped(position), stamped, f64::from(self.station)];
        let a = BOOK.ego.a.seal(&mut self.sensors, &values);
        let acceleration = body.acceleration + self.set_up.acceleration_off;
        let accuracies = published(&sensor);
        let values = [tag, speed, acceleration, self.command, accuracies.0, accuracies.1];
        let b = BOOK.ego.b.seal(&mut self.sensors, &values);
        self.put(at + 0.0006, &a);
        self.put(at + 0.0009, &b);
    }

    /// Sends the driver's request. Returns whether the unit accepted it.
    pub fn request(&mut self, at: f64, engaged: bool, follow: Option<u8>, wanted: f64, gap: f64) -> bool {
        let kind = match follow {
            None => 0.0,
            Some(0) => 1.0,
            Some(_) => 2.0,
        };
        let values = [f64::from(u8::from(engaged)), kind, f64::from(follow.unwrap_or(0)), wanted, gap];
        let frame = BOOK.request.seal(&mut self.sensors, &values);
        self.put(at, &frame) == Verdict::Taken
    }

    /// Sends a measurement of the range sensor: distance, difference of speeds, and age.
    pub fn view(&mut self, at: f64, sensor: &Sensor, distance: f64, difference: f64, age: f64) {
        let values = [distance, difference, sensor.position, sensor.speed, BOOK.range.signals[4].up(age)];
        let frame = BOOK.range.seal(&mut self.sensors, &values);
        self.put(at, &frame);
    }

    /// Sends the position on the globe, in 1e-7°, with a heading in degrees, of the motion that was measured last.
    pub fn place(&mut self, at: f64, latitude: i64, longitude: i64, heading: f64, sensed: f64) {
        let tag = f64::from(self.tag);
        let stamped = stamp(self.gnss(sensed));
        let first = BOOK.place.seal(&mut self.sensors, &[tag, 0.0, latitude as f64 * 1e-7, stamped]);
        let second = BOOK.heading.seal(&mut self.sensors, &[tag, 1.0, longitude as f64 * 1e-7, heading]);
        self.put(at, &first);
        self.put(at, &second);
    }

    /// One period of the unit.
    pub fn tick(&mut self, at: f64) {
        if !self.runs {
            return;
        }
        let answer = self.doors.tick(self.clock(at));
        let book = &*BOOK;
        let mut said = Said { acceleration: self.command, mode: self.said.mode, ..Said::default() };
        let mut half = None;
        self.own.clear();
        for frame in &answer.frames {
            if let Some(word) = book.command.open(frame) {
                said.acceleration = book.command.signals[0].get(word);
                said.mode = book.command.signals[1].raw(word) as u8;
            } else if let Some(word) = book.estimate_a.open(frame) {
                half = Some(word);
            } else if let Some(word) = book.estimate_b.open(frame) {
                said.told = half.and_then(|half| told(half, word));
            } else {
                self.own.push(*frame);
            }
        }
        if let Some(estimate) = &answer.estimate
            && let Some(bound) = &estimate.bound
        {
            let metres = |position: holdover::units::Position| position.to_bits() as f64 / f64::from(1 << 20);
            let (at, low) = (metres(estimate.reading.position), metres(bound.lowest_position()));
            // The reading is a position modulo 4096 m.
            let above = (at - low).rem_euclid(4096.0);
            let width = metres(bound.highest_position()) - low;
            if width < 2000.0 {
                let outside = if above <= width { 0.0 } else { (above - width).min(4096.0 - above) };
                said.estimate_outside = outside;
            }
        }
        self.command = if said.mode == 0 { 0.0 } else { said.acceleration };
        self.said = said;
    }
}

fn told(a: u64, b: u64) -> Option<Told> {
    let book = &*BOOK;
    let ([tag, position, speed, faster], [other, behind, ahead, slower]) =
        (book.estimate_a.signals, book.estimate_b.signals);
    let is_bounded = behind.raw(b) != 16_383 && ahead.raw(b) != 16_383 && faster.raw(a) != 511 && slower.raw(b) != 511;
    (tag.raw(a) == other.raw(b) && is_bounded).then(|| Told {
        position: position.get(a),
        behind: behind.get(b),
        ahead: ahead.get(b),
        speed: speed.get(a),
        slower: slower.get(b),
        faster: faster.get(a),
    })
}

/// The measurement of a body by a sensor.
pub fn measured(sensor: &Sensor, body: &Body, times: f64, random: &mut Random) -> (f64, f64) {
    let off = error(sensor.error, random) * largest(sensor.position, 5.0, random) * times;
    let faster = error(sensor.speed_error, random) * largest(sensor.speed, 1.5, random) * times;
    (body.position + off, (body.speed + faster).max(0.0))
}

/// The largest error this time: 95 times in a hundred the accuracy, else three times as much. What holds where nothing is published is
/// never exceeded.
pub fn largest(published: f64, otherwise: f64, random: &mut Random) -> f64 {
    match published < 0.0 {
        true => otherwise,
        false if random.chance(0.05) => 3.0 * published,
        false => published,
    }
}

/// The accuracies in a message; not a number where none is published.
pub fn published(sensor: &Sensor) -> (f64, f64) {
    let code = |value: f64| if value < 0.0 { f64::NAN } else { value };
    (code(sensor.position), code(sensor.speed))
}

/// An error as a share of the largest, -1 to 1.
pub fn error(kind: Error, random: &mut Random) -> f64 {
    match kind {
        Error::None => 0.0,
        Error::Uniform => random.signed(),
        Error::Edges => random.one_of(&[-1.0, 1.0]),
        Error::High => 1.0,
        Error::Low => -1.0,
    }
}

/// A frame that a unit sent, as its modem takes it off the bus.
pub fn raw(frame: &impl Frame) -> Option<[u8; 8]> {
    frame.data().try_into().ok()
}
