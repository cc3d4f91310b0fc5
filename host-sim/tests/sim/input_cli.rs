//! What the command line means, and how the program ends when it means nothing.

use clap::{CommandFactory, Parser};
use holdover_sim::commands::cli::Cli;
use holdover_sim::commands::options::Options;
use holdover_sim::commands::run::candump::Candump;
use holdover_sim::commands::run::options::RunOptions;
use holdover_sim::input::impairment::Impairment;
use std::path::Path;
use std::process::{Command, Output, Stdio};

fn options(arguments: &str) -> Result<RunOptions, String> {
    let words = std::iter::once("holdover-sim").chain(arguments.split_whitespace());
    let cli = Cli::try_parse_from(words).map_err(|error| error.to_string())?;
    match Options::read(cli).map_err(|error| error.to_string())? {
        Options::Run(options) => Ok(options),
        other => panic!("{other:?} is no run"),
    }
}

fn holdover_sim(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim")).args(arguments).output().unwrap()
}

#[test]
fn the_command_line_is_consistent() {
    Cli::command().debug_assert();
}

#[test]
fn without_a_command_it_is_run_with_the_same_options() {
    assert_eq!(options(""), options("run"));
    assert_eq!(options("--seed 3 --json --step 0.1"), options("run --seed 3 --json --step 0.1"));
    let run = options("run scenarios/paper.toml --seed 3").unwrap();
    assert_eq!(run.scenario, options("--seed 3").unwrap().scenario);
    assert_eq!(run.scenario_file.as_deref(), Some(Path::new("scenarios/paper.toml")));
}

#[test]
fn the_defaults_are_the_papers_scenario_and_a_report() {
    let run = options("").unwrap();
    assert_eq!((run.scenario.seed, run.scenario.step_s, run.destination.json), (1, 0.03, false));
    assert_eq!(run.destination.report.as_deref(), Some(Path::new("holdover-report")));
    assert_eq!((run.scenario_file, run.trace, run.candump), (None, None, None));
}

#[test]
fn the_report_can_be_put_elsewhere_or_left_out() {
    assert_eq!(
        options("--out no/such/folder/yet").unwrap().destination.report.as_deref(),
        Some(Path::new("no/such/folder/yet"))
    );
    assert_eq!(options("--no-report").unwrap().destination.report, None);
    assert!(options("--no-report --out x").is_err());
}

#[test]
fn the_bus_recorded_is_the_egos_unless_said_otherwise() {
    let candump = |arguments| options(arguments).unwrap().candump;
    let of = |vehicle| Some(Candump { file: "bus.log".into(), vehicle });
    assert_eq!(candump("--candump bus.log"), of(2));
    assert_eq!(candump("--candump bus.log --candump-vehicle 0"), of(0));
    assert!(options("--candump-vehicle 1").is_err());
}

#[test]
fn recordings_named_on_the_command_line_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let (drive, link) = (folder.path().join("drive.csv"), folder.path().join("link.csv"));
    std::fs::write(&drive, "t_s,position_m,speed_mps\n0,0,5\n10,50,5\n").unwrap();
    std::fs::write(&link, "t_s,delay_s\n0,0.1\n1,0.1\n").unwrap();
    let run = options(&format!("--leader-motion {} --channel-trace {}", drive.display(), link.display())).unwrap();
    assert_eq!(run.scenario.duration_s, 10.0);
    assert!(matches!(run.scenario.channel.impairment, Impairment::Recorded(_)));
    let message = options(&format!("--leader-motion {}", link.display())).unwrap_err();
    assert!(message.contains("link.csv:1: no column `position_m`"), "{message}");
}

#[test]
fn an_option_that_cannot_be_is_refused_with_its_name_cause_and_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().display();
    let cases = [
        ("--step 0".to_owned(), "--step: `step_s` is 0; give seconds from 0.001 to 1".to_owned()),
        ("--step -1".into(), "--step: `step_s` is -1; give seconds from 0.001 to 1".into()),
        ("--step nan".into(), "--step: `step_s` is NaN; give seconds from 0.001 to 1".into()),
        (
            "--candump x --candump-vehicle 5".into(),
            "--candump-vehicle: there is no vehicle 5; give an index from 0 to 4".into(),
        ),
        (
            "--out Cargo.toml".into(),
            "--out: \"Cargo.toml\" is a file; name a folder for the report, or give --no-report".into(),
        ),
        (format!("--trace {folder}"), format!("--trace: \"{folder}\" is a folder; name a file in it")),
        (
            "--trace no/such/ticks.csv".into(),
            "--trace: \"no/such/ticks.csv\" is in a folder that does not exist; create the folder first".into(),
        ),
        (
            "--trace x --candump ./x".into(),
            "--candump: \"./x\" is also another file of this command; give each a name of its own".into(),
        ),
        (
            "run scenarios/paper.toml --trace scenarios/../scenarios/paper.toml".into(),
            "--trace: \"scenarios/../scenarios/paper.toml\" is also another file of this command; give each a name of \
             its own"
                .into(),
        ),
        ("run no.toml".into(), "no.toml: cannot be read (No such file or directory); check the path".into()),
        ("--channel-trace no.csv".into(), "no.csv: cannot be read (No such file or directory); check the path".into()),
    ];
    for (arguments, message) in cases {
        assert_eq!(options(&arguments).unwrap_err(), message, "{arguments}");
    }
}

#[test]
fn bad_input_ends_with_one_line_on_stderr_and_exit_code_2() {
    let output = holdover_sim(&["run", "no.toml"]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(stderr, "error: no.toml: cannot be read (No such file or directory); check the path\n");
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
}

#[test]
fn what_the_parser_refuses_ends_with_exit_code_2_too() {
    for arguments in [&["--sed", "3"][..], &["rnu"], &["--step", "x"], &["--seed", "-1"], &["--seed"]] {
        let output = holdover_sim(arguments);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}");
        assert!(String::from_utf8(output.stderr).unwrap().starts_with("error: "), "{arguments:?}");
    }
    let stderr = String::from_utf8(holdover_sim(&["--sed", "3"]).stderr).unwrap();
    assert!(stderr.contains("'--seed'"), "{stderr}");
}

#[test]
fn help_names_examples_outputs_and_exit_codes() {
    for arguments in [&["--help"][..], &["run", "--help"], &["-h"]] {
        let output = holdover_sim(arguments);
        let help = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(0));
        for wanted in ["--seed", "--channel-trace", "Examples:", "Output:", "Exit codes:", "stderr"] {
            assert!(help.contains(wanted), "{arguments:?}: {wanted}");
        }
    }
}

#[test]
fn help_for_a_reader_that_has_gone_is_no_panic() {
    let mut help = Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
        .arg("--help")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(help.stdout.take());
    let output = help.wait_with_output().unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    assert_eq!(output.status.code(), Some(0));
}
