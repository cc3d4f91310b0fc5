//! `run --trajectories`: what stands in the file are the figures of the run.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

use holdover_sim::input::scenario::Overrides;
use holdover_sim::measure::trajectories::Wanted;
use holdover_sim::roads::conditions::Conditions;
use holdover_sim::roads::experiment::Experiment;
use holdover_sim::roads::figures::Side;
use holdover_sim::roads::read;
use holdover_sim::roads::trajectories::Records;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim")).arg("run").args(arguments).output().unwrap()
}

type Row = BTreeMap<String, String>;

fn rows(file: &Path) -> Vec<Row> {
    csv::Reader::from_path(file).unwrap().deserialize().map(Result::unwrap).collect()
}

fn number(row: &Row, column: &str) -> Option<f64> {
    row[column].parse().ok()
}

fn error_m(row: &Row) -> Option<f64> {
    Some(number(row, "estimated_position_m")? - number(row, "target_position_m")?)
}

#[test]
fn of_a_string_the_largest_error_in_the_file_is_the_one_that_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let (file, trace) = (folder.path().join("all.csv"), folder.path().join("trace.csv"));
    let arguments = ["--set", "duration_s=20", "--no-report", "--json", "--trajectories-every", "0.01"];
    let files = ["--trajectories", file.to_str().unwrap(), "--trace", trace.to_str().unwrap()];
    let said: serde_json::Value = serde_json::from_slice(&run(&[&arguments[..], &files[..]].concat()).stdout).unwrap();
    let of_follower: Vec<Row> = rows(&file).into_iter().filter(|row| row["vehicle"] == "3").collect();
    // The first second is not counted.
    let counted = of_follower.iter().filter(|row| number(row, "t_s").unwrap() >= 1.0 - 1e-9);
    let largest = counted.filter_map(error_m).map(f64::abs).fold(0.0, f64::max);
    assert!((largest - said["max_position_error_m"].as_f64().unwrap()).abs() < 2e-6, "{largest} {said}");
    // The trace has the same follower.
    let traced = rows(&trace);
    assert_eq!(traced.len(), of_follower.len());
    for (row, traced) in of_follower.iter().zip(&traced) {
        for (column, its) in [("target_speed_mps", "true_speed_mps"), ("highest_position_m", "highest_position_m")] {
            assert_eq!(number(row, column), number(traced, its), "{row:?} {traced:?}");
        }
    }
}

#[test]
fn of_a_corridor_the_largest_error_in_the_file_is_the_one_that_is_reported() {
    let overrides = Overrides { set: vec!["duration_s=40".into()], ..Overrides::default() };
    let text = include_str!("../../scenarios/corridor.toml");
    let experiment = Experiment::new(read::corridor(Path::new("corridor.toml"), text, &overrides).unwrap());
    let folder = tempfile::tempdir().unwrap();
    let wanted = Wanted::read(folder.path().join("all.csv"), experiment.corridor.period_s).unwrap();
    let mut records = Records::of(&wanted, &experiment.network).unwrap();
    let conditions = Conditions::of(&experiment.corridor);
    let outcome = experiment.run_before(1, conditions, None, &mut [&mut records]).unwrap();
    records.finish().unwrap();
    let said = serde_json::to_value(Side::of(&[&outcome])).unwrap();
    let rows = rows(&wanted.file);
    let largest = rows.iter().filter_map(error_m).map(f64::abs).fold(0.0, f64::max);
    let classes = ["position_error", "position_error_after_change"];
    let reported = classes.iter().filter_map(|class| said[*class]["max_m"].as_f64()).fold(0.0, f64::max);
    assert!((largest - reported).abs() < 2e-6, "{largest} {said}");
    // From tick to tick a vehicle gets as far over ground as its speed says.
    let mut last: BTreeMap<&str, (f64, f64)> = BTreeMap::new();
    for row in &rows {
        let place = (number(row, "x_m").unwrap(), number(row, "y_m").unwrap());
        if let Some(before) = last.insert(&row["vehicle"], place) {
            let way = (place.0 - before.0).hypot(place.1 - before.1);
            let drove = number(row, "speed_mps").unwrap() * experiment.corridor.period_s;
            assert!((way - drove).abs() < 0.03, "{way} {row:?}");
        }
    }
    assert!(last.len() >= 10, "{}", last.len());
}

#[test]
fn what_cannot_be_written_is_refused_before_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).display().to_string();
    for (arguments, said) in [
        (vec!["--trajectories", "a.parquet"], "--trajectories: a.parquet is of no kind that can be written; "),
        (vec!["--trajectories", "/nope/a.csv"], "--trajectories: "),
        (vec!["--trajectories", &place("a.csv"), "--trajectories-every", "0"], "--trajectories-every: is 0; "),
        (vec!["--trajectories", &place("a.csv"), "--trace", &place("a.csv")], "--"),
        (
            vec!["corridor", "--demand", "30", "--trajectories", &place("a.csv")],
            "--trajectories: is for the scenario's own traffic",
        ),
    ] {
        let output = run(&arguments);
        let line = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?} {line}");
        assert!(line.starts_with(&format!("error: {said}")) && line.lines().count() == 1, "{line}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
