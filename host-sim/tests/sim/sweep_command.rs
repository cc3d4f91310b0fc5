//! What `sweep` prints and writes, and how it ends.

use std::process::{Command, Output};

use holdover_sim::measure::metrics::{max_abs, percentile_abs};
use serde_json::Value;

fn sweep(arguments: &str, threads: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
        .env("RAYON_NUM_THREADS", threads)
        .arg("sweep")
        .args(arguments.split_whitespace())
        .output()
        .unwrap()
}

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap()
}

/// The rows of a sweep and what stood under `timing` in them.
fn rows(output: Output) -> (Vec<Value>, Vec<Value>) {
    assert_eq!(output.status.code(), Some(0), "{}", text(output.stderr));
    let mut results: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(results.as_object().unwrap().len(), 1);
    let mut rows: Vec<Value> = serde_json::from_value(results["rows"].take()).unwrap();
    let timing = rows.iter_mut().map(|row| row.as_object_mut().unwrap().remove("timing").unwrap()).collect();
    (rows, timing)
}

#[test]
fn each_step_is_a_row_with_both_methods_and_the_cost() {
    let (rows, timing) = rows(sweep("--seeds 2 --steps 0.5,0.02 --json --no-report", "2"));
    let steps: Vec<f64> = rows.iter().map(|row| row["step_s"].as_f64().unwrap()).collect();
    assert_eq!(steps, [0.5, 0.02]);
    for row in &rows {
        let keys: Vec<&String> = row.as_object().unwrap().keys().collect();
        assert_eq!(keys, ["less_rms", "ours", "paper", "seeds", "step_s"]);
        assert_eq!(row["seeds"], 2);
        for method in ["ours", "paper"] {
            let figure = |name: &str| row[method][name].as_f64().unwrap();
            let (max, p99) = (figure("max_position_error_m"), figure("p99_position_error_m"));
            assert!(0.0 < p99 && p99 <= max && max < 20.0, "{row}");
            assert_eq!(row[method].as_object().unwrap().len(), 4);
        }
    }
    for timing in &timing {
        let (ns, rate) = (timing["ns_per_tick"].as_f64().unwrap(), timing["updates_per_s"].as_f64().unwrap());
        assert!((ns * rate / 1e9 - 1.0).abs() < 1e-12 && ns > 10.0 && ns < 1e9, "{timing}");
        assert_eq!(timing.as_object().unwrap().len(), 2);
    }
}

#[test]
fn the_figures_are_those_of_the_runs_of_these_seeds_together() {
    let (rows, _) = rows(sweep("--seed 7 --seeds 3 --steps 0.1 --json --no-report", "2"));
    let folder = tempfile::tempdir().unwrap();
    let (mut ours, mut paper) = (Vec::new(), Vec::new());
    for seed in ["7", "8", "9"] {
        let trace = folder.path().join("ticks.csv");
        let run = Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
            .args(["--step", "0.1", "--seed", seed, "--no-report", "--trace", trace.to_str().unwrap()])
            .args(["--envelope=off", "--range-sensors", "off"])
            .output()
            .unwrap();
        assert!(run.status.success());
        for line in std::fs::read_to_string(&trace).unwrap().lines().skip(1) {
            let fields: Vec<Option<f64>> = line.split(',').map(|field| field.parse().ok()).collect();
            if fields[0].unwrap() >= 1.0 - 1e-9 {
                ours.extend(fields[4].map(|estimate| estimate - fields[1].unwrap()));
                paper.extend(fields[9].map(|estimate| estimate - fields[1].unwrap()));
            }
        }
    }
    for (method, errors) in [("ours", ours), ("paper", paper)] {
        let expected =
            [("max_position_error_m", max_abs(&errors)), ("p99_position_error_m", percentile_abs(&errors, 99.0))];
        for (figure, expected) in expected {
            // The trace has six decimals.
            assert!((rows[0][method][figure].as_f64().unwrap() - expected.unwrap()).abs() < 2e-6, "{method} {figure}");
        }
    }
}

#[test]
fn the_number_of_threads_changes_nothing_but_the_timing() {
    let of_threads = |threads| rows(sweep("--seeds 6 --steps 0.05,1 --json --no-report", threads)).0;
    assert_eq!(of_threads("1"), of_threads("2"));
    assert_eq!(of_threads("1"), of_threads("5"));
}

#[test]
fn the_table_names_the_steps_and_the_papers_own_figures() {
    let folder = tempfile::tempdir().unwrap();
    let output = sweep(&format!("--seeds 1 --steps 0.2,1 --out {}/report", folder.path().display()), "2");
    let (stdout, stderr) = (text(output.stdout), text(output.stderr));
    for wanted in ["seeds 1 to 1\n", "\n0.2 ", "\n1 ", "0.2 m at 0.01 s, 5.8 m at 1 s", "verdict: passed\n"] {
        assert!(stdout.contains(wanted), "{wanted}: {stdout}");
    }
    assert_eq!(stderr, format!("report: {}/report/index.html\n", folder.path().display()));
    let page = std::fs::read_to_string(folder.path().join("report/index.html")).unwrap();
    assert!(page.contains("holdover-sim sweep --seed 1 --seeds 1 --steps 0.2,1"));
}

#[test]
fn a_failed_run_fails_the_sweep_and_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = folder.path().join("crash.toml");
    let crash =
        "seed = 4\nduration_s = 5\nego = 1\n[[vehicle]]\nspeed_mps = 2\n[[vehicle]]\ngap_m = 2\nspeed_mps = 20\n";
    std::fs::write(&scenario, crash).unwrap();
    let arguments = format!("{} --seeds 2 --steps 0.1,0.5 --no-report", scenario.display());
    let output = sweep(&arguments, "2");
    assert_eq!(output.status.code(), Some(1), "{}", text(output.stderr));
    let stdout = text(output.stdout);
    let verdict = "verdict: FAILED: 4 of 4 runs, the first at a step of 0.1 s with seed 4: 1 collision(s)";
    assert!(stdout.contains(verdict), "{stdout}");
    // As JSON, the verdict goes to stderr and the value is whole.
    let output = sweep(&format!("{arguments} --json"), "2");
    assert_eq!(output.status.code(), Some(1));
    assert!(text(output.stderr).contains("FAILED: 4 of 4 runs"));
    assert!(serde_json::from_slice::<Value>(&output.stdout).is_ok());
}

#[test]
fn input_that_cannot_be_is_refused_with_its_cause_and_remedy() {
    let cases = [
        ("--steps 0.1,2", "--steps: `step_s` is 2; give seconds from 0.001 to 1"),
        ("--steps 0", "--steps: `step_s` is 0; give seconds from 0.001 to 1"),
        ("--steps nan", "--steps: `step_s` is NaN; give seconds from 0.001 to 1"),
        ("--seeds 0", "--seeds: is 0; give a number from 1 to 10000"),
        ("--seeds 10001", "--seeds: is 10001; give a number from 1 to 10000"),
        (
            "--seed 18446744073709551615 --seeds 2",
            "--seed: from 18446744073709551615 on there are fewer than 2 seeds: the last one is 18446744073709551615; give a smaller first seed",
        ),
        ("no.toml", "no.toml: cannot be read (No such file or directory); check the path"),
        ("--out Cargo.toml", "--out: \"Cargo.toml\" is a file; name a folder for the report, or give --no-report"),
    ];
    for (arguments, message) in cases {
        let output = sweep(arguments, "1");
        assert_eq!(text(output.stderr), format!("error: {message}\n"), "{arguments}");
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments}");
    }
    for arguments in ["--steps x", "--steps", "--seeds -1", "--seeds 1.5"] {
        assert_eq!(sweep(arguments, "1").status.code(), Some(2), "{arguments}");
    }
}

#[test]
fn help_gives_examples_and_says_what_the_figures_are() {
    let help = text(sweep("--help", "1").stdout);
    for wanted in ["Examples:", "Figures:", "Cost", "--steps", "--seeds", "Exit codes:"] {
        assert!(help.contains(wanted), "{wanted}");
    }
}
