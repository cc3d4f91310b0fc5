//! Recordings that say what cannot be: `check` tells of them, the commands that use them warn, and `--strict` refuses.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn run(folder: &Path, arguments: &str) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_holdover-sim"));
    program.current_dir(folder).args(arguments.split_whitespace()).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A folder with a good drive and link of ten seconds, a drive with a hole, and a link on which nothing arrives.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| fs::write(folder.path().join(name), text).unwrap();
    let drive = |samples: &mut dyn Iterator<Item = u32>| -> String {
        let rows = samples.map(|n| format!("{},{n},10\n", f64::from(n) / 10.0));
        format!("t_s,position_m,speed_mps\n{}", rows.collect::<String>())
    };
    write("drive.csv", drive(&mut (0..=100)));
    write("hole.csv", drive(&mut (0..=100).filter(|n| !(30..70).contains(n))));
    let link = |delay: &str| -> String {
        let rows = (0..=100).map(|n| format!("{},{delay}\n", f64::from(n) / 10.0));
        format!("t_s,delay_s\n{}", rows.collect::<String>())
    };
    write("link.csv", link("0.02"));
    write("deaf.csv", link(""));
    write("milliseconds.csv", link("20"));
    write("semicolons.csv", "t_s;position_m;speed_mps\n0,0;0,0;10,0\n1,0;10,0;10,0\n".into());
    write("city.toml", "duration_s = 3\n[channel]\ntrace = \"milliseconds.csv\"\n".into());
    folder
}

const HOLE: &str =
    "hole.csv:32: no sample for 4.1 s from 2.9 s on, and what is between is drawn straight; split the recording here";

#[test]
fn check_passes_what_is_right_and_tells_what_is_not_file_by_file() {
    let folder = folder();
    let good = run(folder.path(), "check drive.csv link.csv");
    assert_eq!((good.status.code(), stderr(&good).as_str()), (Some(0), ""));
    let lines = "drive.csv: a drive of 10.0 s, 101 samples\nlink.csv: a link of 10.0 s, 101 messages, of which 101 arrive\n\
                 verdict: passed\n";
    assert_eq!(stdout(&good), lines);
    let bad = run(folder.path(), "check drive.csv hole.csv deaf.csv city.toml");
    assert_eq!((bad.status.code(), stderr(&bad).as_str()), (Some(1), ""));
    for line in [HOLE, "deaf.csv:2: no message arrives; ", "milliseconds.csv:2: a message takes 20 s in the median"] {
        assert!(stdout(&bad).contains(line), "{line}: {}", stdout(&bad));
    }
    assert!(stdout(&bad).ends_with("verdict: FAILED: 3 findings\n"), "{}", stdout(&bad));
}

#[test]
fn check_goes_on_after_a_file_that_cannot_be_used() {
    let folder = folder();
    let output = run(folder.path(), "check none.csv semicolons.csv hole.csv");
    assert_eq!(output.status.code(), Some(2));
    assert!(stdout(&output).contains(HOLE), "{}", stdout(&output));
    let said = "error: none.csv: cannot be read (No such file or directory); check the path\n\
                error: semicolons.csv:1: the header \"t_s;position_m;speed_mps\" has semicolons between its columns; write commas \
                between columns, and decimal points\n";
    assert_eq!(stderr(&output), said);
    let without = run(folder.path(), "check");
    assert_eq!(without.status.code(), Some(2));
}

#[test]
fn commands_warn_of_a_finding_in_one_line_and_in_the_report_and_strict_refuses() {
    let folder = folder();
    let commands = [
        "evaluate --motion hole.csv --outage 0.5",
        "evaluate --motion drive.csv --predecessor hole.csv --channel link.csv",
        "run --leader-motion hole.csv",
    ];
    for command in commands {
        let output = run(folder.path(), &format!("{command} --out report"));
        let warnings: Vec<String> =
            stderr(&output).lines().filter(|line| line.contains("warning")).map(Into::into).collect();
        assert_eq!(warnings, [format!("warning: {HOLE}")], "{command}");
        assert!(matches!(output.status.code(), Some(0 | 1)), "{command}");
        let page = fs::read_to_string(folder.path().join("report/index.html")).unwrap();
        assert!(page.contains(&format!("<b>Warning</b><ul><li>{HOLE}</li></ul>")), "{command}");
        let strict = run(folder.path(), &format!("{command} --no-report --strict"));
        assert_eq!((strict.status.code(), stdout(&strict).as_str()), (Some(2), ""), "{command}");
        assert_eq!(stderr(&strict), format!("error: {HOLE}\n"), "{command}");
    }
    let strict = run(folder.path(), "evaluate --motion drive.csv --channel link.csv --no-report --strict");
    assert_eq!((strict.status.code(), stderr(&strict).as_str()), (Some(0), ""));
    for command in ["sweep city.toml --seeds 1 --steps 1 --no-report", "envelope-cost city.toml --seeds 1 --no-report"]
    {
        let strict = run(folder.path(), &format!("{command} --strict"));
        assert_eq!(strict.status.code(), Some(2), "{command}");
        assert!(stderr(&strict).starts_with("error: milliseconds.csv:2: a message takes 20 s"), "{}", stderr(&strict));
    }
}

#[test]
fn a_link_without_a_delivery_fails_and_makes_no_table() {
    let folder = folder();
    let output = run(folder.path(), "evaluate --motion drive.csv --channel deaf.csv --no-report");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let text =
        "0 ticks, 101 messages sent, 0 delivered\nverdict: FAILED: no message of drive.csv arrives over deaf.csv\n";
    assert_eq!(stdout(&output), text);
    let output = run(folder.path(), "evaluate --motion drive.csv --channel milliseconds.csv --no-report --json");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let results: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(results["failures"][0], "no message of drive.csv arrives over milliseconds.csv");
    let output = run(folder.path(), "run --channel-trace deaf.csv --no-report");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stdout(&output).contains("no message arrives over deaf.csv"), "{}", stdout(&output));
    let output = run(folder.path(), "evaluate --motion drive.csv --outage 20 --no-report");
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).contains("FAILED: drive.csv is shorter than every silence"), "{}", stdout(&output));
}

#[test]
fn a_run_says_that_it_hears_a_short_recording_more_than_once() {
    let folder = folder();
    let said = "link.csv: lasts 10.1 s and the run 20.0 s, so it is repeated from 10.1 s on; shorten the run by `duration_s`, or give \
                a longer recording";
    let output = run(folder.path(), "run --channel-trace link.csv --no-report");
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), format!("warning: {said}\n")));
    let strict = run(folder.path(), "run --channel-trace link.csv --no-report --strict");
    assert_eq!((strict.status.code(), stderr(&strict)), (Some(2), format!("error: {said}\n")));
    fs::write(folder.path().join("ten.toml"), "duration_s = 10\n").unwrap();
    let long = run(folder.path(), "run ten.toml --channel-trace link.csv --no-report --strict");
    assert_eq!((long.status.code(), stderr(&long).as_str()), (Some(0), ""));
}

#[test]
fn each_command_has_a_folder_of_its_own() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    run(folder.path(), "run city.toml");
    let report = fs::read(at("holdover-report/index.html")).unwrap();
    let output = run(folder.path(), "evaluate --motion drive.csv --outage 1");
    assert!(stderr(&output).contains("report: holdover-report/evaluate/index.html"), "{}", stderr(&output));
    assert_eq!(fs::read(at("holdover-report/index.html")).unwrap(), report);
}

#[test]
fn a_report_says_where_it_comes_from() {
    let folder = folder();
    run(folder.path(), "evaluate --motion drive.csv --outage 1 --out report");
    let page = fs::read_to_string(folder.path().join("report/index.html")).unwrap();
    assert!(page.contains("<code>holdover-sim evaluate --motion drive.csv --outage 1 --out report</code>"));
    let sum = Command::new("sha256sum").arg("drive.csv").current_dir(folder.path()).output().unwrap();
    let sum = String::from_utf8(sum.stdout).unwrap();
    let sum = sum.split_whitespace().next().unwrap();
    assert!(page.contains(&format!("<dt>drive.csv</dt><dd>SHA-256 {sum}</dd>")), "{sum}");
    let version = stdout(&run(folder.path(), "--version"));
    let said = version.trim().strip_prefix("holdover-sim ").unwrap();
    assert!(page.contains(&format!("<dt>holdover-sim</dt><dd>{said}</dd>")), "{said}");
    assert!(said.contains(" (commit "), "{said}");
    run(folder.path(), "evaluate --motion drive.csv --outage 1 --out report");
    assert_eq!(fs::read_to_string(folder.path().join("report/index.html")).unwrap(), page);
}
