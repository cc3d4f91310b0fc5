//! The log of a simulated bus is one that a wire could have carried, and has all that was sent.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use embedded_can::{Frame as _, Id};
use holdover::time::{Duration, Instant};
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

/// The logs of a run, with the times of the wire and with those of sending.
fn logs(folder: &Path, arguments: &[&str]) -> [Vec<(Instant, Frame)>; 2] {
    ["wire", "sent"].map(|times| {
        let file = folder.join(times);
        ran(&[arguments, &["--no-report", "--candump", file.to_str().unwrap(), "--candump-times", times]].concat());
        read(&file)
    })
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
fn a_log_of_a_string_has_every_frame_once_one_after_the_other_by_identifier() {
    let folder = tempfile::tempdir().unwrap();
    could_have_been(logs(folder.path(), &["--seed", "3"]), Duration::from_millis(10));
}

#[test]
fn a_log_of_a_string_over_can_fd_has_so_too() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = folder.path().join("fd.toml");
    std::fs::write(&scenario, "duration_s = 30\n[bus]\nkind = \"fd\"\n").unwrap();
    could_have_been(logs(folder.path(), &["run", scenario.to_str().unwrap()]), Duration::from_millis(10));
}

#[test]
fn a_log_of_a_corridor_has_every_frame_once_one_after_the_other_by_identifier() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = folder.path().join("short.toml");
    let text = std::fs::read_to_string("scenarios/corridor.toml").unwrap();
    std::fs::write(&scenario, text.replacen("duration_s = 600.0", "duration_s = 20.0", 1)).unwrap();
    let run = ["run", scenario.to_str().unwrap(), "--candump-vehicle", "3"];
    could_have_been(logs(folder.path(), &run), Duration::from_millis(20));
}

/// The first log is the second one as a wire would have carried it. No frame waits longer than `longest`.
fn could_have_been([wire, sent]: [Vec<(Instant, Frame)>; 2], longest: Duration) {
    assert!(sent.len() > 10_000, "{}", sent.len());
    let window = Duration::from_millis(10);
    assert!(highest_load(&wire, window) <= 1.0);
    let at_once = sent.windows(2).filter(|pair| pair[0].0 == pair[1].0).count();
    assert!(2 * at_once > sent.len(), "{at_once}");
    for pair in wire.windows(2) {
        let [(before, _), (end, frame)] = pair else { unreachable!() };
        assert!(end.since(*before) >= length(frame).plus(INTERMISSION), "{pair:?}");
    }
    // Each frame's instant of sending: frames of one identifier keep their order, so the n-th is the n-th.
    let of = |log: &[(Instant, Frame)]| {
        let mut by_number: Vec<(u16, usize, Instant, Frame)> =
            log.iter().enumerate().map(|(place, (at, frame))| (number(frame), place, *at, *frame)).collect();
        by_number.sort_by_key(|(number, place, ..)| (*number, *place));
        by_number
    };
    let (ours, theirs) = (of(&wire), of(&sent));
    assert_eq!(ours.len(), theirs.len());
    let mut most = Duration::ZERO;
    let mut wanted = vec![Instant::from_micros(0); wire.len()];
    for ((_, place, end, frame), (_, _, at, same)) in ours.iter().zip(&theirs) {
        assert_eq!(frame, same);
        let waited = end.since(*at).minus(length(frame));
        most = most.max(waited);
        assert!(waited >= Duration::ZERO, "{} us", waited.as_micros());
        wanted[*place] = *at;
    }
    assert!(most <= longest, "{} us", most.as_micros());
    // Of the frames that wait when a frame starts, none has a lower identifier; and the bus rests only if none waits.
    let mut waiting = BTreeSet::new();
    let mut coming: Vec<usize> = (0..wire.len()).collect();
    coming.sort_by_key(|place| wanted[*place]);
    let mut coming = coming.into_iter().peekable();
    let mut free = Instant::from_micros(0);
    for (place, (end, frame)) in wire.iter().enumerate() {
        let start = end.minus(length(frame));
        while let Some(next) = coming.next_if(|next| wanted[*next] <= start) {
            waiting.insert((number(&wire[next].1), next));
        }
        assert_eq!(waiting.pop_first(), Some((number(frame), place)));
        assert_eq!(start, wanted[place].max(free));
        free = end.plus(INTERMISSION);
    }
}
