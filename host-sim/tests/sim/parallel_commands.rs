//! Every command that works on all cores, as a process: whatever the number of threads and files, it ends well, and with the
//! same results. Each thread has less stack than a unit takes, so that a unit on a stack is seen wherever it lies.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

const THREADS: [usize; 3] = [4, 8, 32];
/// A sixteenth of what a thread has otherwise, and twice what the commands need, optimised.
const STACK_BYTES: usize = 128 << 10;

/// A command that works on `threads` threads, and how it ends.
fn run(folder: &Path, arguments: &str, threads: usize) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_holdover-sim"));
    command.current_dir(folder).args(arguments.split_whitespace());
    command.env("RAYON_NUM_THREADS", threads.to_string()).env("RUST_MIN_STACK", STACK_BYTES.to_string());
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments} on {threads} threads: {} {said}", output.status);
    output
}

/// What it prints but for what the wall clock says.
fn results(folder: &Path, arguments: &str, threads: usize) -> Value {
    let mut results = serde_json::from_slice(&run(folder, arguments, threads).stdout).unwrap();
    drop_timing(&mut results);
    results
}

fn drop_timing(value: &mut Value) {
    match value {
        Value::Object(object) => {
            object.remove("timing");
            object.values_mut().for_each(drop_timing);
        }
        Value::Array(values) => values.iter_mut().for_each(drop_timing),
        _ => {}
    }
}

/// Its results are the same on any number of threads.
fn is_the_same_on_all(folder: &Path, arguments: &str) {
    let arguments = format!("{arguments} --json --no-report");
    let on_one = results(folder, &arguments, 1);
    for threads in THREADS {
        assert!(results(folder, &arguments, threads) == on_one, "{arguments} on {threads} threads is another result");
    }
}

/// A folder with a scenario of 2 s, a corridor with arrivals of 10 s, a link, and 24 drives of 14 s: more silences than are
/// done together.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    for (name, long, short) in [("paper.toml", "duration_s = 20.0", 2), ("corridor.toml", "duration_s = 600.0", 10)] {
        let text = std::fs::read_to_string(format!("scenarios/{name}")).unwrap();
        assert!(text.contains(long), "{name}");
        let text = text.replacen(long, &format!("duration_s = {short}.0"), 1);
        // In this seed of the corridor one vehicle soon comes up behind another, and at this time gap it follows.
        write(
            name,
            text.replacen("seed = 1 ", "seed = 5 ", 1).replacen("\ntime_gap_s = 1.0 ", "\ntime_gap_s = 3.0 ", 1),
        );
    }
    for drive in 0..24 {
        let row = |n: u32| format!("{},{},{}\n", f64::from(n) / 10.0, f64::from(n * (drive + 1)) / 10.0, drive + 1);
        write(&format!("{drive}.csv"), format!("t_s,position_m,speed_mps\n{}", (0..=140).map(row).collect::<String>()));
    }
    let row = |n: u32| format!("{},0.02\n", f64::from(n) / 10.0);
    write("link.csv", format!("t_s,delay_s\n{}", (0..=140).map(row).collect::<String>()));
    folder
}

fn drives(count: usize) -> String {
    (0..count).map(|drive| format!(" {drive}.csv")).collect()
}

#[test]
fn evaluate_in_silences_is_the_same_on_any_number_of_threads() {
    let folder = folder();
    for count in [1, 2, 3, 9, 24] {
        let arguments = format!("evaluate --motion{} --outage 0.1,0.5 --step 0.05", drives(count));
        is_the_same_on_all(folder.path(), &arguments);
    }
}

#[test]
fn evaluate_over_a_link_is_the_same_on_any_number_of_threads() {
    let folder = folder();
    for count in [1, 2, 3, 9, 24] {
        let arguments = format!("evaluate --motion{} --channel link.csv --step 0.05", drives(count));
        is_the_same_on_all(folder.path(), &arguments);
    }
}

#[test]
fn sweep_is_the_same_on_any_number_of_threads() {
    is_the_same_on_all(folder().path(), "sweep paper.toml --seeds 24 --steps 0.1,1");
}

#[test]
fn string_is_the_same_on_any_number_of_threads() {
    is_the_same_on_all(folder().path(), "string --delays 0 --losses 0.2 --step-only --seeds 2");
}

#[test]
fn motions_is_the_same_on_any_number_of_threads() {
    is_the_same_on_all(folder().path(), "motions --silences 3");
}

#[test]
fn envelope_cost_is_the_same_on_any_number_of_threads() {
    is_the_same_on_all(folder().path(), "envelope-cost paper.toml --silences 1 --seeds 2");
}

#[test]
fn braking_is_the_same_on_any_number_of_threads() {
    is_the_same_on_all(folder().path(), "braking --braking 8 --seeds 2");
}

#[test]
fn gains_is_the_same_on_any_number_of_threads() {
    is_the_same_on_all(folder().path(), "gains");
}

#[test]
fn a_corridor_with_many_seeds_is_the_same_on_any_number_of_threads() {
    is_the_same_on_all(folder().path(), "run corridor.toml --seeds 2");
}

/// The steps of the figures are done on all cores, and the simulation's own speed is measured on threads of its own.
#[test]
fn a_corridor_with_a_report_and_its_own_speed_passes_on_eight_threads() {
    run(folder().path(), "run corridor.toml --vehicles 12 --out report", 8);
}
