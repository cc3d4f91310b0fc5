//! The report of a run with hardware in the loop: options, outcome and results enter, an HTML page leaves.

use super::judge::Results;
use super::options::HilOptions;
use super::outcome::Outcome;
use super::table;
use crate::measure::figures::{gaps, speeds};
use crate::report::page::{Cell, Page};
use crate::report::plot::{Axis, Chart, Layer, Series, Tone};

/// Commands and ticks that are farther apart than this are not joined: there was none in between. The device's period is 0.01 s.
const JOINED_S: f64 = 0.05;

/// The page.
pub fn render(options: &HilOptions, outcome: &Outcome, results: &Results) -> Page {
    let mut page = Page::new("holdover-sim · hardware in the loop", &format!("The device in {}", options.name));
    let passed = "The device drove its vehicle as its twin would have, in time.".to_owned();
    let reasons = if results.reasons.is_empty() { vec![passed] } else { results.reasons.clone() };
    let reasons = match results.verdict {
        "inconclusive" => {
            let mut all = vec!["Inconclusive: the harness itself was not good enough to judge the device.".to_owned()];
            all.extend(reasons);
            all
        }
        _ => reasons,
    };
    page.verdict(results.verdict == "passed", &reasons);
    let text = table::text(results);
    let rows: Vec<Vec<Cell>> = text.lines().filter_map(row).collect();
    page.table("What was measured.", &["Figure", "Value"], &rows);
    faults(&mut page, results);
    page.section("Setup");
    page.facts(&facts(options));
    page.section("Course");
    let stride = outcome.recorded.trace.thinning.stride();
    if stride > 1 {
        page.paragraph(&format!(
            "The run is long: speed and gap are of one tick in {stride}. The figures of the table are of all."
        ));
    }
    figures(&mut page, options, outcome);
    page
}

/// The row of a line of the terminal's table: the figure's name, and after two blanks its value.
fn row(line: &str) -> Option<Vec<Cell>> {
    let (name, value) = line.trim_start().split_once("  ")?;
    Some(vec![Cell::text(name.trim()), Cell::text(value.trim())])
}

fn faults(page: &mut Page, results: &Results) {
    if results.faults.is_empty() {
        return;
    }
    let cells = |fault: &super::recovery::Recovery| {
        vec![
            Cell::text(fault.fault),
            Cell::number(format!("{} to {}", fault.from_s, fault.to_s)),
            Cell::text(fault.worst),
            Cell::limit(
                fault.recovered_after_s.map_or("never".into(), |after_s| format!("after {after_s:.2} s")),
                fault.reason().is_none(),
            ),
        ]
    };
    let rows: Vec<Vec<Cell>> = results.faults.iter().map(cells).collect();
    page.table("What became of the device in each fault.", &["Fault", "Time, s", "Worst", "Drove again"], &rows);
}

fn facts(options: &HilOptions) -> Vec<(String, String)> {
    let setup = &options.setup;
    vec![
        ("interface".into(), options.bus.clone()),
        ("mode".into(), if options.lock_step { "lock step" } else { "real time" }.into()),
        ("device".into(), options.device.clone().unwrap_or("somebody else's".into())),
        ("its station".into(), setup.config.station.0.to_string()),
        ("scenario".into(), options.name.clone()),
        ("seed".into(), setup.scenario.seed.to_string()),
        ("duration".into(), format!("{} s", setup.scenario.duration_s)),
    ]
}

fn figures(page: &mut Page, options: &HilOptions, outcome: &Outcome) {
    let ego = options.setup.scenario.ego;
    let joined_s = JOINED_S * outcome.recorded.trace.thinning.stride() as f64;
    let line = |name: &str, points: Vec<(f64, f64)>, tone| {
        Layer::line(Series::new(name, points).joined_within(joined_s), tone)
    };
    let speed = speeds(&outcome.recorded.trace).into_iter().nth(ego).unwrap_or_default();
    let ahead = speeds(&outcome.recorded.trace).into_iter().nth(ego - 1).unwrap_or_default();
    let gap = gaps(&options.setup.scenario, &outcome.recorded.trace).into_iter().nth(ego - 1).unwrap_or_default();
    let millis = |at: &super::monitor::CommandRecord| {
        at.latency.map(|latency| (outcome.time_of(at.at), latency.as_micros() as f64 * 1e-3))
    };
    let latency: Vec<(f64, f64)> =
        outcome.monitor.commands().iter().filter_map(millis).filter(|(at_s, _)| *at_s >= 0.0).collect();
    let chart = |title: &str, unit: &str, layers| {
        let description = format!("{title} over the time of the run");
        Chart { description, layers, ..Chart::new(title, Axis::linear("time", "s"), Axis::linear(title, unit)) }
    };
    let speeds =
        chart("speed", "m/s", vec![line("ego", speed, Tone::Ego), line("vehicle ahead", ahead, Tone::Other(0))]);
    let gaps = chart("gap", "m", vec![line("gap", gap, Tone::Ours)]);
    page.figure("Drive", "The ego under the device's commands, behind the simulated vehicle ahead.", &[&speeds, &gaps]);
    if options.lock_step {
        return;
    }
    let latency = chart("latency", "ms", vec![line("command", latency, Tone::Ours)]);
    page.figure(
        "Latency",
        "From the vehicle's motion on the bus to the device's command that rests on it.",
        &[&latency],
    );
}
