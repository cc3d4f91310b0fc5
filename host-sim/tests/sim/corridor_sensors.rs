//! Range sensors in a corridor: runs with and without them, the log of a bus, and what is said of a table that cannot be.

use std::path::Path;
use std::process::Command;

use holdover_sim::input::scenario::{Envelope, Faults, Overrides};
use holdover_sim::roads::conditions::Conditions;
use holdover_sim::roads::experiment::Experiment;
use holdover_sim::roads::figures::Outcome;
use holdover_sim::roads::{Corridor, read};

const NONE: &str = "share = 0.0 ";
const ALL: &str = "share = 1.0 ";

fn text(edits: &[(&str, &str)]) -> String {
    let mut text = std::fs::read_to_string("scenarios/corridor.toml").unwrap();
    for (from, to) in edits {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    text
}

fn corridor(text: &str) -> Corridor {
    read::corridor(Path::new("c.toml"), text, &Overrides::default()).unwrap()
}

/// The figures of a run with arrivals of this time, with a share of range sensors and with the envelope or without.
fn run(duration: &str, share: &str, engaged: bool) -> Outcome {
    let experiment = Experiment::new(corridor(&text(&[("duration_s = 600.0", duration), (ALL, share)])));
    let scenario = Conditions::of(&experiment.corridor);
    let conditions = Conditions { envelope: Envelope { engaged, ..scenario.envelope }, ..scenario };
    let outcome = experiment.run(1, conditions, None).unwrap();
    assert_eq!(
        (outcome.collisions, outcome.violations, outcome.remains.unserved),
        ([0, 0], [0, 0], 0),
        "{share} {engaged}"
    );
    outcome
}

fn mean_s(outcome: &Outcome) -> f64 {
    outcome.travel_times_s.iter().sum::<f64>() / outcome.travel_times_s.len() as f64
}

#[test]
fn with_the_envelope_sensors_save_stops_and_time_and_nobody_is_hurt() {
    let [without, with] = [NONE, ALL].map(|share| run("duration_s = 300.0", share, true));
    assert_eq!((with.travel_times_s.len(), without.travel_times_s.len()), (153, 153));
    assert!(with.full_stops + 10 <= without.full_stops, "{} {}", with.full_stops, without.full_stops);
    assert!(mean_s(&with) < mean_s(&without) - 1.0, "{} {}", mean_s(&with), mean_s(&without));
}

#[test]
fn without_the_envelope_sensors_hold_nobody_up() {
    let [without, with] = [NONE, ALL].map(|share| run("duration_s = 120.0", share, false));
    assert_eq!(with.full_stops, 0);
    assert!((mean_s(&with) - mean_s(&without)).abs() < 0.05, "{} {}", mean_s(&with), mean_s(&without));
    // In a silence the sensor is off by up to 0.25 m, and moves the estimate a little.
    assert!(with.errors[0].max_m().unwrap() < 0.11, "{:?}", with.errors[0].worst);
}

/// The JSON of a run with arrivals of 20 s, without its timing, and the log of the bus of a vehicle that comes up behind another.
fn json(folder: &Path, text: &str) -> (serde_json::Value, String) {
    std::fs::write(folder.join("c.toml"), text.replacen("duration_s = 600.0", "duration_s = 20.0", 1)).unwrap();
    let line = "run c.toml --json --no-report --candump c.log --candump-vehicle 6";
    let output = Command::new(env!("CARGO_BIN_EXE_holdover-sim")).args(line.split(' ')).current_dir(folder).output();
    let mut results: serde_json::Value = serde_json::from_slice(&output.unwrap().stdout).unwrap();
    results.as_object_mut().unwrap().remove("timing");
    (results, std::fs::read_to_string(folder.join("c.log")).unwrap())
}

#[test]
fn with_a_share_of_0_the_other_keys_change_nothing_and_with_sensors_their_views_are_on_the_bus() {
    let folder = tempfile::tempdir().unwrap();
    let (none, log) = json(folder.path(), &text(&[(ALL, NONE)]));
    let other =
        text(&[(ALL, NONE), ("misses = 0.02", "misses = 0.5"), ("ghosts_per_min = 0.0", "ghosts_per_min = 60")]);
    let (mut blind, its_log) = json(folder.path(), &other);
    assert_eq!((blind["sensors"]["misses"].as_f64(), its_log == log), (Some(0.5), true));
    blind["sensors"] = none["sensors"].clone();
    assert_eq!(blind, none);

    let (all, its_log) = json(folder.path(), &text(&[("\nrange_m = 100.0", "\nrange_m = 200")]));
    let vehicles = all["holdover"]["served"].as_u64().unwrap();
    assert_eq!([&none, &all].map(|results| results["sensors"]["vehicles"].as_u64()), [Some(0), Some(vehicles)]);
    // The identifier of `RangeSensor`.
    assert!(!log.contains(" can0 488#") && its_log.contains(" can0 488#"));
}

#[test]
fn the_table_that_comes_with_the_program_is_what_it_is_when_left_out() {
    let minimal = "kind = \"corridor\"\n[[road]]\nname = \"n\"\npoints = [[0.0, 0.0], [0.002, 0.0]]\n\
                   [[intersection]]\nname = \"A\"\nat = [0.001, 0.0]\n";
    let (sensors, shipped) = (corridor(minimal).sensors, corridor(&text(&[])).sensors);
    assert_eq!((sensors, sensors.share, sensors.sensor.sees_up_to_m), (shipped, 1.0, 100.0));
    // A12 and P9: the sensor shows nothing that is not there, and is not blind for longer than a unit remembers.
    let Faults { ghosts_per_min, dropout_s, .. } = sensors.sensor.faults;
    assert!(ghosts_per_min == 0.0 && dropout_s < 1.0);
}

#[test]
fn a_table_that_cannot_be_is_refused_with_file_line_cause_and_remedy() {
    let cases = [
        ("share = 1.5", "c.toml:3: `share` is 1.5; give a share from 0 to 1"),
        ("share = \"all\"", "c.toml:3: `share` is \"all\"; give a share from 0 to 1"),
        ("share = 1\nrange_m = 0", "c.toml:4: `range_m` is 0; give metres from 1 to 250"),
        ("share = 1\nmisses = -0.1", "c.toml:4: `misses` is -0.1; give a share from 0 to 1"),
        ("share = 1\ndropouts_per_min = 61", "c.toml:4: `dropouts_per_min` is 61; give dropouts a minute from 0 to 60"),
        ("share = 1\ndropout_s = 61", "c.toml:4: `dropout_s` is 61; give seconds from 0 to 60"),
        ("share = 1\nghosts_per_min = -1", "c.toml:4: `ghosts_per_min` is -1; give ghosts a minute from 0 to 60"),
        ("share = 1\nrange_accuracy_m = 2", "c.toml:4: `range_accuracy_m` is 2; give metres from 0 to 1.55"),
        ("share = 1\nmiss = 0.1", "c.toml:4: unknown key \"miss\" in [sensors]; write `misses`"),
    ];
    for (keys, said) in cases {
        let text = format!("kind = \"corridor\"\n[sensors]\n{keys}\n");
        let error = read::corridor(Path::new("c.toml"), &text, &Overrides::default()).unwrap_err();
        assert_eq!(error.to_string(), said);
    }
}
