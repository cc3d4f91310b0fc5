//! Places for output are checked before the work, results are printed before a file is written, and a file is written whole or not at all.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

const DRIVE: &str = "t_s,position_m,speed_mps\n0,0,10\n1,10,10\n2,20,10\n";

fn run(folder: &Path, arguments: &str) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_holdover-sim"));
    program.current_dir(folder).args(arguments.split_whitespace()).output().unwrap()
}

/// The program where no file may be larger than 4 KiB: what a full disk is to it.
fn run_with_little_room(folder: &Path, arguments: &str) -> Output {
    let script = format!("trap '' XFSZ; ulimit -f 4; exec {} {arguments}", env!("CARGO_BIN_EXE_holdover-sim"));
    Command::new("bash").current_dir(folder).args(["-c", &script]).output().unwrap()
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("drive.csv"), DRIVE).unwrap();
    fs::write(folder.path().join("short.toml"), "duration_s = 3").unwrap();
    folder
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_folder_that_cannot_be_created_is_refused_before_the_work() {
    let folder = folder();
    let commands = [
        "string",
        "sweep",
        "gains",
        "motions",
        "envelope-cost",
        "braking",
        "run corridor",
        "run short.toml",
        "evaluate --motion drive.csv --outage 1",
        "hil --bus none0",
    ];
    for (place, cause) in [
        ("/proc/nope", "\"/proc/nope\" cannot be written (No such file or directory); name a folder"),
        ("drive.csv/sub", "\"drive.csv\" is a file"),
    ] {
        for command in commands {
            let start = Instant::now();
            let output = run(folder.path(), &format!("{command} --out {place}"));
            assert_eq!(output.status.code(), Some(2), "{command}: {}", stderr(&output));
            assert!(stderr(&output).starts_with(&format!("error: --out: {cause}")), "{command}: {}", stderr(&output));
            assert_eq!(stderr(&output).lines().count(), 1, "{command}");
            assert!(start.elapsed() < Duration::from_secs(10), "{command} worked first");
        }
    }
}

#[test]
fn a_file_that_cannot_be_written_is_refused_before_the_work() {
    let folder = folder();
    let cases = [
        ("run short.toml --no-report --trace /proc/nope", "--trace: \"/proc/nope\" cannot be written"),
        ("run short.toml --no-report --candump /proc/nope", "--candump: \"/proc/nope\" cannot be written"),
        ("run corridor --no-report --picture /proc/nope", "--picture: \"/proc/nope\" cannot be written"),
        ("gains --no-report --write /proc/nope", "--write: \"/proc/nope\" cannot be written"),
        (
            "evaluate --motion drive.csv --outage 1 --no-report --trace /proc/nope",
            "--trace: \"/proc/nope\" cannot be written",
        ),
    ];
    for (arguments, cause) in cases {
        let output = run(folder.path(), arguments);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments}: {}", stderr(&output));
        assert!(stderr(&output).starts_with(&format!("error: {cause}")), "{arguments}: {}", stderr(&output));
    }
}

#[test]
fn a_full_disk_leaves_the_old_files_and_the_results_have_been_printed() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("report")).unwrap();
    for name in ["report/index.html", "ticks.csv", "bus.log"] {
        fs::write(at(name), "old").unwrap();
    }
    let commands = ["--out report", "--no-report --trace ticks.csv", "--no-report --candump bus.log"];
    for command in commands {
        let output = run_with_little_room(folder.path(), &format!("run short.toml {command}"));
        assert_eq!(output.status.code(), Some(2), "{command}: {}", stderr(&output));
        assert!(stderr(&output).contains("cannot be written (File too large)"), "{command}: {}", stderr(&output));
        assert!(String::from_utf8_lossy(&output.stdout).contains("verdict: passed"), "{command}");
    }
    for name in ["report/index.html", "ticks.csv", "bus.log"] {
        assert_eq!(fs::read_to_string(at(name)).unwrap(), "old", "{name}");
    }
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| !name.to_string_lossy().starts_with('.')), "{left:?}");
}

#[test]
fn a_file_that_cannot_be_written_keeps_no_other_away() {
    let folder = folder();
    let output =
        run_with_little_room(folder.path(), "evaluate --motion drive.csv --outage 1 --out report --trace ticks.csv");
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let trace = fs::read_to_string(folder.path().join("ticks.csv")).unwrap();
    assert!(trace.lines().count() > 2 && trace.ends_with('\n'), "{trace}");
}

#[test]
fn a_kill_in_the_middle_leaves_the_old_file() {
    use std::process::Stdio;
    let folder = folder();
    let file = folder.path().join("ticks.csv");
    fs::write(&file, "old").unwrap();
    let arguments = "run --set duration_s=86400 --no-report --trace ticks.csv";
    // Not INT, which a shell lets its jobs in the background ignore.
    for signal in ["TERM", "KILL"] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_holdover-sim"));
        program.current_dir(folder.path()).args(arguments.split_whitespace()).stderr(Stdio::null());
        let mut child = program.stdout(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(500));
        assert!(child.try_wait().unwrap().is_none(), "it was to be in the middle of a day");
        let killed = Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status().unwrap();
        assert!(killed.success() && !child.wait().unwrap().success());
        assert_eq!(fs::read_to_string(&file).unwrap(), "old", "{signal}");
    }
}

#[test]
fn a_trace_can_be_read_through_a_pipe() {
    let folder = folder();
    let output = run(folder.path(), "run short.toml --no-report --json --trace /dev/stderr");
    assert_eq!(output.status.code(), Some(0));
    assert!(stderr(&output).contains("t_s,true_position_m"), "{}", stderr(&output));
}
