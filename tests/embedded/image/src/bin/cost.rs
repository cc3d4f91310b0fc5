//! What the core costs on the ECU: nothing enters, a line per measurement leaves (`name peers steps count`).
#![no_std]
#![no_main]

use core::hint::black_box;
use cortex_m_rt::entry;
use holdover::model::{Aim, State, Step};
use holdover::time::{Duration, Instant};
use holdover::units::{Position, Seconds, Speed};
use holdover::wire::Transport;
use holdover::{Config, OnboardUnit};
use holdover_image::counter::Counter;
use holdover_image::float::{double, single};
use holdover_image::kalman::predict;
use holdover_image::output::say;
use holdover_image::road::{EGO, Road};
use holdover_image::semihosting::end;
use holdover_image::stack;

const CAPACITY: usize = 400;
const PERIOD: u64 = 10_000;
/// How old the peers' samples are when they arrive, unless something else is measured.
const AGE: Duration = Duration::from_millis(40);

/// What a second of ticks is to show.
#[derive(Clone, Copy, PartialEq)]
enum Second {
    /// All peers talk, in ticks in which the unit does not.
    Usual,
    /// The last peer talks by itself.
    One,
    /// All peers talk and have changed their minds, in the tick in which the unit sends.
    All,
    /// As before, and send their horizons.
    Horizons,
    /// As `All`, with samples of 2 s ago.
    Late,
}

/// The most that each door took.
#[derive(Default)]
struct Worst {
    quiet: u32,
    send: u32,
    one: u32,
    all: u32,
    horizons: u32,
    late: u32,
    receive: u32,
    frames: u32,
    received: u32,
    /// Where the stack was when a tick began.
    top: usize,
}

struct Bench<'a, const PEERS: usize> {
    unit: &'a mut OnboardUnit<PEERS, 8, CAPACITY>,
    counter: &'a Counter,
    road: Road,
    worst: Worst,
}

impl<const PEERS: usize> Bench<'_, PEERS> {
    fn second(&mut self, number: u64, second: Second) {
        let Self { unit, counter, road, worst } = self;
        for tick in 0..100 {
            let at = Instant::from_micros(1_000_000 * number + PERIOD * tick);
            let mut hear = |frame: &_| {
                let (_, count) = counter.count(|| unit.receive(at, frame));
                worst.receive = worst.receive.max(count);
                worst.received += count;
                worst.frames += 1;
            };
            if tick % 50 == 0 {
                road.synchronise(at, &mut hear);
            }
            road.ego(at, &mut hear);
            let phase = tick % 10;
            let age = if second == Second::Late { Duration::from_millis(2_000) } else { AGE };
            for peer in 0..PEERS as u8 {
                let is_last = usize::from(peer) == PEERS - 1;
                let due = match second {
                    Second::Usual => 5,
                    Second::One if is_last => 5,
                    Second::One => 7,
                    Second::All | Second::Horizons | Second::Late => 0,
                };
                if phase != due {
                    continue;
                }
                if second != Second::One {
                    road.parameters_of(peer, second != Second::Usual && tick % 20 == 0, &mut hear);
                }
                road.motion_of(peer, at, age, &mut hear);
                if second == Second::Horizons {
                    road.horizon_of(peer, &mut hear);
                }
            }
            // A tick begins some microseconds after its step, and then everything is read between two steps.
            let now = at.plus(Duration::from_micros(3));
            let (answer, count) = counter.count(|| {
                worst.top = stack::pointer();
                unit.tick(now)
            });
            let place = match (second, phase) {
                (Second::Usual, 0) => &mut worst.send,
                (Second::Usual, 1..=4 | 6..=9) => &mut worst.quiet,
                (Second::One, 5) => &mut worst.one,
                (Second::All, 0) => &mut worst.all,
                (Second::Horizons, 0) => &mut worst.horizons,
                (Second::Late, 0) => &mut worst.late,
                _ => continue,
            };
            *place = (*place).max(count);
            let is_followed = answer.estimate.is_some_and(|estimate| estimate.link_on);
            assert!(number < 2 || is_followed, "{number} {tick} {:?} {:?}", answer.estimate, unit.health());
        }
    }
}

/// All measurements with so many peers.
#[inline(never)]
fn measure<const PEERS: usize>(unit: &mut OnboardUnit<PEERS, 8, CAPACITY>, counter: &Counter) {
    // A horizon of 359 steps is that of `Config::car`; the others have a step of 10 ms.
    for steps in [50, 100, 359, 400] {
        let mut config = Config::car(EGO);
        if steps != 359 {
            config.prediction.step = Duration::from_millis(10);
            config.prediction.horizon = config.prediction.step.times(steps - 2);
        }
        stack::paint();
        let (started, count) = counter.count(|| unit.start(&config));
        assert!(started.is_ok());
        say(format_args!("start {} {} {}", PEERS, steps, count));
        let mut bench = Bench { unit, counter, road: Road::new(PEERS as u8), worst: Worst::default() };
        let seconds = [Second::Usual, Second::Usual, Second::One, Second::All, Second::Horizons];
        // Before the samples of 2 s ago it is quiet for that long: they are to be the newest.
        for (number, second) in (0..).zip(seconds).chain([(8, Second::Late)]) {
            if number == 1 {
                bench.worst = Worst::default();
            }
            bench.second(number, second);
        }
        let worst = bench.worst;
        for (name, count) in [
            ("quiet", worst.quiet),
            ("send", worst.send),
            ("one", worst.one),
            ("all", worst.all),
            ("horizons", worst.horizons),
            ("late", worst.late),
            ("receive", worst.receive),
            ("receive-mean", worst.received / worst.frames),
            ("stack", stack::depth(worst.top) as u32),
        ] {
            say(format_args!("{} {} {} {}", name, PEERS, steps, count));
        }
    }
    for (steps, size) in [
        (50, size_of::<OnboardUnit<PEERS, 8, 50>>()),
        (100, size_of::<OnboardUnit<PEERS, 8, 100>>()),
        (359, size_of::<OnboardUnit<PEERS, 8, 359>>()),
        (400, size_of::<OnboardUnit<PEERS, 8, 400>>()),
    ] {
        say(format_args!("unit {} {} {}", PEERS, steps, size));
    }
}

/// What the frames of one peer take in 100 ms, of eight: motion, horizon, and a fifth of its driving parameters.
#[inline(never)]
fn peer(name: &str, unit: &mut OnboardUnit<8, 8, CAPACITY>, config: &Config, counter: &Counter) {
    const SECONDS: u64 = 3;
    assert!(unit.start(config).is_ok());
    let (mut road, mut sum, mut messages) = (Road::new(8), 0, 0);
    for tick in 0..100 * SECONDS {
        let at = Instant::from_micros(PERIOD * tick);
        let mut deaf = |frame: &_| {
            let _ = unit.receive(at, frame);
        };
        if tick % 50 == 0 {
            road.synchronise(at, &mut deaf);
        }
        road.ego(at, &mut deaf);
        for peer in (0..8).filter(|_| tick % 10 == 5) {
            road.state_of(peer, at, AGE, tick % 50 == 5, &mut |frame| {
                let (_, count) = counter.count(|| unit.receive(at, frame));
                sum += if peer == 7 && tick >= 100 { count } else { 0 };
            });
            messages += u32::from(peer == 7 && tick >= 100);
        }
        let answer = unit.tick(at.plus(Duration::from_micros(3)));
        assert!(tick < 100 || answer.estimate.is_some_and(|estimate| estimate.link_on));
    }
    say(format_args!("{} 8 {} {}", name, CAPACITY, sum / messages));
}

/// The same 400 steps of one follower in the core's fixed point, in `f32` and in `f64`; and as many predictions of a Kalman
/// filter.
#[allow(static_mut_refs)] // each is named once
fn compare(counter: &Counter) {
    static mut FIXED: [[Step; CAPACITY]; 2] =
        [[Step { position: Position::ZERO.ring(), speed: Speed::ZERO }; CAPACITY]; 2];
    let config = Config::car(EGO);
    let law = config.law;
    let aim = Aim::Follow {
        gain: law.gain,
        damping: law.damping,
        time_gap: Seconds::from_millis(1_000), // as in the other two
        standstill: law.standstill,
        catch_up: law.target_speed,
    };
    let stride = config.vehicle_model(aim).over(Duration::from_millis(10), config.length, &config.prediction.model);
    let speed = Speed::from_mm_per_s(11_000);
    let start = State { position: Position::ZERO.ring(), speed, ..State::default() };
    // SAFETY: this function is called once, and nothing else names the static.
    let [ahead, out] = unsafe { &mut FIXED };
    for (step, way) in ahead.iter_mut().zip((18_110..).step_by(110)) {
        *step = Step { position: Position::from_mm(way).ring(), speed };
    }
    let ((_, done), fixed) = counter.count(|| stride.run(start, black_box(ahead), black_box(out)));
    assert!(done == CAPACITY);
    // All of them predict the same.
    let end = out.last().map_or(0, |step| step.position.ahead_of(Position::ZERO.ring()).to_mm()) as f32 / 1000.0;
    macro_rules! in_float {
        ($module:ident) => {{
            static mut STEPS: [[$module::Step; CAPACITY]; 2] =
                [[$module::Step { position: 0.0, speed: 0.0 }; CAPACITY]; 2];
            // SAFETY: as above.
            let [ahead, out] = unsafe { &mut STEPS };
            for (step, way) in ahead.iter_mut().zip((18_110u16..).step_by(110)) {
                *step = $module::Step { position: $module::from(way) / 1000.0, speed: 11.0 };
            }
            let ((), count) =
                counter.count(|| $module::run(black_box(&$module::LAW), black_box(ahead), black_box(out)));
            let float = out.last().map_or(0.0, |step| step.position as f32);
            assert!((float - end).abs() < 0.01, "{float} {end}");
            count
        }};
    }
    let (single, double) = (in_float!(single), in_float!(double));
    let (_, kalman) = counter.count(|| black_box(predict(black_box(CAPACITY))));
    for (name, count) in [("step-fixed", fixed), ("step-f32", single), ("step-f64", double), ("step-kalman", kalman)] {
        say(format_args!("{} 1 {} {}", name, CAPACITY, count));
    }
}

#[entry]
fn main() -> ! {
    static mut EIGHT: OnboardUnit<8, 8, CAPACITY> = OnboardUnit::idle();
    static mut FOUR: OnboardUnit<4, 8, CAPACITY> = OnboardUnit::idle();
    static mut ONE: OnboardUnit<1, 8, CAPACITY> = OnboardUnit::idle();
    if let Some(counter) = Counter::start() {
        counter.check();
        // The compiler does not know, so that it inlines the same in both programs.
        if black_box(cfg!(feature = "fd")) {
            peer("peer-fd", EIGHT, &Config { transport: Transport::Fd, ..Config::car(EGO) }, &counter);
            end(true);
        }
        measure(ONE, &counter);
        measure(FOUR, &counter);
        measure(EIGHT, &counter);
        peer("peer", EIGHT, &Config::car(EGO), &counter);
        compare(&counter);
        end(true);
    }
    end(false)
}
