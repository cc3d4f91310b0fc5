//! `run corridor`: short runs of the real program against what it promises, its exit codes and its output.

use std::path::Path;
use std::process::{Command, Output};

use crate::own_frames::repeats;

fn sim(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim")).args(arguments).output().expect("the program runs")
}

/// The corridor with arrivals of 20 s and whatever else is said, a seed of which one vehicle soon comes up behind another, and a long time
/// gap, so that it follows.
fn short(folder: &Path, edits: &[(&str, &str)]) -> String {
    let text = std::fs::read_to_string("scenarios/corridor.toml").unwrap();
    let mut text = text.replacen("duration_s = 600.0", "duration_s = 20.0", 1);
    text = text.replacen("seed = 1 ", "seed = 5 ", 1).replacen("\ntime_gap_s = 1.0 ", "\ntime_gap_s = 3.0 ", 1);
    for (from, to) in edits {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let file = folder.join("short.toml");
    std::fs::write(&file, text).unwrap();
    file.to_string_lossy().into_owned()
}

#[test]
fn a_short_run_passes_and_the_same_seed_is_the_same_bytes_outside_timing() {
    let folder = tempfile::tempdir().unwrap();
    let file = short(folder.path(), &[]);
    let run = || {
        let output = sim(&["run", &file, "--json", "--no-report"]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let mut results: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert!(results["timing"]["wall_s"].as_f64().unwrap() > 0.0);
        results.as_object_mut().unwrap().remove("timing");
        results
    };
    let results = run();
    let side = &results["holdover"];
    assert!(side["served"].as_u64().unwrap() > 3, "{results}");
    for key in ["unserved", "collisions_on_roads", "collisions_at_intersections", "bound_violations"] {
        assert_eq!(side[key], 0, "{key}: {results}");
    }
    // Everyone is there under every condition.
    for other in ["perfect_link", "alone", "envelope"] {
        assert_eq!(
            results[other]["served"].as_u64().unwrap() + results[other]["unserved"].as_u64().unwrap(),
            side["served"].as_u64().unwrap()
        );
    }
    assert!(side["position_error"]["max_m"].as_f64().unwrap() > 0.0);
    assert_eq!(run(), results);
}

#[test]
fn the_report_has_the_papers_figures_and_ours_beside_others_and_how_fast_it_is_simulated() {
    let folder = tempfile::tempdir().unwrap();
    let file = short(folder.path(), &EARLY_EGO);
    let report = folder.path().join("report");
    let output = sim(&["run", &file, "--json", "--vehicles", "4,8", "--out", report.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let results: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let (steps, motions) = (results["steps"].as_array().unwrap(), results["motions"].as_array().unwrap());
    assert_eq!((steps.len(), motions.len()), (7, 5));
    let scale = results["timing"]["scale"].as_array().unwrap();
    let asked: Vec<u64> = scale.iter().map(|load| load["vehicles"].as_u64().unwrap()).collect();
    assert_eq!(asked, [4, 8]);
    for load in scale {
        let [under_way, peers, speed] =
            ["under_way", "peers_heard", "times_real_time"].map(|key| load[key].as_f64().unwrap());
        assert!(under_way > 0.1 && under_way < 10.0 && peers < under_way + 1.0 && speed > 1.0, "{load}");
    }
    let page = std::fs::read_to_string(report.join("index.html")).unwrap();
    for title in [
        "Figure 1. The ego’s passage",
        "Figure 2. Trajectories at the first intersection",
        "Figure 3. Error of the ego",
        "Figure 4. Largest position error over prediction step",
        "Figure 5. Updates per second on one core over prediction step",
        "Figure 6. free acceleration",
        "Figure 10. 5 m/s",
        "Figure 11. How many times faster than real time",
        "holdover loses",
        "8 vehicles cost",
    ] {
        assert!(page.contains(title), "{title}");
    }
}

#[test]
fn a_limit_that_is_missed_is_a_failed_verdict() {
    let folder = tempfile::tempdir().unwrap();
    let file = short(folder.path(), &[("position_error_m = 0.16 ", "position_error_m = 0.0001 ")]);
    let output = sim(&["run", &file, "--no-report"]);
    assert_eq!(output.status.code(), Some(1));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains("verdict: failed") && text.contains("position error"), "{text}");
}

#[test]
fn roads_by_which_nobody_comes_are_a_failed_verdict_as_nothing_was_measured() {
    let folder = tempfile::tempdir().unwrap();
    let file = short(folder.path(), &[]);
    let text = std::fs::read_to_string(&file).unwrap().replace("vehicles_per_min = ", "vehicles_per_min = 0 # ");
    std::fs::write(&file, text).unwrap();
    let output = sim(&["run", &file, "--no-report"]);
    assert_eq!(output.status.code(), Some(1));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    for said in ["verdict: failed", "nobody got through", "no position error was measured", "no travel times"] {
        assert!(text.contains(said), "{said}: {text}");
    }
}

#[test]
fn the_sides_are_what_they_are_called_with_the_envelope_or_not() {
    let folder = tempfile::tempdir().unwrap();
    let file = short(folder.path(), &[("duration_s = 20.0", "duration_s = 10.0")]);
    let [without, with]: [serde_json::Value; 2] = [&[][..], &["--envelope"]].map(|more| {
        let output = sim(&[&["run", file.as_str(), "--json", "--no-report"], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    });
    for side in ["holdover", "perfect_link", "alone", "envelope", "envelope_perfect_link"] {
        assert_eq!(with[side], without[side], "{side}");
    }
    assert_eq!(without["holdover"]["limited_share"], 0.0);
    assert_eq!([&without, &with].map(|results| results["excerpts_with_envelope"].as_bool().unwrap()), [false, true]);
    // The arrivals last for less than an excerpt does.
    let nothing_wrong = |results: &serde_json::Value| {
        let mut row = results["wrong"][0].clone();
        row.as_object_mut().unwrap().remove("what");
        row
    };
    assert_eq!(nothing_wrong(&without), without["holdover"]);
    assert_eq!(nothing_wrong(&with), with["envelope"]);
}

#[test]
fn the_picture_has_the_papers_figures_and_ours_beside_others_and_is_the_same_for_the_same_seed() {
    let folder = tempfile::tempdir().unwrap();
    let (of_second, of_harrison) = ("\"2nd Street, northwest\"", "\"Harrison Street, southwest\"");
    let edits = [("ego_after_s = 100.0", "ego_after_s = 0.0"), (of_second, of_harrison)];
    let file = short(folder.path(), &edits);
    let draw = |name: &str| {
        let picture = folder.path().join(name);
        let output = sim(&["run", &file, "--no-report", "--json", "--picture", picture.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let results: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(results["motions"].as_array().unwrap().len(), 5);
        std::fs::read_to_string(picture).unwrap()
    };
    let drawn = draw("1.svg");
    for said in [
        "Trajectories at the first intersection",
        "Error of the ego",
        "Largest position error over prediction step",
        "Largest position error in a silence of 4 s",
        "constant acceleration",
        "slot following",
        "How many updates a second",
    ] {
        assert!(drawn.contains(said), "{said}");
    }
    assert!(drawn == draw("2.svg"));
}

#[test]
fn the_list_names_what_can_be_run_by_name() {
    let output = sim(&["run", "--list"]);
    assert_eq!(output.status.code(), Some(0));
    let list = String::from_utf8(output.stdout).unwrap();
    let names: Vec<&str> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(names[..6], ["paper", "corridor", "motorway", "merge", "stop-and-go", "storm"]);
    assert!(["wrong", "wrong-mass", "vans"].iter().all(|name| names.contains(name)), "{names:?}");
    let is_of_roads = |name: &&str| ["corridor", "on-ramp", "turns"].contains(name); // they take minutes
    for name in names.into_iter().filter(|name| !is_of_roads(name)) {
        let output = sim(&["run", name, "--no-report", "--json"]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn what_cannot_be_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let line_of = |text: &str, edits: &[(&str, &str)]| {
        let file = short(folder.path(), edits);
        let lines = std::fs::read_to_string(&file).unwrap();
        let line = 1 + lines.lines().position(|line| line.contains(text)).unwrap();
        let output = sim(&["run", &file]);
        assert_eq!(output.status.code(), Some(2));
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.contains(&format!("short.toml:{line}: ")), "{error} (line {line})");
        error
    };
    assert!(line_of("rnge_m", &[("range_m = 400.0", "rnge_m = 400.0")]).contains("write `range_m`"));
    assert!(line_of("loss = 1.5", &[("loss = 0.1", "loss = 1.5")]).contains("from 0 to 1"));
    assert!(line_of("faults = 1.5", &[("faults = 0.02", "faults = 1.5")]).contains("from 0 to 1"));
    assert!(
        line_of("ego_road", &[("ego_road = \"2nd Street, northwest\"", "ego_road = \"1st\"")]).contains("name one of")
    );
    assert!(
        line_of("vehicles_per_min = 25", &[("vehicles_per_min = 2.0", "vehicles_per_min = 25.0")])
            .contains("headway_s")
    );
}

#[test]
fn options_of_a_string_are_not_for_a_corridor_nor_the_other_way_round() {
    for arguments in [["run", "corridor", "--trace", "x.csv"], ["run", "paper", "--seeds", "3"]] {
        let output = sim(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
    let output = sim(&["sweep", "corridor"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("is a corridor"));
}

/// The ego comes within the 20 s.
const EARLY_EGO: [(&str, &str); 2] =
    [("ego_after_s = 100.0", "ego_after_s = 0.0"), ("\"2nd Street, northwest\"", "\"Harrison Street, southwest\"")];

/// Identifiers of `EgoPosition`, `PeersUnserved`, `OwnRoute`, `Peer0Route`.
const IDS_OF_ROUTES: [&str; 4] = ["487", "489", "495", "4C5"];

fn lines(file: &Path) -> Vec<String> {
    std::fs::read_to_string(file).unwrap().lines().map(str::to_owned).collect()
}

fn has(log: &[String], id: &str) -> bool {
    log.iter().any(|line| line.contains(&format!(" can0 {id}#")))
}

#[test]
fn the_log_of_a_corridor_has_the_messages_of_a_route_and_a_unit_with_the_map_repeats_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = short(folder.path(), &EARLY_EGO);
    let log = folder.path().join("bus.log");
    let name = log.to_str().unwrap();
    for (vehicle, seed) in [(None, "5"), (Some("2"), "5")] {
        let vehicle = |option| vehicle.map_or(vec![], |vehicle| vec![option, vehicle]);
        let run = ["run", &file, "--no-report", "--json", "--seed", seed, "--candump", name];
        let ran = sim(&[&run[..], &vehicle("--candump-vehicle")].concat());
        assert_eq!(ran.status.code(), Some(0), "{}", String::from_utf8_lossy(&ran.stderr));
        let sent = lines(&log);
        for id in IDS_OF_ROUTES {
            assert!(has(&sent, id), "{id}");
        }
        let replayed =
            sim(&[&["replay", name, "--scenario", &file, "--seed", seed][..], &vehicle("--vehicle")].concat());
        assert!(repeats(&String::from_utf8(replayed.stdout).unwrap(), &sent.join("\n")), "seed {seed}");
        // Without the map it is another unit.
        let without = sim(&[&["replay", name][..]].concat());
        assert!(!repeats(&String::from_utf8(without.stdout).unwrap(), &sent.join("\n")));
        // The results are those of a run without a log.
        let results = |output: &Output| -> serde_json::Value {
            let mut results: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
            results.as_object_mut().unwrap().remove("timing");
            results
        };
        assert_eq!(results(&ran), results(&sim(&run[..6])));
    }
}

#[test]
fn a_log_that_cannot_be_is_refused_before_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let file = short(folder.path(), &[]);
    let cases: [(&[&str], &str); 3] = [
        (&[], "--candump: no vehicle of this seed is the ego; name one by --candump-vehicle\n"),
        (&["--candump-vehicle", "999"], "--candump-vehicle: there is no vehicle 999; give an index from 0 to "),
        (&["--demand", "30"], "--candump: is for the scenario's own traffic, and --demand runs other traffic; "),
    ];
    for (arguments, message) in cases {
        let output = sim(&[&["run", &file, "--candump", "x.log"][..], arguments].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.starts_with(&format!("error: {message}")), "{said}");
        assert_eq!((output.status.code(), said.lines().count()), (Some(2), 1));
    }
    let output = sim(&["replay", "x.log", "--scenario", "corridor", "--vehicle", "255"]);
    assert!(String::from_utf8(output.stderr).unwrap().contains("give an index below 255"));
}

#[test]
fn seeds_that_cannot_be_are_refused_with_cause_and_remedy() {
    for seeds in ["0", "10001", "9223372036854775807"] {
        let output = sim(&["run", "corridor", "--seeds", seeds, "--no-report"]);
        let message = format!("error: --seeds: is {seeds}; give a number from 1 to 10000\n");
        assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr)), (Some(2), message.into()));
    }
}
