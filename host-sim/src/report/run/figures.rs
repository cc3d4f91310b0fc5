//! The figures of a run's report: series enter, figures with their captions leave onto the page.

use super::RunReport;
use crate::measure::metrics::{SETTLED_FROM_S, errors_since, max_abs};
use crate::report::page::Page;
use crate::report::plot::{Axis, Category, Chart, Guide, Interval, Layer, Series, Strip, StripRow, Tone, cumulative};

/// The error that the paper claims not to exceed, in metres.
const PAPER_BOUND_M: f64 = 0.5;

/// The unit's error gets a panel of its own if it is this many times smaller than the range of the first panel.
const ZOOM_FROM: f64 = 4.0;

impl RunReport {
    /// The time axis of all figures, from the first to the last sample of any series.
    pub(super) fn span(&self) -> (f64, f64) {
        let series = self.trajectories.iter().chain([&self.error_ours, &self.error_paper]);
        let series = series.chain(&self.speeds).chain(&self.gaps).flat_map(|series| &series.points);
        let times = series.map(|point| point.0).chain(self.channel.iter().map(|message| message.0));
        let (low, high) = times
            .filter(|time| time.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), time| (low.min(time), high.max(time)));
        if low < high { (low, high) } else { (0.0, 1.0) }
    }

    fn time(&self) -> Axis {
        let (from, to) = self.span();
        Axis::linear("time", "s").over(from, to)
    }

    /// A chart over time with the silences shaded.
    pub(super) fn over_time(&self, title: &str, y: Axis, caption: &str) -> Chart {
        let (description, shades) = (caption.into(), self.shades());
        Chart { description, shades, ..Chart::new(title, self.time(), y) }
    }

    /// The silences, and the moment of each collision.
    pub(super) fn shades(&self) -> Vec<Interval> {
        let crashes = self.crashes.iter().flat_map(|crashes| &crashes.list);
        let moments = crashes.map(|crash| Interval::new(crash.at_s, crash.at_s, "collision"));
        self.silences.iter().cloned().chain(moments).collect()
    }

    /// The colour of the vehicle called `name`. The ego has its own.
    fn tone(&self, name: &str) -> Tone {
        match self.trajectories.iter().position(|vehicle| vehicle.name == name) {
            Some(index) if index == self.ego => Tone::Ego,
            Some(index) => Tone::Other(index),
            None => Tone::Other(self.trajectories.len()),
        }
    }

    /// A line for each vehicle.
    fn vehicles(&self, series: &[Series]) -> Vec<Layer> {
        series.iter().map(|s| Layer::line(s.clone(), self.tone(&s.name))).collect()
    }

    pub(super) fn draw_trajectories(&self, page: &mut Page) {
        let (title, caption) = ("Trajectories on the virtual lane", self.say_trajectories());
        let mut chart = self.over_time(title, Axis::linear("position", "m"), &caption);
        chart.height = 300.0;
        chart.layers = self.vehicles(&self.trajectories);
        page.figure(title, &caption, &[&chart]);
    }

    pub(super) fn draw_gaps(&self, page: &mut Page) {
        let (title, caption) = ("Gap to the vehicle ahead", self.say_gaps());
        let mut chart = self.over_time(title, grounded(Axis::linear("bumper gap", "m"), &self.gaps), &caption);
        chart.layers = self.vehicles(&self.gaps);
        page.figure(title, &caption, &[&chart]);
    }

    pub(super) fn draw_speeds(&self, page: &mut Page) {
        let (title, caption) = ("Speed", self.say_speeds());
        let mut chart = self.over_time(title, grounded(Axis::linear("speed", "m/s"), &self.speeds), &caption);
        chart.layers = self.vehicles(&self.speeds);
        page.figure(title, &caption, &[&chart]);
    }

    pub(super) fn draw_error(&self, page: &mut Page) {
        let (title, caption) = ("Position error of the estimate", self.say_error());
        let mut both = self.over_time(title, Axis::linear("position error", "m"), &caption);
        let guide = |at: f64, sign: &str| Guide { at, label: format!("{sign}{PAPER_BOUND_M} m, the paper’s bound") };
        both.guides = vec![guide(PAPER_BOUND_M, "+"), guide(-PAPER_BOUND_M, "−")];
        both.layers =
            vec![Layer::line(self.error_paper.clone(), Tone::Paper), Layer::line(self.error_ours.clone(), Tone::Ours)];
        if !self.zooms_on_ours() {
            page.figure(title, &caption, &[&both]);
            return;
        }
        let mut zoomed = self.over_time("Our position error, enlarged", Axis::linear("ours, enlarged", "m"), &caption);
        zoomed.height = 150.0;
        zoomed.layers = vec![Layer::line(Series { name: String::new(), ..self.error_ours.clone() }, Tone::Ours)];
        zoomed.shades = unlabelled(&self.shades());
        page.figure(title, &caption, &[&both, &zoomed]);
    }

    /// Whether the unit's error is too small to be read on the axis that the paper's bound and error need.
    pub(super) fn zooms_on_ours(&self) -> bool {
        let largest = |series: &Series| max_abs(&finite(series)).unwrap_or(0.0);
        let ours = largest(&self.error_ours);
        ours > 0.0 && ours * ZOOM_FROM < largest(&self.error_paper).max(PAPER_BOUND_M)
    }

    pub(super) fn draw_distribution(&self, page: &mut Page) {
        let (title, caption) = ("Distribution of the position error", self.say_distribution());
        let settled = |series: &Series| -> Vec<f64> {
            errors_since(&series.points, SETTLED_FROM_S).into_iter().map(f64::abs).filter(|e| e.is_finite()).collect()
        };
        let (ours, paper) = (settled(&self.error_ours), settled(&self.error_paper));
        let (least, most) = decades(ours.iter().chain(&paper).copied());
        let x = Axis::logarithmic("magnitude of the position error", "m").over(least, most);
        let mut chart = Chart::new(title, x, Axis::linear("samples at or below", "%").over(0.0, 104.0));
        chart.description = caption.clone();
        chart.guides = vec![Guide { at: 99.0, label: "99 %".into() }, Guide { at: 50.0, label: "half".into() }];
        let staircase = |name: &str, values: &[f64]| {
            let mut steps = cumulative(values, least);
            // Beyond its largest error the distribution of a method is complete. The line continues to the edge.
            steps.extend(steps.last().map(|last| (most, last.1)));
            Series::new(name, steps)
        };
        chart.layers = vec![
            Layer::line(staircase(&self.error_paper.name, &paper), Tone::Paper),
            Layer::line(staircase(&self.error_ours.name, &ours), Tone::Ours),
        ];
        page.figure(title, &caption, &[&chart]);
    }

    pub(super) fn draw_channel(&self, page: &mut Page) {
        let (title, caption) = ("The ego’s link", self.say_channel());
        let delivered = self.channel.iter().filter_map(|&(at, delay)| Some((at, delay? * 1000.0)));
        let lost = self.channel.iter().filter(|message| message.1.is_none()).map(|message| message.0).collect();
        let mut chart = self.over_time(title, Axis::linear("delay", "ms").including(0.0), &caption);
        chart.height = 170.0;
        chart.layers = vec![
            Layer::Rug { name: "lost".into(), at: lost, tone: Tone::Alarm },
            Layer::Dots { series: Series::new("delivered", delivered), tone: Tone::Calm },
        ];
        page.figure(title, &caption, &[&chart]);
    }

    pub(super) fn draw_modes(&self, page: &mut Page) {
        let (title, caption) = ("Modes", self.say_modes());
        let mut names: Vec<&str> = Vec::new();
        for (_, mode) in self.modes.iter().flat_map(|track| &track.changes) {
            if !names.contains(&mode.as_str()) {
                names.push(mode);
            }
        }
        names.sort_by_key(|name| severity(name).0);
        let row = |track: &super::ModeTrack| StripRow {
            name: track.vehicle.clone(),
            changes: track
                .changes
                .iter()
                .filter_map(|(at, mode)| Some((*at, names.iter().position(|name| name == mode)?)))
                .collect(),
        };
        let strip = Strip {
            title: title.into(),
            description: caption.clone(),
            x: self.time(),
            end: self.span().1,
            shades: self.shades(),
            rows: self.modes.iter().map(row).collect(),
            categories: names.iter().map(|name| Category { name: (*name).into(), tone: severity(name).1 }).collect(),
        };
        page.figure(title, &caption, &[&strip]);
    }
}

/// The severity of a mode, and its colour. A mode is identified by its first word.
fn severity(mode: &str) -> (u8, Tone) {
    let word: String = mode.chars().take_while(|c| c.is_alphabetic()).flat_map(char::to_lowercase).collect();
    match word.as_str() {
        "standby" => (0, Tone::Idle),
        "cooperative" => (1, Tone::Calm),
        "holdover" => (2, Tone::Alert),
        "fallback" => (3, Tone::Paper),
        "fault" => (4, Tone::Alarm),
        _ => (5, Tone::Other(3)),
    }
}

/// `axis` down to 0 if the series come near 0, so that the distance from a collision or a stop can be read. If they
/// stay far from 0, that distance is obvious, and the axis shows the differences instead.
fn grounded(axis: Axis, series: &[Series]) -> Axis {
    let values = || series.iter().flat_map(finite);
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    if low < high * 0.6 { axis.including(0.0) } else { axis }
}

/// Whole decades around the positive values, six at the most, ending with that of the largest value.
fn decades(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let positive = values.filter(|value| *value > 0.0);
    let (Some(low), Some(high)) = (positive.clone().reduce(f64::min), positive.reduce(f64::max)) else {
        return (1e-3, 1.0);
    };
    let last = high.log10().ceil();
    let first = low.log10().floor().clamp(last - 6.0, last - 1.0);
    (10f64.powf(first), 10f64.powf(last))
}

pub(super) fn unlabelled(intervals: &[Interval]) -> Vec<Interval> {
    intervals.iter().map(|interval| Interval::new(interval.from, interval.to, "")).collect()
}

fn finite(series: &Series) -> Vec<f64> {
    series.points.iter().map(|point| point.1).filter(|value| value.is_finite()).collect()
}
