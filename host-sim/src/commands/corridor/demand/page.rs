//! The report of a study over demand: rows enter, an HTML page leaves.

use super::plots::plots;
use super::table::{lines, tenths};
use super::{Row, failures};
use crate::commands::corridor::Sensors;
use crate::commands::corridor::options::CorridorOptions;
use crate::commands::corridor::page::facts;
use crate::report::page::{Cell, Page};
use crate::roads::capacity::Capacity;

/// The page.
#[must_use]
pub fn render(options: &CorridorOptions, sensors: &Sensors, rows: &[Row]) -> Page {
    let failures = failures(rows);
    let mut page = Page::new("holdover-sim · report of a corridor over demand", &options.name);
    let passed = ["No collision on any side that is judged, and every vehicle was served.".to_owned()];
    page.verdict(failures.is_empty(), if failures.is_empty() { &passed } else { &failures });
    for slots in &options.slots {
        page.section(&format!("{slots} slots"));
        table(&mut page, rows, *slots);
        for plot in plots(rows, *slots) {
            page.figure(&plot.title, &plot.caption, &[&plot.chart]);
        }
    }
    if let Some(capacity) = rows.first().and_then(|row| row.capacity.as_ref()) {
        limits(&mut page, capacity);
    }
    page.section("Scenario");
    page.facts(&facts(options, sensors));
    page.command(&options.command);
    page
}

fn table(page: &mut Page, rows: &[Row], slots: usize) {
    let row = |row: &Row| {
        let side = &row.side;
        vec![
            Cell::text(row.vehicles_per_min.to_string()),
            Cell::text(row.condition()),
            Cell::number(side.served.to_string()),
            Cell::judged(side.unserved.to_string(), side.unserved == 0),
            Cell::judged(side.collisions().to_string(), side.collisions() == 0),
            Cell::number(side.full_stops.to_string()),
            Cell::strong(tenths(side.mean_travel_time_s)),
            Cell::number(tenths(side.longest_travel_time_s)),
            Cell::strong(tenths(row.exits_per_min)),
        ]
    };
    let header = [
        "Vehicles a minute",
        "Side",
        "Served",
        "Not served",
        "Collisions",
        "Full stops",
        "Mean travel time, s",
        "Longest, s",
        "Exits a minute",
    ];
    let caption = "All seeds together. First come, first served is with the envelope and without passes: every unit waits for near \
                   ends. Who drives alone is there to be compared with, and not judged.";
    let rows: Vec<Vec<Cell>> = rows.iter().filter(|row| row.slots == slots).map(row).collect();
    page.table(caption, &header, &rows);
}

/// The section on what the busiest intersection can serve.
fn limits(page: &mut Page, capacity: &Capacity) {
    page.section("What the busiest intersection can serve");
    page.paragraph(&format!(
        "{:.1} % of all vehicles pass {}. If they pass one at a time at the target speed, and never wait longer than they have to, the \
         demand is bounded. It may be {:.2} times as much if vehicles whose ways do not cross always pass together.",
        100.0 * capacity.share,
        capacity.intersection,
        capacity.abreast
    ));
    let row = |(what, each_s, per_min): (&str, f64, f64)| {
        vec![Cell::text(what), Cell::number(format!("{each_s:.2}")), Cell::number(format!("{per_min:.1}"))]
    };
    let caption = "Conflict time: from when a vehicle's front enters the area until its rear has left, and what the rules keep between \
                   two vehicles. Headway: what the law keeps between two vehicles. What is claimed: the conflict time, and what a unit \
                   claims before and after it.";
    page.table(caption, &["Bound", "Each vehicle, s", "Vehicles a minute"], &lines(capacity).map(row));
}
