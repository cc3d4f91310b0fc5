//! The table of string stability, for a terminal: rows enter, text leaves.

use std::fmt::Write;

use super::amplification::Worst;
use super::options::shipped_time_gap_s;
use super::rows::{LIMIT, Row, smallest_time_gap_s};

/// The table.
#[must_use]
pub fn text(rows: &[Row], failures: &[String]) -> String {
    let mut text = String::from("largest ratio of a vehicle's speed amplitude to its predecessor's\n");
    // Writing into a string cannot fail.
    let _ = writeln!(
        text,
        "{:<12}{:<10}{:<8}{:>10}  {:<22}{:>10}{:>14}{:>17}",
        "time gap, s", "delay, s", "loss", "holdover", "", "runs above", "as it stands", "age times speed"
    );
    for row in rows {
        let place = row.holdover.as_ref().map(|worst| format!("({}, vehicle {})", worst.disturbance, worst.vehicle));
        let _ = writeln!(
            text,
            "{:<12}{:<10}{:<8}{:>10}  {:<22}{:>10}{:>14}{:>17}",
            row.time_gap_s,
            row.delay_s,
            row.loss,
            ratio(row.holdover.as_ref()),
            place.unwrap_or_default(),
            row.runs_above,
            ratio(row.as_it_stands.as_ref()),
            ratio(row.age_times_speed.as_ref()),
        );
    }
    match smallest_time_gap_s(rows) {
        Some(gap) => {
            let shipped = shipped_time_gap_s();
            let _ = writeln!(
                text,
                "at most {LIMIT} at and above a time gap of {gap} s, of those that were tried; {shipped} s is shipped"
            );
        }
        None => {
            let _ = writeln!(text, "not so at the largest time gap that was tried");
        }
    }
    let verdict = if failures.is_empty() { "passed".into() } else { format!("FAILED: {}", failures.join("; ")) };
    let _ = writeln!(text, "verdict: {verdict}");
    text
}

/// A ratio to four digits.
#[must_use]
pub fn ratio(worst: Option<&Worst>) -> String {
    worst.map_or("-".into(), |worst| format!("{:.4}", worst.ratio))
}
