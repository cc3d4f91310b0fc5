//! In silences: when they begin, which ones count, and the figures that come of it.

use super::bench::{BASELINES, Bench, close, column, number, of, p99, rms};
use serde_json::Value;
use std::process::Command;

/// Speeding up and braking, sampled every 70 ms, so that a message's sample is up to 70 ms old; down to a stop.
fn braking() -> Vec<(f64, f64, f64)> {
    let sample = |n: usize| {
        let t = (n * 70) as f64 / 1000.0;
        let (r, v) = if t < 6.0 { (15.0 * t - 1.25 * t * t, 15.0 - 2.5 * t) } else { (45.0, 0.0) };
        (t, (r * 1000.0_f64).round() / 1000.0, (v * 500.0_f64).round() / 500.0)
    };
    (0..=142).map(sample).collect()
}

/// The errors of holding the speed after silences of one length, computed from the file alone.
fn of_constant_speed(drive: &[(f64, f64, f64)], length_ms: i64) -> Vec<f64> {
    let ms = |t: f64| (t * 1000.0).round() as i64;
    let end = ms(drive[drive.len() - 1].0);
    let mut errors = Vec::new();
    for start in (0..).map(|n| n * 100).take_while(|start| start + length_ms <= end) {
        let (t, r, v) = *drive.iter().rfind(|row| ms(row.0) <= start).unwrap();
        let now = start + length_ms;
        let after = drive.iter().position(|row| ms(row.0) >= now).unwrap();
        let (low, high) = (drive[after.max(1) - 1], drive[after.max(1)]);
        let truth = low.1 + (high.1 - low.1) * (now - ms(low.0)) as f64 / (ms(high.0) - ms(low.0)) as f64;
        errors.push(r + v * (now - ms(t)) as f64 / 1000.0 - truth);
    }
    errors
}

#[test]
fn a_silence_begins_at_every_message_and_counts_where_it_ends_inside_the_recording() {
    let bench = Bench::new();
    let drive = braking();
    bench.drive("m.csv", drive.iter().copied());
    let results = bench.results("--motion m.csv --outage 0.25,1,9.94,3");
    let lengths = [250, 1000, 9940, 3000];
    let held = of(&results, "constant_speed");
    assert_eq!(column(held, "by_outage", "outage_s"), [0.25, 1.0, 9.94, 3.0].map(Value::from));
    let mut all = Vec::new();
    for (class, length_ms) in held["by_outage"].as_array().unwrap().iter().zip(lengths) {
        let errors = of_constant_speed(&drive, length_ms);
        assert_eq!(class["count"], errors.len(), "{length_ms}");
        close(number(class, "rms_position_m"), rms(&errors), 1e-6, "rms");
        close(number(class, "p99_position_m"), p99(&errors), 1e-6, "p99");
        let largest = errors.iter().fold(0.0, |largest: f64, error| largest.max(error.abs()));
        close(number(class, "max_position_m"), largest, 1e-6, "max");
        all.extend(errors);
    }
    close(number(held, "rms_position_m"), rms(&all), 1e-6, "over all lengths");
    assert_eq!(results["ticks"], all.len());
    // 9.94 s long: messages at 0, 0.1, … 9.9 s.
    assert_eq!((&results["messages_sent"], &results["messages_delivered"]), (&100.into(), &100.into()));
    assert_eq!(column(held, "by_outage", "count")[2], 1);
    assert!(results["ours"].get("by_age").is_none());
}

#[test]
fn every_method_has_every_silence() {
    let bench = Bench::new();
    bench.drive("m.csv", braking());
    let results = bench.results("--motion m.csv --outage 0.5,2");
    for method in ["ours"].iter().chain(&BASELINES) {
        assert_eq!(column(of(&results, method), "by_outage", "count"), [95, 80].map(Value::from), "{method}");
    }
}

#[test]
fn a_vehicle_at_constant_speed_is_found_by_all_but_freeze_and_paper() {
    let bench = Bench::new();
    bench.drive("m.csv", (0..=200).map(|n| (n as f64 / 20.0, n as f64 / 2.0, 10.0)));
    let results = bench.results("--motion m.csv --outage 4");
    for method in ["ours", "constant_speed", "constant_acceleration", "singer", "kalman"] {
        assert!(number(of(&results, method), "max_position_m") < 1e-3, "{method}");
    }
    close(number(of(&results, "freeze"), "rms_position_m"), 40.0, 1e-9, "freeze");
    assert!(number(of(&results, "paper"), "rms_position_m") > 1.0);
}

#[test]
fn a_vehicle_that_has_stopped_stays() {
    let bench = Bench::new();
    bench.drive("m.csv", braking());
    bench.results("--motion m.csv --outage 3 --trace t.csv");
    // From 6.5 s on it has stood for half a second, so even the measured acceleration is 0.
    let trace = std::fs::read_to_string(bench.file("t.csv")).unwrap();
    let last: Vec<&str> = trace.lines().last().unwrap().split(',').collect();
    assert_eq!(&last[1..3], ["45.000000", "0.000000"]);
    assert_eq!(last[5], "45.000000");
}

#[test]
fn results_do_not_depend_on_the_step_of_a_silent_peer() {
    let bench = Bench::new();
    bench.drive("m.csv", braking());
    let fine = bench.results("--motion m.csv --outage 0.5,2 --step 0.01");
    for (step, tolerance) in [("0.02", 2e-3), ("0.001", 2e-3), ("0.03", 2e-3), ("0.1", 0.02), ("1", 0.3)] {
        let other = bench.results(&format!("--motion m.csv --outage 0.5,2 --step {step}"));
        let [fine, other] = [&fine, &other].map(|results| number(&results["ours"], "rms_position_m"));
        close(other, fine, tolerance, step);
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let bench = Bench::new();
    bench.drive("a.csv", braking()).drive("b.csv", (0..=200).map(|n| (n as f64 / 20.0, n as f64 / 2.0, 10.0)));
    let run = |threads: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_holdover-sim"));
        command.current_dir(bench.file("")).env("RAYON_NUM_THREADS", threads);
        command.args("evaluate --motion a.csv b.csv --outage 0.5,2 --json --trace t.csv --out r".split(' '));
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(0));
        let mut results: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert!(results["timing"].take()["ticks_per_s"].as_f64().unwrap() > 0.0);
        let files = ["t.csv", "r/index.html"].map(|name| std::fs::read(bench.file(name)).unwrap());
        (results.to_string(), files)
    };
    assert_eq!(run("1"), run("2"));
}
