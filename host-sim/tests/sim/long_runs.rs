//! A long run: its memory is bounded, its figures are of every tick, and so are its files.

use std::path::Path;
use std::process::Command;

use holdover_sim::input::impairment::Link;
use holdover_sim::input::scenario::{Overrides, Scenario};
use holdover_sim::measure::simulate::simulate_beside;
use holdover_sim::sim::world::MOST_TICKS;

/// 61,000 ticks of two vehicles.
const LONG: &str = "duration_s = 3050\nperiod_s = 0.05\n[[vehicle]]\n[[vehicle]]\n";

#[test]
fn what_a_run_keeps_does_not_grow_with_its_length() {
    let scenario = Scenario::parse(Path::new("long"), LONG, &Overrides::default()).unwrap();
    let (mut ticks, mut lowest_mps, mut most_frames) = (0, f64::INFINITY, 0);
    let each = |_, trace: &mut holdover_sim::sim::world::Trace, _| {
        ticks += 1;
        lowest_mps = trace.latest.iter().map(|tick| tick.speed_mps).fold(lowest_mps, f64::min);
        most_frames = most_frames.max(trace.log.len());
        trace.log.clear();
    };
    let (trace, summary) = simulate_beside(&scenario, 1, Some(1), each, |_| {}).unwrap();
    assert_eq!((ticks, summary.min_speed_mps), (61_000, Some(lowest_mps)));
    assert_eq!((trace.times_s.len(), trace.thinning.stride()), (30_500, 2));
    assert!(trace.times_s.len() <= MOST_TICKS && trace.vehicles.iter().all(|ticks| ticks.len() == trace.times_s.len()));
    assert_eq!(trace.paper.len(), trace.times_s.len());
    assert!(trace.times_s.windows(2).all(|pair| (pair[1] - pair[0] - 0.1).abs() < 1e-6));
    assert!(most_frames < 1000 && trace.log.len() < 1000, "{most_frames} frames, and {} at the end", trace.log.len());
    let link = trace.channel.link(Link { from: 0, to: 1 }).unwrap();
    assert!(link.counts.sent > 30_000 && link.messages.len() <= 18_000, "{} messages", link.messages.len());
}

#[test]
fn the_trace_of_a_long_run_has_every_tick_and_the_report_says_what_it_shows() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("long.toml"), LONG).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_holdover-sim"))
        .args(["run", "long.toml", "--out", "report", "--trace", "ticks.csv"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let ticks = std::fs::read_to_string(folder.path().join("ticks.csv")).unwrap();
    assert_eq!(ticks.lines().count(), 61_001);
    let page = std::fs::read_to_string(folder.path().join("report/index.html")).unwrap();
    assert!(page.contains("The run is long: figures over time are of one tick in 2."), "what is shown");
    assert!(page.len() < 3_000_000, "{} bytes", page.len());
}
