//! A unit on the road with its peers, second after second: what the peers say in a second enters, and the most instructions that a tick
//! and a frame took in it leave.

use holdover::OnboardUnit;
use holdover::controller::Mode;
use holdover::time::{Duration, Instant};
use holdover::units::Seconds;
use holdover::wire::{Identifiers, Message, Received, Receiver, Role, Said};

use crate::counter::Counter;
use crate::road::Road;
use crate::stack;

/// Steps of a horizon that the unit has room for.
pub const CAPACITY: usize = 400;
/// The period of a tick.
pub const PERIOD: u64 = 10_000;
/// A bus of 500 kbit/s carries so many frames of 8 bytes in a period.
const FULL_BUS: usize = 40;

/// What the peers say in a second.
#[derive(Clone, Copy)]
pub struct Traffic {
    /// In which of ten ticks all of them talk. The unit talks in tick 0.
    pub due: u64,
    /// They talk in the tick after that too.
    pub twice: bool,
    /// The last peer talks by itself, in tick 5.
    pub last_alone: bool,
    /// How old the peers' samples are when they arrive.
    pub age: Duration,
    /// The peers have changed how they drive.
    pub changed: bool,
    /// The peers send their horizons.
    pub horizons: bool,
    /// So many stations without a slot tell their passes.
    pub passers_by: u8,
    /// The range sensor says nothing.
    pub is_blind: bool,
    /// Only the peers on the ego's street talk, where there are intersections.
    pub on_lane: bool,
}

impl Traffic {
    /// All peers talk, in ticks in which the unit does not.
    pub const USUAL: Self = Self {
        due: 5,
        twice: false,
        last_alone: false,
        age: Duration::from_millis(40),
        changed: false,
        horizons: false,
        passers_by: 0,
        is_blind: false,
        on_lane: false,
    };
    /// The last peer talks by itself.
    pub const ONE: Self = Self { due: 7, last_alone: true, ..Self::USUAL };
    /// All peers talk and have changed their minds, in the tick in which the unit sends.
    pub const ALL: Self = Self { due: 0, changed: true, ..Self::USUAL };
    /// As before, and they send their horizons.
    pub const HORIZONS: Self = Self { horizons: true, ..Self::ALL };
    /// As the usual, with passes of as many stations as the unit knows at once.
    pub const PASSES: Self = Self { passers_by: 20, ..Self::USUAL };
    /// No peer talks.
    pub const SILENCE: Self = Self { due: 10, ..Self::USUAL };
    /// As the usual, from the ego's street alone.
    pub const LANE: Self = Self { on_lane: true, ..Self::USUAL };
    /// As the silence, and the range sensor says nothing.
    pub const NOTHING: Self = Self { is_blind: true, ..Self::SILENCE };
    /// Everything at once.
    pub const TOGETHER: Self = Self { passers_by: 20, ..Self::HORIZONS };

    /// The same with samples of so long ago.
    pub const fn aged(self, millis: i64) -> Self {
        Self { age: Duration::from_millis(millis), ..self }
    }

    /// The same in two ticks in a row.
    pub const fn twice(self) -> Self {
        Self { twice: true, ..self }
    }
}

/// The most instructions of a tick in a second.
#[derive(Clone, Copy, Default)]
pub struct Most {
    /// Of the other ticks without news.
    pub quiet: u32,
    /// Of the ticks after those in which the unit sends: without news too, and with the review of the order.
    pub review: u32,
    /// Of the ticks in which the unit sends.
    pub send: u32,
    /// Of the ticks in which the last peer talks by itself.
    pub one: u32,
    /// Of all ticks.
    pub any: u32,
}

impl Most {
    /// The more of both.
    pub fn max(self, other: Self) -> Self {
        Self {
            quiet: self.quiet.max(other.quiet),
            review: self.review.max(other.review),
            send: self.send.max(other.send),
            one: self.one.max(other.one),
            any: self.any.max(other.any),
        }
    }
}

/// What the frames took.
pub struct Frames {
    /// The most of one.
    pub most: u32,
    /// All together, and how many.
    pub sum: u32,
    pub count: u32,
    /// The most of as many in a row as a full bus carries in a period.
    pub full_bus: u32,
    last: [u32; FULL_BUS],
    window: u32,
}

impl Frames {
    /// None yet.
    pub const NONE: Self = Self { most: 0, sum: 0, count: 0, full_bus: 0, last: [0; FULL_BUS], window: 0 };

    fn note(&mut self, count: u32) {
        let place = self.count as usize % FULL_BUS;
        self.window = self.window + count - core::mem::replace(&mut self.last[place], count);
        (self.most, self.full_bus) = (self.most.max(count), self.full_bus.max(self.window));
        (self.sum, self.count) = (self.sum + count, self.count + 1);
    }
}

/// A started unit among its peers.
pub struct Bench<'a, const PEERS: usize> {
    pub unit: &'a mut OnboardUnit<PEERS, 8, CAPACITY>,
    pub counter: &'a Counter,
    pub road: Road,
    pub frames: Frames,
    /// Where the stack was when a tick began.
    pub top: usize,
    /// The time gap that the unit told last.
    pub time_gap: Seconds,
    listener: Receiver<0>,
}

impl<'a, const PEERS: usize> Bench<'a, PEERS> {
    /// At its beginning.
    pub fn new(unit: &'a mut OnboardUnit<PEERS, 8, CAPACITY>, counter: &'a Counter, road: Road) -> Self {
        let listener = Receiver::new(Identifiers::DEFAULT, Role::Modem);
        Self { unit, counter, road, frames: Frames::NONE, top: 0, time_gap: Seconds::ZERO, listener }
    }

    /// A second of ticks, from `number` seconds on. Fails if the unit does not follow anybody that it hears, from the third second on.
    pub fn second(&mut self, number: u64, traffic: Traffic) -> Most {
        let mut most = Most::default();
        for tick in 0..100 {
            let at = Instant::from_micros(1_000_000 * number + PERIOD * tick);
            self.hear(at, tick, traffic);
            let Self { unit, counter, road, top, .. } = self;
            // A tick begins some microseconds after its step, and then everything is read between two steps.
            let now = at.plus(Duration::from_micros(3));
            *top = stack::pointer();
            let begun = counter.begin();
            let answer = unit.tick(now);
            let count = counter.since(begun);
            most.any = most.any.max(count);
            for frame in &answer.frames {
                let heard = self.listener.receive(now, frame);
                if let Ok(Received::Whole(Message::Own(Said::DrivingParameters(parameters)))) = heard {
                    self.time_gap = parameters.time_gap;
                }
            }
            let place = match tick % 10 {
                0 => &mut most.send,
                1 => &mut most.review,
                2..=4 => &mut most.quiet,
                5 => &mut most.one,
                _ => continue,
            };
            *place = (*place).max(count);
            // Among intersections it may be that nobody is in the way.
            let follows = road.has_junctions() || answer.estimate.is_some_and(|estimate| estimate.link_on);
            let is_driven = follows && answer.mode == Mode::Cooperative;
            assert!(
                number < 2 || is_driven || traffic.due > 9,
                "{number} {tick} {:?} {:?} {:?}",
                answer.mode,
                answer.estimate,
                unit.health()
            );
        }
        most
    }

    /// The frames before a tick.
    fn hear(&mut self, at: Instant, tick: u64, traffic: Traffic) {
        let Self { unit, counter, road, frames, .. } = self;
        let mut hear = |frame: &_| frames.note(counter.count(|| unit.receive(at, frame)).1);
        if tick.is_multiple_of(50) {
            road.synchronise(at, &mut hear);
        }
        road.ego(at, &mut hear);
        if !traffic.is_blind {
            road.view(at, &mut hear);
        }
        for peer in 0..PEERS as u8 {
            if traffic.on_lane && !road.is_on_lane(peer) {
                continue;
            }
            let is_alone = traffic.last_alone && usize::from(peer) == PEERS - 1;
            let due = if is_alone { 5 } else { traffic.due };
            if tick % 10 != due && !(traffic.twice && tick % 10 == due + 1) {
                continue;
            }
            if !traffic.last_alone {
                road.parameters_of(peer, traffic.changed && tick.is_multiple_of(20), &mut hear);
            }
            road.motion_of(peer, at, traffic.age, &mut hear);
            if traffic.horizons {
                road.horizon_of(peer, &mut hear);
            }
            road.way_of(peer, at, traffic.age, &mut hear);
        }
        if tick % 10 == traffic.due {
            road.passers_by(traffic.passers_by, at, &mut hear);
        }
    }
}
