//! Runs whose buses are CAN FD: what the vehicles do is what they do over classic CAN, and a log of such a bus replays the same.

use std::path::Path;
use std::process::{Command, Output};

use crate::own_frames::{count, repeats};
use holdover::time::{Duration, Instant};
use holdover_sim::bus::candump::{Content, Entry, LogReader};
use holdover_sim::bus::wire::length;
use serde_json::Value;

fn holdover_sim(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim")).args(arguments).output().unwrap()
}

fn results(arguments: &[&str]) -> Value {
    let output = holdover_sim(&[arguments, &["--json", "--no-report"]].concat());
    assert!(output.status.code().is_some_and(|code| code <= 1), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn scenario(folder: &Path, text: &str) -> String {
    let file = folder.join("scenario.toml");
    std::fs::write(&file, text).unwrap();
    file.display().to_string()
}

/// Twenty seconds of the corridor, with buses of this kind. In this seed one vehicle soon comes up behind another, and at this time gap it
/// follows.
fn corridor(kind: &str) -> String {
    let text = std::fs::read_to_string("scenarios/corridor.toml").unwrap();
    let text = text.replacen("kind = \"classic\"", &format!("kind = \"{kind}\""), 1);
    let text = text.replacen("duration_s = 600.0", "duration_s = 20.0", 1);
    text.replacen("seed = 1 ", "seed = 5 ", 1).replacen("\ntime_gap_s = 1.0 ", "\ntime_gap_s = 3.0 ", 1)
}

/// What a replay of the log with these arguments says, and what the unit said in it.
fn replayed(folder: &Path, scenario: &str, vehicle: &str) -> [String; 2] {
    let log = folder.join("bus.log").display().to_string();
    let run = holdover_sim(&["run", scenario, "--no-report", "--candump", &log, "--candump-vehicle", vehicle]);
    assert!(run.status.code().is_some_and(|code| code <= 1), "{}", String::from_utf8_lossy(&run.stderr));
    let replay = holdover_sim(&["replay", &log, "--scenario", scenario, "--vehicle", vehicle]);
    assert_eq!(replay.status.code(), Some(0), "{}", String::from_utf8_lossy(&replay.stderr));
    let log = std::fs::read_to_string(&log).unwrap();
    assert!(log.lines().all(|line| line.contains("##5")), "every frame is one of CAN FD with a bit rate switch");
    [String::from_utf8(replay.stdout).unwrap(), log]
}

#[test]
fn a_string_drives_as_over_classic_can_but_for_the_first_messages_which_classic_can_loses() {
    let folder = tempfile::tempdir().unwrap();
    for (seed, limits) in [("1", "[envelope]\nengaged = false\n"), ("2", "")] {
        let classic = results(&["run", &scenario(folder.path(), limits), "--seed", seed]);
        let over_fd =
            results(&["run", &scenario(folder.path(), &format!("{limits}[bus]\nkind = \"fd\"\n")), "--seed", seed]);
        let close = |key: &str, within: f64| {
            let [a, b] = [&classic, &over_fd].map(|results| results[key].as_f64().unwrap());
            assert!((a - b).abs() <= within + 1e-3 * a.abs(), "{key}: {a} over classic CAN, {b} over CAN FD");
        };
        // A receiver trusts an identifier from its second frame on. Over classic CAN that takes the first driving parameters and the
        // first horizon; over CAN FD the motion before them has made the identifier known.
        close("max_position_error_m", 0.002);
        close("rms_position_error_m", 0.001);
        close("min_gap_m", 0.01);
        close("collisions", 0.0);
        assert_eq!(classic["verdict"], over_fd["verdict"]);
    }
}

#[test]
fn a_corridor_drives_as_over_classic_can() {
    let folder = tempfile::tempdir().unwrap();
    let classic = results(&["run", &scenario(folder.path(), &corridor("classic")), "--seeds", "1"]);
    let over_fd = results(&["run", &scenario(folder.path(), &corridor("fd")), "--seeds", "1"]);
    let refusals = |results: &Value| results["holdover"]["refusals"].as_f64().unwrap();
    assert!(refusals(&over_fd) < refusals(&classic));
    for side in ["holdover", "perfect_link", "alone", "envelope"] {
        let [a, b] = [&classic[side], &over_fd[side]];
        for key in
            ["served", "unserved", "full_stops", "collisions_on_roads", "association_changes", "bound_violations"]
        {
            assert_eq!(a[key], b[key], "{side}: {key}");
        }
        // A message that is whole some milliseconds earlier may be of use a tick earlier.
        let close = |key: &str, within: f64| {
            let [a, b] = [a, b].map(|side| side.pointer(key).and_then(Value::as_f64).unwrap());
            assert!((a - b).abs() <= within, "{side}{key}: {a} over classic CAN, {b} over CAN FD");
        };
        close("/mean_travel_time_s", 0.02);
        close("/lowest_speed_mps", 0.02);
        close("/position_error/max_m", 0.003);
    }
}

#[test]
fn the_unit_of_a_run_sends_the_same_once_more() {
    let folder = tempfile::tempdir().unwrap();
    let string = scenario(folder.path(), "[bus]\nkind = \"fd\"\n");
    for vehicle in ["0", "2", "4"] {
        let [replayed, log] = replayed(folder.path(), &string, vehicle);
        assert!(count(&log) > 2500 && repeats(&replayed, &log), "vehicle {vehicle}");
    }
    let corridor = scenario(folder.path(), &corridor("fd"));
    let [replayed, log] = replayed(folder.path(), &corridor, "3");
    assert!(count(&log) > 1000 && repeats(&replayed, &log));
}

/// Share of the time in which the bus of the ego is busy, in the whole log of the paper's string: four peers.
fn load(folder: &Path, kind: &str) -> f64 {
    let (scenario, log) = (scenario(folder, &format!("[bus]\nkind = \"{kind}\"\n")), folder.join("bus.log"));
    let run = holdover_sim(&["run", &scenario, "--no-report", "--candump", log.to_str().unwrap()]);
    assert!(run.status.success());
    let frames: Vec<(Instant, Duration)> = LogReader::open(&log)
        .unwrap()
        .map(|entry| match entry.unwrap() {
            Entry { at: Some(at), content: Content::Frame(frame), .. } => (at, length(&frame)),
            other => panic!("{other:?}"),
        })
        .collect();
    let busy: i64 = frames.iter().map(|(_, length)| length.as_micros()).sum();
    let [(first, _), .., (last, _)] = frames[..] else { panic!("no frames") };
    busy as f64 / last.since(first).as_micros() as f64
}

#[test]
fn the_bus_is_busy_for_less_than_half_of_what_it_is_over_classic_can() {
    let folder = tempfile::tempdir().unwrap();
    let [classic, over_fd] = ["classic", "fd"].map(|kind| load(folder.path(), kind));
    // docs/CAN.md has these figures.
    let percent = [classic, over_fd].map(|load| (load * 1000.0).round() / 10.0);
    assert_eq!(percent, [19.1, 6.2]);
}

#[test]
fn a_unit_of_the_other_bus_hears_nothing_and_does_not_fail() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("bus.log").display().to_string();
    let of = |kind: &str| scenario(folder.path(), &format!("duration_s = 3\n[bus]\nkind = \"{kind}\"\n"));
    for (kind, other, cause) in [("fd", None, None), ("classic", Some("--fd"), Some("length"))] {
        let run = holdover_sim(&["run", &of(kind), "--no-report", "--candump", &log]);
        assert!(run.status.success());
        let summary = holdover_sim(&[&["replay", &log, "--json"][..], other.as_slice()].concat());
        assert_eq!(summary.status.code(), Some(0));
        let summary: Value = serde_json::from_slice(&summary.stdout).unwrap();
        assert_eq!(summary["recognised"], serde_json::json!({}), "{summary}");
        let refused: Vec<&String> = summary["refused"].as_object().unwrap().keys().collect();
        assert_eq!(refused, cause.as_slice(), "{summary}");
    }
}

#[test]
fn a_kind_of_bus_that_there_is_not_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let refused = holdover_sim(&["run", &scenario(folder.path(), "[bus]\nkind = \"xl\"\n"), "--no-report"]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(
        refused.status.code() == Some(2) && said.contains("scenario.toml:2") && said.contains("\"classic\" or \"fd\""),
        "{said}"
    );
}
