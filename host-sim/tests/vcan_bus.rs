//! A real CAN interface: `scripts/hil.sh tests` runs these under a kernel that has `vcan0`.
#![cfg(target_os = "linux")]

use embedded_can::{ExtendedId, Frame as _, StandardId};
use holdover::time::{Duration, Instant};
use holdover::wire::Identifier;
use holdover_sim::bus::port::{BusError, Event, Port};
use holdover_sim::bus::socketcan::SocketCan;
use holdover_sim::bus::{self, Bus, Frame};
use std::process::{Command, Output};

fn open() -> SocketCan {
    bus::open("vcan0").unwrap()
}

fn frame(id: u16, data: &[u8]) -> Frame {
    Frame::standard(id, data).unwrap()
}

/// Everything that happens within that time.
fn heard(port: &mut SocketCan, millis: i64) -> Vec<(Instant, Event)> {
    let until = port.now().plus(Duration::from_millis(millis));
    let mut events = Vec::new();
    while port.now() < until {
        events.extend(port.wait(until).unwrap());
    }
    events
}

fn events(port: &mut SocketCan) -> Vec<Event> {
    heard(port, 50).into_iter().map(|(_, event)| event).collect()
}

fn shell(command: &str) -> Output {
    Command::new("sh").args(["-c", command]).output().unwrap()
}

fn sim(arguments: &str) -> Output {
    shell(&format!("'{}' {arguments}", env!("CARGO_BIN_EXE_holdover-sim")))
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn every_kind_of_frame_arrives_as_it_was_sent_and_its_sender_is_told() {
    let (mut a, mut b) = (open(), open());
    let frames = [
        frame(0x123, &[1, 2, 3]),
        frame(0x7FF, &[]),
        Frame::extended(0x1234_5678, &[9; 8]).unwrap(),
        Frame::new_remote(StandardId::new(5).unwrap(), 4).unwrap(),
        Frame::new_remote(ExtendedId::new(0x10_0000).unwrap(), 0).unwrap(),
        Frame::fd(StandardId::new(0x490).unwrap(), 5, &[7; 64]).unwrap(),
        Frame::fd(ExtendedId::new(0x1234_5678).unwrap(), 5, &[1; 12]).unwrap(),
    ];
    for frame in frames {
        Port::send(&mut a, frame).unwrap();
    }
    assert_eq!(a.awaited(), frames.len());
    assert_eq!(events(&mut b), frames.map(Event::Received));
    assert_eq!(events(&mut a), frames.map(Event::Sent));
    assert_eq!(a.awaited(), 0);
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn a_frame_has_the_kernels_time_of_arrival_and_not_that_of_reading() {
    let (mut a, mut b) = (open(), open());
    let before = a.now();
    Port::send(&mut a, frame(1, &[])).unwrap();
    let after = a.now();
    std::thread::sleep(std::time::Duration::from_millis(60));
    for port in [&mut a, &mut b] {
        let (at, _) = heard(port, 20)[0];
        assert!(before <= at && at.since(after) < Duration::from_millis(30), "{before:?} {at:?} {after:?}");
    }
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn a_filter_passes_its_identifiers_of_any_length_and_kind() {
    let (mut a, b) = (open(), open());
    let standard = |id| Identifier::standard(id).unwrap();
    b.hear_only([standard(0x480), standard(0x7F), Identifier::extended(0x18FF_0201).unwrap()]).unwrap();
    let mut b = b;
    let remote = Frame::new_remote(StandardId::new(0x480).unwrap(), 8).unwrap();
    let [other, extended] = [0x480, 0x18FF_0201].map(|id| Frame::extended(id, &[3]).unwrap());
    for frame in [frame(0x480, &[1]), remote, frame(0x481, &[1]), other, extended, frame(0x7F, &[2; 8])] {
        Port::send(&mut a, frame).unwrap();
    }
    assert_eq!(events(&mut b), [frame(0x480, &[1]), remote, extended, frame(0x7F, &[2; 8])].map(Event::Received));
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn an_error_frame_is_reported_as_one() {
    let (mut a, mut b) = (open(), open());
    a.send_error(BusError::BUS_OFF).unwrap();
    shell("cansend vcan0 20000020#0000000000000000");
    assert_eq!(events(&mut b), [BusError::BUS_OFF, BusError::NO_ACKNOWLEDGEMENT].map(Event::Error));
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn as_a_bus_it_gives_the_others_frames_up_to_a_time_and_not_the_own_ones() {
    let (mut a, mut b) = (open(), open());
    let start = a.now();
    Bus::send(&mut a, start, frame(1, &[])).unwrap();
    Bus::send(&mut b, start, frame(2, &[])).unwrap();
    assert_eq!(b.receive(Instant::from_micros(0)).unwrap(), None);
    let (at, received) = b.receive(b.now()).unwrap().unwrap();
    assert_eq!((received, b.receive(b.now()).unwrap()), (frame(1, &[]), None));
    assert!(start <= at);
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn an_interface_that_goes_down_is_told_and_used_again_when_it_is_up() {
    let mut a = open();
    assert!(shell("ip link set vcan0 down").status.success());
    let refused = bus::open("vcan0").unwrap_err().to_string();
    assert_eq!(heard(&mut a, 50).iter().filter(|(_, event)| *event == Event::Down).count(), 1);
    let unsent = Port::send(&mut a, frame(1, &[])).unwrap_err();
    assert!(shell("ip link set vcan0 up").status.success());
    assert_eq!(unsent.kind(), std::io::ErrorKind::NetworkDown);
    assert_eq!(refused, "--bus: \"vcan0\" is down; as root: ip link set vcan0 up");
    let mut b = open();
    Port::send(&mut a, frame(2, &[])).unwrap();
    assert_eq!(events(&mut b), [Event::Received(frame(2, &[]))]);
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn what_cannot_be_opened_is_named_with_its_remedy() {
    let absent = bus::open("vcan7").unwrap_err().to_string();
    assert_eq!(
        absent,
        "--bus: there is no network interface \"vcan7\"; as root: modprobe vcan && ip link add dev vcan7 type vcan && ip \
         link set vcan7 up"
    );
    assert_eq!(bus::open("lo").unwrap_err().to_string(), "--bus: \"lo\" is no CAN interface; name one, such as vcan0");
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn a_second_of_a_full_bus_is_lost_by_nobody_who_looks_away() {
    let (mut a, mut b) = (open(), open());
    for number in 0..4000u32 {
        Port::send(&mut a, frame(0x100, &number.to_be_bytes())).unwrap();
    }
    let received = heard(&mut b, 3000);
    assert_eq!(received.len(), 4000);
    assert!(received.is_sorted_by_key(|(at, _)| *at));
    assert_eq!(heard(&mut a, 3000).len(), 4000);
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn a_recorded_log_replays_with_its_timing_for_can_utils_and_from_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (ours, again, theirs) = (path("ours.log"), path("again.log"), path("theirs.log"));
    let sim = env!("CARGO_BIN_EXE_holdover-sim");
    // A stranger's traffic, recorded by us; then replayed by us, recorded by candump.
    shell(&format!(
        "{sim} record --bus vcan0 --duration 4 -o {ours} & sleep 0.5; \
         for byte in 01 02 03 04 05; do cansend vcan0 123#$byte; sleep 0.1; done; cansend vcan0 12345678#R; wait"
    ));
    let out = shell(&format!(
        "candump -L -T 2000 vcan0 >{theirs} & sleep 0.3; {sim} replay {ours} --bus vcan0; wait; \
         {sim} record --bus vcan0 --duration 4 -o {again} & sleep 0.5; canplayer -I {theirs}; wait"
    ));
    let frames = |log: &str| -> Vec<(f64, String)> {
        let text = std::fs::read_to_string(log).unwrap();
        let line = |line: &str| {
            let words: Vec<&str> = line.split_whitespace().collect();
            (words[0].trim_matches(['(', ')']).parse().unwrap(), words[2].to_owned())
        };
        text.lines().map(line).collect()
    };
    let (ours, theirs, again) = (frames(&ours), frames(&theirs), frames(&again));
    assert_eq!(ours.len(), 6, "{out:?}");
    for log in [&theirs, &again] {
        assert_eq!(
            ours.iter().map(|(_, frame)| frame).collect::<Vec<_>>(),
            log.iter().map(|(_, frame)| frame).collect::<Vec<_>>()
        );
        let span = |log: &[(f64, String)]| log[5].0 - log[0].0;
        assert!((span(&ours) - span(log)).abs() < 0.1, "{} s and {} s", span(&ours), span(log));
    }
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn a_command_without_its_interface_ends_with_exit_code_2() {
    for command in ["record --bus vcan7", "ecu --bus vcan7", "hil --bus vcan7", "replay Cargo.toml --bus vcan7"] {
        let output = sim(command);
        assert_eq!(output.status.code(), Some(2), "{command}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.starts_with("error: --bus: there is no network interface \"vcan7\"; "), "{said}");
    }
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn a_recording_that_is_killed_has_all_but_the_last_moment() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("killed.log");
    let mut port = open();
    let mut recorder = Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
        .args(["record", "--bus", "vcan0", "--output"])
        .arg(&file)
        .spawn()
        .unwrap();
    heard(&mut port, 1_000);
    for count in 0..300_u16 {
        Port::send(&mut port, frame(0x123, &count.to_be_bytes())).unwrap();
        heard(&mut port, 5);
    }
    recorder.kill().unwrap();
    recorder.wait().unwrap();
    let log = std::fs::read_to_string(&file).unwrap();
    // A tenth of a second is 20 of them.
    assert!(log.ends_with('\n') && log.lines().count() > 250, "{}", log.lines().count());
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn can_fd_frames_are_recorded_as_candump_writes_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (ours, theirs) = (path("ours.log"), path("theirs.log"));
    let sim = env!("CARGO_BIN_EXE_holdover-sim");
    let out = shell(&format!(
        "candump -L -T 2000 vcan0 >{theirs} & {sim} record --bus vcan0 --duration 2 -o {ours} & sleep 0.7; \
         cansend vcan0 123##1AABBCC; cansend vcan0 12345678##3AABBCCDDAABBCCDDAA; cansend vcan0 124##0; \
         cansend vcan0 125#11; wait"
    ));
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    assert!(said.contains("4 frames recorded, 3 of them CAN FD"), "{said}");
    let (ours, theirs) = (std::fs::read_to_string(ours).unwrap(), std::fs::read_to_string(theirs).unwrap());
    assert_eq!(ours, theirs);
    assert_eq!(ours.lines().filter(|line| line.contains("##")).count(), 3);
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn a_recording_ends_by_sigterm_as_by_ctrl_c_with_all_frames_and_their_number() {
    for signal in ["TERM", "INT"] {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("ended.log");
        let recorder = Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
            .args(["record", "--bus", "vcan0", "--output"])
            .arg(&file)
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        let mut port = open();
        heard(&mut port, 700);
        for count in 0..300_u16 {
            Port::send(&mut port, frame(0x123, &count.to_be_bytes())).unwrap();
        }
        heard(&mut port, 20);
        shell(&format!("kill -{signal} {}", recorder.id()));
        let ended = recorder.wait_with_output().unwrap();
        let said = String::from_utf8(ended.stderr).unwrap();
        assert_eq!((ended.status.code(), said.as_str()), (Some(0), "300 frames recorded\n"), "{signal}");
        assert_eq!(std::fs::read_to_string(&file).unwrap().lines().count(), 300, "{signal}");
    }
}

#[test]
#[ignore = "needs vcan0: scripts/hil.sh tests"]
fn a_unit_ends_by_sigterm_as_by_ctrl_c_with_exit_code_0() {
    for (signal, how) in [("TERM", &[][..]), ("INT", &["--lock-step"])] {
        let mut unit =
            Command::new(env!("CARGO_BIN_EXE_holdover-sim")).args(["ecu", "--bus", "vcan0"]).args(how).spawn().unwrap();
        heard(&mut open(), 700);
        shell(&format!("kill -{signal} {}", unit.id()));
        assert_eq!(unit.wait().unwrap().code(), Some(0), "{signal}");
    }
}
