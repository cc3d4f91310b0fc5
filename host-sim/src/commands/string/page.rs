//! The report of string stability: rows enter, an HTML page with a table and curves leaves.

use super::options::StringOptions;
use super::rows::{LIMIT, Mean, Row, Smallest, smallest};
use super::table::{not_run, ratio, runs, shipped};
use crate::measure::bootstrap::spelled;
use crate::report::page::{Cell, Page};
use crate::report::plot::{Axis, Chart, Guide, Layer, Series, Tone};

const WHAT: &str = "Ten vehicles follow a leader that is disturbed. Shown is the largest ratio, over all disturbances, of a \
                    vehicle’s speed amplitude to its predecessor’s. Below 1 a disturbance dies out along the string; above \
                    1 it grows, and the last vehicle brakes for what the first hardly felt.";

const MIXED: &str = "People drive some of the vehicles, and the command below says which. The ratios are those of the others, which a unit \
                     drives. The other methods are not run, because each of them drives every vehicle of a string.";

const CHANCE: &str = "Which messages are lost decides what a step passes on, so the largest ratio grows with the number of \
                      seeds, and the verdict is of these runs and no others.";

/// The page.
pub fn render(options: &StringOptions, rows: &[Row], failures: &[String]) -> Page {
    let mut page = Page::new("holdover-sim · report of string stability", "What a string makes of a disturbance");
    let passed = format!("With holdover no ratio is above {LIMIT} in {}.", runs(options, rows));
    page.verdict(failures.is_empty(), &if failures.is_empty() { vec![passed] } else { failures.to_vec() });
    page.paragraph(WHAT);
    if !options.has_cars_alone() {
        let kinds: Vec<&str> = options.kinds.iter().map(|kind| kind.name()).collect();
        page.paragraph(&format!("The followers are of these kinds, in turn: {}.", kinds.join(", ")));
    }
    if options.mixture.is_mixed() {
        page.paragraph(MIXED);
    }
    page.paragraph(&format!("{}. {CHANCE}", runs(options, rows)));
    table(&mut page, rows);
    means(&mut page, rows);
    page.command(&options.command());
    if options.time_gaps_s.len() > 1 {
        smallest_gaps(&mut page, options, rows);
        over_time_gap(&mut page, options, rows);
    }
    for &time_gap_s in &options.time_gaps_s {
        let rows: Vec<&Row> = rows.iter().filter(|row| row.time_gap_s == time_gap_s).collect();
        over_delay(&mut page, time_gap_s, &options.losses, &rows);
        if options.disturbances.iter().any(|disturbance| disturbance.frequency_hz().is_some()) {
            over_frequency(&mut page, time_gap_s, options, &rows);
        }
    }
    page
}

/// The means over the runs, with their intervals. Bold is a method that differs from holdover in the whole interval, and
/// holdover where it passes on less than all others.
fn means(page: &mut Page, rows: &[Row]) {
    let number = |value: f64| format!("{value:.4}");
    let cells = |row: &Row| {
        let others = row.means.iter().skip(1);
        let is_least = |mean: &Mean| match mean.holdover_less_this_interval {
            Some([low, _]) => low > 0.0,
            None => {
                let mut highs = others.clone().map(|other| other.holdover_less_this_interval.map(|[_, high]| high));
                highs.all(|high| high.is_some_and(|high| high < 0.0))
            }
        };
        let cell = |mean: &Mean| {
            let text = match (mean.ratio, mean.ratio_interval) {
                (Some(ratio), None) => number(ratio),
                (Some(ratio), some) => format!("{} ({})", number(ratio), spelled(some, number)),
                (None, _) => "–".into(),
            };
            if is_least(mean) { Cell::strong(text) } else { Cell::number(text) }
        };
        let place = [row.time_gap_s, row.delay_s, row.loss].map(|value| Cell::number(value.to_string()));
        place.into_iter().chain(row.means.iter().map(cell)).collect::<Vec<_>>()
    };
    let header =
        ["Time gap, s", "Delay, s", "Loss", "Holdover", "As it stands", "Age times speed", "CACC", "Degraded CACC"];
    let caption = "The largest ratio of a run, in the mean over the runs, with its interval of 95 % confidence (bootstrap) where \
                   there are at least five runs. Bold: another method that passes on less than holdover in the whole interval of \
                   their difference; holdover, where it passes on less than each other one in that sense.";
    page.table(caption, &header, &rows.iter().map(cells).collect::<Vec<_>>());
}

fn table(page: &mut Page, rows: &[Row]) {
    let cells = |row: &Row| {
        let met = row.holdover.as_ref().is_none_or(|worst| worst.ratio <= LIMIT);
        let place = row.holdover.as_ref().map(|worst| format!("{}, vehicle {}", worst.disturbance, worst.vehicle));
        vec![
            Cell::number(row.time_gap_s.to_string()),
            Cell::number(row.delay_s.to_string()),
            Cell::number(row.loss.to_string()),
            Cell::judged(ratio(row.holdover.as_ref()), met),
            Cell::text(place.unwrap_or_default()),
            Cell::number(row.runs.to_string()),
            Cell::number(row.runs_above.to_string()),
            Cell::number(ratio(row.as_it_stands.as_ref())),
            Cell::number(ratio(row.age_times_speed.as_ref())),
            Cell::number(ratio(row.cacc.as_ref())),
            Cell::number(ratio(row.degraded_cacc.as_ref())),
        ]
    };
    let header = [
        "Time gap, s",
        "Delay, s",
        "Loss",
        "Holdover",
        "Where",
        "Runs",
        "Runs above",
        "As it stands",
        "Age times speed",
        "CACC",
        "Degraded CACC",
    ];
    let caption = "Largest ratio of a vehicle’s speed amplitude to its predecessor’s, with holdover; and without it, by the \
                   newest message as it stands, and moved on by its age times its speed; and with the controller of Ploeg et al. (IEEE T-ITS 16, 2015), \
                   which has a sensor without errors, and with that controller without messages.";
    page.table(caption, &header, &rows.iter().map(cells).collect::<Vec<_>>());
}

fn guide() -> Guide {
    Guide { at: LIMIT, label: format!("limit {LIMIT}") }
}

fn smallest_gaps(page: &mut Page, options: &StringOptions, rows: &[Row]) {
    let caption =
        format!("Smallest time gap of those that were run, in s, at and above which the ratio is at most {LIMIT}.");
    let or = |gap: Option<f64>, nothing: &str| Cell::number(gap.map_or(nothing.to_owned(), |gap| gap.to_string()));
    let said = |gap: Option<f64>| or(gap, not_run(options));
    let cells = |link: &Smallest| {
        vec![
            Cell::number(link.delay_s.to_string()),
            Cell::number(link.loss.to_string()),
            or(link.holdover_s, "none"),
            said(link.as_it_stands_s),
            said(link.age_times_speed_s),
            said(link.cacc_s),
            said(link.degraded_cacc_s),
        ]
    };
    let header = ["Delay, s", "Loss", "Holdover", "As it stands", "Age times speed", "CACC", "Degraded CACC"];
    page.table(&caption, &header, &smallest(rows).iter().map(cells).collect::<Vec<_>>());
}

fn over_time_gap(page: &mut Page, options: &StringOptions, rows: &[Row]) {
    let time_gaps_s = &options.time_gaps_s;
    let caption = "Largest ratio of all delays and losses over the time gap; the smallest at and above which it is within the \
                   limit is the smallest that can be shipped.";
    let line = |name: &str, tone: Tone, of: &dyn Fn(&Row) -> Option<f64>| {
        let largest =
            |time_gap_s: f64| rows.iter().filter(|row| row.time_gap_s == time_gap_s).filter_map(of).reduce(f64::max);
        let points = time_gaps_s.iter().filter_map(|&time_gap_s| Some((time_gap_s, largest(time_gap_s)?)));
        Layer::Line { series: Series::new(name, points), tone, marked: true }
    };
    let layers = vec![
        line("age times speed", Tone::Other(1), &|row| Some(row.age_times_speed.as_ref()?.ratio)),
        line("CACC", Tone::Other(2), &|row| Some(row.cacc.as_ref()?.ratio)),
        line("degraded CACC", Tone::Other(3), &|row| Some(row.degraded_cacc.as_ref()?.ratio)),
        line("holdover", Tone::Ours, &|row| Some(row.holdover.as_ref()?.ratio)),
    ];
    let axes = (Axis::linear("time gap", "s"), Axis::linear("largest ratio", "").including(1.0));
    let title = format!("Largest ratio over the time gap{}", shipped(options));
    let chart =
        Chart { description: caption.into(), layers, guides: vec![guide()], ..Chart::new(&title, axes.0, axes.1) };
    page.figure(&title, caption, &[&chart]);
}

fn over_delay(page: &mut Page, time_gap_s: f64, losses: &[f64], rows: &[&Row]) {
    let caption = "Largest ratio over the delay of the messages, for the largest share of them lost.";
    let Some(most) = losses.iter().copied().reduce(f64::max) else { return };
    let line = |name: &str, tone: Tone, of: &dyn Fn(&Row) -> Option<f64>| {
        let points = rows.iter().filter(|row| row.loss == most).filter_map(|row| Some((row.delay_s, of(row)?)));
        Layer::Line { series: Series::new(name, points), tone, marked: true }
    };
    let layers = vec![
        line("as it stands", Tone::Idle, &|row| Some(row.as_it_stands.as_ref()?.ratio)),
        line("age times speed", Tone::Other(1), &|row| Some(row.age_times_speed.as_ref()?.ratio)),
        line("CACC", Tone::Other(2), &|row| Some(row.cacc.as_ref()?.ratio)),
        line("degraded CACC", Tone::Other(3), &|row| Some(row.degraded_cacc.as_ref()?.ratio)),
        line("holdover", Tone::Ours, &|row| Some(row.holdover.as_ref()?.ratio)),
    ];
    let axes = (Axis::linear("delay", "s"), Axis::linear("largest ratio", "").including(1.0));
    let title = format!("Largest ratio over delay at a time gap of {time_gap_s} s");
    let chart =
        Chart { description: caption.into(), layers, guides: vec![guide()], ..Chart::new(&title, axes.0, axes.1) };
    page.figure(&title, caption, &[&chart]);
}

fn over_frequency(page: &mut Page, time_gap_s: f64, options: &StringOptions, rows: &[&Row]) {
    let caption = "Largest ratio with holdover over the driven frequency, for each delay, at the largest share lost.";
    let Some(most) = options.losses.iter().copied().reduce(f64::max) else { return };
    let points = |row: &Row| {
        let pairs = options.disturbances.iter().zip(&row.by_disturbance);
        pairs.filter_map(|(which, worst)| Some((which.frequency_hz()?, worst.as_ref()?.ratio))).collect::<Vec<_>>()
    };
    let layers = rows.iter().filter(|row| row.loss == most).enumerate().map(|(index, row)| Layer::Line {
        series: Series::new(format!("{} s", row.delay_s), points(row)),
        tone: Tone::Other(index % 7),
        marked: true,
    });
    let axes = (Axis::logarithmic("frequency", "Hz"), Axis::linear("largest ratio", "").including(1.0));
    let title = format!("Largest ratio over frequency at a time gap of {time_gap_s} s");
    let chart = Chart {
        description: caption.into(),
        layers: layers.collect(),
        guides: vec![guide()],
        ..Chart::new(&title, axes.0, axes.1)
    };
    page.figure(&title, caption, &[&chart]);
}
