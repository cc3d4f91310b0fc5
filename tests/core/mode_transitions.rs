//! The mode machine: by its facts it does what a literal table says and nothing else, and from outside, frames in and
//! frames out, every transition that can happen does.

use std::collections::BTreeSet;

use crate::rig::random::Random;
use crate::rig::road::{Road, Senses};
use crate::rig::{TARGET, config};
use holdover::controller::{Facts, FallbackCause, FaultCause, Mode, TargetFact};
use holdover::time::{Duration, Instant};
use holdover::wire::command::ModeCode;
use holdover::wire::{Message, Predecessor, StationHash};

/// Standby, Cooperative, Holdover, Fallback (not associated, never heard, silent, range, request), Fault (ego missing, ego stale).
const STATES: [&str; 10] = ["S", "C", "H", "Fn", "Fh", "Fs", "Fr", "Fq", "Xm", "Xs"];

/// What the facts are, in the order of the columns.
const FACTS: [&str; 11] = ["off", "Xm", "Xs", "leads", "on", "silent", "Fn", "Fh", "Fs", "Fr", "Fq"];

/// State by state, and within a state that waits by how long it has, the next state by the facts.
const NEXT: [(&str, &str, [&str; 11]); 15] = [
    ("S", "", ["S", "Xm", "Xs", "C", "C", "H", "Fn", "Fh", "Fs", "Fr", "Fq"]),
    ("C", "", ["S", "Xm", "Xs", "C", "C", "H", "Fn", "Fh", "Fs", "Fr", "Fq"]),
    ("H", "", ["S", "Xm", "Xs", "C", "C", "H", "Fn", "Fh", "Fs", "Fr", "Fq"]),
    ("Fn", "", ["S", "Xm", "Xs", "C", "C", "H", "Fn", "Fh", "Fs", "Fr", "Fq"]),
    ("Fh", "", ["S", "Xm", "Xs", "C", "C", "H", "Fn", "Fh", "Fs", "Fr", "Fq"]),
    ("Fr", "", ["S", "Xm", "Xs", "C", "C", "H", "Fn", "Fh", "Fs", "Fr", "Fq"]),
    ("Fq", "", ["S", "Xm", "Xs", "C", "C", "H", "Fn", "Fh", "Fs", "Fr", "Fq"]),
    ("Fs", "not yet", ["S", "Xm", "Xs", "C", "Fs", "Fs", "Fn", "Fh", "Fs", "Fr", "Fq"]),
    ("Fs", "almost", ["S", "Xm", "Xs", "C", "Fs", "Fs", "Fn", "Fh", "Fs", "Fr", "Fq"]),
    ("Fs", "enough", ["S", "Xm", "Xs", "C", "C", "Fs", "Fn", "Fh", "Fs", "Fr", "Fq"]),
    ("Xm", "almost", ["S", "Xm", "Xs", "Xm", "Xm", "Xm", "Xm", "Xm", "Xm", "Xm", "Xm"]),
    ("Xm", "enough", ["S", "Xm", "Xs", "C", "C", "H", "Fn", "Fh", "Fs", "Fr", "Fq"]),
    ("Xs", "not yet", ["S", "Xm", "Xs", "Xs", "Xs", "Xs", "Xs", "Xs", "Xs", "Xs", "Xs"]),
    ("Xs", "almost", ["S", "Xm", "Xs", "Xs", "Xs", "Xs", "Xs", "Xs", "Xs", "Xs", "Xs"]),
    ("Xs", "enough", ["S", "Xm", "Xs", "C", "C", "H", "Fn", "Fh", "Fs", "Fr", "Fq"]),
];

const NOW: Instant = Instant::from_micros(100_000_000);
const REJOIN_US: i64 = 300_000;
const RECOVER_US: i64 = 500_000;

fn name(code: ModeCode, detail: u8) -> &'static str {
    match (code, detail) {
        (ModeCode::Standby, 0) => "S",
        (ModeCode::Cooperative, 0) => "C",
        (ModeCode::Holdover, 0) => "H",
        (ModeCode::Fallback, 1) => "Fn",
        (ModeCode::Fallback, 2) => "Fh",
        (ModeCode::Fallback, 3) => "Fs",
        (ModeCode::Fallback, 4) => "Fr",
        (ModeCode::Fallback, 5) => "Fq",
        (ModeCode::Fault, 16) => "Xm",
        (ModeCode::Fault, 17) => "Xs",
        other => panic!("no such mode: {other:?}"),
    }
}

fn mode(state: &str, waited: &str) -> Mode {
    let since = Instant::from_micros(50_000_000);
    let ago = |limit: i64| match waited {
        "not yet" => None,
        "almost" => Some(NOW.minus(Duration::from_micros(limit - 1))),
        _ => Some(NOW.minus(Duration::from_micros(limit))),
    };
    let fallback = |cause| Mode::Fallback { since, cause, heard_since: ago(REJOIN_US) };
    let fault = |cause| Mode::Fault { since, cause, gone_since: ago(RECOVER_US) };
    match state {
        "S" => Mode::Standby,
        "C" => Mode::Cooperative,
        "H" => Mode::Holdover { since },
        "Fn" => fallback(FallbackCause::NotAssociated),
        "Fh" => fallback(FallbackCause::NeverHeard),
        "Fs" => fallback(FallbackCause::Silent),
        "Fr" => fallback(FallbackCause::RangeDisagrees),
        "Fq" => fallback(FallbackCause::RequestLost),
        "Xm" => fault(FaultCause::EgoMissing),
        _ => fault(FaultCause::EgoStale),
    }
}

fn facts(name: &str, target: TargetFact) -> Facts {
    let fine = Facts { engaged: true, ego: Ok(()), target };
    match name {
        "off" => Facts { engaged: false, ..fine },
        "Xm" => Facts { ego: Err(FaultCause::EgoMissing), ..fine },
        "Xs" => Facts { ego: Err(FaultCause::EgoStale), ..fine },
        "leads" => Facts { target: TargetFact::NotNeeded, ..fine },
        "on" => Facts { target: TargetFact::On, ..fine },
        "silent" => Facts { target: TargetFact::Off, ..fine },
        "Fn" => Facts { target: TargetFact::Lost(FallbackCause::NotAssociated), ..fine },
        "Fh" => Facts { target: TargetFact::Lost(FallbackCause::NeverHeard), ..fine },
        "Fs" => Facts { target: TargetFact::Lost(FallbackCause::Silent), ..fine },
        "Fq" => Facts { target: TargetFact::Lost(FallbackCause::RequestLost), ..fine },
        _ => Facts { target: TargetFact::Lost(FallbackCause::RangeDisagrees), ..fine },
    }
}

#[test]
fn every_state_goes_where_the_table_says_and_nowhere_else() {
    let targets = [
        TargetFact::NotNeeded,
        TargetFact::On,
        TargetFact::Off,
        TargetFact::Lost(FallbackCause::NotAssociated),
        TargetFact::Lost(FallbackCause::NeverHeard),
        TargetFact::Lost(FallbackCause::Silent),
        TargetFact::Lost(FallbackCause::RangeDisagrees),
        TargetFact::Lost(FallbackCause::RequestLost),
    ];
    for (state, waited, row) in NEXT {
        for (column, expected) in FACTS.iter().zip(row) {
            // The target is beside the point where the column is about the driver or the ego.
            for target in targets {
                let next = mode(state, waited).next(&facts(column, target), NOW);
                assert_eq!(name(next.code(), next.detail()), expected, "{state} {waited}: {column}");
            }
        }
    }
}

#[test]
fn a_state_keeps_its_data_and_a_new_one_starts_now() {
    let (since, on) = (Instant::from_micros(50_000_000), TargetFact::On);
    let next = |state, waited, column| mode(state, waited).next(&facts(column, on), NOW);
    for state in ["S", "C", "Fn", "Fh", "Fr"] {
        assert_eq!(next(state, "", "silent"), Mode::Holdover { since: NOW }, "{state}");
    }
    assert_eq!(next("H", "", "silent"), Mode::Holdover { since });
    let (cause, heard_since) = (FallbackCause::Silent, None);
    assert_eq!(next("Fs", "almost", "silent"), Mode::Fallback { since, cause, heard_since });
    assert_eq!(next("Fs", "almost", "Fs"), Mode::Fallback { since, cause, heard_since });
    assert_eq!(next("Fs", "not yet", "on"), Mode::Fallback { since, cause, heard_since: Some(NOW) });
    assert_eq!(next("Fn", "", "Fs"), Mode::Fallback { since, cause, heard_since });
    assert_eq!(next("H", "", "Fs"), Mode::Fallback { since: NOW, cause, heard_since });
    let (cause, gone_since) = (FaultCause::EgoStale, None);
    assert_eq!(next("Xs", "almost", "Xs"), Mode::Fault { since, cause, gone_since });
    assert_eq!(next("Xs", "not yet", "on"), Mode::Fault { since, cause, gone_since: Some(NOW) });
    assert_eq!(next("Xm", "almost", "Xs"), Mode::Fault { since: NOW, cause, gone_since });
    assert_eq!(next("C", "", "Xs"), Mode::Fault { since: NOW, cause, gone_since });
}

/// One walk through random circumstances; the transitions seen in the frames that the unit sends.
fn walk(seed: u64, seen: &mut BTreeSet<(&'static str, &'static str)>) {
    let mut random = Random::new(seed);
    let mut config = config();
    config.link.holdover = Duration::from_millis(700);
    let mut road = Road::new(&config, 0.0, 10.0);
    road.senses = Senses { ego: random.happens(0.5), v2x: random.happens(0.5), range: false, clock: true, desk: true };
    road.engaged = random.happens(0.5);
    let mut before = "S";
    for _ in 0..60 {
        for _ in 0..=random.below(3) {
            match random.below(7) {
                6 => road.senses.desk = random.happens(0.7),
                0 => road.engaged = random.happens(0.8),
                1 => road.senses.ego = random.happens(0.7),
                2 => road.senses.v2x = random.happens(0.5),
                3 => (road.senses.range, road.wrong) = (random.happens(0.7), random.extreme(0.0, 60.0)),
                _ => {
                    let whom = [TARGET, TARGET, TARGET, StationHash(77)][random.below(4) as usize];
                    road.predecessor = [
                        Predecessor::Station(whom),
                        Predecessor::Station(whom),
                        Predecessor::None,
                        Predecessor::Unknown,
                    ][random.below(4) as usize];
                }
            }
        }
        for _ in 0..[2, 5, 12, 35, 90][random.below(5) as usize] {
            let heard = road.step();
            let mode = heard.answer.mode;
            let now = name(mode.code(), mode.detail());
            assert_eq!(heard.command.mode, mode.code());
            let told =
                heard.all.iter().find_map(|m| if let Message::Status(s) = m { Some((s.mode, s.detail)) } else { None });
            assert!(told.is_none_or(|told| told == (mode.code(), mode.detail())), "{told:?} {mode:?}");
            seen.insert((before, now));
            before = now;
        }
    }
}

#[test]
fn from_outside_every_transition_happens_but_those_that_cannot() {
    let mut seen = BTreeSet::new();
    for seed in 0..900 {
        walk(seed, &mut seen);
    }
    for from in STATES {
        for to in STATES {
            // A vehicle whose motion has come once is never again one whose motion never came; and a silent target that
            // was given up is not held over before it has been heard. What engages the unit is a request.
            let is_possible =
                (to != "Xm" || from == "Xm" || from == "S") && (from, to) != ("Fs", "H") && (from, to) != ("S", "Fq");
            assert_eq!(seen.contains(&(from, to)), is_possible, "{from} -> {to}");
        }
    }
}

#[test]
fn a_held_over_target_is_driven_by_again_without_a_jump_of_the_command() {
    for silence in [0.4, 2.0, 6.0] {
        // Without the envelope, whose limit on jerk is its own.
        let mut road = Road::new(&holdover::Config { envelope: None, ..config() }, 20.0, 22.0);
        road.power_up();
        road.run(1.01);
        road.senses.v2x = false;
        // What the estimate cannot know.
        road.acceleration = -1.0;
        assert_eq!(road.run(silence).command.mode, ModeCode::Holdover);
        road.senses.v2x = true;
        road.commands.clear();
        assert_eq!(road.run(3.0).command.mode, ModeCode::Cooperative);
        let (down, up) = road.steepest();
        // The controller's 5 m/s³, and a step of the wire.
        assert!(down >= -5.2 - 1e-6 && up <= 5.2 + 1e-6, "{silence}: {down} {up}");
    }
}

#[test]
fn a_target_that_was_given_up_is_followed_again_with_a_limited_jerk() {
    let mut config = config();
    config.link.holdover = Duration::from_millis(2_000);
    let mut road = Road::new(&config, 20.0, 22.0);
    road.power_up();
    road.run(1.01);
    road.senses.v2x = false;
    assert_eq!(road.run(6.0).command.mode, ModeCode::Fallback);
    road.senses.v2x = true;
    road.commands.clear();
    assert_eq!(road.run(0.2).command.mode, ModeCode::Fallback);
    assert_eq!(road.run(4.0).command.mode, ModeCode::Cooperative);
    let (down, up) = road.steepest();
    assert!(down >= -5.2 - 1e-6 && up <= 5.2 + 1e-6, "{down} {up}");
}

#[test]
fn taking_over_from_a_driver_who_brakes_hard_is_limited_in_jerk() {
    let mut road = Road::new(&holdover::Config { envelope: None, ..config() }, 20.0, 60.0);
    road.engaged = false;
    road.run(2.0);
    // The driver brakes harder than the controller ever would.
    road.command = -7.0;
    road.rig.tick(road.now);
    let at = road.now;
    let _ = road.rig.ego(at, road.ego.position, road.ego.speed, -7.0, -7.0);
    road.rig.tick(at);
    road.engaged = true;
    let _ = road.rig.request(at, true, road.predecessor);
    road.commands = vec![-7.0];
    road.run(1.0);
    let (_, up) = road.steepest();
    assert!(up <= 5.2 + 1e-6 && road.commands.iter().any(|u| *u > -4.0), "{up}");
}
