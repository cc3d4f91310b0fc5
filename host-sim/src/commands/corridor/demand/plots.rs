//! The figures of a study over demand: rows enter, charts leave.

use super::Row;
use super::cases::Which;
use super::table::lines;
use crate::commands::corridor::plots::{Plot, plot};
use crate::report::plot::{Axis, Chart, Layer, Series, Tone};

/// Sides that are drawn beside one another; the silences have a figure of their own.
const SIDES: [(Which, Tone); 6] = [
    (Which::Holdover, Tone::Other(0)),
    (Which::PerfectLink, Tone::Other(1)),
    (Which::Alone, Tone::Other(2)),
    (Which::FirstCome, Tone::Other(3)),
    (Which::Envelope, Tone::Ours),
    (Which::EnvelopePerfectLink, Tone::Other(6)),
];

/// The colours of the silences, which no reader takes for that of ours.
const LENGTHS: [Tone; 6] = [Tone::Other(0), Tone::Other(1), Tone::Other(2), Tone::Other(3), Tone::Other(6), Tone::Calm];

const DEMAND: &str = "demand";
const PER_MIN: &str = "vehicles a minute";

/// All figures of the rows with this number of slots.
#[must_use]
pub fn plots(rows: &[Row], slots: usize) -> Vec<Plot> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.slots == slots).collect();
    vec![travel_times(&rows), exits(&rows), silences(&rows)]
}

fn series<'a>(rows: &[&'a Row], which: Which, of: impl Fn(&'a Row) -> Option<f64>) -> Series {
    let rows = rows.iter().filter(|row| row.which == which);
    Series::new(which.name(), rows.filter_map(|row| Some((row.vehicles_per_min, of(row)?))))
}

fn by_side<'a>(rows: &[&'a Row], of: impl Fn(&'a Row) -> Option<f64> + Copy) -> Vec<Layer> {
    let line = |(which, tone): (Which, Tone)| Layer::Line { series: series(rows, which, of), tone, marked: true };
    SIDES.into_iter().map(line).collect()
}

/// The bounds as upright lines from 0 to `top`.
fn bounds(rows: &[&Row], top: f64) -> Vec<Layer> {
    let Some(capacity) = rows.first().and_then(|row| row.capacity.as_ref()) else { return Vec::new() };
    let tones = [Tone::Idle, Tone::Alert, Tone::Alarm];
    let upright = |((what, _, per_min), tone): ((&str, f64, f64), Tone)| {
        Layer::line(Series::new(format!("bound {what}"), [(per_min, 0.0), (per_min, top)]), tone)
    };
    lines(capacity).into_iter().zip(tones).map(upright).collect()
}

fn largest<'a>(rows: &[&'a Row], of: impl Fn(&'a Row) -> Option<f64>) -> f64 {
    rows.iter().filter_map(|row| of(row)).fold(0.0, f64::max)
}

fn chart(title: &str, y: Axis, layers: Vec<Layer>) -> Chart {
    let x = Axis::linear(DEMAND, PER_MIN).including(0.0);
    Chart { layers, height: 300.0, listed: true, ..Chart::new(title, x, y.including(0.0)) }
}

fn travel_times(rows: &[&Row]) -> Plot {
    let of = |row: &Row| row.side.mean_travel_time_s;
    let mut layers = bounds(rows, largest(rows, of));
    layers.extend(by_side(rows, of));
    let title = "Mean travel time over demand";
    let caption = "From a vehicle's arrival until it has left, of those that were served. The upright lines are the most that the \
                   busiest intersection can serve, one vehicle at a time."
        .to_owned();
    plot(title, caption, chart(title, Axis::linear("mean travel time", "s"), layers))
}

fn exits(rows: &[&Row]) -> Plot {
    let of = |row: &Row| row.exits_per_min;
    let most = largest(rows, |row| Some(row.vehicles_per_min));
    let mut layers = bounds(rows, most);
    layers.push(Layer::line(Series::new("as many as arrive", [(0.0, 0.0), (most, most)]), Tone::Calm));
    layers.extend(by_side(rows, of));
    let title = "Exits a minute over demand";
    let caption = "Vehicles that left a minute while vehicles arrived, without the first minute, in which the roads fill. Below the \
                   line of those who arrive, queues grow."
        .to_owned();
    plot(title, caption, chart(title, Axis::linear("exits", "vehicles a minute"), layers))
}

fn silences(rows: &[&Row]) -> Plot {
    let of = |row: &Row| row.side.mean_travel_time_s;
    let with: Vec<&Row> =
        rows.iter().copied().filter(|row| matches!(row.which, Which::Envelope | Which::Silence)).collect();
    let mut lengths_s: Vec<f64> = with.iter().map(|row| row.dark_s).collect();
    lengths_s.sort_by(f64::total_cmp);
    lengths_s.dedup();
    let line = |(dark_s, tone): (f64, Tone)| {
        let points = with.iter().filter(|row| row.dark_s == dark_s);
        let points = points.filter_map(|row| Some((row.vehicles_per_min, of(row)?)));
        let is_ours = with.iter().any(|row| row.dark_s == dark_s && row.which == Which::Envelope);
        let tone = if is_ours { Tone::Ours } else { tone };
        Layer::Line { series: Series::new(format!("{dark_s} s"), points), tone, marked: true }
    };
    let layers = lengths_s.into_iter().zip(LENGTHS).map(line).collect();
    let title = "Mean travel time over demand, by the length of silences";
    let caption = "With the envelope; every vehicle is silent once on its way.".to_owned();
    plot(title, caption, chart(title, Axis::linear("mean travel time", "s"), layers))
}
