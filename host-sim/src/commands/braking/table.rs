//! The table of `braking`, for a terminal: rows enter, text leaves.

use std::fmt::Write;

use super::rows::{Comfort, Row, Side};
use crate::verdict::Verdict;

const NOTES: &str =
    "avoidable: pairs in which the vehicle behind could have come to rest, had it begun to brake in time;
known at once: the same, had it begun with the vehicle ahead (--help)
";

/// The table.
#[must_use]
pub fn text(rows: &[Row], failures: &[String]) -> String {
    let mut text = String::new();
    let Some(first) = rows.first() else { return text };
    // Writing to a string cannot fail.
    let _ =
        writeln!(text, "ten vehicles behind a leader that brakes to a stop in a silence; seeds each: {}", first.seeds);
    let heads = ["gap, m", "braking, m/s²", "jerk, m/s³", "collisions", "avoidable", "known at once"];
    let _ = write!(text, "{:<13}{:<15}{:<11}", "time gap, s", "leader, m/s²", "envelope");
    text.extend(heads.map(|head| format!("{head:>15}")));
    text.push('\n');
    for row in rows {
        let names = [row.time_gap_s.to_string(), row.braking_mps2.to_string()];
        line(&mut text, &names, "(leader)", &felt(&row.leader, String::new(), Default::default()));
        line(&mut text, &Default::default(), "off", &cells(&row.off));
        line(&mut text, &Default::default(), "on", &cells(&row.on));
    }
    text.push_str(NOTES);
    let _ = writeln!(text, "{}", Verdict::of(failures).line(failures));
    text
}

fn cells(side: &Side) -> [String; 6] {
    let gap = side.min_gap_m.map_or("-".into(), |gap| format!("{gap:.2}"));
    let counts = [side.collisions, side.avoidable, side.avoidable_at_once].map(|count| count.to_string());
    felt(&side.comfort, gap, counts)
}

fn felt(comfort: &Comfort, gap: String, [collisions, avoidable, at_once]: [String; 3]) -> [String; 6] {
    let Comfort { hardest_braking_mps2, largest_jerk_mps3 } = comfort;
    [gap, format!("{hardest_braking_mps2:.2}"), format!("{largest_jerk_mps3:.1}"), collisions, avoidable, at_once]
}

fn line(text: &mut String, [time_gap, braking]: &[String; 2], envelope: &str, cells: &[String]) {
    let _ = write!(text, "{time_gap:<13}{braking:<15}{envelope:<11}");
    text.extend(cells.iter().map(|cell| format!("{cell:>15}")));
    while text.ends_with(' ') {
        text.pop();
    }
    text.push('\n');
}
