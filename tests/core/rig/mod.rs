//! A unit on a test rig: what the vehicle's sensors, its modem and its driver say enters as messages, goes to the unit as
//! frames through its doors, and what the unit answers comes back decoded from its frames. All numbers are float64, all
//! times microseconds of true time; the unit's own clock runs [`OFFSET`] ahead of it.
#![allow(dead_code)] // every test uses its own part of it

pub mod chase;
pub mod junction;
pub mod plant;
pub mod random;
pub mod road;

use holdover::health::Cause;
use holdover::time::{GnssTime, Instant};
use holdover::units::{Acceleration, Distance, Position, Speed};
use holdover::wire::command::Command;
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::driving_parameters::{DrivingParameters, Limits};
use holdover::wire::estimate::TargetEstimate;
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::range_sensor::RangeSample;
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::{Message, Predecessor, Received, Receiver, Role, Said, Sender, Slot, StationHash};
use holdover::{Answer, Config, OnboardUnit};

/// The unit: few steps, since no test here is about the far end of a horizon.
pub type Unit = OnboardUnit<4, 8, 64>;

/// The unit's clock at true time 0, in microseconds.
pub const OFFSET: u64 = 777_123_457;
/// GNSS time at true time 0.
const EPOCH: u64 = 1_465_000_123_456_700;

/// The ego's station, and its target's.
pub const EGO: StationHash = StationHash(1);
pub const TARGET: StationHash = StationHash(2);
/// The slot that the rig puts the target in.
pub const SLOT: Slot = Slot(2);

/// A car whose horizon fits [`Unit`], and that keeps 1 s: the scenes are laid out for that.
pub fn config() -> Config {
    let mut config = Config::car(EGO);
    config.law.time_gap = holdover::units::Seconds::from_millis(1_000);
    config.prediction.horizon = holdover::time::Duration::from_millis(600);
    config
}

/// One answer, and its frames decoded.
pub struct Heard {
    pub answer: Answer,
    pub command: Command,
    pub estimate: Option<TargetEstimate>,
    pub all: Vec<Message>,
}

/// The rig.
pub struct Rig {
    pub unit: Unit,
    sensors: Sender<0>,
    modem: Sender<16>,
    listener: Receiver<0>,
    sequence: u8,
    tag: u8,
    /// The speed that the driver wants, in m/s.
    pub wanted: f64,
}

/// The instant of the unit's clock.
pub fn instant(at: i64) -> Instant {
    Instant::from_micros(OFFSET.saturating_add_signed(at))
}

/// The stamp of a true time by a clock that is off by so many microseconds.
pub fn gnss(at: i64, off: i64) -> GnssTime {
    GnssTime::from_micros(EPOCH.saturating_add_signed(at + off))
}

impl Rig {
    pub fn new(config: &Config) -> Self {
        Self {
            unit: Unit::new(config).unwrap(),
            sensors: Sender::new(config.identifiers),
            modem: Sender::new(config.identifiers),
            listener: Receiver::new(config.identifiers, Role::Modem),
            sequence: 0,
            tag: 0,
            wanted: 40.0,
        }
    }

    /// Gives the unit a message of the vehicle or of the modem; the verdict on its last frame.
    pub fn put(&mut self, at: i64, message: &Message) -> Result<(), Cause> {
        let mut frames = Vec::new();
        let sent = match message {
            Message::Peer(..) => self.modem.send(message, &mut |frame| frames.push(frame)),
            _ => self.sensors.send(message, &mut |frame| frames.push(frame)),
        };
        sent.unwrap();
        let mut verdict = Ok(());
        for frame in &frames {
            verdict = self.unit.receive(instant(at), frame).map(|_| ());
        }
        verdict
    }

    /// One time synchronisation by a clock that is off by so many microseconds.
    pub fn synchronise(&mut self, at: i64, off: i64) {
        self.sequence = (self.sequence + 1) % 16;
        let time = gnss(at, off).as_micros();
        let sync = Sync { sequence: self.sequence, seconds: (time / 1_000_000) as u32 };
        let follow_up = FollowUp { sequence: self.sequence, micros: (time % 1_000_000) as u32 };
        let _ = self.put(at, &Message::Sync(sync)); // the first frames of an identifier are not trusted yet
        let _ = self.put(at, &Message::FollowUp(follow_up));
    }

    /// Makes every identifier that the tests use trusted, and the clock synchronised if wanted.
    pub fn power_up(&mut self, synchronised: bool, off: i64) {
        for at in [-900_000, -600_000, -300_000, -100_000] {
            if synchronised {
                self.synchronise(at, off);
            }
        }
    }

    /// The ego's own motion now, with the accuracies of a good sensor.
    pub fn ego(&mut self, at: i64, position: f64, speed: f64, acceleration: f64, demand: f64) -> Result<(), Cause> {
        let motion = self.motion(EGO, at, position, speed, acceleration, demand, Some((0.05, 0.02)));
        self.put(at, &Message::Ego(Said::Motion(motion)))
    }

    /// A motion with a fresh tag, stamped `at`.
    #[allow(clippy::too_many_arguments)] // a motion has that many
    pub fn motion(
        &mut self,
        station: StationHash,
        at: i64,
        position: f64,
        speed: f64,
        acceleration: f64,
        demand: f64,
        accuracy: Option<(f64, f64)>,
    ) -> Motion {
        self.tag = (self.tag + 1) % 4;
        Motion {
            tag: self.tag,
            position: WirePosition::from_mm((position * 1e3).round() as i64),
            speed: mps(speed.max(0.0)),
            acceleration: mps2(acceleration),
            demand: mps2(demand),
            stamp: gnss(at, 0).stamp(),
            position_accuracy: accuracy.map(|(position, _)| metres(position)),
            speed_accuracy: accuracy.map(|(_, speed)| mps(speed)),
            station,
        }
    }

    /// A target's message in its slot.
    pub fn target(&mut self, at: i64, said: Said) -> Result<(), Cause> {
        self.put(at, &Message::Peer(SLOT, said))
    }

    /// The driver's request.
    pub fn request(&mut self, at: i64, engaged: bool, predecessor: Predecessor) -> Result<(), Cause> {
        let target_speed = mps(self.wanted);
        self.put(at, &Message::DriverRequest(DriverRequest { engaged, predecessor, target_speed, time_gap: None }))
    }

    /// The range sensor's view.
    pub fn range(&mut self, at: i64, distance: f64, difference: f64, age_ms: i64) -> Result<(), Cause> {
        let sample = RangeSample {
            distance: metres(distance),
            speed_difference: mps(difference),
            distance_accuracy: metres(0.2),
            speed_accuracy: mps(0.2),
            age: holdover::time::Duration::from_millis(age_ms),
            nobody: false,
        };
        self.put(at, &Message::Range(sample))
    }

    /// The range sensor sees that no vehicle is nearer than that.
    pub fn nobody(&mut self, at: i64, distance: f64, age_ms: i64) -> Result<(), Cause> {
        let sample = RangeSample {
            distance: metres(distance),
            speed_difference: mps(0.0),
            distance_accuracy: metres(0.2),
            speed_accuracy: mps(0.2),
            age: holdover::time::Duration::from_millis(age_ms),
            nobody: true,
        };
        self.put(at, &Message::Range(sample))
    }

    /// One period.
    pub fn tick(&mut self, at: i64) -> Heard {
        let answer = self.unit.tick(instant(at));
        let mut all = Vec::new();
        for frame in &answer.frames {
            if let Ok(Received::Whole(message)) = self.listener.receive(instant(at), frame) {
                all.push(message);
            }
        }
        let command = all.iter().find_map(|m| if let Message::Command(c) = m { Some(*c) } else { None });
        let estimate = all.iter().find_map(|m| if let Message::Estimate(e) = m { Some(*e) } else { None });
        Heard { command: command.unwrap_or(answer.command), estimate, all, answer }
    }
}

/// A target that follows nobody and may do what it likes within these limits.
pub fn parameters(acceleration: f64, emergency_braking: f64) -> DrivingParameters {
    let config = config();
    DrivingParameters {
        length: metres(LENGTH),
        standstill: config.law.standstill,
        predecessor: Predecessor::None,
        target_speed: mps(30.0),
        catch_up: config.law.catch_up,
        time_gap: config.law.time_gap,
        gain: config.law.gain,
        damping: config.law.damping,
        feed_forward: config.law.feed_forward,
        lag: config.lag,
        limits: Limits {
            acceleration: mps2(acceleration),
            braking: mps2(emergency_braking.min(4.0)),
            jerk: config.limits.jerk,
            emergency_braking: mps2(emergency_braking),
        },
        horizon_tenths: 0,
    }
}

/// Of a target with [`parameters`].
pub const LENGTH: f64 = 4.8;

pub fn metres(m: f64) -> Distance {
    Distance::from_bits((m * f64::from(1 << 20)).round() as i32)
}

pub fn place(m: f64) -> Position {
    Position::from_bits((m * f64::from(1 << 20)).round() as i64)
}

pub fn mps(v: f64) -> Speed {
    Speed::from_bits((v * f64::from(1 << 23)).round() as i32)
}

pub fn mps2(a: f64) -> Acceleration {
    Acceleration::from_bits((a * f64::from(1 << 25)).round() as i32)
}

/// In metres, exact in float64 up to ±8e9 m.
pub fn m_of(position: Position) -> f64 {
    position.to_bits() as f64 / f64::from(1 << 20)
}

pub fn mps_of(speed: Speed) -> f64 {
    f64::from(speed.to_bits()) / f64::from(1 << 23)
}

pub fn mps2_of(acceleration: Acceleration) -> f64 {
    f64::from(acceleration.to_bits()) / f64::from(1 << 25)
}
