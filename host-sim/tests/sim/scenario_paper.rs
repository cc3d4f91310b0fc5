//! The paper's scenario with vehicles that are not as published holds its limits: seeds enter, and over the worst of them the follower's
//! estimate of the ego stays within what is promised, and nobody collides or stops. (`sweep_limits` has the scenario itself.) A committed
//! table shows every change of behaviour as a readable diff of numbers; `HOLDOVER_UPDATE_SNAPSHOTS=1 cargo test -p holdover-sim` writes it
//! anew.

use std::fmt::Write;
use std::path::Path;

use holdover_sim::commands::sweep::rows;
use holdover_sim::input::library;
use holdover_sim::input::scenario::{Overrides, Scenario};
use holdover_sim::measure::figures::{Errors, Summary, Timing};
use holdover_sim::measure::simulate::simulate;

const SEEDS: u64 = 100;
/// The estimate is by messages alone, as in the paper.
const BY_MESSAGES: Overrides = Overrides::MESSAGES_ALONE;
/// The figures are deterministic; the documents give them to the millimetre.
const ROUNDING_M: f64 = 0.0005;
/// Half as long again as the 0.3 s that every vehicle publishes.
const WRONG_LAG_S: f64 = 0.45;

fn paper() -> Scenario {
    let scenario = Scenario::read(None, &BY_MESSAGES).expect("the defaults are a scenario");
    assert_eq!((scenario.vehicles.len(), scenario.ego), (5, 2), "the paper's scenario as pinned");
    assert!(scenario.vehicles.iter().all(|vehicle| vehicle.lag_s == 0.3 && vehicle.plant_lag_s == 0.3));
    scenario.at_step(0.01).expect("a step")
}

/// The same with plants that are lazier than their units say.
fn with_wrong_lag() -> Scenario {
    let mut scenario = paper();
    scenario.vehicles.iter_mut().for_each(|vehicle| vehicle.plant_lag_s = WRONG_LAG_S);
    scenario
}

/// The figures without the wall clock's.
fn summary(scenario: &Scenario, seed: u64) -> Summary {
    let (_, summary) = simulate(scenario, seed, None, |_| ()).expect("the scenario is accepted");
    Summary { timing: Timing { realtime_factor: 0.0 }, ..summary }
}

#[test]
fn whatever_is_wrong_about_every_vehicle_costs_no_more_than_documented() {
    // The scenario that comes with the program; the largest error and its 99th percentile in metres, as documented.
    let documented = [
        ("wrong-lag", [0.067, 0.032]),
        ("wrong-mass", [0.116, 0.037]),
        ("wrong-grade", [0.013, 0.0059]),
        ("wrong-wind", [0.014, 0.0057]),
        ("wrong", [0.149, 0.102]),
        ("vans", [0.016, 0.0072]),
        ("buses", [0.021, 0.0078]),
    ];
    for (name, [max_m, p99_m]) in documented {
        let (file, text) = library::text(Path::new(name)).unwrap();
        let scenario = Scenario::parse(&file, &text, &BY_MESSAGES).unwrap().at_step(0.01).unwrap();
        let runs = rows::run(&scenario, 1, SEEDS, || {}).unwrap();
        let (max, p99) = (runs.ours.max_position_error_m.unwrap(), runs.ours.p99_position_error_m.unwrap());
        assert!(max <= max_m + ROUNDING_M && p99 <= p99_m + ROUNDING_M, "{name}: {max} m, {p99} m");
        assert_eq!(runs.failures, [], "{name}");
    }
}

#[test]
fn the_same_seed_is_the_same_run_and_another_seed_another() {
    let scenario = paper();
    assert_eq!(summary(&scenario, 7), summary(&scenario, 7));
    assert_ne!(summary(&scenario, 7), summary(&scenario, 8));
}

#[test]
fn the_figures_are_those_of_the_committed_table() {
    let mut table = String::from(
        "The ego's position as its follower estimates it: errors in m from t = 1 s on, ours and the literal paper's.\n\n\
         plants  seed |     max     p99     rms | paper max     p99     rms | least gap, m  speed, m/s  stops  collisions\n",
    );
    for (name, scenario) in [("0.30 s", paper()), ("0.45 s", with_wrong_lag())] {
        for seed in 1..=5 {
            table += &row(name, seed, &summary(&scenario, seed));
        }
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots/paper.txt");
    if std::env::var_os("HOLDOVER_UPDATE_SNAPSHOTS").is_some() {
        std::fs::write(&file, &table).expect("the table can be written");
    }
    let committed = std::fs::read_to_string(&file).expect("the table is committed");
    assert_eq!(
        table.lines().collect::<Vec<_>>(),
        committed.lines().collect::<Vec<_>>(),
        "behaviour changed; if that was meant, write the table anew with HOLDOVER_UPDATE_SNAPSHOTS=1"
    );
}

fn row(plants: &str, seed: u64, summary: &Summary) -> String {
    let known = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let errors = |errors: &Errors| {
        [errors.max_position_error_m, errors.p99_position_error_m, errors.rms_position_error_m].map(known)
    };
    let ([max, p99, rms], [paper_max, paper_p99, paper_rms]) = (errors(&summary.ours), errors(&summary.paper));
    let (gap, speed) = (known(summary.min_gap_m), known(summary.min_speed_mps));
    let (stops, collisions) = (summary.full_stops, summary.collisions);
    let mut row = String::new();
    let _ = write!(row, "{plants}  {seed:>4} | {max:>7.4} {p99:>7.4} {rms:>7.4} | {paper_max:>9.4} {paper_p99:>7.4} ");
    let _ = writeln!(row, "{paper_rms:>7.4} | {gap:>12.3} {speed:>11.3} {stops:>6} {collisions:>11}");
    row
}
