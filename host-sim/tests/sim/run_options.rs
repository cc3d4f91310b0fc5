//! `run --show`, `--set`, `--list`, `--version`, names that are nearly right, and mistyped command lines: one line that names the remedy.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim")).current_dir(folder).args(arguments).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The one line on stderr of a command that is refused.
fn refusal(arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), arguments);
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}: {stderr}");
    assert_eq!(stderr.lines().count(), 1, "{arguments:?}: {stderr}");
    stderr.trim_end().strip_prefix("error: ").unwrap().to_owned()
}

#[test]
fn what_the_parser_refuses_is_one_line_with_cause_and_remedy() {
    let cases: &[(&[&str], &str)] = &[
        (&["--seed", "-1"], "--seed: is \"-1\"; give a whole number from 0 on"),
        (&["--seed", "x"], "--seed: is \"x\"; give a whole number from 0 on"),
        (&["--seed", "99999999999999999999"], "--seed: is \"99999999999999999999\"; give a whole number from 0 on"),
        (&["run", "corridor", "--seeds", "-1"], "--seeds: is \"-1\"; give a whole number from 0 on"),
        (&["--step", "x"], "--step: is \"x\"; give a number"),
        (&["--seed"], "--seed: has no value; give one"),
        (&["--sed", "3"], "there is no argument \"--sed\"; did you mean '--seed'?"),
        (&["evalute"], "there is no command \"evalute\"; did you mean 'evaluate'?"),
        (&["rnu"], "there is no command \"rnu\"; see `holdover-sim --help`"),
        (&["run", "--envelope=maybe"], "--envelope: is \"maybe\"; give one of on, off"),
        (
            &["run", "--no-report", "--out", "x"],
            "--no-report cannot be used together with --out <DIR>; leave one of them out",
        ),
        (&["evaluate"], "--motion <FILE.csv>... is missing; give it, or see `holdover-sim evaluate --help`"),
        (&["--wholly-unknown"], "there is no argument \"--wholly-unknown\"; see `holdover-sim --help`"),
    ];
    for (arguments, line) in cases {
        assert_eq!(refusal(arguments), *line, "{arguments:?}");
    }
}

#[test]
fn a_name_that_is_nearly_one_of_the_library_is_suggested() {
    let begins = "\"coridor\" is neither a file nor a scenario of the library; did you mean \"corridor\"?";
    assert_eq!(refusal(&["run", "coridor"]), begins);
    assert_eq!(refusal(&["run", "--show", "coridor"]), format!("--show: {begins}"));
    let far = refusal(&["run", "qqq"]);
    assert!(
        far.contains("; give a file, or one of paper, corridor, motorway, merge, stop-and-go, storm, wrong-lag"),
        "{far}"
    );
    assert_eq!(
        refusal(&["run", "coridor.toml"]),
        "coridor.toml: cannot be read (No such file or directory); check the path"
    );
}

#[test]
fn a_scenario_of_the_library_is_shown_as_its_file_is_and_runs() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["paper", "corridor", "storm"] {
        let shown = run(folder.path(), &["run", "--show", name]);
        assert_eq!(shown.status.code(), Some(0));
        assert_eq!(stdout(&shown), fs::read_to_string(format!("scenarios/{name}.toml")).unwrap());
    }
    fs::write(folder.path().join("my.toml"), stdout(&run(folder.path(), &["run", "--show", "paper"]))).unwrap();
    let json = |arguments: &[&str]| {
        let output = run(folder.path(), &[arguments, &["--json", "--no-report"]].concat());
        let mut value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        value["timing"] = serde_json::Value::Null;
        value
    };
    assert_eq!(json(&["run", "my.toml"]), json(&["run"]));
}

#[test]
fn the_list_is_json_where_json_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &["run", "--list", "--json"]);
    let list: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let names: Vec<&str> = list.as_array().unwrap().iter().map(|entry| entry["name"].as_str().unwrap()).collect();
    assert_eq!(names[..6], ["paper", "corridor", "motorway", "merge", "stop-and-go", "storm"]);
    assert!(["wrong", "wrong-mass", "vans"].iter().all(|name| names.contains(name)), "{names:?}");
    assert!(list.as_array().unwrap().iter().all(|entry| entry["about"].as_str().unwrap().len() > 20));
}

#[test]
fn what_is_set_counts_as_if_it_stood_in_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("base.toml", "duration_s = 4\n[[vehicle]]\n[[vehicle]]\ngap_m = 12\n[[vehicle]]\n");
    let whole = "duration_s = 3\nego = 1\n[leader]\nprogram = [[0, 13], [2, 9]]\n[channel]\nloss = 0.5\napplies_to = \"all\"\n\
                 [[vehicle]]\n[[vehicle]]\ngap_m = 20\nkind = \"van\"\n[[vehicle]]\n";
    write("whole.toml", whole);
    let sets = [
        "duration_s=3",
        "ego = 1",
        "channel.loss=0.9",
        "channel.loss=0.5",
        "channel.applies_to=all",
        "leader.program=[[0,13],[2,9]]",
        "vehicle.1.gap_m=20",
        "vehicle.1.kind=van",
    ];
    let mut typed = vec!["run", "base.toml", "--no-report", "--trace", "set.csv"];
    sets.iter().for_each(|set| typed.extend(["--set", set]));
    assert!(matches!(run(folder.path(), &typed).status.code(), Some(0 | 1)));
    assert!(matches!(
        run(folder.path(), &["run", "whole.toml", "--no-report", "--trace", "whole.csv"]).status.code(),
        Some(0 | 1)
    ));
    let ticks = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(ticks("set.csv"), ticks("whole.csv"));
    assert_eq!(ticks("set.csv").lines().count(), 301);
    run(folder.path(), &["run", "base.toml", "--set", "duration_s=3", "--out", "report"]);
    let page = fs::read_to_string(folder.path().join("report/index.html")).unwrap();
    assert!(page.contains("<code>holdover-sim run base.toml --seed 1 --set duration_s=3</code>"));
}

#[test]
fn a_vehicle_that_the_file_leaves_out_can_be_set() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("base.toml"), "duration_s = 3\nego = 1\n[channel]\noutages = []").unwrap();
    let ticks = |arguments: &[&str]| {
        let set = ["--set", "vehicle.2.time_gap_s=1.5", "--no-report", "--trace", "ticks.csv"];
        let output = run(folder.path(), &[arguments, &set].concat());
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read_to_string(folder.path().join("ticks.csv")).unwrap()
    };
    // The paper's scenario has the same five vehicles, and says so.
    assert_eq!(ticks(&["run"]), ticks(&["run", "paper"]));
    let short = ["--set", "duration_s=3", "--set", "ego=1", "--set", "channel.outages=[]"];
    assert_eq!(ticks(&["run", "base.toml"]), ticks(&[&["run", "paper"], &short[..]].concat()));
    let beyond = refusal(&["run", "--set", "vehicle.5.gap_m=10"]);
    assert!(beyond.contains("names \"5\" of a list of 5; give an index from 0 to 4"), "{beyond}");
    let corridor = refusal(&["run", "corridor", "--set", "vehicle.0.gap_m=10"]);
    assert!(corridor.starts_with("--set: unknown key \"vehicle\""), "{corridor}");
}

#[test]
fn what_is_set_is_checked_like_the_file() {
    let cases = [
        ("channel.los=0.3", "--set: unknown key \"los\" in [channel]; write `loss`"),
        ("channel.loss=2", "--set: `loss` is 2; give a share from 0 to 1"),
        ("channel.loss=1e300", "--set: `loss` is 1e300; give a share from 0 to 1"),
        ("channel.loss=much", "--set: `loss` is \"much\"; give a share from 0 to 1"),
        ("duration_s", "--set: is \"duration_s\"; give KEY=VALUE, such as channel.loss=0.3"),
        ("duration_s=", "--set: is \"duration_s=\"; give KEY=VALUE, such as channel.loss=0.3"),
        ("=3", "--set: is \"=3\"; give KEY=VALUE, such as channel.loss=0.3"),
        ("kind=corridor", "--set: `kind` says what the other keys are, and cannot be set; give another scenario"),
    ];
    for (set, line) in cases {
        assert_eq!(refusal(&["run", "--set", set]), line, "{set}");
    }
    let beyond = refusal(&["run", "motorway", "--set", "vehicle.99.gap_m=10"]);
    assert!(beyond.contains("names \"99\" of a list of ") && beyond.contains("; give an index from 0 to "), "{beyond}");
    let corridor = refusal(&["run", "corridor", "--set", "channel.loss=7"]);
    assert_eq!(corridor, "--set: `loss` is 7; give a share from 0 to 1");
}

#[test]
fn the_version_names_the_commit_or_says_that_it_is_unknown() {
    let folder = tempfile::tempdir().unwrap();
    let version = stdout(&run(folder.path(), &["--version"]));
    let commit =
        version.trim_end().strip_prefix(concat!("holdover-sim ", env!("CARGO_PKG_VERSION"), " (commit ")).unwrap();
    let commit = commit.strip_suffix(')').unwrap();
    let commit = commit.strip_suffix(", modified").unwrap_or(commit);
    if commit != "unknown" {
        let (hash, day) = commit.split_once(" of ").unwrap();
        assert!(hash.len() == 12 && hash.chars().all(|c| c.is_ascii_hexdigit()), "{version}");
        assert!(day.len() == 10 && day.chars().filter(|c| *c == '-').count() == 2, "{version}");
    }
}

#[test]
fn help_explains_what_can_be_set_shown_and_refused() {
    let folder = tempfile::tempdir().unwrap();
    let help = stdout(&run(folder.path(), &["run", "--help"]));
    for words in ["--show <NAME>", "--set <KEY=VALUE>", "vehicle.1.gap_m=20", "--strict"] {
        assert!(help.contains(words), "{words}");
    }
    let help = stdout(&run(folder.path(), &["check", "--help"]));
    for words in ["<FILE>...", "gaps", "slopes", "units", "Exit codes:"] {
        assert!(help.contains(words), "{words}");
    }
}
