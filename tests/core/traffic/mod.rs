//! The traffic around one unit: a plain situation enters, and the frames of every period leave, as the time base, the
//! vehicle's own sensors, its driver and its modem put them on the bus.
//!
//! Everybody drives 10 m/s on one lane: the ego, the vehicle that it follows (slot 0, 17 m ahead, nearly as far
//! as the ego wants; the leader of the string), and one far behind (slot 1).

#![allow(dead_code)] // every test file uses another part of it

use embedded_can::{ExtendedId, Id, StandardId};
use holdover::health::Cause;
use holdover::time::{Duration, GnssTime, Instant};
use holdover::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};
use holdover::wire::Identifiers;
use holdover::wire::catalogue;
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::driving_parameters::{DrivingParameters, Limits};
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::status::Status;
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::{Frame, Message, Predecessor, Received, Receiver, Role, Said, Sender, Slot, StationHash, e2e};
use holdover::{Answer, Config, OnboardUnit, Reception};

pub const PEERS: usize = 4;
pub const SAMPLES: usize = 4;
pub type Unit = OnboardUnit<PEERS, SAMPLES, 400>;

pub const EGO: StationHash = StationHash(9);
pub const TARGET: StationHash = StationHash(1);
pub const BEHIND: StationHash = StationHash(2);
pub const PERIOD: Duration = Duration::from_millis(10);
/// GNSS time at the start of the traffic: some moment, 4 s before the stamps wrap.
pub const EPOCH: GnssTime = GnssTime::from_micros((13_107_200 * 111_111_111) - 4_000_000);

/// What comes every period, and where everybody is.
#[derive(Clone)]
pub struct Traffic {
    pub sender: Sender<16>,
    /// Of the unit's own clock at the start of the traffic.
    pub offset: Instant,
    /// Periods so far.
    pub period: i64,
    pub request: DriverRequest,
    /// Which parts of the traffic there are.
    pub sync: bool,
    pub ego: bool,
    pub target: bool,
    pub behind: bool,
    /// From a peer's stamp to the reception of its message.
    pub delay: Duration,
    pub tag: u8,
    pub sequence: u8,
}

impl Traffic {
    pub fn new() -> Self {
        Self {
            sender: Sender::new(Identifiers::DEFAULT),
            offset: Instant::from_micros(77_000_000),
            period: 0,
            request: request(Predecessor::Station(TARGET)),
            sync: true,
            ego: true,
            target: true,
            behind: true,
            delay: Duration::ZERO,
            tag: 0,
            sequence: 0,
        }
    }

    /// On the unit's own clock.
    pub fn now(&self) -> Instant {
        self.offset.plus(PERIOD.times(self.period))
    }

    pub fn gnss(&self, at: Instant) -> GnssTime {
        GnssTime::from_micros(EPOCH.as_micros().saturating_add_signed(at.since(self.offset).as_micros()))
    }

    /// The motion of someone who is at that place at the start of the traffic, as true at an instant.
    pub fn motion(&mut self, station: StationHash, start_mm: i64, at: Instant) -> Motion {
        self.tag = (self.tag + 1) % 4;
        Motion {
            tag: self.tag,
            position: WirePosition::from_mm(start_mm + at.since(self.offset).as_micros() / 100),
            speed: Speed::from_mm_per_s(10_000),
            acceleration: Acceleration::ZERO,
            demand: Acceleration::ZERO,
            stamp: self.gnss(at).stamp(),
            position_accuracy: None,
            speed_accuracy: None,
            station,
        }
    }

    /// The frames of a message, with the counters that are next.
    pub fn frames(&mut self, message: &Message) -> Vec<Frame> {
        let mut frames = Vec::new();
        self.sender.send(message, &mut |frame| frames.push(frame)).expect("the catalogue has a line for it");
        frames
    }

    pub fn peer(&mut self, slot: u8, said: Said) -> Vec<Frame> {
        self.frames(&Message::Peer(Slot(slot), said))
    }

    /// What the time base sends.
    pub fn time_base(&mut self) -> Vec<Frame> {
        self.sequence = (self.sequence + 1) % 16;
        let (sequence, micros) = (self.sequence, self.gnss(self.now()).as_micros());
        let sync = Sync { sequence, seconds: u32::try_from(micros / 1_000_000).expect("before 2116") };
        let follow_up = FollowUp { sequence, micros: (micros % 1_000_000) as u32 };
        [self.frames(&Message::Sync(sync)), self.frames(&Message::FollowUp(follow_up))].concat()
    }

    /// All frames of this period; then it is the next one.
    pub fn next(&mut self) -> (Instant, Vec<Frame>) {
        let (now, n) = (self.now(), self.period);
        let mut frames = Vec::new();
        if self.sync && n % 50 == 0 {
            frames.extend(self.time_base());
        }
        if self.ego {
            let motion = self.motion(EGO, 0, now);
            frames.extend(self.frames(&Message::Ego(Said::Motion(motion))));
        }
        if n % 10 == 0 {
            frames.extend(self.frames(&Message::DriverRequest(self.request)));
        }
        let stamped = now.minus(self.delay);
        for (slot, station, start_mm, speaks) in [(0, TARGET, 17_000, self.target), (1, BEHIND, -500_000, self.behind)]
        {
            if speaks && n % 10 == i64::from(slot) {
                let motion = self.motion(station, start_mm, stamped);
                frames.extend(self.peer(slot, Said::Motion(motion)));
            }
            if speaks && n % 50 == i64::from(slot) {
                frames.extend(self.peer(slot, Said::DrivingParameters(leads())));
            }
        }
        self.period += 1;
        (now, frames)
    }

    /// One period of a unit in this traffic; refusals are the unit's to count.
    pub fn step(&mut self, unit: &mut Unit) -> Answer {
        let (now, frames) = self.next();
        frames.iter().for_each(|frame| drop_result(unit.receive(now, frame)));
        unit.tick(now)
    }

    /// Some periods; the last answer.
    pub fn run(&mut self, unit: &mut Unit, periods: usize) -> Answer {
        (1..periods).for_each(|_| drop(self.step(unit)));
        self.step(unit)
    }

    /// Where the target is at an instant, in metres.
    pub fn target_at(&self, at: Instant) -> f64 {
        17.0 + at.since(self.offset).as_micros() as f64 * 1e-5
    }
}

pub fn drop_result(_: Result<Reception, Cause>) {}

pub fn receive_all(unit: &mut Unit, at: Instant, frames: &[Frame]) -> Vec<Result<Reception, Cause>> {
    frames.iter().map(|frame| unit.receive(at, frame)).collect()
}

/// A unit that has been in the traffic for 3 s.
pub fn settled_with(config: &Config) -> (Unit, Traffic) {
    let (mut unit, mut traffic) = (Unit::new(config).expect("the configuration is sound"), Traffic::new());
    traffic.run(&mut unit, 300);
    (unit, traffic)
}

/// Behind a target at the gap of 1 s. The ego of this traffic does not heed its commands, so an envelope would brake ever harder.
pub fn settled() -> (Unit, Traffic) {
    let mut config = Config::car(EGO);
    config.law.time_gap = Seconds::from_millis(1_000);
    config.envelope = None;
    settled_with(&config)
}

pub fn request(predecessor: Predecessor) -> DriverRequest {
    DriverRequest { engaged: true, predecessor, target_speed: Speed::from_mm_per_s(10_000), time_gap: None }
}

/// The driving parameters of a leader that wants the speed that everybody drives.
pub fn leads() -> DrivingParameters {
    DrivingParameters {
        length: Distance::from_mm(4800),
        standstill: Distance::from_mm(2000),
        predecessor: Predecessor::None,
        target_speed: Speed::from_mm_per_s(10_000),
        catch_up: Fraction::ZERO,
        time_gap: Seconds::from_millis(1000),
        gain: Gain::from_milli(500),
        damping: Seconds::from_millis(2000),
        feed_forward: Fraction::ZERO,
        lag: FineSeconds::from_millis(300),
        limits: Limits {
            acceleration: Acceleration::from_mm_per_s2(2500),
            braking: Acceleration::from_mm_per_s2(4000),
            jerk: Jerk::from_mm_per_s3(5000),
            emergency_braking: Acceleration::from_mm_per_s2(8000),
        },
        horizon_tenths: 0,
    }
}

/// The frame once more with other data under a checksum that fits, and with that counter or its own.
pub fn resealed(frame: Frame, counter: Option<u8>, change: impl FnOnce(&mut [u8; 8])) -> Frame {
    let mut data: [u8; 8] = frame.data[..].try_into().expect("of classic CAN");
    change(&mut data);
    let data_id = catalogue::data_id(Identifiers::DEFAULT.offset_of(frame.id).expect("of the block"));
    Frame { id: frame.id, data: e2e::protect(data, data_id, counter.unwrap_or(frame.data[1] & 0x0F)).into() }
}

/// The pages of health among what a unit sent.
pub fn pages(frames: &[Frame]) -> Vec<Status> {
    thread_local!(static MODEM: std::cell::RefCell<Receiver<0>> = const {
        std::cell::RefCell::new(Receiver::new(Identifiers::DEFAULT, Role::Modem))
    });
    let decode = |frame: &Frame| match MODEM.with_borrow_mut(|modem| modem.receive(Instant::ZERO, frame)) {
        Ok(Received::Whole(Message::Status(status))) => Some(status),
        _ => None,
    };
    frames.iter().filter_map(decode).collect()
}

/// Whether a frame is a page of health.
pub fn is_page(frame: &Frame) -> bool {
    frame.id == Identifiers::DEFAULT.at(0x18)
}

/// Any frame that can stand on a bus.
#[derive(Clone, Debug)]
pub struct AnyFrame {
    pub id: Id,
    pub data: Vec<u8>,
    pub remote: bool,
}

impl From<Frame> for AnyFrame {
    fn from(frame: Frame) -> Self {
        Self { id: frame.id.into(), data: frame.data.to_vec(), remote: false }
    }
}

pub fn standard(id: u16) -> Id {
    Id::Standard(StandardId::new(id).expect("11 bits"))
}

pub fn extended(id: u32) -> Id {
    Id::Extended(ExtendedId::new(id).expect("29 bits"))
}

impl embedded_can::Frame for AnyFrame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        Some(Self { id: id.into(), data: data.to_vec(), remote: false })
    }

    fn new_remote(id: impl Into<Id>, dlc: usize) -> Option<Self> {
        Some(Self { id: id.into(), data: vec![0; dlc], remote: true })
    }

    fn is_extended(&self) -> bool {
        matches!(self.id, Id::Extended(_))
    }

    fn is_remote_frame(&self) -> bool {
        self.remote
    }

    fn id(&self) -> Id {
        self.id
    }

    fn dlc(&self) -> usize {
        self.data.len()
    }

    fn data(&self) -> &[u8] {
        &self.data
    }
}
