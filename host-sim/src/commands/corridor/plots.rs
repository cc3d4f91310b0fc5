//! The figures of a corridor's report: journals and results enter, charts leave.

use super::Results;
use super::scale::Load;
use crate::report::plot::{Axis, Chart, Guide, Interval, Layer, Series, Tone};
use crate::report::sweep::PUBLISHED;
use crate::roads::experiment::Experiment;
use crate::roads::figures::StepRow;
use crate::roads::journal::Journal;

/// Time of the trajectories before and after the ego's crossing, in seconds.
const AROUND_S: (f64, f64) = (20.0, 25.0);

/// A figure: its title, its caption, and the chart.
pub struct Plot {
    /// The title.
    pub title: String,
    /// The caption.
    pub caption: String,
    /// The chart.
    pub chart: Chart,
}

pub(super) fn plot(title: &str, caption: String, chart: Chart) -> Plot {
    Plot { title: title.into(), chart: Chart { description: caption.clone(), ..chart }, caption }
}

/// All figures that have data.
#[must_use]
pub fn plots(experiment: &Experiment, results: &Results, steps: &[(StepRow, Journal)]) -> Vec<Plot> {
    let finest = steps.first().map(|(_, journal)| journal);
    let first = finest.and_then(|journal| trajectories(experiment, journal));
    let mut plots: Vec<Plot> = first.into_iter().collect();
    plots.extend(errors_over_time(steps));
    plots.push(largest_errors(steps));
    plots.extend(costs(results));
    plots
}

/// Trajectories at the ego's first intersection, all legs on the virtual lane.
fn trajectories(experiment: &Experiment, journal: &Journal) -> Option<Plot> {
    let ego = journal.ego?;
    let own = journal.tracks.get(&ego)?;
    let lanes = &experiment.network.lanes;
    let stop = lanes[own.road].stops.first()?;
    let crosses_s = own.points.iter().find(|(_, way_m)| *way_m >= stop.at_m)?.0;
    let span_s = (crosses_s - AROUND_S.0, crosses_s + AROUND_S.1);
    let mut layers = Vec::new();
    let mut named = Vec::new();
    for (trip, track) in &journal.tracks {
        let Some(here) = lanes[track.road].stops.iter().find(|here| here.intersection == stop.intersection) else {
            continue;
        };
        let near = |point: &(f64, f64)| (span_s.0..=span_s.1).contains(&point.0) && (-180.0..=60.0).contains(&point.1);
        let points: Vec<(f64, f64)> =
            track.points.iter().map(|(at_s, way_m)| (*at_s, way_m - here.at_m)).filter(near).collect();
        if points.is_empty() {
            continue;
        }
        let tone = if *trip == ego { Tone::Ego } else { Tone::Other(here.leg) };
        let road = &experiment.corridor.roads[track.road].name;
        let name = if *trip == ego { "ego".to_owned() } else { road.clone() };
        // One entry for each leg.
        let name = if named.contains(&name) { String::new() } else { name };
        named.push(name.clone());
        layers.push(Layer::line(Series::new(name, points), tone));
    }
    let name = &experiment.corridor.intersections[stop.intersection].name;
    let half_m = experiment.network.junctions[stop.intersection].half_m;
    let shades = journal.dark.map(|dark| Interval::new(dark.from_s, dark.to_s, "the ego is silent"));
    let title = "Trajectories at the first intersection, all legs on the virtual lane";
    let caption = format!(
        "Distance to the crossing point of {name} over time; 0 is the crossing point, and nobody may be between the two lines \
         (±{half_m} m) together with another one whose way crosses."
    );
    let axes = (Axis::linear("time", "s").over(span_s.0, span_s.1), Axis::linear("beyond the crossing point", "m"));
    let guides = [-half_m, half_m].map(|at| Guide { at, label: String::new() }).to_vec();
    let chart = Chart {
        layers,
        guides,
        shades: shades.into_iter().collect(),
        height: 320.0,
        listed: true,
        ..Chart::new(title, axes.0, axes.1)
    };
    Some(plot(title, caption, chart))
}

fn errors_over_time(steps: &[(StepRow, Journal)]) -> Option<Plot> {
    let shown = steps.iter().filter(|(row, _)| [0.01, 0.1, 1.0].contains(&row.step_s));
    let layers: Vec<Layer> = shown
        .enumerate()
        .map(|(index, (row, journal))| {
            let points = journal.errors.iter().step_by(5).copied();
            let tone = if index == 0 { Tone::Ours } else { Tone::Other(index) };
            Layer::line(Series::new(format!("δt {} s", row.step_s), points), tone)
        })
        .collect();
    let dark = steps.first()?.1.dark;
    let title = "Error of the ego's estimate of its target over time";
    let caption = "Believed minus true position of the target on the virtual lane, at three prediction steps. Where it leaps, the \
                   ego follows someone else from then on."
        .to_owned();
    let axes = (Axis::linear("time", "s"), Axis::linear("position error", "m").including(0.0));
    let shades = dark.map(|dark| Interval::new(dark.from_s, dark.to_s, "the ego is silent")).into_iter().collect();
    Some(plot(title, caption, Chart { layers, shades, ..Chart::new(title, axes.0, axes.1) }))
}

fn largest_errors(steps: &[(StepRow, Journal)]) -> Plot {
    let points = steps.iter().filter_map(|(row, _)| Some((row.step_s, row.side.position_error.max_m?)));
    let [fine, coarse] = PUBLISHED;
    let mark =
        |name: &str, point| Layer::Line { series: Series::new(name, [point]), tone: Tone::Other(1), marked: true };
    let layers = vec![
        Layer::Line { series: Series::new("holdover", points), tone: Tone::Ours, marked: true },
        mark("", fine),
        mark("as published", coarse),
    ];
    let title = "Largest position error over prediction step";
    let caption = "The largest error of anyone's target, leaving out one second after that target's own association has changed. \
                   The dots by themselves are what the paper reports from its own simulation."
        .to_owned();
    let axes = (Axis::logarithmic("prediction step δt", "s"), Axis::logarithmic("largest error", "m"));
    plot(title, caption, Chart { layers, ..Chart::new(title, axes.0, axes.1) })
}

/// The speed of the simulation, which depends on the machine.
pub fn scale(loads: &[Load]) -> Option<Plot> {
    if loads.is_empty() {
        return None;
    }
    let points = loads.iter().map(|load| (load.vehicles as f64, load.times_real_time));
    let layers = vec![Layer::Line { series: Series::new("", points), tone: Tone::Ours, marked: true }];
    let title = "How many times faster than real time so many vehicles are simulated";
    let caption = format!(
        "Corridors side by side on {} thread(s) of this machine; a line that falls by as much as the number of vehicles grows is \
         a cost in proportion.",
        loads.iter().map(|load| load.threads).max().unwrap_or(1)
    );
    let axes = (Axis::logarithmic("vehicles under way at once", ""), Axis::logarithmic("times real time", ""));
    Some(plot(title, caption, Chart { layers, ..Chart::new(title, axes.0, axes.1) }))
}

/// The computing time of a tick, which depends on the machine.
fn costs(results: &Results) -> Option<Plot> {
    let points: Vec<(f64, f64)> = results.timing.cost.iter().map(|cost| (cost.step_s, cost.updates_per_s)).collect();
    if points.is_empty() {
        return None;
    }
    let layers = vec![Layer::Line { series: Series::new("", points), tone: Tone::Ours, marked: true }];
    let title = "Updates per second on one core over prediction step";
    let caption =
        "How many ticks of the ego's unit, with the traffic that it heard, this machine does in a second.".to_owned();
    let axes = (Axis::logarithmic("prediction step δt", "s"), Axis::logarithmic("updates per second", ""));
    Some(plot(title, caption, Chart { layers, ..Chart::new(title, axes.0, axes.1) }))
}
