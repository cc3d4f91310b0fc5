//! Facts about a unit over CAN FD: what a vehicle says of itself is taken or refused as one; frames of classic CAN are refused and
//! counted; it answers in frames of CAN FD, by the same schedule.
#![cfg(feature = "fd")]

use crate::traffic::leads;
use holdover::health::Cause;
use holdover::time::{Duration, GnssTime, Instant};
use holdover::units::{Acceleration, Distance, Position, Speed};
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::fd::State;
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::{
    Frame, Identifiers, Message, Predecessor, Received, Receiver, Role, Said, Sender, Slot, StationHash, Transport,
};
use holdover::{Answer, Config, LockStep, OnboardUnit, Reception};

type Unit = OnboardUnit<2, 8, 400>;

const EPOCH: u64 = 1_465_000_123_000_000;
const PEER: StationHash = StationHash(7);

struct Bench {
    unit: Unit,
    sender: Sender<2>,
    modem: Receiver<0>,
    now: u64,
}

impl Bench {
    fn new() -> Self {
        let config = Config { transport: Transport::Fd, ..Config::car(StationHash(1)) };
        let sender = Sender::new(Identifiers::DEFAULT).over(Transport::Fd);
        let modem = Receiver::new(Identifiers::DEFAULT, Role::Modem).over(Transport::Fd);
        Self { unit: Unit::new(&config).unwrap(), sender, modem, now: 60_000_000 }
    }

    fn frame(&mut self, message: &Message) -> Frame {
        let mut frames = Vec::new();
        self.sender.send(message, &mut |frame| frames.push(frame)).unwrap();
        let [frame] = frames[..] else { panic!("{message:?} is one frame") };
        frame
    }

    fn put(&mut self, message: &Message) -> Result<Reception, Cause> {
        let frame = self.frame(message);
        self.unit.receive(Instant::from_micros(self.now), &frame)
    }

    /// 30 m ahead if it is the peer's, at 10 m/s.
    fn motion(&self, station: StationHash, age_us: u64) -> Motion {
        let at = self.now - age_us;
        let mm = if station == PEER { 30_000 } else { 0 } + at as i64 / 100;
        Motion {
            tag: 0,
            position: WirePosition::from_position(Position::from_mm(mm)),
            speed: Speed::from_mm_per_s(10_000),
            acceleration: Acceleration::ZERO,
            demand: Acceleration::ZERO,
            stamp: GnssTime::from_micros(EPOCH + at).stamp(),
            position_accuracy: Some(Distance::from_mm(100)),
            speed_accuracy: Some(Speed::from_mm_per_s(40)),
            station,
        }
    }

    fn state(&self, age_us: u64) -> State {
        State { motion: self.motion(PEER, age_us), parameters: Some(leads()), horizon: None }
    }

    fn say(&mut self, state: State) -> Result<Reception, Cause> {
        self.put(&Message::Peer(Slot(0), Said::State(state)))
    }

    /// One period: time base, own motion and request, a state of the peer every 100 ms, and the tick.
    fn period(&mut self) -> Answer {
        let time = EPOCH + self.now;
        if self.now.is_multiple_of(500_000) {
            let _ = self.put(&Message::Sync(Sync { sequence: 3, seconds: (time / 1_000_000) as u32 }));
            let _ = self.put(&Message::FollowUp(FollowUp { sequence: 3, micros: (time % 1_000_000) as u32 }));
        }
        let _ = self.put(&Message::Ego(Said::Motion(self.motion(StationHash(1), 0))));
        let request = DriverRequest {
            engaged: true,
            predecessor: Predecessor::Station(PEER),
            target_speed: Speed::from_mm_per_s(13_000),
            time_gap: None,
        };
        let _ = self.put(&Message::DriverRequest(request));
        if self.now.is_multiple_of(100_000) {
            let _ = self.say(self.state(20_000));
        }
        let answer = self.unit.tick(Instant::from_micros(self.now));
        self.now += 10_000;
        answer
    }

    fn heard(&mut self, answer: &Answer) -> Vec<Message> {
        let at = Instant::from_micros(self.now);
        let heard = answer.frames.iter().filter_map(|frame| match self.modem.receive(at, frame) {
            Ok(Received::Whole(message)) => Some(message),
            Ok(other) => panic!("{other:?}"),
            Err(cause) => {
                assert_eq!(cause, Cause::NotYetTrusted);
                None
            }
        });
        heard.collect()
    }
}

#[test]
fn it_cooperates_and_says_by_the_same_schedule_what_it_says_over_classic_can_in_a_frame_a_message() {
    let mut bench = Bench::new();
    let (mut states, mut parameters, mut horizons) = (0, 0, 0);
    for _ in 0..300 {
        let answer = bench.period();
        assert!(answer.frames.len() <= 4 && answer.frames.iter().all(|frame| frame.data.len() > 8));
        for message in bench.heard(&answer) {
            if let Message::Own(Said::State(state)) = message {
                states += 1;
                parameters += usize::from(state.parameters.is_some());
                horizons += usize::from(state.horizon.is_some());
                assert!(state.horizon.is_none_or(|knots| knots.tag == state.motion.tag));
            }
        }
    }
    assert_eq!(format!("{:?}", bench.unit.mode()), "Cooperative");
    // Before its first motion is trusted it has none to say, and the first that it says is not trusted. Driving parameters are said with
    // every fifth, and twice at once when they change.
    assert_eq!(states, 28);
    assert!(horizons >= 25 && (6..=10).contains(&parameters), "{horizons} {parameters}");
}

#[test]
fn with_a_refused_motion_all_that_came_with_it_is_refused_and_counted_once() {
    let mut bench = Bench::new();
    (0..100).for_each(|_| drop(bench.period()));
    let before = bench.unit.health().total();
    assert_eq!(bench.say(bench.state(5_000)), Ok(Reception::Taken));
    assert_eq!(bench.say(bench.state(5_000)), Err(Cause::Duplicate));
    assert_eq!(bench.say(bench.state(11_000_000)), Err(Cause::Stale));
    assert_eq!(bench.unit.health().total(), before + 2);
    assert_eq!(bench.unit.health().of(Cause::Duplicate), 1);
}

#[test]
fn frames_of_classic_can_are_refused_by_their_length_and_change_nothing_else() {
    let mut bench = Bench::new();
    (0..100).for_each(|_| drop(bench.period()));
    let before = bench.unit.clone();
    let mut classic = Sender::<2>::new(Identifiers::DEFAULT);
    let (mut refused, at) = (0, Instant::from_micros(bench.now));
    for said in [Said::State(bench.state(0)), Said::Motion(bench.motion(PEER, 0))] {
        classic
            .send(&Message::Peer(Slot(1), said), &mut |frame| match bench.unit.receive(at, &frame) {
                Err(Cause::Length) => refused += 1,
                // Identifiers of second halves and parts are no messages over CAN FD.
                other => assert_eq!(other, Ok(Reception::Foreign)),
            })
            .unwrap();
    }
    assert_eq!((refused, bench.unit.health().of(Cause::Length)), (2, 2));
    let state = |unit: &Unit| format!("{unit:?}").replace("counts: [2,", "counts: [0,");
    assert!(state(&bench.unit) == state(&before));
}

#[test]
fn in_lock_step_the_pair_of_can_fd_ticks_it_and_that_of_classic_can_does_not() {
    let mut bench = Bench::new();
    let mut shell = LockStep::new();
    let pair =
        |sequence| [Message::Sync(Sync { sequence, seconds: 7 }), Message::FollowUp(FollowUp { sequence, micros: 5 })];
    let mut classic = Vec::new();
    for message in pair(1) {
        Sender::<2>::new(Identifiers::DEFAULT).send(&message, &mut |frame| classic.push(frame)).unwrap();
    }
    assert!(classic.iter().all(|frame| shell.receive(&mut bench.unit, frame).is_none()));
    let [sync, follow_up] = pair(2).map(|message| bench.frame(&message));
    assert!(shell.receive(&mut bench.unit, &sync).is_none());
    let mut wrong = follow_up;
    wrong.data[11] ^= 1;
    assert!(shell.receive(&mut bench.unit, &wrong).is_none());
    assert!(shell.receive(&mut bench.unit, &follow_up).is_some_and(|answer| !answer.frames.is_empty()));
    assert_eq!(Duration::from_millis(10), bench.unit.config().period);
}
