//! The results of a corridor as text: figures enter, tables for a terminal leave.

use std::fmt::Write;

use super::Results;
use super::scale::Load;
use crate::roads::experiment::Sides;
use crate::roads::figures::Side;

/// A figure's name, and its text for a side.
pub type Line = (&'static str, fn(&Side) -> String);

fn number(value: Option<f64>, digits: usize) -> String {
    value.filter(|value| value.is_finite()).map_or("-".into(), |value| format!("{value:.digits$}"))
}

/// The figures in the order of the table.
pub const LINES: &[Line] = &[
    ("vehicles served", |side| side.served.to_string()),
    ("not served", |side| side.unserved.to_string()),
    ("collisions on roads", |side| side.collisions_on_roads.to_string()),
    ("collisions in conflict areas", |side| side.collisions_at_intersections.to_string()),
    ("full stops", |side| side.full_stops.to_string()),
    ("  emergency stops", |side| side.emergency_stops.to_string()),
    ("vehicles with a fault", |side| side.faults.to_string()),
    ("  drivers who took over", |side| side.takeovers.to_string()),
    ("mean travel time, s", Side::spelled_travel_time),
    ("longest travel time, s", |side| number(side.longest_travel_time_s, 1)),
    ("smallest gap on a road, m", |side| number(side.smallest_gap_m, 2)),
    ("shortest clearance, s", |side| number(side.smallest_clearance_s, 2)),
    ("lowest speed, m/s", |side| number(side.lowest_speed_mps, 2)),
    ("position error, max, m", |side| number(side.position_error.max_m, 3)),
    ("  of 99 % of the pairs, m", |side| number(side.pairs_p99_m, 3)),
    ("  pairs beyond 0.2 m", |side| side.pairs_beyond.to_string()),
    ("position error, rms, m", |side| number(side.position_error.rms_m, 4)),
    ("  within 1 s of a change, max", |side| number(side.position_error_after_change.max_m, 3)),
    ("  change not heard of, max", |side| number(side.position_error_unheard.max_m, 3)),
    ("entry time, off by, mean, s", |side| number(side.entry_error.mean_s, 2)),
    ("  standard deviation, s", |side| number(side.entry_error.std_s, 2)),
    ("changes of association", |side| side.association_changes.to_string()),
    ("order disagreements", |side| side.order_disagreements.to_string()),
    ("outside the bound, ticks", |side| side.bound_violations.to_string()),
    ("  by a clock that is off", |side| side.bound_violations_by_clock.to_string()),
    ("limited by the envelope, %", |side| format!("{:.1}", 100.0 * side.limited_share)),
];

/// The names of the sides, in the order of the table.
pub const SIDES: [&str; Sides::COUNT] =
    ["holdover", "perfect link", "drives alone", "with envelope", "… perfect link", "… emergencies"];

/// The tables.
#[must_use]
pub fn text(results: &Results) -> String {
    let mut text = String::new();
    let last = results.seed + (results.seeds as u64 - 1);
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{}: seeds {} to {last}", results.scenario, results.seed);
    if results.sensors.vehicles > 0 {
        let all = results.sides.holdover.served + results.sides.holdover.unserved;
        let _ = writeln!(text, "{} of {all} vehicles have a range sensor", results.sensors.vehicles);
    }
    let _ = write!(text, "{:30}", "");
    SIDES.iter().for_each(|side| {
        let _ = write!(text, "{side:>16}");
    });
    text.push('\n');
    for (name, of) in LINES {
        let _ = write!(text, "{name:30}");
        results.sides.all().iter().for_each(|side| {
            let _ = write!(text, "{:>16}", of(side));
        });
        text.push('\n');
    }
    if results.excerpts_with_envelope {
        text += "\nwith the envelope:\n";
    }
    let _ = writeln!(
        text,
        "\n{:22}{:>10}{:>10}{:>12}{:>12}",
        "what is wrong", "max, m", "rms, m", "travel, s", "collisions"
    );
    for row in &results.wrong {
        let error = row.side.position_error;
        let _ = writeln!(
            text,
            "{:22}{:>10}{:>10}{:>12}{:>12}",
            row.what,
            number(error.max_m, 3),
            number(error.rms_m, 4),
            number(row.side.mean_travel_time_s, 2),
            row.side.collisions()
        );
    }
    let _ = writeln!(text, "\nwith the envelope, so many vehicles without passes:");
    let _ =
        writeln!(text, "{:>22}{:>10}{:>12}{:>12}{:>12}", "share, %", "served", "travel, s", "full stops", "collisions");
    for row in &results.without_passes {
        let _ = writeln!(
            text,
            "{:>22.0}{:>10}{:>12}{:>12}{:>12}",
            100.0 * row.share,
            row.side.served,
            number(row.side.mean_travel_time_s, 2),
            row.side.full_stops,
            row.side.collisions()
        );
    }
    if !results.steps.is_empty() {
        let _ = writeln!(text, "\n{:22}{:>10}{:>10}{:>12}", "step, s", "max, m", "rms, m", "updates/s");
        for row in &results.steps {
            let error = row.side.position_error;
            let cost = results.timing.cost.iter().find(|cost| cost.step_s == row.step_s);
            let updates = cost.map_or("-".into(), |cost| format!("{:.0}", cost.updates_per_s));
            let _ = writeln!(
                text,
                "{:22}{:>10}{:>10}{updates:>12}",
                row.step_s,
                number(error.max_m, 3),
                number(error.rms_m, 4)
            );
        }
    }
    text += &scale(&results.timing.scale);
    let verdict = if results.failures.is_empty() { "passed" } else { "failed" };
    let _ = writeln!(text, "\nverdict: {verdict}");
    results.failures.iter().for_each(|failure| {
        let _ = writeln!(text, "  {failure}");
    });
    text
}

/// The columns of the table of the simulation's speed.
pub const SCALE: [&str; 8] = [
    "vehicles",
    "corridors",
    "cores had",
    "peers heard",
    "wall, s",
    "× real time",
    "vehicle s / s",
    "µs / vehicle s, peer",
];

/// A row of that table. The first cell has the intended and the true number of vehicles.
#[must_use]
pub fn scale_row(load: &Load) -> [String; 8] {
    [
        format!("{} ({:.1})", load.vehicles, load.under_way),
        load.corridors.to_string(),
        number(load.cores, 2),
        format!("{:.1}", load.peers_heard),
        format!("{:.2}", load.wall_s),
        format!("{:.1}", load.times_real_time),
        format!("{:.0}", load.vehicle_seconds_per_s),
        number(Some(load.us_per_vehicle_second_and_peer), 1),
    ]
}

/// Whether the cost is in proportion, in words. Empty for fewer than two numbers of vehicles, and if no vehicle was
/// heard.
#[must_use]
pub fn proportion(loads: &[Load]) -> Option<String> {
    let ([first, ..], [.., last]) = (loads, loads) else { return None };
    let grown = last.us_per_vehicle_second_and_peer / first.us_per_vehicle_second_and_peer;
    let is_known = [first, last].iter().all(|load| load.us_per_vehicle_second_and_peer.is_finite());
    (loads.len() > 1 && is_known).then(|| {
        let (many, few) = (last.vehicles, first.vehicles);
        format!("{many} vehicles cost {grown:.2} times as much per vehicle and peer heard as {few} do")
    })
}

fn scale(loads: &[Load]) -> String {
    let Some(said) = proportion(loads).or_else(|| (!loads.is_empty()).then(String::new)) else { return String::new() };
    let mut text = String::from("\n");
    let rows = std::iter::once(SCALE.map(str::to_owned)).chain(loads.iter().map(scale_row));
    for [first, rest @ ..] in rows {
        let _ = write!(text, "{first:14}");
        rest.iter().zip(&SCALE[1..]).for_each(|(cell, name)| {
            let _ = write!(text, "{cell:>width$}", width = name.chars().count() + 2);
        });
        text.push('\n');
    }
    text + &said + if said.is_empty() { "" } else { "\n" }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(vehicles: usize, peers_heard: f64) -> Load {
        Load {
            vehicles,
            corridors: 1,
            threads: 1,
            under_way: vehicles as f64,
            peers_heard,
            wall_s: 0.1,
            times_real_time: 300.0,
            vehicle_seconds_per_s: 300.0,
            cores: None,
            us_per_vehicle_second_and_peer: 1e3 / peers_heard,
        }
    }

    #[test]
    fn the_cost_per_peer_heard_is_compared_where_there_is_one() {
        let said = proportion(&[load(10, 4.0), load(300, 2.0)]);
        assert_eq!(said.unwrap(), "300 vehicles cost 2.00 times as much per vehicle and peer heard as 10 do");
        assert_eq!(proportion(&[load(10, 4.0)]), None);
        assert_eq!(proportion(&[]), None);
    }

    #[test]
    fn where_nobody_is_heard_nothing_is_said() {
        for loads in [[load(1, 0.0), load(2, 0.5)], [load(1, 0.5), load(2, 0.0)], [load(1, 0.0), load(2, 0.0)]] {
            assert_eq!(proportion(&loads), None);
            let text = scale(&loads);
            assert!(!text.contains("inf") && !text.contains("NaN") && !text.contains("times as much"), "{text}");
        }
        assert_eq!(scale_row(&load(1, 0.0))[7], "-");
    }
}
