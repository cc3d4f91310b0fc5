//! The report of one run: its series and figures of merit enter, an HTML page leaves.

mod certainty;
mod crash;
mod figures;
mod prose;

use super::{
    markup::{MILLIMETRES_BELOW_M, count, significant},
    page::{Cell, Page},
    plot::{Interval, Series},
};

pub use crash::{Crash, Crashes};

/// Whether the run passed, with the reasons.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Verdict {
    /// Whether every limit was met.
    pub passed: bool,
    /// One sentence per reason.
    pub reasons: Vec<String>,
}

/// A limit on a figure of merit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Limit {
    /// Met by this value or less.
    AtMost(f64),
    /// Met by this value or more.
    AtLeast(f64),
}

impl Limit {
    /// Whether `value` meets the limit. A value that is not a number meets no limit.
    pub fn is_met_by(self, value: f64) -> bool {
        match self {
            Self::AtMost(limit) => value <= limit,
            Self::AtLeast(limit) => value >= limit,
        }
    }
}

/// One figure of merit.
#[derive(Debug, Clone, PartialEq)]
pub struct SummaryRow {
    /// The name of the figure.
    pub metric: String,
    /// The unit's value; `None` where there is no measurement.
    pub ours: Option<f64>,
    /// The literal paper's value on the same messages; `None` where it has none.
    pub paper: Option<f64>,
    /// The unit; empty for a plain count.
    pub unit: String,
    /// The limit on the unit's value.
    pub limit: Option<Limit>,
}

impl SummaryRow {
    /// The same in millimetres, where metres would be all zeros.
    fn readable(&self) -> Self {
        let values = || [self.ours, self.paper].into_iter().flatten();
        let is_small = values().any(|value| value != 0.0) && values().all(|value| value.abs() < MILLIMETRES_BELOW_M);
        if self.unit != "m" || !is_small || self.limit.is_some() {
            return self.clone();
        }
        let milli = |value: Option<f64>| value.map(|value| value * 1e3);
        Self { ours: milli(self.ours), paper: milli(self.paper), unit: "mm".into(), ..self.clone() }
    }
}

/// The modes of one vehicle's unit over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModeTrack {
    /// The vehicle's name, as in the trajectories.
    pub vehicle: String,
    /// `(from_s, mode)` in order of time; each holds until the next. Repeated modes, as in a sample per tick, count as
    /// one. `standby`, `cooperative`, `holdover`, `fallback` and `fault` have their own colours, with or without more
    /// text after the word.
    pub changes: Vec<(f64, String)>,
}

/// The bound of the ego's position at one time, in metres relative to the unit's estimate; behind it is negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundSample {
    /// Time.
    pub at_s: f64,
    /// Lowest possible position.
    pub lowest_m: f64,
    /// True position.
    pub truth_m: f64,
    /// Highest possible position.
    pub highest_m: f64,
}

/// The command and the acceleration of the estimating vehicle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drive {
    /// Its name, as in the trajectories.
    pub vehicle: String,
    /// Whether its envelope is engaged.
    pub engaged: bool,
    /// Acceleration commanded over time, in m/s².
    pub command: Series,
    /// Acceleration reached over time, in m/s².
    pub reached: Series,
    /// The times at which the envelope changed the command.
    pub limited_s: Vec<f64>,
}

/// The content of the page. Vehicles are identified by name: a series of `gaps` or `speeds` belongs to the trajectory
/// of the same name. Times are in seconds of the run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RunReport {
    /// The page's title.
    pub title: String,
    /// The settings of the run: names and values.
    pub facts: Vec<(String, String)>,
    /// The verdict.
    pub verdict: Verdict,
    /// The command line that repeats this run.
    pub command: String,
    /// The figures of merit.
    pub summary: Vec<SummaryRow>,
    /// The collisions, if there were any.
    pub crashes: Option<Crashes>,
    /// Position over time of each vehicle, in metres along the virtual lane, leader first.
    pub trajectories: Vec<Series>,
    /// Index of the ego in `trajectories`.
    pub ego: usize,
    /// The unit's error: that of the ego's position as its follower estimates it, in metres.
    pub error_ours: Series,
    /// The literal paper's error, on the same messages.
    pub error_paper: Series,
    /// The bound of the ego's position, at the times at which there is one.
    pub bound: Vec<BoundSample>,
    /// The command and the acceleration of the estimating vehicle.
    pub drive: Drive,
    /// The times in which the scenario silences the ego's link.
    pub silences: Vec<Interval>,
    /// For each message over the ego's link its time, and its delay in seconds; `None` if it was lost.
    pub channel: Vec<(f64, Option<f64>)>,
    /// Speed over time of each vehicle, in m/s.
    pub speeds: Vec<Series>,
    /// Bumper gap to the vehicle ahead over time, in metres, for each vehicle except the leader.
    pub gaps: Vec<Series>,
    /// Modes over time.
    pub modes: Vec<ModeTrack>,
    /// Refusals by cause.
    pub refusals: Vec<(String, u64)>,
    /// Further notes for the reader.
    pub notes: Vec<String>,
}

impl RunReport {
    /// The page, as one self-contained HTML document. The same report is always the same bytes.
    pub fn render(&self) -> String {
        self.page().finish()
    }

    /// The page, to which more can be added.
    pub fn page(&self) -> Page {
        let mut page = Page::new("holdover-sim · report of a run", &self.title);
        page.verdict(self.verdict.passed, &self.verdict.reasons);
        // The picture that matters comes first: the error, through the silences.
        page.section("The error, through silences");
        self.draw_error(&mut page);
        page.section("Figures of merit");
        let rows: Vec<Vec<Cell>> = self.summary.iter().map(summary_cells).collect();
        page.table(
            "Figures of merit; bold: the smaller of two errors.",
            &["Measure", "Ours", "Literal paper", "Unit", "Limit"],
            &rows,
        );
        self.draw_crashes(&mut page);
        page.section("Scenario");
        page.facts(&self.facts);
        page.command(&self.command);
        page.section("Motion");
        self.draw_trajectories(&mut page);
        self.draw_gaps(&mut page);
        self.draw_speeds(&mut page);
        self.draw_drive(&mut page);
        page.section("Estimation");
        self.draw_bound(&mut page);
        self.draw_distribution(&mut page);
        page.section("Channel and modes");
        self.draw_channel(&mut page);
        self.draw_modes(&mut page);
        page.section("Refused input");
        self.list_refusals(&mut page);
        if !self.notes.is_empty() {
            page.section("Notes");
            page.list(&self.notes);
        }
        page
    }

    fn list_refusals(&self, page: &mut Page) {
        let mut refusals: Vec<&(String, u64)> = self.refusals.iter().filter(|refusal| refusal.1 > 0).collect();
        // The most frequent cause comes first. Equal counts keep their order.
        refusals.sort_by_key(|refusal| std::cmp::Reverse(refusal.1));
        if refusals.is_empty() {
            page.paragraph("No frame was refused.");
            return;
        }
        let cells = |(cause, n): &(String, u64)| vec![Cell::text(cause.clone()), Cell::number(count(*n))];
        let rows: Vec<Vec<Cell>> = refusals.into_iter().map(cells).collect();
        page.table(
            "What the units refused, by cause; refused input changes nothing but its counter.",
            &["Cause", "Count"],
            &rows,
        );
    }
}

fn summary_cells(row: &SummaryRow) -> Vec<Cell> {
    let row = &row.readable();
    let spelled = |value: Option<f64>| value.map_or("–".into(), |value| significant_or_count(value, &row.unit));
    let limit = match row.limit {
        None => Cell::text("–"),
        Some(limit) => {
            let met = row.ours.is_some_and(|ours| limit.is_met_by(ours));
            let (sign, value) = match limit {
                Limit::AtMost(value) => ('≤', value),
                Limit::AtLeast(value) => ('≥', value),
            };
            let state = if met { "met" } else { "missed" };
            Cell::limit(format!("{sign} {}, {state}", significant_or_count(value, &row.unit)), met)
        }
    };
    let unit = Cell::text(row.unit.clone());
    // The smaller of two errors is the better one.
    let cell = |value: Option<f64>, other: Option<f64>| match (value, other) {
        (Some(value), Some(other)) if value <= other => Cell::strong(spelled(Some(value))),
        _ => Cell::number(spelled(value)),
    };
    vec![Cell::text(row.metric.clone()), cell(row.ours, row.paper), cell(row.paper, row.ours), unit, limit]
}

/// A whole number without a unit is a count. Any other value is a measurement with three significant digits.
fn significant_or_count(value: f64, unit: &str) -> String {
    if unit.is_empty() && value.fract() == 0.0 && (0.0..1e15).contains(&value) {
        count(value as u64)
    } else {
        significant(value, 3)
    }
}
