//! What `run` says of the bound and of the envelope: JSON, trace and report.

use std::collections::HashMap;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim")).arg("run").args(arguments).output().unwrap()
}

fn json(arguments: &[&str]) -> Value {
    let output = run(&[arguments, &["--json", "--no-report"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The numbers of a tick by their column.
type Tick = HashMap<String, f64>;

/// The ticks of a run's trace.
fn trace(arguments: &[&str]) -> Vec<Tick> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("ticks.csv");
    assert!(run(&[arguments, &["--no-report", "--trace", file.to_str().unwrap()]].concat()).status.success());
    let text = std::fs::read_to_string(&file).unwrap();
    let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let tick = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        assert_eq!(header.len(), fields.len(), "{line}");
        let numbers =
            header.iter().zip(fields).filter_map(|(name, field)| Some((name.to_string(), field.parse().ok()?)));
        numbers.collect()
    };
    text.lines().skip(1).map(tick).collect()
}

/// A scenario file with that text.
fn scenario(folder: &Path, text: &str) -> String {
    let file = folder.join("s.toml");
    std::fs::write(&file, text).unwrap();
    file.display().to_string()
}

#[test]
fn disengaged_the_envelope_limits_nothing_and_the_bound_is_told() {
    let results = json(&["--envelope=off"]);
    assert_eq!(results["bound"]["violations"], 0);
    assert_eq!(results["bound"]["beyond_limits"], 0);
    let width_m = results["bound"]["median_width_m"].as_f64().unwrap();
    assert!((0.1..0.5).contains(&width_m), "{width_m}");
    assert_eq!(results["envelope"], serde_json::json!({"engaged": false, "limited_share": 0.0}));
}

#[test]
fn without_a_range_sensor_it_stops_in_a_long_silence_and_that_is_no_failure() {
    let results = json(&["--range-sensors", "off"]);
    assert_eq!(results["envelope"]["engaged"], true);
    assert!(results["envelope"]["limited_share"].as_f64().unwrap() > 0.05, "{results}");
    assert!(results["full_stops"].as_u64().unwrap() > 0, "{results}");
    assert_eq!((&results["collisions"], &results["bound"]["violations"]), (&Value::from(0), &Value::from(0)));
}

#[test]
fn without_silence_and_delay_it_has_nothing_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let clean = "[channel]\nloss = 0\noutages = []\ndelay_mean_s = 0\ndelay_std_s = 0\n";
    let results = json(&[&scenario(folder.path(), clean)]);
    assert_eq!(results["envelope"]["limited_share"], 0.0, "{results}");
}

#[test]
fn the_trace_holds_the_truth_between_the_ends_and_marks_what_was_limited() {
    let ticks = trace(&["--range-sensors", "off"]);
    let (mut known, mut limited) = (0, 0);
    for tick in &ticks {
        limited += usize::from(tick["limited"] == 1.0);
        if !tick.contains_key("lowest_position_m") {
            continue;
        }
        known += 1;
        for quantity in ["position_m", "speed_mps"] {
            // The trace has six decimals.
            let (low, high) = (tick[&format!("lowest_{quantity}")] - 1e-6, tick[&format!("highest_{quantity}")] + 1e-6);
            assert!((low..=high).contains(&tick[&format!("true_{quantity}")]), "{tick:?}");
        }
    }
    assert!(known * 100 > ticks.len() * 98, "{known} of {}", ticks.len());
    assert!((50..1000).contains(&limited), "{limited}");
    assert!(trace(&["--envelope=off"]).iter().all(|tick| tick["limited"] == 0.0));
}

#[test]
fn a_range_sensor_keeps_the_bound_narrow_through_a_silence() {
    let folder = tempfile::tempdir().unwrap();
    let with = |sensor: &str| {
        let plain = "[[vehicle]]\n";
        let text = plain.repeat(3) + "[[vehicle]]\n" + sensor + plain + "[envelope]\nengaged = false\n";
        let ticks = trace(&[&scenario(folder.path(), &text)]);
        let silent = ticks.iter().filter(|tick| (6.0..7.9).contains(&tick["t_s"]));
        silent.map(|tick| tick["highest_position_m"] - tick["lowest_position_m"]).fold(0.0, f64::max)
    };
    let (without, with) = (with("range_sensor = false\n"), with(""));
    assert!(without > 20.0 && with < 1.8, "{without} {with}");
}

#[test]
fn the_report_shows_the_bound_and_what_the_envelope_limited() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().display().to_string();
    let page = |arguments: &[&str]| {
        assert!(run(&[arguments, &["--out", &out]].concat()).status.success());
        std::fs::read_to_string(folder.path().join("index.html")).unwrap()
    };
    let engaged = page(&["--range-sensors", "off", "--seed", "3"]);
    assert!(engaged.contains("holdover-sim run --seed 3 --range-sensors off"));
    assert!(engaged.contains("is inside at every one of") && engaged.contains("The envelope limits that for"));
    assert!(page(&["--envelope=off"]).contains("The envelope is not engaged."));
}

#[test]
fn a_recorded_leader_that_does_the_impossible_is_excused_and_said_so() {
    let folder = tempfile::tempdir().unwrap();
    // From 10 m/s to 4 m/s within a twentieth of a second, at 15 s.
    let (mut text, mut position_m) = ("t_s,position_m,speed_mps\n".to_owned(), 0.0);
    for row in 0..600 {
        let speed_mps = if row < 300 { 10.0 } else { 4.0 };
        position_m += 0.05 * speed_mps;
        text += &format!("{},{position_m},{speed_mps}\n", f64::from(row) * 0.05);
    }
    let file = folder.path().join("drive.csv");
    std::fs::write(&file, text).unwrap();
    let results = json(&["--leader-motion", file.to_str().unwrap()]);
    assert_eq!(results["bound"]["violations"], 0, "{results}");
    assert!(results["bound"]["beyond_limits"].as_u64().unwrap() > 0, "{results}");
    let out = folder.path().join("report");
    run(&["--leader-motion", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert!(std::fs::read_to_string(out.join("index.html")).unwrap().contains("as no road vehicle can"));
}
