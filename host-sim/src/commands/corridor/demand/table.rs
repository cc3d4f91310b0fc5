//! The rows of a study over demand as text: figures enter, a table for a terminal leaves.

use std::fmt::Write;

use super::Row;
use crate::roads::capacity::Capacity;

/// A value with a digit behind the point.
pub(super) fn tenths(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.1}"))
}

/// The table, and what the busiest intersection can serve.
#[must_use]
pub fn text(rows: &[Row]) -> String {
    let mut text = String::from(
        "a minute  slots  side                               served  left over  collisions: road  area  outside  stops  mean s  \
         longest s  exits a minute  turned away\n",
    );
    for row in rows {
        let side = &row.side;
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{:8}{:7}  {:32}{:>9}{:11}{:18}{:6}{:9}{:7}{:>8}{:>11}{:>16}{:13}",
            row.vehicles_per_min,
            row.slots,
            row.condition(),
            side.served,
            side.unserved,
            side.collisions_on_roads,
            side.collisions_at_intersections,
            side.bound_violations,
            side.full_stops,
            tenths(side.mean_travel_time_s),
            tenths(side.longest_travel_time_s),
            tenths(row.exits_per_min),
            side.turned_away,
        );
    }
    text + &rows.first().and_then(|row| row.capacity.as_ref()).map_or(String::new(), limits)
}

/// What limits the demand.
fn limits(capacity: &Capacity) -> String {
    let mut text = format!("\nthe most that {} can serve, one vehicle at a time:\n", capacity.intersection);
    for (what, each_s, per_min) in lines(capacity) {
        let _ = writeln!(text, "{per_min:8.1}  {what}, {each_s:.2} s each");
    }
    text
}

/// The bounds: the name of each, the time for each vehicle, and the number of vehicles a minute.
pub(super) fn lines(capacity: &Capacity) -> [(&'static str, f64, f64); 3] {
    [
        ("by conflict time", capacity.conflict_s, capacity.alternating_per_min),
        ("by headway", capacity.headway_s, capacity.following_per_min),
        ("by what is claimed", capacity.claimed_s, capacity.claimed_per_min),
    ]
}
