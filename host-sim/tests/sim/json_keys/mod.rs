//! `--json` of every command: its keys are those that `docs/JSON.md` tells, no more and no less, and outside `timing` the same input is
//! the same bytes on any number of threads.

mod documented;

use std::path::Path;
use std::process::Command;

use documented::{Documents, differences};
use holdover::time::Duration;
use holdover_sim::commands::hil::judge::judge;
use holdover_sim::commands::hil::lock_step;
use holdover_sim::commands::hil::session::{self, Setup};
use holdover_sim::commands::hil::virtual_bus::{Behaviour, bench};
use holdover_sim::input::scenario::{Overrides, Scenario};
use holdover_sim::measure::figures::Collision;
use holdover_sim::sim::world::{self, MOST_TICKS};
use serde_json::Value;

fn run(folder: &Path, arguments: &str, threads: &str) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
        .env("RAYON_NUM_THREADS", threads)
        .current_dir(folder)
        .args(arguments.split_whitespace())
        .arg("--json")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{arguments}: {said}");
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{arguments}: {error}\n{said}"))
}

/// What is left without wall-clock figures, as bytes.
fn timeless(value: &Value) -> String {
    fn strip(value: &mut Value) {
        match value {
            Value::Object(members) => {
                members.remove("timing");
                members.values_mut().for_each(strip);
            }
            Value::Array(items) => items.iter_mut().for_each(strip),
            _ => {}
        }
    }
    let mut value = value.clone();
    strip(&mut value);
    value.to_string()
}

/// Runs each line twice, and holds what comes against the table under that heading.
fn holds(heading: &str, folder: &Path, lines: &[&str]) {
    let once = |arguments: &&str| {
        let [first, again] = ["1", "3"].map(|threads| run(folder, arguments, threads));
        assert_eq!(timeless(&first), timeless(&again), "{arguments}");
        first
    };
    let values: Vec<Value> = lines.iter().map(once).collect();
    let differences = differences(&Documents::read().keys(heading), &values);
    assert!(differences.is_empty(), "{heading}: {}", differences.join("; "));
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

#[test]
fn the_keys_of_run_on_a_string_are_the_documented_ones() {
    let folder = folder();
    std::fs::write(folder.path().join("short.toml"), "duration_s = 3").unwrap();
    // The leader stops unseen and unheard, so that there is a collision.
    let crash = "duration_s = 14\n[envelope]\nengaged = false\n[leader]\nprogram = [[0, 15.0], [6, 0.0]]\n[channel]\n\
                 outages = [[5, 14]]\napplies_to = \"all\"\n[[vehicle]]\n[[vehicle]]\nrange_sensor = false\n";
    std::fs::write(folder.path().join("crash.toml"), crash).unwrap();
    holds("run", folder.path(), &["run short.toml --no-report", "run crash.toml --no-report"]);
}

#[test]
fn the_keys_of_the_list_are_the_documented_ones() {
    holds("run --list", folder().path(), &["run --list"]);
}

#[test]
fn the_keys_of_the_rows_over_demand_are_the_documented_ones() {
    let folder = folder();
    let text = std::fs::read_to_string("scenarios/corridor.toml").unwrap();
    std::fs::write(folder.path().join("short.toml"), text.replacen("duration_s = 600.0", "duration_s = 10.0", 1))
        .unwrap();
    holds("run corridor --demand", folder.path(), &["run short.toml --no-report --demand 20"]);
}

#[test]
fn the_keys_of_run_on_a_corridor_are_the_documented_ones() {
    let folder = folder();
    let text = std::fs::read_to_string("scenarios/corridor.toml").unwrap();
    let text =
        text.replacen("duration_s = 600.0", "duration_s = 10.0", 1).replacen("after_s = 100.0", "after_s = 0.0", 1);
    // The ego is to come within the ten seconds.
    let text = text.replacen("ego_road = \"2nd Street, northwest\"", "ego_road = \"Harrison Street, southwest\"", 1);
    std::fs::write(folder.path().join("short.toml"), text).unwrap();
    holds("run corridor", folder.path(), &["run short.toml --no-report --picture p.svg --vehicles 1,2"]);
}

#[test]
fn the_keys_of_evaluate_are_the_documented_ones() {
    let folder = folder();
    let drive = |t: u32| format!("{},{},10\n", f64::from(t) / 10.0, t);
    let motion: String = (0..60).map(drive).collect();
    std::fs::write(folder.path().join("drive.csv"), format!("t_s,position_m,speed_mps\n{motion}")).unwrap();
    let link: String = (0..60).map(|t| format!("{},0.05\n", f64::from(t) / 10.0)).collect();
    std::fs::write(folder.path().join("link.csv"), format!("t_s,delay_s\n{link}")).unwrap();
    let lines =
        ["--channel link.csv", "--outage 0.5,1"].map(|how| format!("evaluate --motion drive.csv {how} --no-report"));
    holds("evaluate", folder.path(), &lines.each_ref().map(String::as_str));
}

#[test]
fn the_keys_of_sweep_and_envelope_cost_are_the_documented_ones() {
    let folder = folder();
    std::fs::write(folder.path().join("short.toml"), "duration_s = 5").unwrap();
    holds("sweep", folder.path(), &["sweep short.toml --seeds 2 --steps 0.1,1 --no-report"]);
    holds(
        "envelope-cost",
        folder.path(),
        &["envelope-cost short.toml --seeds 2 --silences 1 --distance 20 --no-report"],
    );
}

#[test]
fn the_keys_of_gains_are_the_documented_ones() {
    holds("gains", folder().path(), &["gains --no-report"]);
}

#[test]
fn the_keys_of_string_are_the_documented_ones() {
    holds("string", folder().path(), &["string --delays 0.1 --losses 0.2 --frequencies 1 --seeds 2 --no-report"]);
}

#[test]
fn the_keys_of_braking_are_the_documented_ones() {
    holds(
        "braking",
        folder().path(),
        &["braking --braking 8 --seeds 1 --no-report", "braking --braking 0.5 --seeds 1 --no-report"],
    );
}

#[test]
fn the_keys_of_motions_are_the_documented_ones() {
    holds("motions", folder().path(), &["motions --silences 1 --no-report"]);
}

#[test]
fn the_keys_of_replay_are_the_documented_ones() {
    let folder = folder();
    std::fs::write(folder.path().join("short.toml"), "duration_s = 2").unwrap();
    run(folder.path(), "run short.toml --no-report --candump good.log", "1");
    // Its checksum is not right.
    std::fs::write(folder.path().join("bad.log"), "(1.000000) can0 484#0102030405060708\n").unwrap();
    holds("replay", folder.path(), &["replay good.log", "replay bad.log"]);
}

#[test]
fn the_keys_of_hil_are_the_documented_ones() {
    let scenario = Scenario::parse(Path::new("hil"), "duration_s = 4", &Overrides::default()).unwrap();
    let config = world::config(&scenario, scenario.ego);
    let faults = vec!["corrupt@1:1".parse().unwrap()];
    let latency_p99_ms = holdover_sim::commands::hil::judge::LATENCY_P99_MS;
    let setup =
        Setup { scenario, config, wait: Duration::from_millis(3000), latency_p99_ms, faults, most_ticks: MOST_TICKS };
    // The device drives well; so a collision is made up.
    let collision = Collision {
        at_s: 1.0,
        vehicle: 2,
        into: 1,
        speed_mps: 5.0,
        into_speed_mps: 0.0,
        believed_gap_m: Some(3.0),
        least_gap_m: Some(1.0),
        age_s: Some(0.5),
        mode: "holdover",
        command_mps2: 0.0,
    };
    let json = |is_in_steps: bool| {
        let (port, mut rig) = bench(Behaviour::good(setup.config, is_in_steps));
        let outcome = if is_in_steps {
            lock_step::run(&setup, port, &mut rig, |_| {})
        } else {
            session::run(&setup, port, &mut rig, |_| {})
        };
        let mut results = judge(&setup, &outcome.unwrap());
        results.scenario.collided.push(collision);
        serde_json::to_value(results).unwrap()
    };
    let values = [json(true), json(false)];
    assert_eq!(timeless(&values[0]), timeless(&json(true)));
    let differences = differences(&Documents::read().keys("hil"), &values);
    assert!(differences.is_empty(), "{}", differences.join("; "));
}
