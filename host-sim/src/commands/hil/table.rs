//! The verdict table, for a terminal: results enter, text leaves.

use std::fmt::Write;

use super::judge::Results;
use super::spread::Spread;

/// The table.
#[must_use]
pub fn text(results: &Results) -> String {
    let mut text = String::new();
    let Results { device, deviation, timing, scenario, .. } = results;
    // Writing to a string cannot fail.
    let mut row = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<38}{value:>24}");
    };
    row("device: commands", device.commands.to_string());
    let modes: Vec<String> = device.modes.iter().map(|(mode, count)| format!("{mode} {count}")).collect();
    row("  by mode", modes.join(", "));
    row("  latency p50 / p99 / max, ms", spread(&timing.latency));
    row("  missed periods", timing.missed_periods.to_string());
    row("  commands judged / disturbed", format!("{} / {}", timing.judged_commands, timing.disturbed_commands));
    row("  end-to-end errors", device.e2e_errors.to_string());
    let refused: Vec<String> = device.refusals.iter().map(|(cause, count)| format!("{cause} {count}")).collect();
    row("  refused by it", if refused.is_empty() { "nothing".into() } else { refused.join(", ") });
    if deviation.lock_step {
        row("twin: steps compared, bit for bit", deviation.ticks.to_string());
        row("  frames compared", deviation.frames.to_string());
        row("  frames that differ", deviation.different_frames.to_string());
    } else {
        row("twin: ticks compared", deviation.ticks.to_string());
        row("  position apart at most, m", format!("{:.4}", deviation.position_m));
        row("  speed apart at most, m/s", format!("{:.4}", deviation.speed_mps));
        row("  command apart at most, m/s²", format!("{:.4}", deviation.command_mps2));
        row("  ticks not explained by the stamps", deviation.unexplained.to_string());
    }
    for fault in &results.faults {
        let after = fault.recovered_after_s.map_or("never".into(), |after_s| format!("after {after_s:.2} s"));
        row(&format!("fault: {} at {} s", fault.fault, fault.from_s), format!("{}, drove {after}", fault.worst));
    }
    let metres = |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.3}"));
    row("scenario: largest position error, m", metres(scenario.ours.max_position_error_m));
    row("  smallest gap, m", metres(scenario.min_gap_m));
    row("  collisions", scenario.collisions.to_string());
    row("harness: late p50 / p99 / max, ms", spread(&timing.harness.lateness));
    row("  frames sent / lost", format!("{} / {}", timing.harness.frames, timing.harness.lost));
    let _ = writeln!(text, "{}", results.code().line(&results.reasons));
    text
}

fn spread(spread: &Spread) -> String {
    let millis = |value: Option<f64>| value.map_or("-".into(), |value| format!("{value:.2}"));
    format!("{} / {} / {}", millis(spread.p50_ms), millis(spread.p99_ms), millis(spread.max_ms))
}
