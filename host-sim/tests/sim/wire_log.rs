//! The log of a simulated bus is one that a wire could have carried.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use embedded_can::{Frame as _, Id};
use holdover::time::{Duration, Instant};
use holdover::wire::Slot;
use holdover::wire::catalogue::{CATALOGUE, Line};
use holdover_sim::bus::Frame;
use holdover_sim::bus::candump::{Content, LogReader};
use holdover_sim::bus::wire::length;

/// Three bits at 500 kbit/s.
const INTERMISSION: Duration = Duration::from_micros(6);

fn ran(arguments: &[&str]) {
    let output = Command::new(env!("CARGO_BIN_EXE_holdover-sim")).args(arguments).output().unwrap();
    assert!(output.status.code().is_some_and(|code| code <= 1), "{}", String::from_utf8_lossy(&output.stderr));
}

fn read(file: &Path) -> Vec<(Instant, Frame)> {
    let frame = |content| if let Content::Frame(frame) = content { frame } else { panic!("a classic frame") };
    let entries = LogReader::open(file).unwrap().map(Result::unwrap);
    entries.map(|entry| (entry.at.unwrap(), frame(entry.content))).collect()
}

/// The log of a run.
fn log(folder: &Path, arguments: &[&str]) -> Vec<(Instant, Frame)> {
    let file = folder.join("bus.log");
    ran(&[arguments, &["--no-report", "--candump", file.to_str().unwrap()]].concat());
    read(&file)
}

fn number(frame: &Frame) -> u16 {
    if let Id::Standard(id) = frame.id() { id.as_raw() } else { panic!("a standard identifier") }
}

/// The largest load of the windows of this length, of those that begin with a frame.
fn highest_load(log: &[(Instant, Frame)], window: Duration) -> f64 {
    let spans: Vec<(Instant, Instant)> = log.iter().map(|(end, frame)| (end.minus(length(frame)), *end)).collect();
    let load = |first: usize| {
        let to = spans[first].0.plus(window);
        let within = spans[first..].iter().take_while(|(start, _)| *start < to);
        within.map(|(start, end)| to.min(*end).since(*start).as_micros()).sum::<i64>()
    };
    (0..spans.len()).map(load).max().unwrap_or(0) as f64 / window.as_micros() as f64
}

#[test]
fn in_a_log_of_a_string_one_frame_ends_after_the_other() {
    let folder = tempfile::tempdir().unwrap();
    could_have_been(&log(folder.path(), &["--seed", "3"]));
}

#[test]
fn in_a_log_of_a_string_over_can_fd_too() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = folder.path().join("fd.toml");
    std::fs::write(&scenario, "duration_s = 30\n[bus]\nkind = \"fd\"\n").unwrap();
    could_have_been(&log(folder.path(), &["run", scenario.to_str().unwrap()]));
}

#[test]
fn in_a_log_of_a_corridor_too() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = short_corridor(folder.path());
    could_have_been(&log(folder.path(), &["run", &scenario, "--candump-vehicle", "3"]));
}

/// The corridor with arrivals of 20 s.
fn short_corridor(folder: &Path) -> String {
    let scenario = folder.join("short.toml");
    let text = std::fs::read_to_string("scenarios/corridor.toml").unwrap();
    std::fs::write(&scenario, text.replacen("duration_s = 600.0", "duration_s = 20.0", 1)).unwrap();
    scenario.to_str().unwrap().to_owned()
}

#[test]
fn every_message_that_anybody_sends_is_in_the_log_of_a_shipped_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let logs = [
        log(folder.path(), &["run", "storm", "--candump-vehicle", "3"]),
        log(folder.path(), &["run", &short_corridor(folder.path()), "--candump-vehicle", "3"]),
    ];
    let offsets: BTreeSet<u16> = logs.iter().flatten().map(|(_, frame)| number(frame) - 0x480).collect();
    // A simulated vehicle that tells where it is on the globe tells its route too, and its modem sends that.
    let is_expected = |line: &&Line| line.is_sent() && line.name != "Peer{slot}Position";
    for line in CATALOGUE.iter().filter(is_expected) {
        let slots = if line.is_per_slot() { 16 } else { 1 };
        let is_logged = (0..slots).any(|slot| offsets.contains(&line.offset_for(Slot(slot))));
        assert!(is_logged, "{}", line.name);
    }
}

/// A wire could have carried it: no frame begins before the one before it has ended, and no window of 10 ms is loaded by more than
/// all of it. A third of the frames follow one with a lower identifier without a pause, as frames do that waited together.
fn could_have_been(log: &[(Instant, Frame)]) {
    assert!(log.len() > 10_000, "{}", log.len());
    let load = highest_load(log, Duration::from_millis(10));
    assert!((0.2..=1.0).contains(&load), "{load}");
    let mut at_once = 0;
    for pair in log.windows(2) {
        let [(before, first), (end, frame)] = pair else { unreachable!() };
        let pause = end.since(*before).minus(length(frame));
        assert!(pause >= INTERMISSION, "{pair:?}");
        at_once += usize::from(pause == INTERMISSION && number(first) < number(frame));
    }
    assert!(3 * at_once > log.len(), "{at_once} of {}", log.len());
}
