//! The report of a corridor: results and journals enter, an HTML page leaves.

use super::map;
use super::options::CorridorOptions;
use super::plots::{plots, scale};
use super::scale::{Load, SPAN_S};
use super::table::{LINES, SCALE, SIDES, proportion, scale_row};
use super::{Results, Sensors};
use crate::commands::motions;
use crate::report::page::{Cell, Page};
use crate::roads::experiment::{EXCERPT_S, Experiment};
use crate::roads::figures::StepRow;
use crate::roads::journal::Journal;
use crate::roads::shares::ShareRow;

/// The page.
#[must_use]
pub fn render(
    options: &CorridorOptions,
    experiment: &Experiment,
    results: &Results,
    steps: &[(StepRow, Journal)],
) -> Page {
    let mut page = Page::new("holdover-sim · report of a corridor", &options.name);
    page.verdict(results.failures.is_empty(), &reasons(results));
    let finest = steps.first().map(|(_, journal)| journal);
    if let Some(map) = finest.and_then(|journal| map::passage(experiment, journal)) {
        page.section("The passage");
        page.figure(&map.title, &map.description, &[&map]);
    }
    page.section("All sides");
    let header: Vec<&str> = ["Figure"].into_iter().chain(SIDES).collect();
    let row = |(name, of): &super::table::Line| {
        let cells = results.sides.all().into_iter().map(|side| Cell::number(of(side)));
        [Cell::text(name.trim())].into_iter().chain(cells).collect()
    };
    let caption = "All seeds together. Beside what the scenario describes, without the envelope: the same trips with a link \
                   without delay, loss and silence; with vehicles that drive alone while the link to whoever is just ahead is lost \
                   (an ideal range sensor and adaptive cruise control on the same road, the stop line at an intersection); with \
                   the envelope; with it over that perfect link; and with it, emergency stops and faults.";
    page.table(caption, &header, &LINES.iter().map(row).collect::<Vec<Vec<Cell>>>());
    page.section("Scenario");
    page.facts(&facts(options, &results.sensors));
    page.command(&options.command);
    page.section("Figures");
    let how = if results.excerpts_with_envelope { "with" } else { "without" };
    page.paragraph(&format!("Seed {}, arrivals of the first {EXCERPT_S} s, {how} the envelope.", results.seed));
    for plot in plots(experiment, results, steps) {
        page.figure(&plot.title, &plot.caption, &[&plot.chart]);
    }
    page.section("What is wrong");
    let spelled = |value: Option<f64>| value.map_or("–".into(), |value| format!("{value:.3}"));
    let rows = results.wrong.iter().map(|row| {
        vec![
            Cell::text(row.what.clone()),
            Cell::strong(spelled(row.side.position_error.max_m)),
            Cell::number(spelled(row.side.position_error.rms_m)),
            Cell::number(spelled(row.side.mean_travel_time_s)),
            Cell::number(row.side.collisions().to_string()),
        ]
    });
    let caption =
        "How the largest position error grows when every vehicle differs from what its unit believes and publishes.";
    page.table(
        caption,
        &["What is wrong", "Largest error, m", "rms, m", "Mean travel time, s", "Collisions"],
        &rows.collect::<Vec<_>>(),
    );
    without_passes(&mut page, &results.without_passes);
    page.section("Beside seven others, over what a target does in a silence");
    motions::section(&mut page, &results.motions);
    speed(&mut page, &results.timing.scale);
    page
}

/// The section on vehicles that keep no passes.
fn without_passes(page: &mut Page, rows: &[ShareRow]) {
    page.section("Shares without passes");
    let row = |row: &ShareRow| {
        let side = &row.side;
        let seconds = side.mean_travel_time_s.map_or("–".into(), |time| format!("{time:.2}"));
        vec![
            Cell::number(format!("{:.0} %", 100.0 * row.share)),
            Cell::number(side.served.to_string()),
            Cell::number(side.unserved.to_string()),
            Cell::strong(seconds),
            Cell::number(side.full_stops.to_string()),
            Cell::number(side.collisions().to_string()),
        ]
    };
    let caption = format!(
        "Arrivals of the first {EXCERPT_S} s, with the envelope. This share of the vehicles keeps no passes: others give way to them by \
         what is certain of them and by what is seen, and they to others."
    );
    let header = ["Without passes", "Served", "Not served", "Mean travel time, s", "Full stops", "Collisions"];
    page.table(&caption, &header, &rows.iter().map(row).collect::<Vec<_>>());
}

/// The section on the speed of the simulation.
fn speed(page: &mut Page, loads: &[Load]) {
    let Some(plot) = scale(loads) else { return };
    page.section("How fast this is simulated");
    let said = proportion(loads).map_or(String::new(), |said| format!(" {said}."));
    page.paragraph(&format!(
        "Corridors side by side, each with a seed of its own, as many as it takes until so many vehicles are under way on \
         average (in parentheses: were); {SPAN_S} s of them, once the roads are full.{said}"
    ));
    let rows: Vec<Vec<Cell>> = loads.iter().map(|load| scale_row(load).map(Cell::number).to_vec()).collect();
    page.table("Wall time on this machine, and how many cores the threads had of it.", &SCALE, &rows);
    page.figure(&plot.title, &plot.caption, &[&plot.chart]);
}

fn reasons(results: &Results) -> Vec<String> {
    if !results.failures.is_empty() {
        return results.failures.clone();
    }
    let side = &results.sides.holdover;
    let error = side.position_error.max_m.map_or("–".into(), |error| format!("{error:.3} m"));
    vec![format!(
        "No collision, {} vehicles served, {} full stop(s); a target's position was never off by more than {error}.",
        side.served, side.full_stops
    )]
}

pub(super) fn facts(options: &CorridorOptions, sensors: &Sensors) -> Vec<(String, String)> {
    let corridor = &options.corridor;
    let (radio, traffic) = (&corridor.radio, &corridor.traffic);
    let rate: f64 = corridor.roads.iter().map(|road| road.vehicles_per_min).sum();
    [
        ("seeds", options.seeds.len().to_string()),
        ("arrivals", format!("{rate:.1} a minute on {} roads, for {} s", corridor.roads.len(), corridor.duration_s)),
        ("intersections", corridor.intersections.len().to_string()),
        ("target speed", format!("{} m/s", traffic.target_speed_mps)),
        ("time gap", format!("{} s", traffic.time_gap_s)),
        ("prediction step δt", format!("{} s", corridor.step_s)),
        ("messages", format!("{} Hz", corridor.message_rate_hz)),
        (
            "every link",
            format!(
                "delay Normal({} s, {} s) truncated at 0, loss {} %, up to {} m",
                radio.delay_mean_s,
                radio.delay_std_s,
                radio.loss * 100.0,
                radio.range_m
            ),
        ),
        ("every vehicle", format!("silent for {} s from a random moment on", radio.dark_s)),
        ("range sensors", said(sensors)),
        ("envelope in the figures", if options.excerpts_with_envelope { "engaged" } else { "not engaged" }.to_owned()),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .to_vec()
}

/// The range sensors, in words.
fn said(sensors: &Sensors) -> String {
    if sensors.vehicles == 0 {
        return "none".to_owned();
    }
    let faults = &sensors.faults;
    format!(
        "share {}: {} vehicles, up to {} m, ±{} m and ±{} m/s; {} % of the views missing, {} dropouts of {} s and {} ghosts a \
         minute",
        sensors.share,
        sensors.vehicles,
        sensors.range_m,
        sensors.range_accuracy_m,
        sensors.range_speed_accuracy_mps,
        faults.misses * 100.0,
        faults.dropouts_per_min,
        faults.dropout_s,
        faults.ghosts_per_min
    )
}
