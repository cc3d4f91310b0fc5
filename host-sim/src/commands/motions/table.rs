//! The table of target motions, for a terminal: rows enter, text leaves.

use std::fmt::Write;

use super::rows::{Outcome, Row};
use crate::measure::baseline::spoken;
use crate::measure::bootstrap::spelled;
use crate::report::markup::significant;

/// The table.
#[must_use]
pub fn text(rows: &[Row]) -> String {
    let mut text = String::new();
    for row in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}: {}", row.motion, standing(row));
        let _ = writeln!(text, "{:<23}{:>33}{:>14}", "", "position error, m", "speed, m/s");
        let _ = writeln!(text, "{:<23}{:>11}{:>11}{:>11}{:>14}", "", "rms", "99 %", "maximum", "rms");
        for method in &row.methods {
            let _ = writeln!(
                text,
                "{:<23}{:>11.3}{:>11.3}{:>11.3}{:>14.3}",
                spoken(method.name),
                method.rms_position_m,
                method.p99_position_m,
                method.max_position_m,
                method.rms_speed_mps
            );
        }
        text.push('\n');
    }
    let losses: Vec<String> =
        rows.iter().filter(|row| row.standing == Outcome::Loses).map(|row| row.motion.to_string()).collect();
    let _ = writeln!(text, "holdover loses: {}", if losses.is_empty() { "nowhere".into() } else { losses.join("; ") });
    text
}

/// The unit beside the best of the other methods, in words.
#[must_use]
pub fn standing(row: &Row) -> String {
    let published = if row.published { "published" } else { "not published" };
    let (word, ratio, best) = (row.standing.word(), significant(row.ours_over_best, 3), spoken(row.best_baseline));
    let interval = spelled(row.ours_over_best_interval, |value| significant(value, 3));
    let interval = if interval.is_empty() { "too few silences for an interval".into() } else { interval };
    format!("{published}; holdover {word}, {ratio} times the rms of {best} ({interval})")
}
