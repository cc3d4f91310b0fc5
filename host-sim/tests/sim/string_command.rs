//! `string`: short runs of the real program against what it promises, and the limit at the time gap that is shipped.

use std::process::{Command, Output};

use clap::Parser;
use holdover_sim::commands::cli::Cli;
use holdover_sim::commands::options::Options;
use holdover_sim::commands::string::options::{StringOptions, shipped_time_gap_s};
use holdover_sim::commands::string::rows::{self, LIMIT, Row};
use holdover_sim::input::scenario::SensorShare;

fn options(arguments: &str) -> StringOptions {
    let words = ["holdover-sim", "string"].into_iter().chain(arguments.split_whitespace());
    match Options::read(Cli::try_parse_from(words).unwrap()).unwrap() {
        Options::String(options) => options,
        other => panic!("{other:?} is not of a string"),
    }
}

fn string(arguments: &str) -> Output {
    let words = std::iter::once("string").chain(arguments.split_whitespace());
    Command::new(env!("CARGO_BIN_EXE_holdover-sim")).args(words).output().unwrap()
}

fn rows(arguments: &str) -> Vec<Row> {
    rows::run(&options(arguments), || {}).unwrap()
}

/// The worst place of the table: 0.2 s late and 40 % lost, a step.
fn worst_place(more: &str) -> Row {
    rows(&format!("--delays 0.2 --losses 0.4 --step-only {more}")).remove(0)
}

#[test]
fn a_step_over_the_worst_link_is_damped_at_the_shipped_time_gap_and_not_at_a_tenth_of_a_second_less() {
    let ratio = |row: &Row| row.holdover.as_ref().unwrap().ratio;
    // Of the first forty seeds 6 is the one whose losses are the worst at a tenth of a second less. The figures are documented to
    // the digit of which half is allowed here.
    let shipped = worst_place("--seed 5 --seeds 2");
    assert!(ratio(&shipped) <= 1.0039 + 0.00005, "{shipped:?}");
    assert!(rows::failures(std::slice::from_ref(&shipped)).is_empty(), "{shipped:?}");
    let less =
        worst_place(&format!("--seed 6 --seeds 1 --time-gaps {:.1}", shipped_time_gap_s(SensorShare::NONE) - 0.1));
    assert!(ratio(&less) > LIMIT && ratio(&less) <= 1.0228 + 0.0001, "{less:?}");
    assert_eq!(rows::failures(std::slice::from_ref(&less)).len(), 1, "{less:?}");
}

#[test]
fn with_range_sensors_a_step_over_the_worst_link_is_damped_at_the_shipped_time_gap_and_at_a_tenth_of_a_second_less() {
    for gap_s in [shipped_time_gap_s(SensorShare::ALL), shipped_time_gap_s(SensorShare::ALL) - 0.1] {
        let row = worst_place(&format!("--range-sensors on --seeds 2 --time-gaps {gap_s:.1}"));
        assert!(rows::failures(std::slice::from_ref(&row)).is_empty(), "{row:?}");
    }
}

#[test]
fn without_a_loss_every_seed_is_the_same_run() {
    let of = |seed: u32| rows(&format!("--delays 0.1 --losses 0 --step-only --seed {seed} --seeds 9"));
    let [first, other] = [1, 2].map(of);
    assert_eq!((&first, first[0].runs), (&other, 1));
}

#[test]
fn a_step_has_forty_seeds_and_a_sine_one_unless_it_is_said() {
    // Six places with a loss and three without, a step and seven sines.
    assert_eq!(rows::count(&options("")), 6 * (40 + 7) + 3 * 8);
    assert_eq!(rows::count(&options("--step-only")), 6 * 40 + 3);
    assert_eq!(rows::count(&options("--seeds 2")), 6 * 2 * 8 + 3 * 8);
}

#[test]
fn the_verdict_and_the_page_say_of_how_many_runs_and_seeds_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let output = string(&format!("--delays 0 --losses 0,0.2 --step-only --seeds 2 --out {}", folder.path().display()));
    let runs = "3 runs, a step with 2 seeds, where nothing is lost with 1, from seed 1 on";
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.ends_with(&format!("verdict: passed; {runs}\n")), "{said}");
    let page = std::fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(page.contains(&format!("With holdover no ratio is above 1.01 in {runs}.")), "{page}");
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn seeds_that_cannot_be_are_refused_with_option_cause_and_remedy() {
    let cases = [
        ("--seeds 0", "--seeds: is 0; give a number from 1 to 10000"),
        ("--seeds 9223372036854775807", "--seeds: is 9223372036854775807; give a number from 1 to 10000"),
        (
            "--seed 18446744073709551615",
            "--seed: from 18446744073709551615 on there are fewer than 40 seeds: the last one is 18446744073709551615; give a smaller first seed",
        ),
    ];
    for (arguments, message) in cases {
        let output = string(&format!("{arguments} --no-report"));
        assert_eq!(String::from_utf8_lossy(&output.stderr), format!("error: {message}\n"), "{arguments}");
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments}");
    }
}

#[test]
fn the_help_says_where_chance_decides_and_how_to_run_more() {
    let help = String::from_utf8(string("--help").stdout).unwrap();
    for wanted in ["Chance:", "run with 40", "--step-only --seeds 200"] {
        assert!(help.contains(wanted), "{wanted}: {help}");
    }
}

#[test]
fn range_sensors_are_on_or_off_and_each_has_a_shipped_time_gap() {
    for (arguments, on) in [("", false), ("--range-sensors off", false), ("--range-sensors on", true)] {
        let output = string(&format!("--delays 0 --losses 0 --step-only --json --no-report {arguments}"));
        let said: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(said["range_sensors"], on, "{arguments}");
        let gap = if on { "shipped_time_gap_with_sensor_s" } else { "shipped_time_gap_s" };
        assert!(said[gap].is_number() && said["rows"][0]["time_gap_s"] == said[gap], "{arguments}: {said}");
    }
    for wrong in ["maybe", "1.5", "-1", "half"] {
        let output = string(&format!("--range-sensors={wrong}"));
        assert_eq!(output.status.code(), Some(2));
        let line = String::from_utf8(output.stderr).unwrap();
        assert_eq!(line, format!("error: --range-sensors: is \"{wrong}\"; give on, off or a share from 0 to 1\n"));
    }
}

#[test]
fn half_of_the_vehicles_with_range_sensors_keep_to_the_limit_at_the_time_gap_of_those_without() {
    let row = rows("--delays 0.1 --losses 0.1 --step-only --seeds 1 --range-sensors 0.5").remove(0);
    assert!(rows::failures(std::slice::from_ref(&row)).is_empty(), "{row:?}");
    assert_eq!(row.time_gap_s, shipped_time_gap_s(SensorShare::NONE));
}

#[test]
fn the_smallest_time_gap_of_each_link_is_that_from_which_on_every_row_holds() {
    let rows = rows("--delays 0,0.1 --losses 0 --step-only --time-gaps 0.6,1,1.6");
    let smallest = rows::smallest(&rows);
    assert_eq!(smallest.len(), 2);
    for link in &smallest {
        let of_link = |row: &&Row| row.delay_s == link.delay_s;
        let least = |of: fn(&Row) -> f64| {
            let holds = |gap: &f64| {
                rows.iter().filter(of_link).filter(|row| row.time_gap_s >= *gap).all(|row| of(row) <= LIMIT)
            };
            [0.6, 1.0, 1.6].into_iter().find(holds)
        };
        assert_eq!(link.holdover_s, least(|row| row.holdover.as_ref().unwrap().ratio));
        assert_eq!(link.cacc_s, least(|row| row.cacc.as_ref().unwrap().ratio));
        assert_eq!(link.degraded_cacc_s, least(|row| row.degraded_cacc.as_ref().unwrap().ratio));
    }
}

#[test]
fn in_a_mixed_string_the_vehicles_that_a_unit_drives_damp_a_step_and_nobody_is_hit() {
    for mixture in ["--people 3", "--unequipped 3", "--people 1 --unequipped 4,5"] {
        let row =
            rows(&format!("--delays 0.1 --losses 0.1 --step-only --seeds 1 --range-sensors on {mixture}")).remove(0);
        assert!(rows::failures(std::slice::from_ref(&row)).is_empty(), "{mixture}: {row:?}");
        assert_eq!((row.collisions, row.not_following, &row.cacc), (0, 0, &None), "{mixture}");
    }
}

#[test]
fn vans_and_buses_need_a_longer_time_gap_than_cars() {
    let ratio = |kinds: &str, time_gap_s: f64| {
        let link = "--delays 0 --losses 0 --step-only --range-sensors on";
        let row = rows(&format!("{link} --kinds {kinds} --time-gaps {time_gap_s}")).remove(0);
        assert_eq!((row.collisions, row.not_following), (0, 0), "{kinds}, {time_gap_s} s");
        row.holdover.unwrap().ratio
    };
    assert!(ratio("car", 0.8) <= LIMIT);
    assert!(ratio("van", 0.8) > LIMIT && ratio("van", 1.0) <= LIMIT);
    assert!(ratio("bus", 1.0) > LIMIT && ratio("bus", 1.4) <= LIMIT);
    // The third follower is the bus.
    let mixed =
        rows("--delays 0 --losses 0 --step-only --range-sensors on --kinds car,van,bus --time-gaps 0.8").remove(0);
    assert_eq!(mixed.holdover.unwrap().vehicle, 3);
    let command = options("--kinds car,bus --people 2 --step-only").command();
    assert!(command.contains(" --range-sensors off --kinds car,bus --people 2 "), "{command}");
}

#[test]
fn the_kinds_are_in_the_results_and_a_kind_that_is_none_is_refused() {
    let output = string("--kinds car,bus --delays 0 --losses 0 --step-only --json --no-report");
    let results: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(results["kinds"], serde_json::json!(["car", "bus"]));
    let none = "has no value; give one";
    for (kinds, message) in [("tram", "is \"tram\"; give one of car, van, bus"), ("", none), ("car,", none)] {
        let output = string(&format!("--kinds={kinds} --no-report"));
        assert_eq!(String::from_utf8_lossy(&output.stderr), format!("error: --kinds: {message}\n"), "{kinds}");
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{kinds}");
    }
}

#[test]
fn a_mixture_that_cannot_be_is_refused_with_option_cause_and_remedy() {
    let cases = [
        ("--people 0", "--people: vehicle 0 is none of the followers; give followers, from 1 to 10"),
        ("--unequipped 11", "--unequipped: vehicle 11 is none of the followers; give followers, from 1 to 10"),
        (
            "--unequipped 3",
            "--unequipped: the unit behind vehicle 3 neither hears it nor sees it; give `--range-sensors on`",
        ),
        ("--people -1", "--people: is \"-1\"; give a whole number from 0 on"),
        (
            "--people 1,2,3,4,5,6 --unequipped 7,8,9,10 --range-sensors on",
            "no vehicle is left that a unit drives; leave one of them out of `--people` and `--unequipped`",
        ),
        (
            "--people 2,3 --unequipped 3 --range-sensors on",
            "--people: vehicle 3 is in `--unequipped` too; leave it out of one of the two",
        ),
    ];
    for (arguments, message) in cases {
        let output = string(&format!("{arguments} --no-report"));
        assert_eq!(String::from_utf8_lossy(&output.stderr), format!("error: {message}\n"), "{arguments}");
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments}");
    }
}

#[test]
fn behind_the_last_vehicle_and_behind_people_nobody_needs_a_sensor() {
    for arguments in
        ["--unequipped 10", "--unequipped 4 --people 5", "--unequipped 9,10,10 --people 1 --range-sensors on"]
    {
        let mixture = options(arguments).mixture;
        assert!(mixture.is_mixed() && mixture.unequipped.len() < 3, "{arguments}: {mixture:?}");
    }
}

#[test]
fn methods_that_are_not_run_have_no_smallest_time_gap() {
    let rows = rows("--delays 0 --losses 0 --step-only --time-gaps 1.2,1.6 --people 3");
    let smallest = rows::smallest(&rows);
    assert!(smallest.iter().all(|link| link.holdover_s.is_some()), "{smallest:?}");
    assert!(
        smallest.iter().all(|link| link.cacc_s.or(link.as_it_stands_s).or(link.degraded_cacc_s).is_none()),
        "{smallest:?}"
    );
}
