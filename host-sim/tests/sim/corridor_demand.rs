//! `run corridor --demand`, and vehicles that keep no passes: short runs of the real program against what they are said to be.

use std::path::Path;
use std::process::Command;

use holdover_sim::input::scenario::{Envelope, Overrides};
use holdover_sim::roads::conditions::Conditions;
use holdover_sim::roads::experiment::Experiment;
use holdover_sim::roads::figures::Outcome;
use holdover_sim::roads::read;
use serde_json::Value;

const NOBODY: &str = "without_passes = 0.0 ";

fn text(duration: &str, without: &str) -> String {
    let text = std::fs::read_to_string("scenarios/corridor.toml").unwrap();
    assert!(text.contains("duration_s = 600.0") && text.contains(NOBODY));
    text.replacen("duration_s = 600.0", duration, 1).replacen(NOBODY, without, 1)
}

/// A run with the envelope of the corridor in this text, in which this share of the vehicles keeps no passes, if it is said here.
fn run(text: &str, share: Option<f64>) -> Outcome {
    let corridor = read::corridor(Path::new("c.toml"), text, &Overrides::default()).unwrap();
    let experiment = Experiment::new(corridor);
    let scenario = Conditions::of(&experiment.corridor);
    let envelope = Envelope { engaged: true, ..scenario.envelope };
    let without_passes = share.unwrap_or(scenario.without_passes);
    let outcome = experiment.run(1, Conditions { envelope, without_passes, ..scenario }, None).unwrap();
    assert_eq!((outcome.collisions, outcome.violations, outcome.remains.unserved), ([0, 0], [0, 0], 0), "{share:?}");
    outcome
}

#[test]
fn where_nobody_keeps_passes_vehicles_stop_more_and_where_half_of_them_does_some_stop() {
    let text = text("duration_s = 120.0", NOBODY);
    let stops = [0.0, 0.5, 1.0].map(|share| run(&text, Some(share)).full_stops);
    assert!(stops[0] < stops[1] && stops[0] < stops[2], "{stops:?}");
}

#[test]
fn the_share_of_the_file_is_that_of_the_run() {
    let [short, nobody] = ["duration_s = 40.0", "without_passes = 1.0 "];
    let (by_file, by_hand) = (run(&text(short, nobody), None), run(&text(short, NOBODY), Some(1.0)));
    assert_eq!(by_file, by_hand);
    assert_ne!(by_file, run(&text(short, NOBODY), None));
}

#[test]
fn a_share_beyond_1_is_refused_with_its_line() {
    let text = text("duration_s = 40.0", "without_passes = 1.5 ");
    let error = read::corridor(Path::new("c.toml"), &text, &Overrides::default()).unwrap_err().to_string();
    let line = 1 + text.lines().position(|line| line.starts_with("without_passes")).unwrap();
    assert!(error.contains(&format!("c.toml:{line}: ")) && error.contains("from 0 to 1"), "{error}");
}

#[test]
fn each_demand_is_run_on_every_side_with_a_table_a_page_and_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let (file, report) = (folder.path().join("short.toml"), folder.path().join("report"));
    std::fs::write(&file, text("duration_s = 75.0", NOBODY)).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
        .args(["run", file.to_str().unwrap(), "--demand", "8,16", "--json", "--out", report.to_str().unwrap()])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    // Which run ends last depends on the threads.
    assert!(said.contains("20 of 20 runs done ("), "{said}");
    assert!(said.contains("(16 a minute, 8 slots, with envelope, silences of 12 s, seed 1)"), "{said}");
    let rows: Vec<Value> = serde_json::from_slice(&output.stdout).unwrap();
    let identity = |row: &Value| {
        let switch = |key: &str| if row[key].as_bool().unwrap() { key.to_owned() } else { String::new() };
        let switches = ["perfect_link", "envelope", "passes"].map(switch).join(" ");
        format!("{} {} s {}", row["side"].as_str().unwrap(), row["dark_s"], switches.trim())
    };
    let sides = [
        "holdover 4.0 s ",
        "perfect_link 0.0 s perfect_link",
        "alone 4.0 s ",
        "first_come 4.0 s envelope",
        "envelope 4.0 s envelope passes",
        "envelope_perfect_link 0.0 s perfect_link envelope passes",
        "silence 0.0 s envelope passes",
        "silence 2.0 s envelope passes",
        "silence 8.0 s envelope passes",
        "silence 12.0 s envelope passes",
    ];
    assert_eq!(rows.iter().map(identity).collect::<Vec<_>>(), [sides, sides].concat());
    for (rows, per_min) in rows.chunks(10).zip([8.0, 16.0]) {
        let arrived = |row: &Value| row["served"].as_u64().unwrap() + row["unserved"].as_u64().unwrap();
        for row in rows {
            assert_eq!((row["vehicles_per_min"].as_f64(), row["slots"].as_u64()), (Some(per_min), Some(8)));
            assert!(arrived(row) == arrived(&rows[0]) && row["exits_per_min"].as_f64().is_some(), "{row}");
            assert!((row["capacity"]["following_per_min"].as_f64().unwrap() - 65.05).abs() < 0.01, "{row}");
        }
    }
    let page = std::fs::read_to_string(report.join("index.html")).unwrap();
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    roxmltree::Document::parse_with_options(&page, options).unwrap();
    assert!(!page.contains("<script src"));
    for said in [
        "Figure 1. Mean travel time over demand",
        "Figure 2. Exits a minute over demand",
        "Figure 3. Mean travel time over demand, by the length of silences",
        "first come, first served",
        "What the busiest intersection can serve",
        "bound by headway",
        "--demand 8,16",
    ] {
        assert!(page.contains(said), "{said}");
    }
}
