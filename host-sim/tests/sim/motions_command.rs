//! What `motions` measures, prints and writes.

use std::process::{Command, Output};
use std::sync::LazyLock;

use holdover_sim::commands::motions::motion::TargetMotion;
use holdover_sim::commands::motions::rows::{self, MethodFigures, Outcome, Row};
use holdover_sim::commands::motions::table;
use holdover_sim::input::scenario::SensorShare;
use serde_json::Value;

static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| rows::run(1, 50, SensorShare::NONE, || {}).unwrap());

fn row(motion: TargetMotion) -> &'static Row {
    ROWS.iter().find(|row| row.motion == motion).unwrap()
}

fn method(motion: TargetMotion, name: &str) -> &'static MethodFigures {
    row(motion).methods.iter().find(|method| method.name == name).unwrap()
}

fn motions(arguments: &str, threads: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
        .env("RAYON_NUM_THREADS", threads)
        .arg("motions")
        .args(arguments.split_whitespace())
        .output()
        .unwrap()
}

#[test]
fn every_silence_is_compared_every_10_ms() {
    assert_eq!(ROWS.iter().map(|row| row.motion).collect::<Vec<_>>(), TargetMotion::ALL);
    for row in &*ROWS {
        assert_eq!((row.silences, row.comparisons, row.methods.len()), (50, 20_000, 8), "{}", row.motion);
        assert!(row.methods.iter().all(|method| method.growth.len() == 16));
    }
}

#[test]
fn every_method_is_as_good_as_documented_in_fifty_silences_of_each_motion() {
    // Root of the mean square and largest magnitude of the position error in metres, as documented, in the order of the motions.
    const DOCUMENTED: [(&str, [[f64; 2]; 5]); 8] = [
        ("holdover", [[0.004, 0.011], [0.003, 0.010], [6.72, 20.1], [3.78, 14.4], [12.4, 34.2]]),
        ("freeze", [[22.1, 50.2], [27.8, 58.4], [32.4, 57.8], [29.4, 52.3], [21.5, 34.2]]),
        ("constant_speed", [[2.21, 6.26], [1.27, 5.71], [5.59, 13.6], [3.78, 14.4], [12.4, 34.2]]),
        ("constant_acceleration", [[0.157, 0.639], [0.985, 8.61], [9.54, 32.6], [3.78, 14.4], [12.4, 34.2]]),
        ("singer", [[0.975, 3.25], [0.814, 5.73], [6.29, 18.7], [3.78, 14.4], [12.4, 34.2]]),
        ("kalman", [[0.184, 0.696], [1.43, 13.8], [10.9, 34.5], [3.78, 14.4], [12.4, 34.2]]),
        ("paper", [[0.041, 0.113], [0.908, 1.59], [4.43, 10.3], [3.78, 14.4], [12.4, 34.2]]),
        ("consensus", [[2.21, 6.26], [1.27, 5.71], [5.59, 13.6], [3.78, 14.4], [12.4, 34.2]]),
    ];
    for (name, documented) in DOCUMENTED {
        for (motion, documented) in TargetMotion::ALL.into_iter().zip(documented) {
            let figures = method(motion, name);
            for (figure, documented) in [figures.rms_position_m, figures.max_position_m].into_iter().zip(documented) {
                // Three digits are given, or whole millimetres; half of the last one is what a figure may be off by.
                let rounding = 0.5 * 10f64.powf(documented.log10().floor() - 2.0).max(1e-3);
                assert!(
                    (figure - documented).abs() <= rounding * 1.001,
                    "{motion}, {name}: {figure}, not {documented}"
                );
            }
        }
    }
    for motion in [TargetMotion::FreeAcceleration, TargetMotion::SlotFollowing] {
        assert_eq!(row(motion).standing, Outcome::Wins, "{motion}");
    }
}

#[test]
fn of_a_braking_that_begins_in_the_silence_nobody_knows() {
    // At the last tick of the silence that braking began in first: what it took off the way at the speed before.
    let soft_m = 0.5 * 2.0 * (3.99_f64 - 0.2).powi(2);
    let hard_m = 13.4 * (3.99 - 0.1) - 13.4 * 13.4 / (2.0 * 5.0);
    for (motion, missed_m) in [(TargetMotion::Braking, soft_m), (TargetMotion::HardBraking, hard_m)] {
        assert_eq!(row(motion).standing, Outcome::Draws, "{motion}");
        for name in ["holdover", "constant_speed", "constant_acceleration", "singer", "kalman", "paper", "consensus"] {
            let max_m = method(motion, name).max_position_m;
            // Messages tell positions to 1 mm.
            assert!((max_m - missed_m).abs() < 1e-3, "{motion}, {name}: {max_m} instead of {missed_m}");
        }
    }
}

#[test]
fn the_table_says_where_ours_loses() {
    assert_eq!(row(TargetMotion::Sine).standing, Outcome::Loses);
    let text = table::text(&ROWS);
    let last = text.lines().last().unwrap();
    assert_eq!(last, format!("holdover loses: {}", TargetMotion::Sine));
    assert!(text.contains(&format!("{}: not published; holdover loses", TargetMotion::Sine)));
}

#[test]
fn the_json_is_the_same_on_any_number_of_threads() {
    let outputs = ["1", "3"].map(|threads| motions("--silences 3 --json --no-report", threads));
    assert_eq!(outputs[0].status.code(), Some(0));
    assert_eq!(outputs[0].stdout, outputs[1].stdout);
    let results: Value = serde_json::from_slice(&outputs[0].stdout).unwrap();
    let rows = results["rows"].as_array().unwrap();
    let keys: Vec<&str> = rows.iter().map(|row| row["motion"].as_str().unwrap()).collect();
    assert_eq!(keys, ["free_acceleration", "slot_following", "sine", "braking_2", "braking_5"]);
    let other = motions("--silences 3 --seed 9 --json --no-report", "2");
    assert_ne!(other.stdout, outputs[0].stdout);
}

#[test]
fn the_report_has_a_curve_for_each_motion() {
    let folder = tempfile::tempdir().unwrap();
    let output = motions(&format!("--silences 1 --out {}", folder.path().display()), "2");
    assert_eq!(output.status.code(), Some(0));
    let page = std::fs::read_to_string(folder.path().join("index.html")).unwrap();
    let document = roxmltree::Document::parse_with_options(
        &page,
        roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() },
    );
    let document = document.unwrap();
    assert_eq!(
        document.descendants().filter(|node| node.has_tag_name(("http://www.w3.org/1999/xhtml", "figure"))).count(),
        5
    );
    assert!(page.contains("holdover-sim motions --silences 1 --seed 1"));
}

#[test]
fn impossible_numbers_are_bad_input_with_a_remedy() {
    for (arguments, says) in [("--silences 0", "from 1 to 1000"), ("--seed 18446744073709551615", "smaller first seed")]
    {
        let output = motions(&format!("{arguments} --no-report"), "1");
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.contains(says) && error.trim_end().lines().count() == 1, "{error}");
    }
}

#[test]
fn a_target_that_is_seen_is_not_lost_in_a_silence() {
    let of = |arguments: &str| {
        let output = motions(&format!("--silences 10 --json --no-report {arguments}"), "2");
        assert_eq!(output.status.code(), Some(0));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    let rms = |results: &Value, row: usize, method: usize| {
        results["rows"][row]["methods"][method]["rms_position_m"].as_f64().unwrap()
    };
    let (unseen, seen) = (of(""), of("--range-sensors on"));
    assert_eq!((unseen["range_sensor_share"].as_f64(), seen["range_sensor_share"].as_f64()), (Some(0.0), Some(1.0)));
    for row in 0..5 {
        // A view errs by up to 0.25 m.
        assert!(rms(&seen, row, 0) < 0.25, "{}", seen["rows"][row]["motion"]);
        // The others hear what they heard; only, views take time on the bus, so that it comes a little later.
        for method in 1..8 {
            let ratio = rms(&seen, row, method) / rms(&unseen, row, method);
            assert!((0.95..1.05).contains(&ratio), "{} of {}: {ratio}", method, seen["rows"][row]["motion"]);
        }
    }
}
