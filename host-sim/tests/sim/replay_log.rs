//! What logs `replay` reads, what it makes of their times, and how it refuses those that cannot be replayed.

use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use holdover::time::Instant;
use holdover_sim::bus::Frame;
use holdover_sim::bus::candump::LogReader;
use holdover_sim::bus::port::{BusError, Event, Port};
use holdover_sim::commands::replay::onto_bus;

fn holdover_sim(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_holdover-sim")).args(arguments).output().unwrap()
}

/// Replays that log from a file called `bus.log` in a folder that it is run in.
fn replay(log: &[u8], arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bus.log"), log).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_holdover-sim"));
    command.current_dir(folder.path()).args(["replay", "bus.log"]).args(arguments).output().unwrap()
}

fn summary(log: &[u8], arguments: &[&str]) -> serde_json::Value {
    let output = replay(log, &[arguments, &["--json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The times of the commands that a unit on that bus sends.
fn ticks(log: &str, arguments: &[&str]) -> Vec<String> {
    let output = replay(log.as_bytes(), arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let lines = String::from_utf8(output.stdout).unwrap();
    lines.lines().filter_map(|line| Some(line.split_once(" 482#")?.0.to_owned())).collect()
}

#[test]
fn ticks_begin_with_the_first_frame_and_end_at_or_after_the_last() {
    let log = "(0000000005.000004) vcan3 123#00\n(0000000005.021000) vcan3 123#00\n";
    let at = |micros| format!("(0000000005.{micros:06}) vcan3");
    assert_eq!(ticks(log, &[]), [at(4), at(10_004), at(20_004), at(30_004)]);
    assert_eq!(ticks(log, &["--period", "0.02"]), [at(4), at(20_004), at(40_004)]);
    assert_eq!(ticks("(0.000000) vcan3 123#\n", &[]), ["(0000000000.000000) vcan3"]);
}

#[test]
fn the_screen_form_and_the_log_form_give_the_same() {
    let logged = "(1436509052.249713) can1 484#0102030405060708\n(1436509052.260000) can1 1F334455#AA\n";
    let shown = " (1436509052.249713)  can1  484   [8]  01 02 03 04 05 06 07 08   '........'\n\n \
                 (1436509052.260000)  can1  1F334455   [1]  AA\r\n";
    let (logged, shown) = (replay(logged.as_bytes(), &[]), replay(shown.as_bytes(), &[]));
    assert!(logged.status.success() && !logged.stdout.is_empty());
    assert_eq!(logged.stdout, shown.stdout);
}

#[test]
fn standard_input_is_read_like_a_file() {
    let log = b"(1.000000) can0 484#0102030405060708\n(1.500000) can0 123#\n";
    let mut child = Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
        .args(["replay", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(log).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(output.stdout, replay(log, &[]).stdout);
}

#[test]
fn other_interfaces_are_ignored() {
    let log = b"(1.000000) can0 123#\n(90000.000000) can1 484#0102030405060708\n(1.010000) can0 123#\n";
    let of_can0 = summary(log, &[]);
    assert_eq!((&of_can0["ignored"], &of_can0["ticks"]), (&3.into(), &2.into()));
    let of_can1 = summary(log, &["--interface", "can1"]);
    assert_eq!((&of_can1["ignored"], &of_can1["ticks"]), (&2.into(), &1.into()));
    assert_eq!(of_can1["refused"].as_object().unwrap().values().next(), Some(&1.into()));
    let output = replay(log, &["--interface", "can7"]);
    let message = "error: bus.log: has no frame on interface \"can7\"; give one that it has, such as \"can0\"\n";
    assert_eq!(String::from_utf8(output.stderr).unwrap(), message);
}

#[test]
fn a_second_of_disorder_is_replayed() {
    let log = b"(10.000000) can0 123#\n(9.000000) can0 123#\n(10.020000) can0 123#\n";
    assert_eq!(summary(log, &[])["ticks"], 3);
}

#[test]
fn what_is_no_log_ends_with_one_line_and_exit_code_2() {
    let good = "(10.000000) can0 123#00\n";
    let cases: [(&[u8], &str); 15] = [
        (b"", "bus.log: has no frames; give a log as `candump -l` writes it"),
        (b"\n\n  \n", "bus.log: has no frames; give a log as `candump -l` writes it"),
        (b"\x7fELF\x02\x01\x01\0\0\xff\xfe", "bus.log:1: is not text; give a log as `candump -l` writes it"),
        (b"\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", "bus.log:1: \"\\u{0}\\u{0}"),
        (b"t_s,position_m,speed_mps\n0,0,0\n", "bus.log:1: \"t_s,position_m,speed_mps\" is no network interface"),
        (b"(10.0", "bus.log:1: the time begins with \"(10.0\""),
        (b"(10.000000) can0\n", "bus.log:1: the line is not complete; delete it"),
        (b"(10.000000) can0 12#00\n", "bus.log:1: "),
        (b"(10.000000) can0 123#0G\n", "bus.log:1: the data \"0G\" is not hexadecimal"),
        (b"(10.000000) can0 123#012\n", "bus.log:1: the data \"012\" has half a byte"),
        (b"(10.000000) can0 123#010203040506070809\n", "bus.log:1: 9 bytes of data"),
        (b"(1e1) can0 123#00\n", "bus.log:1: the time is \"1e1\""),
        (
            b"can0 123 [1] 00\n",
            "bus.log:1: the line has no time; record with `candump -l`, or on the screen with -t a, z or d",
        ),
        (
            b"(8.500000) can0 123#00\n",
            "bus.log:2: the time is 1.500 s before that of a line above; sort the log by time, or split it where its \
             clock was set",
        ),
        (
            b"(1700000000.000000) can0 123#00\n",
            "bus.log:2: the time is 1699999990.000 s after that of the line above; sort the log by time",
        ),
    ];
    for (number, (log, message)) in cases.into_iter().enumerate() {
        let mut log = log.to_vec();
        if message.starts_with("bus.log:2") {
            log.splice(..0, good.bytes());
        }
        let output = replay(&log, &["--summary"]);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(stderr.starts_with(&format!("error: {message}")), "case {number}: {stderr}");
        assert!(stderr.contains("; ") && stderr.ends_with('\n') && stderr.lines().count() == 1, "{stderr}");
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "case {number}");
    }
}

#[test]
fn options_that_cannot_be_are_refused_by_name() {
    let cases: [(&[&str], &str); 7] = [
        (&["--period", "0.2"], "--period: is 0.2; give seconds from 0.001 to 0.1"),
        (&["--period", "nan"], "--period: is NaN; give seconds from 0.001 to 0.1"),
        (&["--step", "0"], "--step: is 0; give seconds from 0.001 to 1"),
        (&["--vehicle", "2", "--step", "0"], "--step: `step_s` is 0; give seconds from 0.001 to 1"),
        (&["--vehicle", "5"], "--vehicle: there is no vehicle 5; give an index from 0 to 4"),
        (
            &["--base-id", "0x741"],
            "--base-id: the first identifier is 0x741; give one up to 0x740, so that the messages fit into 11 bits",
        ),
        (&["--interface", "a b"], "--interface: \"a b\" is no network interface; give a name as it stands in the log"),
    ];
    for (arguments, message) in cases {
        let output = replay(b"(1.000000) can0 123#\n", arguments);
        assert_eq!(String::from_utf8(output.stderr).unwrap(), format!("error: {message}\n"));
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    }
    for arguments in
        [&["--vehicle", "2", "--station", "3"][..], &["--vehicle", "2", "--period", "0.01"], &["--base-id", "x"]]
    {
        assert_eq!(replay(b"(1.000000) can0 123#\n", arguments).status.code(), Some(2), "{arguments:?}");
    }
    let output = holdover_sim(&["replay", "no.log"]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(stderr, "error: no.log: cannot be read (No such file or directory); check the path\n");
}

#[test]
fn help_gives_examples_and_the_rules_of_time() {
    let help = String::from_utf8(holdover_sim(&["replay", "--help"]).stdout).unwrap();
    for wanted in ["Examples:", "Time:", "--summary", "--base-id", "Exit codes:"] {
        assert!(help.contains(wanted), "{wanted}");
    }
}

/// A second of a bus, in the form of candump's screen with `-t z` or `-t d`, or with times since 1970.
fn screen(form: char) -> String {
    let (mut log, mut last) = (String::new(), 0);
    for number in 0..120_u64 {
        let at = number * 10_000 + if number % 3 == 0 { 0 } else { 137 };
        let time = match form {
            'a' => format!("{:010}.{:06}", 1_436_509_052 + at / 1_000_000, at % 1_000_000),
            'z' => format!("{:03}.{:06}", at / 1_000_000, at % 1_000_000),
            _ => format!("{:03}.{:06}", (at - last) / 1_000_000, (at - last) % 1_000_000),
        };
        last = at;
        log += &format!(" ({time})  can1  484   [8]  01 02 03 04 05 06 07 08\n");
    }
    log
}

#[test]
fn differences_and_times_since_the_first_frame_are_the_same_drive() {
    let [absolute, zero, differences] = ['a', 'z', 'd'].map(|form| summary(screen(form).as_bytes(), &[]));
    assert_eq!((&absolute["ticks"], &absolute["frames"]), (&121.into(), &120.into()));
    for other in [&zero, &differences] {
        for key in ["frames", "ticks", "refused", "recognised", "ignored"] {
            assert_eq!(other[key], absolute[key], "{key}");
        }
    }
    let [zero, differences] = ['z', 'd'].map(|form| replay(screen(form).as_bytes(), &[]).stdout);
    assert!(!zero.is_empty() && zero == differences);
}

#[test]
fn differences_that_are_all_alike_are_differences() {
    let log = " (000.000000)  can0  123   [0] \n".to_owned() + &" (000.010000)  can0  123   [0] \n".repeat(50);
    assert_eq!(summary(log.as_bytes(), &[])["ticks"], 51);
}

#[test]
fn differences_of_two_interfaces_count_from_line_to_line() {
    let log = " (000.000000)  can0  123   [0] \n (000.030000)  can1  123   [0] \n (000.020000)  can0  123   [0] \n \
               (000.010000)  can0  123   [0] \n";
    assert_eq!(summary(log.as_bytes(), &[])["ticks"], 7);
}

#[test]
fn two_frames_that_changed_places_do_not_make_times_since_the_first_frame_differences() {
    let good = screen('z');
    let mut lines: Vec<&str> = good.split_inclusive('\n').collect();
    lines.swap(30, 31);
    assert_eq!(summary(lines.concat().as_bytes(), &[])["ticks"], 121);
}

#[test]
fn a_log_of_another_bus_is_told_from_one_in_which_nothing_happened() {
    let said = |log: &[u8], arguments: &[&str]| {
        let output = replay(log, &[&["--summary"], arguments].concat());
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stderr).unwrap()
    };
    let warning = "warning: none of 1 frames is for the unit; ";
    assert_eq!(said(b"(1.0) can0 123#00\n", &[]), format!("{warning}give --base-id or --place\n"));
    let fd = b"(1.0) can0 484##50102030405060708090A0B0C\n";
    assert_eq!(said(fd, &[]), format!("{warning}the log has CAN FD frames: give --fd\n"));
    assert_eq!(said(b"(1.0) can0 484#0102030405060708\n", &[]), "");
}

#[test]
fn a_log_that_ends_within_a_line_says_which_one_to_delete() {
    let whole = b"(1436509052.249713) can1 484#0102030405060708\n(1436509052.250000) can1 484#0102030405060708";
    for length in [56, 60, 68, 73, 76] {
        let output = replay(&whole[..length], &["--summary"]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(said, "error: bus.log:2: the line is not complete; delete it\n", "{length}");
    }
}

#[test]
fn a_mistake_behind_the_first_relative_times_has_its_line() {
    let log = " (000.000000)  can0  123   [0] \n\n (000.010000)  can0  123   [1]\n";
    let output = replay(log.as_bytes(), &["--summary"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(
        (output.status.code(), said.as_str()),
        (Some(2), "error: bus.log:3: the line is not complete; delete it\n")
    );
}

#[test]
fn logs_of_other_tools_are_refused_by_name_with_the_way_to_convert_them() {
    let folder = tempfile::tempdir().unwrap();
    let asc = b"date Thu Apr 20 10:44:05 2023\nbase hex  timestamps absolute\n";
    let trc = b";$FILEVERSION=1.1\n;$STARTTIME=45036.4\n";
    let cases: [(&str, &[u8], &str); 7] = [
        (
            "drive.asc",
            asc,
            "is an ASC log, and no candump log; convert it with python-can: python -m can.logconvert drive.asc drive.log",
        ),
        (
            "drive.blf",
            b"LOGG\x90\0\0\0\x02\xff",
            "is a BLF log, and no candump log; convert it with python-can: python -m can.logconvert drive.blf drive.log",
        ),
        (
            "drive.TRC",
            trc,
            "is a TRC log, and no candump log; convert it with python-can: python -m can.logconvert drive.TRC drive.log",
        ),
        (
            "drive.mf4",
            b"MDF     4.10    \x9a\x01",
            "is an MF4 log, and no candump log; convert it with python-can: python -m can.logconvert drive.mf4 drive.log (it needs asammdf)",
        ),
        // Without the right name, by its content; and without content that is known, by its name.
        (
            "renamed.log",
            b"LOGG\x90\0\0\0\x02\xff",
            "is a BLF log, and no candump log; convert it with python-can: python -m can.logconvert IN.blf OUT.log",
        ),
        (
            "old.trc",
            b"    1)  1059900002 Rx         0300  7  00 00 00 00 04 00 00\n",
            "is a TRC log, and no candump log; convert it with python-can: python -m can.logconvert old.trc old.log",
        ),
        (
            "my drive.asc",
            asc,
            "is an ASC log, and no candump log; convert it with python-can: python -m can.logconvert IN.asc OUT.log",
        ),
    ];
    for (name, content, message) in cases {
        std::fs::write(folder.path().join(name), content).unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_holdover-sim"));
        let output = command.current_dir(folder.path()).args(["replay", name]).output().unwrap();
        assert_eq!(String::from_utf8(output.stderr).unwrap(), format!("error: {name}: {message}\n"));
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{name}");
    }
    // A candump log may have any name.
    std::fs::write(folder.path().join("good.asc"), "(1.000000) can0 123#\n").unwrap();
    let good = folder.path().join("good.asc");
    assert_eq!(holdover_sim(&["replay", good.to_str().unwrap()]).status.code(), Some(0));
}

#[test]
fn frames_of_the_other_kind_of_bus_are_ignored_or_with_fd_refused_for_their_length() {
    let folder = tempfile::tempdir().unwrap();
    let log = |kind: &str| {
        let (scenario, log) = (folder.path().join("scenario.toml"), folder.path().join(format!("{kind}.log")));
        std::fs::write(&scenario, format!("duration_s = 2\n[bus]\nkind = \"{kind}\"\n")).unwrap();
        let [scenario, file] = [&scenario, &log].map(|path| path.to_str().unwrap());
        assert!(holdover_sim(&["run", scenario, "--no-report", "--candump", file]).status.success());
        std::fs::read(&log).unwrap()
    };
    let (classic, fd) = (log("classic"), log("fd"));
    let ignored = summary(&fd, &[]);
    assert!(ignored["frames"] == ignored["ignored"] && ignored["frames"].as_u64() > Some(100), "{ignored}");
    let refused = summary(&classic, &["--fd"]);
    let causes: Vec<&str> = refused["refused"].as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!((causes, refused["recognised"].as_object().unwrap().len()), (vec!["length"], 0), "{refused}");
}

/// A bus that keeps what is sent.
struct Kept(Vec<Frame>);

impl Port for Kept {
    fn now(&self) -> Instant {
        Instant::from_micros(0)
    }

    fn send(&mut self, frame: Frame) -> io::Result<()> {
        self.0.push(frame);
        Ok(())
    }

    fn send_error(&mut self, _: BusError) -> io::Result<()> {
        Ok(())
    }

    fn wait(&mut self, _: Instant) -> io::Result<Option<(Instant, Event)>> {
        Ok(None)
    }
}

#[test]
fn frames_of_can_fd_are_put_on_a_bus_and_error_frames_are_left_out() {
    let log = "(1.000000) can0 123#AB\n(1.000000) can0 123##5AABBCC\n(1.000000) can0 20000040#0000000000000000\n";
    let mut port = Kept(Vec::new());
    let file = Path::new("bus.log");
    let sent = onto_bus::play(&mut port, None, file, LogReader::new(file, log.as_bytes())).unwrap();
    assert_eq!((sent.frames, port.0.iter().map(Frame::is_fd).collect::<Vec<_>>()), (2, vec![false, true]));
}

#[test]
fn the_help_says_what_becomes_of_can_fd() {
    let help = String::from_utf8(holdover_sim(&["replay", "--help"]).stdout).unwrap();
    for said in ["those of CAN FD too; error frames are left out", "with --fd also one of classic CAN (length)"] {
        assert!(help.contains(said), "{said}");
    }
    assert!(!help.contains("error frames and CAN FD are left out"));
}
