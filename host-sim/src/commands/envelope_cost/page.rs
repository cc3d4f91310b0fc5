//! The report of the envelope's cost: rows enter; an HTML page with a table and bars leaves.

use super::options::EnvelopeCostOptions;
use super::rows::{Row, Side};
use super::table::silence;
use crate::measure::bootstrap::spelled as interval;
use crate::report::markup::{count, quantity, significant};
use crate::report::page::{Cell, Page};
use crate::report::plot::{Axis, Bars, Tone};

const WHAT: &str = "The envelope is each unit’s last gate. In every tick it caps the acceleration so that the vehicle stays \
                    able to stop behind the nearest point at which the vehicle ahead can come to rest, by all that is \
                    certain of it. News moves that point; silence does not. So the longer the silence, the more careful the \
                    vehicle; without the envelope it drives on by the estimate.";

/// The page.
pub fn render(options: &EnvelopeCostOptions, rows: &[Row], failures: &[String]) -> Page {
    let mut page = Page::new("holdover-sim · report of the envelope’s cost", "What the envelope costs");
    let passed = "With the envelope nobody collided, and no target was ever outside its bound.".to_owned();
    page.verdict(failures.is_empty(), &if failures.is_empty() { vec![passed] } else { failures.to_vec() });
    table(&mut page, rows);
    page.paragraph(WHAT);
    page.section("Scenario");
    page.facts(&facts(options));
    page.command(&command(options));
    page.section("Cost");
    figures(&mut page, rows);
    page
}

fn table(page: &mut Page, rows: &[Row]) {
    let header = [
        "Silence",
        "Envelope",
        "Limited, %",
        "Travel time, s",
        "Stops per run",
        "Gap, m",
        "Braking, m/s²",
        "Collisions",
    ];
    let spelled = |value: Option<f64>| value.map_or("–".into(), |value| significant(value, 3));
    let cells = |row: &Row, name: String, envelope: &str, side: &Side| {
        vec![
            Cell::text(name),
            Cell::text(envelope),
            Cell::number(significant(100.0 * side.limited_share, 3)),
            Cell::number(match side.travel_time_interval_s {
                None => spelled(side.travel_time_s),
                some => format!("{} ({})", spelled(side.travel_time_s), interval(some, |time| significant(time, 4))),
            }),
            Cell::number(significant(stops_per_run(row, side), 3)),
            Cell::number(spelled(side.min_gap_m)),
            Cell::number(significant(side.hardest_braking_mps2, 3)),
            Cell::number(count(side.collisions as u64)),
        ]
    };
    let name = |row: &Row| row.silence_s.map_or("as recorded".into(), |length| format!("{length} s"));
    let pair = |row: &Row| [cells(row, name(row), "off", &row.off), cells(row, name(row), "on", &row.on)];
    let caption = "Time limited and travel time are of the vehicles whose link to the one ahead is impaired, gap and \
                   braking the worst of all runs. In parentheses: the interval of 95 % confidence over the seeds (bootstrap).";
    page.table(caption, &header, &rows.iter().flat_map(pair).collect::<Vec<_>>());
}

fn facts(options: &EnvelopeCostOptions) -> Vec<(String, String)> {
    let first = options.scenarios.first().map(|(_, scenario)| scenario);
    let mut facts = vec![
        ("seeds".into(), format!("{} to {}", options.seed, options.seed + (options.seeds - 1))),
        ("travel time over".into(), format!("{} m", options.distance_m)),
    ];
    if let Some(scenario) = first {
        let envelope = &scenario.envelope;
        facts.extend([
            ("vehicles".into(), scenario.vehicles.len().to_string()),
            ("period of the units".into(), format!("{} s", scenario.period_s)),
            ("emergency braking".into(), format!("{} m/s²", envelope.braking_mps2)),
            ("its jerk".into(), format!("{} m/s³", envelope.jerk_mps3)),
            ("margin".into(), format!("{} m", envelope.margin_m)),
        ]);
    }
    facts
}

fn command(options: &EnvelopeCostOptions) -> String {
    let mut words = vec!["holdover-sim envelope-cost".to_owned()];
    words.extend(options.scenario_file.as_ref().map(|file| file.display().to_string()));
    words.push(format!("--seed {} --seeds {}", options.seed, options.seeds));
    words.extend(options.arguments.iter().cloned());
    words.join(" ")
}

fn figures(page: &mut Page, rows: &[Row]) {
    let bars = |title: &str, unit: &str, value: &dyn Fn(&Row, &Side) -> Option<f64>| {
        let of = |side: fn(&Row) -> &Side| rows.iter().map(|row| value(row, side(row))).collect();
        Bars {
            title: title.into(),
            description: format!("{title} for each length of silence, without the envelope and with it."),
            x_label: "length of the silence (s)".into(),
            y: Axis::linear(title, unit),
            height: 150.0,
            groups: rows.iter().map(silence).collect(),
            methods: vec![
                ("without the envelope".into(), Tone::Idle, of(|row| &row.off)),
                ("with it".into(), Tone::Ours, of(|row| &row.on)),
            ],
        }
    };
    let limited = bars("time limited", "%", &|_, side| Some(100.0 * side.limited_share));
    let travel = bars("travel time", "s", &|_, side| side.travel_time_s);
    let stops = bars("full stops per run", "", &|row, side| Some(stops_per_run(row, side)));
    let braking = bars("hardest braking", "m/s²", &|_, side| Some(side.hardest_braking_mps2));
    let gap = bars("smallest gap", "m", &|_, side| side.min_gap_m);
    page.figure("Time", &say_time(rows), &[&limited, &travel]);
    page.figure("Comfort", &say_comfort(rows), &[&stops, &braking]);
    page.figure("Safety", &say_safety(rows), &[&gap]);
}

/// The longest silence, in words, and its row.
fn longest(rows: &[Row]) -> Option<(String, &Row)> {
    let row = rows.iter().max_by(|a, b| a.silence_s.unwrap_or(0.0).total_cmp(&b.silence_s.unwrap_or(0.0)))?;
    Some((
        row.silence_s.map_or("over the recorded channel".into(), |length| format!("in a silence of {length} s")),
        row,
    ))
}

fn say_time(rows: &[Row]) -> String {
    let Some((when, row)) = longest(rows) else { return "There is nothing to show.".into() };
    let limited = quantity(100.0 * row.on.limited_share, "%");
    let time = match (row.off.travel_time_s, row.on.travel_time_s) {
        (Some(_), Some(_)) if row.cost_interval_s.is_some_and(|[low, high]| low <= 0.0 && high >= 0.0) => {
            let range = interval(row.cost_interval_s, |time| significant(time, 3));
            format!("what it adds to the way of {} m cannot be told from nothing ({range} s)", row.distance_m)
        }
        (Some(off), Some(on)) if on >= off => {
            format!("the way of {} m takes {} longer with it", row.distance_m, quantity(on - off, "s"))
        }
        (Some(off), Some(on)) => {
            format!("the way of {} m takes {} less with it", row.distance_m, quantity(off - on, "s"))
        }
        _ => format!("not every vehicle comes {} m far", row.distance_m),
    };
    format!("The envelope limits the command for {limited} of the time {when}, and {time}.")
}

fn say_comfort(rows: &[Row]) -> String {
    let Some((when, row)) = longest(rows) else { return "There is nothing to show.".into() };
    let stops = |side: &Side| significant(stops_per_run(row, side), 3);
    let brakes = |side: &Side| quantity(side.hardest_braking_mps2, "m/s²");
    format!(
        "Full stops per run {when}: {} without the envelope, {} with it; the hardest braking is {} and {}.",
        stops(&row.off),
        stops(&row.on),
        brakes(&row.off),
        brakes(&row.on)
    )
}

fn say_safety(rows: &[Row]) -> String {
    let smallest = |side: fn(&Row) -> &Side| rows.iter().filter_map(|row| side(row).min_gap_m).reduce(f64::min);
    let spelled = |gap: Option<f64>| gap.map_or("–".into(), |gap| quantity(gap, "m"));
    format!(
        "The smallest gap of all runs is {} without the envelope and {} with it. A smaller gap with it is no contradiction: \
         behind a vehicle that has stopped, one stops nearer than one drives. Without it, what the one ahead does unseen \
         decides.",
        spelled(smallest(|row| &row.off)),
        spelled(smallest(|row| &row.on))
    )
}

fn stops_per_run(row: &Row, side: &Side) -> f64 {
    side.full_stops as f64 / row.seeds as f64
}
