//! A unit that lives by a log sends what the unit on that bus sent, and is not moved by other people's traffic.

use std::path::Path;
use std::process::{Command, Output};

use crate::own_frames::{count, repeats};

fn holdover_sim(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim")).args(arguments).output().unwrap()
}

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap()
}

fn name(file: &Path) -> &str {
    file.to_str().unwrap()
}

/// The bus of that vehicle in a run, with the run's own times.
fn record(folder: &Path, vehicle: &str, arguments: &[&str]) -> String {
    let log = folder.join("bus.log");
    let ran =
        holdover_sim(&[arguments, &["--no-report", "--candump", name(&log), "--candump-vehicle", vehicle]].concat());
    assert!(ran.status.code().is_some_and(|code| code <= 1), "{}", text(ran.stderr));
    std::fs::read_to_string(log).unwrap()
}

#[test]
fn the_unit_of_every_vehicle_of_a_run_sends_the_same_once_more() {
    let folder = tempfile::tempdir().unwrap();
    for (vehicle, step) in [("0", "0.01"), ("1", "0.05"), ("2", "0.01"), ("3", "0.1"), ("4", "1")] {
        let log = record(folder.path(), vehicle, &["--seed", "3", "--step", step]);
        assert!(count(&log) > 3000);
        let file = folder.path().join("bus.log");
        let replayed = holdover_sim(&["replay", name(&file), "--vehicle", vehicle, "--step", step]);
        assert_eq!(replayed.status.code(), Some(0), "{}", text(replayed.stderr));
        assert!(repeats(&text(replayed.stdout), &log), "vehicle {vehicle} at {step} s");
    }
}

#[test]
fn a_scenario_of_odd_numbers_is_replayed_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = folder.path().join("odd.toml");
    let odd = "duration_s = 8\nperiod_s = 0.007\nstep_s = 0.03\nmessage_rate_hz = 3\nego = 1\n\
               [channel]\ndelay_mean_s = 0.1\ndelay_std_s = 0.2\nloss = 0.2\nduplicate = 0.1\noutages = [[3, 4]]\n\
               applies_to = \"all\"\n\
               [[vehicle]]\nspeed_mps = 12\nlag_s = 0.1\n\
               [[vehicle]]\ngap_m = 20\nspeed_mps = 12\ntime_gap_s = 1.3\nstandstill_m = 3\nlength_m = 7\nlag_s = 0.6\n";
    std::fs::write(&scenario, odd).unwrap();
    for vehicle in ["0", "1"] {
        let log = record(folder.path(), vehicle, &["run", name(&scenario)]);
        let file = folder.path().join("bus.log");
        let replayed = holdover_sim(&["replay", name(&file), "--scenario", name(&scenario), "--vehicle", vehicle]);
        assert!(repeats(&text(replayed.stdout), &log), "vehicle {vehicle}");
    }
    // Another unit on that bus sends other frames.
    let log = record(folder.path(), "1", &["run", name(&scenario)]);
    let replayed = holdover_sim(&["replay", name(&folder.path().join("bus.log")), "--station", "2"]);
    assert!(replayed.status.success() && !repeats(&text(replayed.stdout), &log));
}

#[test]
fn a_bus_on_other_identifiers_is_replayed_with_its_base() {
    let folder = tempfile::tempdir().unwrap();
    let log = record(folder.path(), "2", &[]);
    // The end-to-end protection is over data ids, which do not move with the identifiers.
    let moved = |log: &str, from: u16, to: u16| -> String {
        let moved = |line: &str| {
            let (head, rest) = line.split_once("can0 ").unwrap();
            let id = u16::from_str_radix(&rest[..3], 16).unwrap() - from + to;
            format!("{head}can0 {id:03X}{}\n", &rest[3..])
        };
        log.lines().map(moved).collect()
    };
    let file = folder.path().join("moved.log");
    std::fs::write(&file, moved(&log, 0x480, 0x123)).unwrap();
    for base in ["0x123", "291"] {
        let replayed = holdover_sim(&["replay", name(&file), "--vehicle", "2", "--base-id", base]);
        let back = moved(&text(replayed.stdout), 0x123, 0x480);
        assert!(repeats(&back, &log), "{base}");
    }
}

#[test]
fn foreign_traffic_is_ignored_frame_by_frame_and_changes_no_state() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("foreign.log");
    let mut log = String::new();
    let mut frames = 0;
    // Every standard identifier but the catalogue's, extended ones across it, remote ones, FD and error frames.
    for (number, id) in (0..0x800u32).filter(|id| !(0x480..0x540).contains(id)).enumerate() {
        let at = 46_408.0 + number as f64 * 0.002;
        log += &format!("({at:.6}) can0 {id:03X}#{:016X}\n", u64::from(id).wrapping_mul(0x9E37_79B9_7F4A_7C15));
        log += &format!("({at:.6}) can0 {:08X}#0102030405060708\n", 0x480 + id);
        log += &format!("({at:.6}) can0 {id:03X}#R\n");
        log += &format!("({at:.6}) can0 {id:03X}##1AABB\n");
        log += &format!("({at:.6}) can0 20000004#0001000000000000\n");
        frames += 5;
    }
    std::fs::write(&file, log).unwrap();
    let printed = holdover_sim(&["replay", name(&file), "--json"]);
    let summary: serde_json::Value = serde_json::from_slice(&printed.stdout).unwrap();
    let seconds = f64::from(0x800 - 0xC0 - 1) * 0.002;
    assert_eq!(summary["frames"], frames);
    assert_eq!(summary["ignored"], frames);
    assert_eq!(summary["recognised"], serde_json::json!({}));
    assert_eq!(summary["refused"], serde_json::json!({}));
    assert_eq!(summary["ticks"], (seconds / 0.01).ceil() as u64 + 1);
    assert_eq!(summary["state_changed"], false);
    assert!(summary["timing"]["frames_per_s"].as_f64().unwrap() > 0.0);
    assert_eq!(summary.as_object().unwrap().len(), 7);
    let text = text(holdover_sim(&["replay", name(&file), "--summary"]).stdout);
    assert!(text.contains("as if it had heard nothing"), "{text}");
}

#[test]
fn every_frame_is_recognised_refused_or_ignored() {
    let folder = tempfile::tempdir().unwrap();
    let log = record(folder.path(), "3", &["--seed", "9"]);
    // A tenth of the lines twice, and every hundredth with a digit of its data changed.
    let mut damaged = String::new();
    for (number, line) in log.lines().enumerate() {
        let (head, last) = line.split_at(line.len() - 1);
        let other = if last == "0" { "1" } else { "0" };
        damaged += &format!("{head}{}\n", if number % 100 == 50 { other } else { last });
        if number % 10 == 3 {
            damaged += &format!("{line}\n");
        }
    }
    let file = folder.path().join("damaged.log");
    std::fs::write(&file, &damaged).unwrap();
    let printed = holdover_sim(&["replay", name(&file), "--vehicle", "3", "--json"]);
    let summary: serde_json::Value = serde_json::from_slice(&printed.stdout).unwrap();
    let sum = |of: &str| summary[of].as_object().unwrap().values().map(|count| count.as_u64().unwrap()).sum::<u64>();
    let frames = damaged.lines().count() as u64;
    assert_eq!(summary["frames"], frames);
    assert_eq!(sum("recognised") + sum("refused") + summary["ignored"].as_u64().unwrap(), frames);
    assert!(summary["ignored"].as_u64().unwrap() >= count(&damaged) as u64);
    for cause in ["checksum", "repeated", "not_yet_trusted"] {
        assert!(summary["refused"][cause].as_u64().unwrap() > 0, "{summary}");
    }
    for message in ["EgoMotionA", "EgoMotionB", "DriverRequest", "TimeSync", "TimeFollowUp", "Peer0MotionA"] {
        assert!(summary["recognised"][message].as_u64().unwrap() > 0, "{summary}");
    }
    assert_eq!(summary["state_changed"], true);
}
