//! What `braking` prints and writes, and how it ends.

use std::process::{Command, Output};

use serde_json::Value;

fn braking(arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim")).arg("braking").args(arguments.split_whitespace()).output().unwrap()
}

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap()
}

fn rows(arguments: &str) -> Vec<Value> {
    let output = braking(&format!("{arguments} --json --no-report"));
    assert_eq!(output.status.code(), Some(0), "{}", text(output.stderr));
    let mut results: Value = serde_json::from_slice(&output.stdout).unwrap();
    serde_json::from_value(results["rows"].take()).unwrap()
}

fn number(row: &Value, side: &str, figure: &str) -> f64 {
    row[side][figure].as_f64().unwrap_or_else(|| panic!("{side}.{figure} of {row}"))
}

#[test]
fn at_six_tenths_of_a_second_the_envelope_keeps_cars_vans_and_buses_apart_and_the_law_alone_does_not() {
    let rows = rows("--time-gaps 0.6 --braking 2,8 --seeds 3");
    let [gently, hard] = &rows[..] else { panic!("{rows:?}") };
    for row in [gently, hard] {
        assert_eq!((number(row, "on", "collisions"), number(row, "on", "bound_violations")), (0.0, 0.0));
        assert!(number(row, "on", "min_gap_m") >= 0.5, "less than the envelope's margin: {row}");
    }
    // The law brakes at 4 m/s² at most: enough for a leader that brakes gently, too little for one that brakes at 8 m/s².
    assert_eq!(number(gently, "off", "collisions"), 0.0);
    assert!(number(hard, "off", "collisions") > 0.0 && hard["off"]["min_gap_m"].is_null());
    assert!(number(hard, "off", "hardest_braking_mps2") < 4.1 && number(hard, "on", "hardest_braking_mps2") > 4.1);
}

#[test]
fn the_leader_brakes_as_it_was_told_to() {
    for row in &rows("--braking 2,5,8 --seeds 1") {
        let braking = row["braking_mps2"].as_f64().unwrap();
        assert!((number(row, "leader", "hardest_braking_mps2") - braking).abs() < 1e-9, "{row}");
        // 25 m/s³, as far as that goes in a tenth of a second.
        let jerk = (braking / 0.1).min(25.0);
        assert!((number(row, "leader", "largest_jerk_mps3") - jerk).abs() < 0.5, "{row}");
    }
}

#[test]
fn the_report_has_the_command_and_both_sides() {
    let folder = tempfile::tempdir().unwrap();
    let output = braking(&format!("--seeds 1 --braking 5 --out {}/report", folder.path().display()));
    assert_eq!(output.status.code(), Some(0), "{}", text(output.stderr));
    let page = std::fs::read_to_string(folder.path().join("report/index.html")).unwrap();
    assert!(page.contains(
        "holdover-sim braking --braking 5 --time-gaps 0.8 --speed 15 --silence 4 --delay 0.1 --loss 0.1 --range-sensors on \
         --seed 1 --seeds 1"
    ));
    let table = text(output.stdout);
    assert!(table.contains("(leader)") && table.contains("off") && table.contains("verdict: passed"), "{table}");
}

#[test]
fn bad_input_is_refused_with_the_option_and_the_limits() {
    for (arguments, said) in [
        ("--braking 0.4", "--braking: is 0.4; give m/s² from 0.5 to 12"),
        ("--braking 2,NaN", "--braking: is NaN; give m/s² from 0.5 to 12"),
        ("--time-gaps 4", "--time-gaps: is 4; give seconds from 0.1 to 3.995"),
        ("--speed 0", "--speed: is 0; give m/s from 1 to 40"),
        ("--silence 21", "--silence: is 21; give seconds from 0.1 to 20"),
        ("--delay -1", "--delay: is -1; give seconds from 0 to 1"),
        ("--loss 1", "--loss: is 1; give a share from 0 to 0.9"),
        ("--seeds 0", "--seeds: is 0; give a number from 1 to 10000"),
        ("--seed 18446744073709551615 --seeds 2", "--seed: "),
    ] {
        let output = braking(&format!("{arguments} --no-report"));
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments}");
        let said_so = text(output.stderr);
        assert!(
            said_so.starts_with(&format!("error: {said}")) && said_so.lines().count() == 1,
            "{arguments}: {said_so}"
        );
    }
    assert!(text(braking("--help").stdout).contains("Exit codes:"));
}
