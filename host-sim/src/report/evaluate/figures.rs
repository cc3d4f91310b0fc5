//! The figures of an evaluation's report: series enter, figures with their captions leave onto the page.

use super::{Classes, Drive, EvaluateReport, Method};
use crate::measure::baseline::spoken;
use crate::measure::metrics::max_abs;
use crate::report::{
    page::Page,
    plot::{Axis, Bars, Chart, Figure, Guide, Interval, Layer, Series, Tone, cumulative},
};

/// Least age on the logarithmic axis, which has no place for 0.
const LEAST_AGE_S: f64 = 1e-3;

/// The unit's curve is shown once more, without the methods whose errors are this many times larger.
const ENLARGED_FROM: f64 = 4.0;

impl EvaluateReport {
    pub(super) fn draw_classes(&self, page: &mut Page) {
        let (title, caption) = (self.name_classes(), self.say_classes());
        let values = |method: &Method| method.classes.iter().map(|(rms_m, _)| *rms_m).collect();
        let bars = Bars {
            title: title.clone(),
            description: caption.clone(),
            x_label: match self.classes {
                Classes::Age => "age of the newest sample (s)".into(),
                Classes::Outage(_) => "length of the silence (s)".into(),
            },
            y: Axis::logarithmic("position error, rms", "m"),
            height: 260.0,
            groups: self.class_names.iter().map(|(name, _)| name.trim_end_matches(" s").to_owned()).collect(),
            methods: self.methods.iter().map(|m| (spoken(&m.name), self.tone(&m.name), values(m))).collect(),
        };
        page.figure(&title, &caption, &[&bars]);
    }

    pub(super) fn draw_drive(&self, drive: &Drive, page: &mut Page) {
        let (title, caption) = (drive.name.clone(), self.say_drive(drive));
        let ends = drive.speed.points.first().zip(drive.speed.points.last());
        let (from, to) = ends.map_or((0.0, 1.0), |(first, last)| (first.0, last.0));
        let chart = |title: &str, y: Axis, shades: Vec<Interval>| {
            let x = Axis::linear("time of the recording", "s").over(from, to);
            Chart { description: caption.clone(), shades, ..Chart::new(title, x, y) }
        };
        let mut errors = chart(&title, Axis::linear("position error", "m").including(0.0), drive.silences.clone());
        // The unit's line lies on top.
        let line = |series: &Series| {
            Layer::line(Series { name: spoken(&series.name), ..series.clone() }, self.tone(&series.name))
        };
        errors.layers = drive.errors.iter().rev().map(line).collect();
        let mut enlarged = chart("The same, enlarged", Axis::linear("enlarged", "m").including(0.0), Vec::new());
        enlarged.height = 150.0;
        let small = drive.errors.iter().rev().filter(|series| !dwarfs(series, &drive.errors));
        enlarged.layers = small.map(line).collect();
        let shades =
            drive.silences.iter().map(|silence| Interval { label: String::new(), ..silence.clone() }).collect();
        let mut speed = chart("True speed", Axis::linear("true speed", "m/s").including(0.0), shades);
        speed.height = 110.0;
        speed.layers = vec![Layer::line(Series { name: String::new(), ..drive.speed.clone() }, Tone::Idle)];
        let panels: &[&dyn Figure] = if enlarged.layers.len() < errors.layers.len() {
            &[&errors, &enlarged, &speed]
        } else {
            &[&errors, &speed]
        };
        page.figure(&title, &caption, panels);
    }

    pub(super) fn draw_distribution(&self, page: &mut Page) {
        let (title, caption) = ("Distribution of the position error", self.say_distribution());
        let magnitudes = self.methods.iter().flat_map(|method| &method.errors).map(|error| error.abs());
        let (least, most) = decades(magnitudes);
        let x = Axis::logarithmic("magnitude of the position error", "m").over(least, most);
        let mut chart = Chart::new(title, x, Axis::linear("comparisons at or below", "%").over(0.0, 104.0));
        chart.height = 260.0;
        chart.description = caption.clone();
        chart.guides = vec![Guide { at: 99.0, label: "99 %".into() }, Guide { at: 50.0, label: "half".into() }];
        let staircase = |method: &Method| {
            let mut steps = cumulative(&method.errors, least);
            // Beyond its largest error the distribution of a method is complete. The line continues to the edge.
            steps.extend(steps.last().map(|last| (most, last.1)));
            Layer::line(Series::new(spoken(&method.name), thinned(steps)), self.tone(&method.name))
        };
        chart.layers = self.methods.iter().rev().map(staircase).collect();
        page.figure(title, &caption, &[&chart]);
    }

    pub(super) fn draw_link(&self, drive: &Drive, page: &mut Page) {
        let (title, caption) = ("Delay of every message, and age of what is known", self.say_link(drive));
        let times = drive.messages.iter().map(|message| message.0);
        let from = times.clone().reduce(f64::min).unwrap_or(0.0);
        let to = times.chain(drive.age.points.iter().map(|point| point.0)).reduce(f64::max).unwrap_or(1.0);
        let chart = |title: &str, y: Axis| {
            let x = Axis::linear("time of the recording", "s").over(from, to);
            Chart { description: caption.clone(), height: 170.0, ..Chart::new(title, x, y) }
        };
        let delivered = drive.messages.iter().filter_map(|&(at, delay)| Some((at, delay? * 1000.0)));
        let lost = drive.messages.iter().filter(|message| message.1.is_none()).map(|message| message.0).collect();
        let mut delays = chart("Delay of every message", Axis::logarithmic("delay", "ms"));
        delays.shades = drive.silences.clone();
        delays.layers = vec![
            Layer::Rug { name: "lost".into(), at: lost, tone: Tone::Alarm },
            Layer::Dots { series: Series::new("delivered", delivered), tone: Tone::Calm },
        ];
        let mut age = chart("Age of the newest sample", Axis::logarithmic("age of the newest sample", "s"));
        let ages = drive.age.points.iter().map(|&(at, age)| (at, age.max(LEAST_AGE_S)));
        age.layers = vec![Layer::line(Series::new("", ages), Tone::Calm)];
        page.figure(title, &caption, &[&delays, &age]);
    }
}

/// Whether the unit's series, the first one, is too small to be read on the axis that this series needs.
fn dwarfs(series: &Series, all: &[Series]) -> bool {
    let largest = |series: &Series| max_abs(&series.values()).unwrap_or(0.0);
    all.first().is_some_and(|ours| largest(series) > ENLARGED_FROM * largest(ours))
}

/// Whole decades around the positive values, five at the most, ending with that of the largest value.
fn decades(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let positive = values.filter(|value| *value > 0.0 && value.is_finite());
    let (Some(low), Some(high)) = (positive.clone().reduce(f64::min), positive.reduce(f64::max)) else {
        return (1e-3, 1.0);
    };
    let last = high.log10().ceil();
    let first = low.log10().floor().clamp(last - 5.0, last - 1.0);
    (10f64.powf(first), 10f64.powf(last))
}

/// A staircase of a few thousand steps at the most. Points within a tenth of a percent of the last point kept and
/// within a hundredth of a decade are dropped, because they cannot be seen.
fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    let last = points.len().saturating_sub(1);
    for (index, point) in points.into_iter().enumerate() {
        let near = |before: &(f64, f64)| (point.1 - before.1).abs() < 0.1 && (point.0 / before.0).log10().abs() < 0.01;
        if index == last || !kept.last().is_some_and(near) {
            kept.push(point);
        }
    }
    kept
}
