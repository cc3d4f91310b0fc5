//! The short table of a run, for a terminal: figures enter, text leaves.

use std::fmt::Write;

use crate::input::scenario::Scenario;
use crate::measure::figures::{Errors, Summary};
use crate::verdict::Verdict;

/// The table.
pub fn text(scenario: &Scenario, summary: &Summary, failures: &[String]) -> String {
    let mut text = String::new();
    let name = match scenario.vehicles.len() > scenario.ego + 1 {
        true => "position error of the ego as its follower estimates it",
        false => "position error of the ego's target as the ego estimates it",
    };
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{name}, m");
    let _ = writeln!(text, "{:<26}{:>12}{:>16}", "", "holdover", "literal paper");
    let row = |text: &mut String, label: &str, of: fn(&Errors) -> Option<f64>| {
        let _ = writeln!(text, "{label:<26}{:>12}{:>16}", metres(of(&summary.ours)), metres(of(&summary.paper)));
    };
    row(&mut text, "  maximum", |errors| errors.max_position_error_m);
    row(&mut text, "  99th percentile", |errors| errors.p99_position_error_m);
    row(&mut text, "  rms", |errors| errors.rms_position_error_m);
    let _ = writeln!(text, "{:<26}{:>12}", "smallest gap, m", metres(summary.min_gap_m));
    let _ = writeln!(text, "{:<26}{:>12}", "lowest speed, m/s", metres(summary.min_speed_mps));
    let _ = writeln!(text, "{:<26}{:>12}", "full stops", summary.full_stops);
    let _ = writeln!(text, "{:<26}{:>12}", "collisions", summary.collisions);
    let _ = writeln!(text, "{:<26}{:>12}", "median width of bound, m", metres(summary.bound.median_width_m));
    let _ = writeln!(text, "{:<26}{:>12}", "ticks outside the bound", summary.bound.violations);
    if summary.envelope.engaged {
        let percent = format!("{:.1} %", 100.0 * summary.envelope.limited_share);
        let _ = writeln!(text, "{:<26}{percent:>12}", "limited by the envelope");
    }
    let _ = writeln!(text, "{:<26}{:>12.0}", "simulated s per s", summary.timing.realtime_factor);
    let _ = writeln!(text, "{}", Verdict::of(failures).line(failures));
    text
}

fn metres(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.4}"))
}
