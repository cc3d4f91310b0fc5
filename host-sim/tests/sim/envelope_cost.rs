//! What `envelope-cost` prints and writes, and how it ends.

use std::process::{Command, Output};

use serde_json::Value;

fn envelope_cost(arguments: &str, threads: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
        .env("RAYON_NUM_THREADS", threads)
        .arg("envelope-cost")
        .args(arguments.split_whitespace())
        .output()
        .unwrap()
}

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap()
}

fn rows(arguments: &str) -> Vec<Value> {
    let output = envelope_cost(&format!("{arguments} --json --no-report"), "2");
    assert_eq!(output.status.code(), Some(0), "{}", text(output.stderr));
    let mut results: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(results.as_object().unwrap().len(), 1);
    serde_json::from_value(results["rows"].take()).unwrap()
}

#[test]
fn each_silence_is_a_row_without_and_with_the_envelope() {
    let rows = rows("--silences 1,8 --seeds 3 --range-sensors off");
    assert_eq!(rows.iter().map(|row| row["silence_s"].as_f64().unwrap()).collect::<Vec<_>>(), [1.0, 8.0]);
    for row in &rows {
        let keys: Vec<&String> = row.as_object().unwrap().keys().collect();
        assert_eq!(keys, ["cost_interval_s", "distance_m", "off", "on", "seeds", "silence_s"]);
        for side in ["off", "on"] {
            let keys: Vec<&String> = row[side].as_object().unwrap().keys().collect();
            let wanted = [
                "bound_violations",
                "collisions",
                "full_stops",
                "hardest_braking_mps2",
                "limited_share",
                "min_gap_m",
                "travel_time_interval_s",
                "travel_time_s",
            ];
            assert_eq!(keys, wanted);
            assert_eq!((&row[side]["collisions"], &row[side]["bound_violations"]), (&Value::from(0), &Value::from(0)));
        }
        assert_eq!((&row["off"]["limited_share"], &row["off"]["full_stops"]), (&Value::from(0.0), &Value::from(0)));
    }
    let on = |row: usize, figure: &str| rows[row]["on"][figure].as_f64().unwrap();
    let off = |row: usize, figure: &str| rows[row]["off"][figure].as_f64().unwrap();
    assert!(0.0 < on(0, "limited_share") && on(0, "limited_share") < on(1, "limited_share"));
    // Eight seconds of silence cost seconds of travel time and full stops, and no more braking than there is.
    assert!(on(1, "travel_time_s") > off(1, "travel_time_s") + 1.0);
    assert!(on(1, "full_stops") >= 3.0 && on(1, "hardest_braking_mps2") <= 8.0 && on(1, "min_gap_m") > 0.5);
}

#[test]
fn with_range_sensors_the_envelope_costs_nothing() {
    for row in rows("--silences 1,2,4,8 --seeds 20") {
        let [off, on] = ["off", "on"].map(|side| row[side]["travel_time_s"].as_f64().unwrap());
        // As docs/RESULTS.md says, to half of the last digit.
        assert!((off - 18.41).abs() <= 0.005 && (on - 18.41).abs() <= 0.005, "{off} s, {on} s");
        assert!(row["on"]["limited_share"].as_f64().unwrap() <= 0.00045, "{row}");
        assert_eq!([&row["off"]["full_stops"], &row["on"]["full_stops"]], [&Value::from(0); 2]);
    }
}

#[test]
fn the_figures_of_twenty_seeds_without_range_sensors_are_the_documented_ones() {
    // As docs/RESULTS.md shows them: silence; percent of the time limited; travel time without and with the envelope; full stops per
    // run; smallest gap without and with it.
    let documented = [
        [1.0, 1.8, 18.41, 18.54, 0.0, 10.8, 7.9],
        [2.0, 4.2, 18.41, 21.01, 2.65, 10.8, 1.5],
        [4.0, 6.6, 18.41, 22.21, 3.05, 10.8, 1.3],
        [8.0, 16.1, 18.48, 26.20, 5.00, 10.8, 1.3],
    ];
    // Half of the last digit that is shown: the figures are deterministic.
    let within = [0.0, 0.05, 0.005, 0.005, 0.005, 0.05, 0.05];
    let rows = rows("--silences 1,2,4,8 --seeds 20 --range-sensors off");
    assert_eq!(rows.len(), documented.len());
    for (row, documented) in rows.iter().zip(documented) {
        let figure = |side: &str, name: &str| row[side][name].as_f64().unwrap();
        let measured = [
            row["silence_s"].as_f64().unwrap(),
            100.0 * figure("on", "limited_share"),
            figure("off", "travel_time_s"),
            figure("on", "travel_time_s"),
            figure("on", "full_stops") / 20.0,
            figure("off", "min_gap_m"),
            figure("on", "min_gap_m"),
        ];
        for ((measured, documented), within) in measured.into_iter().zip(documented).zip(within) {
            assert!((measured - documented).abs() <= within + 1e-9, "{measured} for {documented}: {row}");
        }
    }
}

#[test]
fn a_run_is_what_run_makes_of_the_same_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("s.toml");
    // As long after the silence as `envelope-cost` lets it go on.
    std::fs::write(&file, "duration_s = 36\n[channel]\noutages = [[4, 6]]\n").unwrap();
    let row = &rows("--silences 2 --seed 7 --seeds 1")[0];
    for (side, options) in [("off", &["--envelope=off"][..]), ("on", &[][..])] {
        let run = Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
            .args(["run", file.to_str().unwrap(), "--seed", "7", "--json", "--no-report"])
            .args(options)
            .output()
            .unwrap();
        let run: Value = serde_json::from_slice(&run.stdout).unwrap();
        let side = &row[side];
        assert_eq!(side["limited_share"], run["envelope"]["limited_share"]);
        for figure in ["full_stops", "min_gap_m", "collisions"] {
            assert_eq!(side[figure], run[figure], "{figure}");
        }
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let of_threads = |threads| envelope_cost("--silences 1,3 --seeds 4 --json --no-report", threads).stdout;
    assert_eq!(of_threads("1"), of_threads("2"));
    assert_eq!(of_threads("1"), of_threads("5"));
}

#[test]
fn a_vehicle_that_does_not_come_so_far_leaves_no_travel_time() {
    let row = &rows("--silences 1 --seeds 1 --distance 5000")[0];
    assert_eq!((&row["off"]["travel_time_s"], &row["on"]["travel_time_s"]), (&Value::Null, &Value::Null));
}

#[test]
fn a_recorded_channel_is_taken_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("link.csv");
    let lost = |tenth: u32| if (50..90).contains(&tenth) { "" } else { "0.03" };
    let rows_of = (0..200).map(|tenth| format!("{},{}\n", f64::from(tenth) * 0.1, lost(tenth))).collect::<String>();
    std::fs::write(&file, format!("t_s,delay_s\n{rows_of}")).unwrap();
    let rows = rows(&format!("--channel-trace {} --seeds 1 --range-sensors off", file.display()));
    assert_eq!((rows.len(), &rows[0]["silence_s"]), (1, &Value::Null));
    assert!(rows[0]["on"]["limited_share"].as_f64().unwrap() > 0.0);
    let output = envelope_cost(&format!("--channel-trace {} --silences 1 --no-report", file.display()), "1");
    let message = "error: --silences: a recorded channel has the silences that it has; leave out --silences, or the \
                   recording\n";
    assert_eq!((output.status.code(), text(output.stderr).as_str()), (Some(2), message));
}

#[test]
fn the_table_and_the_report_stand_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let output = envelope_cost(&format!("--seeds 1 --silences 0.5,2 --out {}/report", folder.path().display()), "2");
    let (stdout, stderr) = (text(output.stdout), text(output.stderr));
    for wanted in ["seeds each: 1; travel time over 200 m\n", "\n0.5 ", "\n2 ", " off ", " on ", "verdict: passed\n"] {
        assert!(stdout.contains(wanted), "{wanted}: {stdout}");
    }
    assert_eq!(stderr, format!("report: {}/report/index.html\n", folder.path().display()));
    let page = std::fs::read_to_string(folder.path().join("report/index.html")).unwrap();
    assert!(page.contains("holdover-sim envelope-cost --seed 1 --seeds 1 --silences 0.5,2 --distance 200"));
    assert_eq!((page.matches("<figure ").count(), page.matches("<svg ").count()), (3, 3 * 5));
    roxmltree::Document::parse_with_options(&page, roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() })
        .unwrap();
}

#[test]
fn a_collision_with_the_envelope_fails_and_one_without_it_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let start = |gap_m: f64| {
        let file = folder.path().join("crash.toml");
        let crash = format!("ego = 1\n[[vehicle]]\nspeed_mps = 2\n[[vehicle]]\ngap_m = {gap_m}\nspeed_mps = 20\n");
        std::fs::write(&file, crash).unwrap();
        envelope_cost(&format!("{} --seeds 2 --silences 1 --no-report", file.display()), "2")
    };
    // Nobody can stop within 2 m of 20 m/s; within 45 m only emergency braking does.
    let output = start(2.0);
    assert_eq!(output.status.code(), Some(1));
    let stdout = text(output.stdout);
    assert!(stdout.contains("verdict: FAILED: 2 collision(s) in silences of 1 s with the envelope"), "{stdout}");
    let output = start(45.0);
    let stdout = text(output.stdout);
    assert_eq!(output.status.code(), Some(0), "{stdout}");
}

#[test]
fn input_that_cannot_be_is_refused_with_its_cause_and_remedy() {
    let cases = [
        ("--silences 1,0", "--silences: has a length of 0 s; give seconds from 0.1 to 600"),
        ("--silences nan", "--silences: has a length of NaN s; give seconds from 0.1 to 600"),
        ("--silences -1", "--silences: has a length of -1 s; give seconds from 0.1 to 600"),
        ("--seeds 0", "--seeds: is 0; give a number from 1 to 10000"),
        ("--distance 0", "--distance: is 0; give metres from 1 to 1000000"),
        (
            "--seed 18446744073709551615 --seeds 2",
            "--seed: from 18446744073709551615 on there are fewer than 2 seeds: the last one is 18446744073709551615; give a smaller first seed",
        ),
        ("no.toml", "no.toml: cannot be read (No such file or directory); check the path"),
        ("--out Cargo.toml", "--out: \"Cargo.toml\" is a file; name a folder for the report, or give --no-report"),
    ];
    for (arguments, message) in cases {
        let output = envelope_cost(arguments, "1");
        assert_eq!(text(output.stderr), format!("error: {message}\n"), "{arguments}");
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments}");
    }
    for arguments in ["--silences x", "--silences", "--seeds -1", "--seeds 1.5"] {
        assert_eq!(envelope_cost(arguments, "1").status.code(), Some(2), "{arguments}");
    }
}

#[test]
fn help_gives_examples_and_says_what_the_figures_are() {
    let help = text(envelope_cost("--help", "1").stdout);
    for wanted in ["Examples:", "Runs:", "Figures:", "--silences", "--seeds", "--distance", "Exit codes:"] {
        assert!(help.contains(wanted), "{wanted}");
    }
}

#[test]
fn the_shorter_name_is_the_same_command() {
    let named = |name: &str| {
        Command::new(env!("CARGO_BIN_EXE_holdover-sim")).args([name, "--help"]).output().map(|output| output.stdout)
    };
    assert_eq!(named("price").unwrap(), named("envelope-cost").unwrap());
}
