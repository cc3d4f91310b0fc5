//! The table of a sweep, for a terminal: rows enter, text leaves.

use std::fmt::Write;

use super::options::SweepOptions;
use super::rows::{Failure, Row};
use super::verdict;
use crate::report::markup::count;
use crate::report::sweep::PUBLISHED;

/// The table.
#[must_use]
pub fn text(options: &SweepOptions, rows: &[Row], failures: &[Failure]) -> String {
    let (first, last) = (options.seed, options.last_seed());
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "position error of the ego as its follower estimates it, m; seeds {first} to {last}");
    let _ = writeln!(text, "{:<8}{:>22}{:>24}{:>22}", "", "holdover", "literal paper", "cost of a tick");
    let _ = writeln!(
        text,
        "{:<8}{:>10}{:>12}{:>12}{:>12}{:>10}{:>12}",
        "step, s", "maximum", "99th pct.", "maximum", "99th pct.", "ns", "per s"
    );
    for row in rows {
        let _ = writeln!(
            text,
            "{:<8}{:>10}{:>12}{:>12}{:>12}{:>10}{:>12}",
            row.step_s,
            metres(row.ours.max_position_error_m),
            metres(row.ours.p99_position_error_m),
            metres(row.paper.max_position_error_m),
            metres(row.paper.p99_position_error_m),
            whole(row.timing.ns_per_tick),
            whole(row.timing.updates_per_s),
        );
    }
    let published = PUBLISHED.map(|(step_s, error_m)| format!("{error_m} m at {step_s} s")).join(", ");
    let _ = writeln!(text, "the paper reports a maximum of {published}");
    let _ = writeln!(text, "{}", verdict(options.runs(), failures));
    text
}

fn metres(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.4}"))
}

fn whole(value: f64) -> String {
    count(value.round() as u64)
}
