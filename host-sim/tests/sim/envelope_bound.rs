//! Nothing is ever outside what is certain of it: the paper's scenario over many seeds, with models that are right and
//! wrong, with and without the envelope and the range sensor.

use holdover_sim::input::scenario::{Overrides, Scenario};
use holdover_sim::measure::figures::Summary;
use holdover_sim::measure::simulate::simulate;
use holdover_sim::parallel;
use std::path::Path;

/// What is promised of a hundred runs.
const MANY: u64 = 100;
/// Where much else differs from run to run, fewer do.
const SOME: u64 = 25;
/// Keys of followers that hear messages alone, and of units without the envelope.
const NO_SENSOR: &str = "range_sensor = false";
const OFF: &str = "[envelope]\nengaged = false\n";

/// The paper's scenario with these keys in every vehicle but, for what needs one ahead, the leader.
fn paper(of_all: &str, of_followers: &str, rest: &str) -> Scenario {
    let vehicle = |index: usize| {
        let of_followers = if index > 0 { of_followers } else { "" };
        format!("[[vehicle]]\n{of_all}\n{of_followers}\n")
    };
    let text = (0..5).map(vehicle).collect::<String>() + rest;
    Scenario::parse(Path::new("s.toml"), &text, &Overrides::default()).unwrap()
}

/// The figures of every seed's run.
fn runs(scenario: &Scenario, seeds: u64) -> Vec<Summary> {
    let run = |seed| simulate(scenario, seed, None, |_| {}).unwrap().1;
    parallel::each(1..=seeds, run)
}

fn hold(scenario: &Scenario, seeds: u64) -> Vec<Summary> {
    let runs = runs(scenario, seeds);
    for (seed, run) in (1..).zip(&runs) {
        assert_eq!((run.bound.violations, run.bound.beyond_limits, run.collisions), (0, 0, 0), "seed {seed}");
        assert!(run.bound.median_width_m.is_some_and(|width_m| width_m < 0.5), "seed {seed}: {:?}", run.bound);
    }
    runs
}

#[test]
fn the_truth_is_inside_its_bound_in_a_hundred_runs() {
    hold(&paper("", NO_SENSOR, OFF), MANY);
}

#[test]
fn the_truth_is_inside_its_bound_when_the_actuators_lag_half_as_long_again_as_published() {
    hold(&paper("plant_lag_s = 0.45", NO_SENSOR, OFF), MANY);
}

#[test]
fn the_truth_is_inside_its_bound_while_the_envelope_brakes_and_nobody_collides() {
    let runs = hold(&paper("", NO_SENSOR, ""), SOME);
    assert!(runs.iter().all(|run| run.envelope.limited_share > 0.01), "a silence of 4 s without the envelope's doing");
    assert!(runs.iter().all(|run| run.min_gap_m.is_some_and(|gap_m| gap_m > 0.5)), "less than the margin is left");
}

#[test]
fn the_truth_is_inside_its_bound_when_a_range_sensor_with_errors_narrows_it_and_nobody_has_to_stop() {
    let sensor = "range_sensor = true\nrange_accuracy_m = 0.5\nrange_speed_accuracy_mps = 0.3";
    let runs = hold(&paper("", sensor, ""), SOME);
    assert!(runs.iter().all(|run| run.full_stops == 0 && run.min_gap_m > Some(8.0)));
}
