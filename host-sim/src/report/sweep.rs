//! The report of a sweep: a row of figures for each prediction step enters, an HTML page leaves.
//!
//! Except for the section on computing time, which is wall time, the same rows give the same bytes.

use super::{
    markup::{count, quantity, significant},
    page::{Cell, Page},
    plot::{Axis, Chart, Layer, Series, Tone},
    run::Verdict,
};
use crate::measure::bootstrap::{Interval, spelled};

/// The largest position errors that the paper reports: `(step in s, error in m)`.
pub const PUBLISHED: [(f64, f64); 2] = [(0.01, 0.2), (1.0, 5.8)];

const LITERAL: &str = "The literal paper keeps no standstill distance, and knows of no lag and no limit on acceleration \
                       and jerk; the simulated vehicles have all of these. Part of its error is that.";

/// The figures of one step; errors in metres, `None` where there was no estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepRow {
    /// Prediction step in seconds.
    pub step_s: f64,
    /// The unit's largest error.
    pub max_ours: Option<f64>,
    /// The unit's 99th percentile.
    pub p99_ours: Option<f64>,
    /// The literal paper's largest error.
    pub max_paper: Option<f64>,
    /// The literal paper's 99th percentile.
    pub p99_paper: Option<f64>,
    /// The rms of both, the unit's first.
    pub rms: [Option<f64>; 2],
    /// Their intervals over the seeds.
    pub rms_intervals: [Option<Interval>; 2],
    /// Whose rms is less, where the intervals say so: `holdover` or `paper`.
    pub less_rms: Option<&'static str>,
    /// Wall time of a tick in nanoseconds.
    pub ns_per_tick: f64,
}

/// The content of the page.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SweepReport {
    /// The page's title.
    pub title: String,
    /// The settings of the sweep: names and values.
    pub facts: Vec<(String, String)>,
    /// The verdict.
    pub verdict: Verdict,
    /// The command line that repeats this sweep.
    pub command: String,
    /// The rows, in any order of their steps.
    pub rows: Vec<SweepRow>,
}

impl SweepReport {
    /// The page, as one self-contained HTML document.
    pub fn render(&self) -> String {
        self.page().finish()
    }

    /// The page, to which more can be added.
    pub fn page(&self) -> Page {
        let mut rows = self.rows.clone();
        rows.sort_by(|a, b| a.step_s.total_cmp(&b.step_s));
        let mut page = Page::new("holdover-sim · report of a sweep", &self.title);
        page.verdict(self.verdict.passed, &self.verdict.reasons);
        errors_table(&mut page, &rows);
        intervals_table(&mut page, &rows);
        page.section("Scenario");
        page.facts(&self.facts);
        page.command(&self.command);
        page.section("Error over prediction step");
        errors_figure(&mut page, &rows);
        page.paragraph(LITERAL);
        page.section("Cost");
        cost_table(&mut page, &rows);
        cost_figure(&mut page, &rows);
        page
    }
}

fn errors_table(page: &mut Page, rows: &[SweepRow]) {
    let published = |step_s: f64| PUBLISHED.iter().find(|(at, _)| *at == step_s).map(|(_, error)| *error);
    let spelled = |value: Option<f64>| value.map_or("–".into(), |value| significant(value, 3));
    let better = |value: Option<f64>, other: Option<f64>| match (value, other) {
        (Some(value), Some(other)) if value <= other => Cell::strong(spelled(Some(value))),
        _ => Cell::number(spelled(value)),
    };
    let cells = |row: &SweepRow| {
        vec![
            Cell::number(format!("{} s", row.step_s)),
            better(row.max_ours, row.max_paper),
            better(row.p99_ours, row.p99_paper),
            better(row.max_paper, row.max_ours),
            better(row.p99_paper, row.p99_ours),
            Cell::number(spelled(published(row.step_s))),
        ]
    };
    let header =
        ["Step", "Ours, largest", "Ours, 99 %", "Literal paper, largest", "Literal paper, 99 %", "As published"];
    let caption = "Position error in metres: the largest of all runs, and the 99th percentile of all runs together, ours \
                   and the literal paper’s, the smaller in bold; and the largest that the paper reports.";
    page.table(caption, &header, &rows.iter().map(cells).collect::<Vec<_>>());
}

fn intervals_table(page: &mut Page, rows: &[SweepRow]) {
    let number = |value: f64| significant(value, 3);
    let cell = |row: &SweepRow, index: usize, name: &str| {
        let text = match (row.rms[index], row.rms_intervals[index]) {
            (Some(rms), None) => number(rms),
            (Some(rms), some) => format!("{} ({})", number(rms), spelled(some, number)),
            _ => "–".into(),
        };
        if row.less_rms == Some(name) { Cell::strong(text) } else { Cell::number(text) }
    };
    let cells = |row: &SweepRow| {
        vec![Cell::number(format!("{} s", row.step_s)), cell(row, 0, "holdover"), cell(row, 1, "paper")]
    };
    let caption = "Rms of the position error of all runs together in metres, with its interval of 95 % confidence over the seeds \
                   (bootstrap), where there are at least five. Bold is what is less in each of these draws but one in forty.";
    page.table(caption, &["Step", "Ours", "Literal paper"], &rows.iter().map(cells).collect::<Vec<_>>());
}

fn errors_figure(page: &mut Page, rows: &[SweepRow]) {
    let caption = say_errors(rows);
    let chart = |title: &str, up: &str, ours: fn(&SweepRow) -> Option<f64>, paper: fn(&SweepRow) -> Option<f64>| {
        let line = |name: &str, tone: Tone, of: fn(&SweepRow) -> Option<f64>| {
            let points = rows.iter().filter_map(|row| Some((row.step_s, of(row)?)));
            Layer::Line { series: Series::new(name, points), tone, marked: true }
        };
        let axes = (Axis::logarithmic("prediction step", "s"), Axis::logarithmic(up, "m"));
        let layers = vec![line("literal paper", Tone::Paper, paper), line("holdover", Tone::Ours, ours)];
        Chart { description: caption.clone(), layers, height: 260.0, ..Chart::new(title, axes.0, axes.1) }
    };
    let mut largest = chart("Largest position error", "largest error", |row| row.max_ours, |row| row.max_paper);
    let mark = |name: &str, point: (f64, f64)| {
        // A line of one point is a dot, with its label beside it.
        Layer::Line { series: Series::new(name, [point]), tone: Tone::Other(1), marked: true }
    };
    let [fine, coarse] = PUBLISHED;
    largest.layers.extend([mark("", fine), mark("as published", coarse)]);
    let percentile =
        chart("99th percentile of the position error", "99th percentile", |row| row.p99_ours, |row| row.p99_paper);
    page.figure("Position error over prediction step", &caption, &[&largest, &percentile]);
}

fn say_errors(rows: &[SweepRow]) -> String {
    let mut pairs = rows.iter().filter_map(|row| Some((row.step_s, row.max_ours?, row.max_paper?)));
    let Some((step_s, ours, paper)) = pairs.next_back() else {
        return "There is nothing to show: no run had an estimate.".into();
    };
    let published = PUBLISHED.map(|(step_s, error)| format!("{error} m at {step_s} s")).join(" and ");
    format!(
        "At a step of {step_s} s the largest error is {} here and {} with the literal paper on the same messages. The \
         dots by themselves are the largest errors that the paper reports from its own simulation: {published}.",
        quantity(ours, "m"),
        quantity(paper, "m"),
    )
}

fn cost_table(page: &mut Page, rows: &[SweepRow]) {
    let whole = |value: f64| count(value.round() as u64);
    let cells = |row: &SweepRow| {
        vec![
            Cell::number(format!("{} s", row.step_s)),
            Cell::number(whole(row.ns_per_tick)),
            Cell::number(whole(1e9 / row.ns_per_tick)),
        ]
    };
    let caption = "Wall time of the estimating unit’s tick on the machine that ran the sweep.";
    let header = ["Prediction step", "Nanoseconds per tick", "Updates per second"];
    page.table(caption, &header, &rows.iter().map(cells).collect::<Vec<_>>());
}

fn cost_figure(page: &mut Page, rows: &[SweepRow]) {
    let caption = "A tick brings the horizon of every peer up to now and, when its own messages are due, computes the \
                   own one; a finer step has more steps in the same horizon.";
    let axes = (Axis::logarithmic("prediction step", "s"), Axis::logarithmic("time per tick", "ns"));
    let series = Series::new("", rows.iter().map(|row| (row.step_s, row.ns_per_tick)));
    let layers = vec![Layer::Line { series, tone: Tone::Ours, marked: true }];
    let chart = Chart { description: caption.into(), layers, ..Chart::new("Cost of a tick", axes.0, axes.1) };
    page.figure("Cost of a tick over prediction step", caption, &[&chart]);
}
