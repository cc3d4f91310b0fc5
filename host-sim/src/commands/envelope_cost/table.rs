//! The table of the envelope's cost, for a terminal: rows enter, text leaves.

use std::fmt::Write;

use super::rows::{Row, Side};
use crate::verdict::Verdict;

/// The table.
#[must_use]
pub fn text(rows: &[Row], failures: &[String]) -> String {
    let mut text = String::new();
    let Some(first) = rows.first() else { return text };
    // Writing to a string cannot fail.
    let _ = writeln!(text, "seeds each: {}; travel time over {} m", first.seeds, first.distance_m);
    let heads = ["limited, %", "travel, s", "stops/run", "gap, m", "braking, m/s²", "collisions"];
    let _ = write!(text, "{:<11}{:<10}", "silence, s", "envelope");
    text.extend(heads.map(|head| format!("{head:>14}")));
    text.push('\n');
    for row in rows {
        line(&mut text, &silence(row), "off", &row.off, row.seeds);
        line(&mut text, "", "on", &row.on, row.seeds);
    }
    let _ = writeln!(text, "{}", Verdict::of(failures).line(failures));
    text
}

/// Name of a row's silence.
#[must_use]
pub fn silence(row: &Row) -> String {
    row.silence_s.map_or("recorded".into(), |length| length.to_string())
}

fn line(text: &mut String, silence: &str, envelope: &str, side: &Side, seeds: u64) {
    let number = |value: Option<f64>, digits: usize| value.map_or("-".into(), |value| format!("{value:.digits$}"));
    let cells = [
        number(Some(100.0 * side.limited_share), 2),
        number(side.travel_time_s, 2),
        number(Some(side.full_stops as f64 / seeds as f64), 2),
        number(side.min_gap_m, 2),
        number(Some(side.hardest_braking_mps2), 2),
        side.collisions.to_string(),
    ];
    let _ = write!(text, "{silence:<11}{envelope:<10}");
    text.extend(cells.map(|cell| format!("{cell:>14}")));
    text.push('\n');
}
