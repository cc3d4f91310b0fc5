//! What the core costs on the ECU: nothing enters, a line per measurement leaves (`name peers steps count`).
#![no_std]
#![no_main]

use core::hint::black_box;
use cortex_m_rt::entry;
use holdover::model::{Aim, Consensus, State, Step};
use holdover::parameters::FEED_FORWARD;
use holdover::time::{Duration, Instant};
use holdover::units::{Position, Seconds, Speed};
use holdover::wire::Transport;
use holdover::{Config, OnboardUnit};
use holdover_image::bench::{Bench, CAPACITY, Most, PERIOD, Traffic};
use holdover_image::counter::Counter;
use holdover_image::float::{double, single};
use holdover_image::junction::WAY;
use holdover_image::kalman::predict;
use holdover_image::output::say;
use holdover_image::road::{EGO, Road};
use holdover_image::semihosting::end;
use holdover_image::stack;

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
        say(format_args!("start {PEERS} {steps} {count}"));
        let mut bench = Bench::new(unit, counter, Road::new(PEERS as u8));
        let seconds = [Traffic::USUAL, Traffic::USUAL, Traffic::ONE, Traffic::ALL, Traffic::HORIZONS];
        // Before the samples of 2 s ago it is quiet for that long: they are to be the newest.
        let late = Traffic::ALL.aged(2_000);
        let [_, usual, one, all, horizons, _, _, _, late] = core::array::from_fn(|number| {
            let silence = if number < 8 { Traffic::SILENCE } else { late };
            bench.second(number as u64, *seconds.get(number).unwrap_or(&silence))
        });
        let frames = bench.frames;
        for (name, count) in [
            ("quiet", usual.quiet),
            ("send", usual.send),
            ("one", one.one),
            ("all", all.any),
            ("horizons", horizons.any),
            ("late", late.any),
            ("receive", frames.most),
            ("receive-mean", frames.sum / frames.count),
            ("stack", stack::depth(bench.top) as u32),
        ] {
            say(format_args!("{name} {PEERS} {steps} {count}"));
        }
    }
    for (steps, size) in [
        (50, size_of::<OnboardUnit<PEERS, 8, 50>>()),
        (100, size_of::<OnboardUnit<PEERS, 8, 100>>()),
        (359, size_of::<OnboardUnit<PEERS, 8, 359>>()),
        (400, size_of::<OnboardUnit<PEERS, 8, 400>>()),
    ] {
        say(format_args!("unit {PEERS} {steps} {size}"));
    }
}

/// So long it is silent before the gap is taken as opened: it opens from 5 s on.
const SILENCE_S: u64 = 9;

/// What the configuration of the manual takes on a drive past an intersection, and without parts of it.
#[inline(never)]
fn drive(unit: &mut OnboardUnit<8, 8, CAPACITY>, counter: &Counter) {
    for (name, has_map, has_envelope, has_sensor, is_terse) in [
        ("bare", false, false, false, false),
        ("envelope", false, true, false, false),
        ("map", true, false, false, false),
        ("both", true, true, false, false),
        ("sensor", false, true, true, false),
        ("terse", false, true, true, true),
        ("all", true, true, true, false),
    ] {
        let car = if has_sensor { Config::car(EGO).with_range_sensor() } else { Config::car(EGO) };
        let config = Config { envelope: car.envelope.filter(|_| has_envelope), ..car };
        let road = || {
            let road = if has_map { Road::new(8).with_junctions() } else { Road::new(8) };
            let road = if is_terse { road.with_terse_target() } else { road };
            if has_sensor { road.with_sensor() } else { road }
        };
        let begin = |unit: &mut OnboardUnit<8, 8, CAPACITY>| {
            assert!(unit.start(&config).is_ok());
            assert!(!has_map || unit.set_out(&WAY).is_ok());
        };
        begin(unit);
        stack::paint();
        let mut bench = Bench::new(unit, counter, road());
        let mut cycle = [Most::default(); 4];
        for number in 0..16 {
            let kinds = [Traffic::USUAL, Traffic::ALL, Traffic::HORIZONS, Traffic::PASSES];
            let (kind, most) = (kinds[number as usize % 4], &mut cycle[number as usize % 4]);
            *most = bench.second(number, kind).max(*most);
        }
        let [usual, all, horizons, passes] = cycle;
        let (frames, mut deep) = (bench.frames, stack::depth(bench.top));
        // The first seconds with horizons, from many places; behind what is heard, and after a silence in which the time gap has opened.
        let mut first = |spacing: i64, by: i64, silence: u64| {
            begin(bench.unit);
            let mut bench =
                Bench::new(bench.unit, counter, road().spaced_by(spacing).further_away(by + 11_000 * silence as i64));
            // The gap opens only behind a vehicle on the ego's street.
            let before = if silence > 0 { Traffic::LANE } else { Traffic::USUAL };
            for number in 0..3 {
                bench.second(number, before);
            }
            for number in 3..3 + silence {
                bench.second(number, Traffic::NOTHING);
            }
            // At the smaller gap of a sensor nobody on the street may be near enough to be followed, where there are intersections.
            let is_opened = bench.time_gap > config.law.time_gap;
            assert!(is_opened == (silence > 0) || has_map && has_sensor, "{}", bench.time_gap.to_millis());
            stack::paint();
            let most = (3..6).map(|number| bench.second(number + silence, Traffic::HORIZONS).any).max().unwrap_or(0);
            deep = stack::depth(bench.top).max(deep);
            most
        };
        let (mut heard, mut opened) = (0, 0);
        for (spacing, by) in [12_000, 14_000, 18_000]
            .into_iter()
            .flat_map(|spacing| (0..if has_map { 90_000 } else { 1 }).step_by(2_000).map(move |by| (spacing, by)))
        {
            (heard, opened) = (first(spacing, by, 0).max(heard), first(spacing, by, SILENCE_S).max(opened));
        }
        // Samples that come after a silence that was as long as they are old.
        let mut after = |silence: u64, has_ticks: bool, traffic: Traffic| {
            begin(bench.unit);
            let mut bench = Bench::new(bench.unit, counter, road());
            for number in 0..3 {
                bench.second(number, Traffic::USUAL);
            }
            for number in (3..3 + silence).filter(|_| has_ticks) {
                bench.second(number, Traffic::SILENCE);
            }
            stack::paint();
            let most = bench.second(3 + silence, traffic).any;
            deep = stack::depth(bench.top).max(deep);
            most
        };
        let stale = config.link.stale.as_millis();
        let oldest = stale - 100;
        let rows = [
            ("quiet", usual.quiet),
            ("review", usual.review),
            ("send", usual.send),
            ("all", all.any),
            ("horizons", horizons.any),
            ("passes", passes.any),
            ("first", heard),
            ("opened", opened),
            ("late-0.3", after(0, true, Traffic::ALL.aged(300))),
            ("late-3", after(4, true, Traffic::ALL.aged(3_000))),
            ("late-twice", after(4, true, Traffic::ALL.aged(3_000).twice())),
            ("horizons-twice", after(1, true, Traffic::HORIZONS.aged(310).twice())),
            ("late-most", after(stale as u64 / 1_000 + 1, true, Traffic::ALL.aged(oldest))),
            ("together", after(stale as u64 / 1_000 + 1, true, Traffic::TOGETHER.aged(oldest))),
            ("pause", after(3, false, Traffic::TOGETHER)),
        ];
        let worst = rows.iter().map(|(_, count)| *count).max().unwrap_or(0);
        let others = [("worst", worst), ("receive", frames.most), ("bus", frames.full_bus), ("stack", deep as u32)];
        for (row, count) in rows.into_iter().chain(others) {
            say(format_args!("{name}-{row} 8 359 {count}"));
        }
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
            road.state_of(peer, at, Traffic::USUAL.age, tick % 50 == 5, &mut |frame| {
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
        law: Consensus {
            time_gap: Seconds::from_millis(1_000), // as in the other two
            feed_forward: FEED_FORWARD,            // which they do not have
            ..law.consensus()
        },
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
    let ((_, done), fixed) = counter.count(|| stride.run(start, speed, black_box(ahead), black_box(out)));
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
    let counter = Counter::start();
    counter.check();
    // The compiler does not know, so that it inlines the same in both programs.
    if black_box(cfg!(feature = "fd")) {
        peer("peer-fd", EIGHT, &Config { transport: Transport::Fd, ..Config::car(EGO) }, &counter);
        end(true);
    }
    measure(ONE, &counter);
    measure(FOUR, &counter);
    measure(EIGHT, &counter);
    drive(EIGHT, &counter);
    peer("peer", EIGHT, &Config::car(EGO), &counter);
    compare(&counter);
    end(true);
}
