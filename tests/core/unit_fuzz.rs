//! Any frames at any times: nothing panics, every tick is answered, and while the unit drives, its command stays within
//! the configured limits.

#[allow(dead_code)] // others use all of it
use crate::messages;
use crate::traffic;
use crate::traffic::{AnyFrame, EGO, PEERS, Traffic, Unit, drop_result, extended, resealed, standard};
use holdover::config::{Config, Envelope};
use holdover::controller::Mode;
use holdover::time::{Duration, Instant};
use holdover::units::{Acceleration, Distance, Jerk, Speed};
use holdover::wire::Identifiers;
use holdover::wire::catalogue::BLOCK;
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::{Frame, Message, Said, Sender};
use proptest::prelude::*;
use proptest::test_runner::{Config as Proptest, RngSeed};

/// What happens next.
#[derive(Clone, Debug)]
enum Event {
    /// A message of random, representable values comes in order.
    Message(Message),
    /// A frame of random bits under a good checksum; by its offset, its counter and its data.
    Sealed(u16, u8, [u8; 8]),
    /// Any frame at all.
    Any(AnyFrame),
    /// So many periods of ordinary traffic.
    Traffic(u8),
    /// Time passes, or runs back; by so many microseconds.
    Pause(i64),
    /// The unit is ticked.
    Tick,
}

fn event() -> impl Strategy<Value = Event> {
    let pause = prop_oneof![
        8 => 0i64..30_000,
        2 => 0i64..2_000_000,
        1 => -50_000i64..0,
        1 => 0i64..20_000_000,
        1 => Just(3_600_000_000i64),
    ];
    let id = prop_oneof![(0u16..0x800).prop_map(standard), any::<u32>().prop_map(|id| extended(id & 0x1FFF_FFFF))];
    let frame = (id, proptest::collection::vec(any::<u8>(), 0..=8), any::<bool>());
    // Those who drive are driven: a request that is mostly a request to.
    let request =
        (messages::driver_request(), 0..10u8).prop_map(|(request, off)| DriverRequest { engaged: off > 0, ..request });
    prop_oneof![
        6 => messages::to_unit(PEERS as u8).prop_map(Event::Message),
        2 => request.prop_map(|request| Event::Message(Message::DriverRequest(request))),
        2 => messages::motion().prop_map(|motion| Event::Message(Message::Ego(Said::Motion(motion)))),
        3 => (0..BLOCK, 0u8..16, any::<[u8; 8]>()).prop_map(|(id, counter, data)| Event::Sealed(id, counter, data)),
        1 => frame.prop_map(|(id, data, remote)| Event::Any(AnyFrame { id, data, remote })),
        4 => (1u8..30).prop_map(Event::Traffic),
        5 => pause.prop_map(Event::Pause),
        8 => Just(Event::Tick),
    ]
}

/// The widest that a command may be, and how far one may be from the last: what the jerk makes of a period, and downward, where ticks
/// were missed, of the time since then, up to a period and the delay that the envelope tolerates.
struct Bounds {
    range: std::ops::RangeInclusive<Acceleration>,
    jerk: Jerk,
    period: Duration,
    longest: Duration,
    last: Option<(Instant, Acceleration)>,
}

impl Bounds {
    fn of(config: &Config) -> Self {
        let limits = &config.limits;
        let (range, jerk) = match &config.envelope {
            None => (limits.braking.negated()..=limits.acceleration, limits.jerk),
            Some(envelope) => (envelope.braking.negated()..=envelope.acceleration, envelope.jerk),
        };
        let longest = config.period.plus(config.envelope.map_or(Duration::ZERO, |envelope| envelope.delay));
        Self { range, jerk, period: config.period, longest, last: None }
    }

    /// In standby somebody else drives, and what they demand is what the unit starts from.
    fn check(&mut self, at: Instant, mode: Mode, command: Acceleration) -> Result<(), TestCaseError> {
        if let Some((then, last)) = self.last.filter(|(_, last)| mode != Mode::Standby && self.range.contains(last)) {
            prop_assert!(self.range.contains(&command), "{command:?} after {last:?} in {mode:?}");
            // Both commands are rounded to the format from the wire's steps.
            let within = |time: Duration| self.jerk.over(time.fine_seconds()).plus(Acceleration::from_bits(2));
            let time = at.since(then).min(self.longest).max(self.period);
            // What the jerk makes of a time that is no whole number of periods is encoded as the next step down.
            let step = if time == self.period { Acceleration::ZERO } else { Acceleration::from_mm_per_s2(2) };
            let down = within(time).plus(step);
            let change = command.minus(last);
            let is_kept = change <= within(self.period) && change >= down.negated();
            prop_assert!(is_kept, "{command:?} after {last:?} in {mode:?}");
        }
        self.last = Some((at, command));
        Ok(())
    }
}

fn play(config: &Config, events: Vec<Event>) -> Result<(), TestCaseError> {
    let mut unit = Unit::new(config).expect("the configuration is sound");
    let mut traffic = Traffic::new();
    let mut sender = Sender::<16>::new(Identifiers::DEFAULT);
    let mut bounds = Bounds::of(config);
    let mut now = traffic.now();
    let mut frames = Vec::new();
    for event in events {
        frames.clear();
        match event {
            Event::Message(message) => {
                sender.send(&message, &mut |frame| frames.push(frame)).expect("the catalogue has a line for it");
            }
            Event::Sealed(offset, counter, data) => {
                let frame = Frame { id: Identifiers::DEFAULT.at(offset), data: data.into() };
                frames.push(resealed(frame, Some(counter), |_| ()));
            }
            Event::Any(frame) => drop_result(unit.receive(now, &frame)),
            Event::Traffic(periods) => {
                // Their counters follow those of the random messages.
                traffic.offset = now.minus(traffic::PERIOD.times(traffic.period));
                std::mem::swap(&mut traffic.sender, &mut sender);
                for _ in 0..periods {
                    now = traffic.now();
                    let answer = traffic.step(&mut unit);
                    bounds.check(now, answer.mode, answer.command.acceleration)?;
                }
                std::mem::swap(&mut traffic.sender, &mut sender);
            }
            Event::Pause(micros) => now = now.plus(Duration::from_micros(micros)).max(Instant::from_micros(1)),
            Event::Tick => {
                let answer = unit.tick(now);
                prop_assert!(!answer.frames.is_empty());
                prop_assert!(answer.estimate.is_none_or(|estimate| estimate.reading.speed >= Speed::ZERO));
                bounds.check(now, answer.mode, answer.command.acceleration)?;
            }
        }
        frames.iter().for_each(|frame| drop_result(unit.receive(now, frame)));
    }
    Ok(())
}

const ENVELOPE: Envelope = Envelope {
    acceleration: Acceleration::from_mm_per_s2(1_500),
    braking: Acceleration::from_mm_per_s2(3_000),
    jerk: Jerk::from_mm_per_s3(4_000),
    speed: Speed::from_mm_per_s(30_000),
    margin: Distance::from_mm(500),
    ..Envelope::CAR
};

proptest! {
    #![proptest_config(Proptest {
        cases: if cfg!(debug_assertions) { 100 } else { 300 },
        rng_seed: RngSeed::Fixed(1939),
        failure_persistence: None,
        ..Proptest::default()
    })]

    #[test]
    fn no_frame_at_no_time_makes_it_panic_or_leave_its_limits(
        events in proptest::collection::vec(event(), 1..200), is_enveloped: bool,
    ) {
        let envelope = is_enveloped.then_some(ENVELOPE);
        play(&Config { envelope, ..Config::car(EGO) }, events)?;
    }

    #[test]
    fn no_frame_at_no_time_makes_it_panic_in_paper_mode(events in proptest::collection::vec(event(), 1..100)) {
        let mut config = Config { envelope: Some(ENVELOPE), ..Config::car(EGO) };
        config.prediction.model = holdover::config::Model::PAPER;
        play(&config, events)?;
    }
}
