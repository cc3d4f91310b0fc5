//! What is left of a message whose other frames were lost joins nothing, however long it waits or however soon the next one of
//! its tag comes: tags come round after four messages, a silence may last as long as it likes, and messages are overtaken.

#[allow(dead_code)] // others use all of it
use crate::messages;
use crate::rig;
use crate::rig::{Rig, SLOT, TARGET, m_of, mps_of};
use holdover::health::Cause;
use holdover::time::{Duration, Instant};
use holdover::wire::{Frame, Identifiers, Message, Received, Receiver, Role, Said, Sender, Slot, StationHash};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;

const SECOND: i64 = 1_000_000;

/// Both ends of a bus.
struct Bus<const PEERS: usize> {
    sender: Sender<16>,
    receiver: Receiver<PEERS>,
}

impl<const PEERS: usize> Bus<PEERS> {
    fn new(role: Role) -> Self {
        Self { sender: Sender::new(Identifiers::DEFAULT), receiver: Receiver::new(Identifiers::DEFAULT, role) }
    }

    fn frames(&mut self, message: &Message) -> Vec<Frame> {
        let mut frames = Vec::new();
        self.sender.send(message, &mut |frame| frames.push(frame)).unwrap();
        frames
    }

    fn hear(&mut self, at: Instant, frames: &[Frame]) -> Vec<Result<Received, Cause>> {
        frames.iter().map(|frame| self.receiver.receive(at, frame)).collect()
    }
}

/// Messages of one kind, all with the same tag, and their cycle.
struct Kind {
    name: &'static str,
    role: Role,
    cycle: Duration,
    draw: Box<dyn Fn(&mut TestRunner) -> Message>,
}

fn kinds() -> Vec<Kind> {
    fn drawn<S: Strategy>(strategy: S, runner: &mut TestRunner) -> S::Value {
        strategy.new_tree(runner).unwrap().current()
    }
    let peer = |said| Message::Peer(Slot(3), said);
    let kind = |name, role, cycle_ms, draw| Kind { name, role, cycle: Duration::from_millis(cycle_ms), draw };
    vec![
        kind(
            "motion",
            Role::Unit,
            100,
            Box::new(move |r| {
                peer(Said::Motion(holdover::wire::motion::Motion { tag: 2, ..drawn(messages::motion(), r) }))
            }),
        ),
        kind(
            "ego's motion",
            Role::Unit,
            10,
            Box::new(|r| {
                Message::Ego(Said::Motion(holdover::wire::motion::Motion { tag: 2, ..drawn(messages::motion(), r) }))
            }),
        ),
        kind(
            "horizon",
            Role::Unit,
            100,
            Box::new(move |r| {
                peer(Said::Horizon(holdover::wire::horizon::Knots { tag: 2, ..drawn(messages::knots(), r) }))
            }),
        ),
        kind(
            "parameters",
            Role::Unit,
            500,
            Box::new(move |r| peer(Said::DrivingParameters(drawn(messages::parameters(), r)))),
        ),
        kind("place", Role::Unit, 100, Box::new(move |r| peer(Said::Geo(drawn(messages::geo(), r))))),
        kind("route", Role::Unit, 200, Box::new(move |r| peer(Said::Route(drawn(messages::route(), r))))),
        kind(
            "estimate",
            Role::Modem,
            10,
            Box::new(|r| {
                Message::Estimate(holdover::wire::estimate::TargetEstimate { tag: 2, ..drawn(messages::estimate(), r) })
            }),
        ),
    ]
}

#[test]
fn one_lost_frame_and_a_silence_of_any_length_make_no_message_of_two() {
    let mut runner = TestRunner::deterministic();
    for kind in kinds() {
        let parts = Bus::<8>::new(kind.role).frames(&(kind.draw)(&mut runner)).len();
        for (lost, k) in (0..parts).flat_map(|lost| (1..=12i64).chain([100, 6_000]).map(move |k| (lost, k))) {
            // The sender itself counts the tags of driving parameters; only in a silence of 15 times 3 frames do its counters come round.
            let unheard = if kind.name == "parameters" { 4 * k - 1 } else { 0 };
            if unheard % 5 != 0 {
                continue;
            }
            let mut bus = Bus::<8>::new(kind.role);
            let mut at = Instant::from_micros(50 * SECOND as u64);
            for _ in 0..3 {
                let message = (kind.draw)(&mut runner);
                let frames = bus.frames(&message);
                bus.hear(at, &frames);
                at = at.plus(kind.cycle);
            }
            let (old, new) = ((kind.draw)(&mut runner), (kind.draw)(&mut runner));
            let mut frames = bus.frames(&old);
            frames.remove(lost);
            let heard = bus.hear(at, &frames);
            assert!(heard.iter().all(|heard| *heard == Ok(Received::Pending)), "{} {heard:?}", kind.name);
            at = at.plus(kind.cycle.times(4 * k));
            (0..unheard).for_each(|_| drop(bus.frames(&old)));
            let frames = bus.frames(&new);
            let heard = bus.hear(at, &frames);
            let whole: Vec<_> = heard.iter().filter_map(|heard| heard.as_ref().ok()).collect();
            let expected = Received::Whole(new);
            assert_eq!(whole.last(), Some(&&expected), "{} without {lost}, {k}", kind.name);
            let others = whole.iter().filter(|heard| matches!(heard, Received::Whole(_))).count();
            let torn = heard.iter().filter(|heard| **heard == Err(Cause::Torn)).count();
            assert_eq!((others, torn), (1, 1), "{} without {lost}, {k}", kind.name);
        }
    }
}

#[test]
fn one_lost_frame_beside_an_overtaken_message_of_its_tag_makes_no_message_of_two() {
    let mut runner = TestRunner::deterministic();
    for kind in kinds() {
        let parts = Bus::<8>::new(kind.role).frames(&(kind.draw)(&mut runner)).len();
        // Whatever its sender's counters were when it began.
        for (lost, before) in (0..parts).flat_map(|lost| (0..15).map(move |before| (lost, before))) {
            let mut bus = Bus::<8>::new(kind.role);
            let mut at = Instant::from_micros(50 * SECOND as u64);
            (0..before).for_each(|_| drop(bus.frames(&(kind.draw)(&mut runner))));
            for _ in 0..3 {
                let frames = bus.frames(&(kind.draw)(&mut runner));
                bus.hear(at, &frames);
                at = at.plus(kind.cycle);
            }
            let (old, new) = ((kind.draw)(&mut runner), (kind.draw)(&mut runner));
            let mut frames = bus.frames(&old);
            frames.remove(lost);
            bus.hear(at, &frames);
            // The tags of driving parameters are not their station's, but counted as they are handed on: none meets its own so soon.
            if kind.name == "parameters" {
                continue;
            }
            let frames = bus.frames(&new);
            let heard = bus.hear(at.plus(Duration::from_millis(3)), &frames);
            let torn = heard.iter().filter(|heard| **heard == Err(Cause::Torn)).count();
            assert_eq!((heard.last(), torn), (Some(&Ok(Received::Whole(new))), 1), "{} without {lost}", kind.name);
            assert_eq!(heard.iter().filter(|heard| matches!(heard, Ok(Received::Whole(_)))).count(), 1);
        }
    }
}

#[test]
fn a_sender_whose_halves_count_apart_is_understood_from_its_third_message_on() {
    let mut runner = TestRunner::deterministic();
    let motion = &kinds()[0];
    let mut bus = Bus::<8>::new(motion.role);
    let mut other = Sender::<16>::new(Identifiers::DEFAULT);
    let mut taken = Vec::new();
    for n in 0..12u64 {
        let at = Instant::from_micros(50 * SECOND as u64 + n * 100_000);
        let message = (motion.draw)(&mut runner);
        let mut frames = bus.frames(&message);
        let mut others = Vec::new();
        // From the seventh on its second halves are counted by one that was silent once: the first of them repeats a counter.
        if n != 5 {
            other.send(&message, &mut |frame| others.push(frame)).unwrap();
        }
        if n > 5 {
            frames[1] = others[1];
        }
        taken.push(matches!(bus.hear(at, &frames)[1], Ok(Received::Whole(_))));
    }
    let expected = [false, true, true, true, true, true, false, false, false, true, true, true];
    assert_eq!(taken, expected);
}

/// A motion of a station by the rig, and its two frames.
fn halves(rig: &mut Rig, sender: &mut Sender<16>, station: StationHash, at: i64, place: (f64, f64)) -> Vec<Frame> {
    let motion = rig.motion(station, at, place.0, place.1, 0.0, 0.0, Some((0.5, 0.2)));
    let mut frames = Vec::new();
    sender.send(&Message::Peer(SLOT, Said::Motion(motion)), &mut |frame| frames.push(frame)).unwrap();
    frames
}

/// A target at 25 m/s brakes to a standstill unheard; the first or the second half of the last message before that was lost.
/// What is held of it afterwards.
fn heard_after_a_silence(lost: usize, messages: i64) -> (f64, f64) {
    let mut rig = Rig::new(&rig::config());
    let mut sender = Sender::<16>::new(Identifiers::DEFAULT);
    rig.power_up(true, 0);
    let mut now = 0;
    for n in 0..12 {
        now = n * 100_000;
        if n % 5 == 0 {
            rig.synchronise(now, 0);
        }
        let place = (500.0 + 2.5 * n as f64, 25.0);
        let frames = halves(&mut rig, &mut sender, TARGET, now, place);
        for (half, frame) in frames.iter().enumerate().filter(|(half, _)| n < 11 || *half != lost) {
            let _ = (half, rig.unit.receive(rig::instant(now), frame));
        }
    }
    for _ in 1..messages {
        now += 100_000;
        let _ = rig.motion(TARGET, now, 0.0, 0.0, 0.0, 0.0, None); // its tag is counted
        if now % 500_000 == 0 {
            rig.synchronise(now, 0);
        }
    }
    now += 100_000;
    rig.synchronise(now, 0);
    for frame in halves(&mut rig, &mut sender, TARGET, now, (570.0, 0.0)) {
        let _ = rig.unit.receive(rig::instant(now), &frame);
    }
    let newest = rig.unit.peers().get(2).unwrap().newest().unwrap();
    (m_of(newest.position), mps_of(newest.speed))
}

#[test]
fn a_vehicle_that_stands_after_a_silence_is_not_believed_to_drive() {
    for (lost, messages) in (0..2).flat_map(|lost| (36..140).map(move |messages| (lost, messages))) {
        assert_eq!(heard_after_a_silence(lost, messages), (570.0, 0.0), "{lost} {messages}");
    }
}

#[test]
fn halves_of_two_stations_ten_minutes_apart_make_no_message() {
    for (lost, kept) in [(0, 1), (1, 0)] {
        let mut rig = Rig::new(&rig::config());
        let mut sender = Sender::<16>::new(Identifiers::DEFAULT);
        rig.power_up(true, 0);
        for now in [0, 100_000] {
            for frame in halves(&mut rig, &mut sender, TARGET, now, (500.0, 25.0)) {
                let _ = rig.unit.receive(rig::instant(now), &frame);
            }
        }
        let first = halves(&mut rig, &mut sender, TARGET, 200_000, (505.0, 25.0));
        assert!(rig.unit.receive(rig::instant(200_000), &first[kept]).is_ok());
        let later = 600 * SECOND + 200_000;
        rig.synchronise(later, 0);
        for _ in 0..3 {
            let _ = rig.motion(TARGET, later, 0.0, 0.0, 0.0, 0.0, None);
        }
        let second = halves(&mut rig, &mut sender, StationHash(66), later, (900.0, 5.0));
        let heard = |rig: &Rig| rig.unit.peers().get(2).unwrap().heard().copied().collect::<Vec<_>>();
        let before = heard(&rig);
        assert_eq!(rig.unit.receive(rig::instant(later), &second[lost]), Err(Cause::Torn));
        assert_eq!(heard(&rig), before);
    }
}
