//! The report of a run: options, trace and figures enter, the page's content leaves.

use crate::commands::run::collided::crashes;
use crate::commands::run::options::RunOptions;
use crate::input::impairment::{AppliesTo, Impairment, Link};
use crate::input::scenario::Scenario;
use crate::measure::figures::{Summary, errors, gaps, mode_name, ours, papers, speeds};
use crate::measure::metrics::SETTLED_FROM_S;
use crate::report::RunReport;
use crate::report::plot::{Interval, Series};
use crate::report::run::{BoundSample, Drive, Limit, ModeTrack, SummaryRow, Verdict};
use crate::sim::world::{Tick, Trace};

/// The paper's own figure for the same silence, in metres.
const PAPER_ERROR_M: f64 = 0.5;

/// The content of the page.
pub fn report(options: &RunOptions, trace: &Trace, summary: &Summary, failures: &[String]) -> RunReport {
    let scenario = &options.scenario;
    let names: Vec<String> = (0..trace.vehicles.len()).map(|index| name(scenario, index)).collect();
    let positions = |index: usize| {
        let ticks = &trace.vehicles[index];
        trace.times_s.iter().zip(ticks).map(|(at_s, tick)| (*at_s, tick.position_m)).collect::<Vec<_>>()
    };
    let silences = silences(scenario, trace);
    let joined_s = 1.5 * scenario.period_s * trace.thinning.stride() as f64;
    RunReport {
        title: title(options),
        facts: facts(scenario),
        verdict: Verdict { passed: failures.is_empty(), reasons: reasons(summary, failures) },
        command: command(options),
        summary: rows(summary),
        crashes: crashes(scenario, trace, summary, &names),
        trajectories: (0..names.len()).map(|index| Series::new(names[index].clone(), positions(index))).collect(),
        ego: trace.measured.vehicle,
        // Where there is no estimate there is no error, and no line.
        error_ours: Series::new("holdover", errors(trace, ours(trace))).joined_within(joined_s),
        error_paper: Series::new("literal paper", errors(trace, papers(trace))).joined_within(joined_s),
        bound: bound(trace),
        drive: drive(scenario, trace, &names),
        silences,
        channel: channel(trace),
        speeds: speeds(trace).into_iter().zip(&names).map(|(speed, name)| Series::new(name.clone(), speed)).collect(),
        gaps: gaps(scenario, trace)
            .into_iter()
            .zip(&names[1..])
            .map(|(gap, name)| Series::new(name.clone(), gap))
            .collect(),
        modes: modes(trace, &names),
        refusals: trace.refusals.iter().map(|(cause, count)| (cause.name().to_owned(), *count)).collect(),
        notes: notes(trace, summary),
    }
}

fn name(scenario: &Scenario, index: usize) -> String {
    match index {
        0 => "leader".into(),
        ego if ego == scenario.ego => "ego".into(),
        other => format!("vehicle {other}"),
    }
}

fn title(options: &RunOptions) -> String {
    match &options.scenario_file {
        Some(file) => file.file_stem().map_or("a scenario".into(), |stem| stem.to_string_lossy().into_owned()),
        None if options.scenario.leader.motion.is_some() => "A recorded leader".into(),
        None => "The paper's scenario".into(),
    }
}

fn command(options: &RunOptions) -> String {
    let mut words = vec!["holdover-sim run".to_owned()];
    words.extend(options.scenario_file.as_ref().map(|file| file.display().to_string()));
    words.push(format!("--seed {}", options.scenario.seed));
    words.extend(options.arguments.iter().cloned());
    words.join(" ")
}

fn facts(scenario: &Scenario) -> Vec<(String, String)> {
    let mut facts = vec![
        ("vehicles".into(), scenario.vehicles.len().to_string()),
        ("duration".into(), format!("{} s", scenario.duration_s)),
        ("period of the units".into(), format!("{} s", scenario.period_s)),
        ("prediction step δt".into(), format!("{} s", scenario.step_s)),
        ("messages".into(), format!("{} Hz", scenario.message_rate_hz)),
        ("seed".into(), scenario.seed.to_string()),
    ];
    let channel = match &scenario.channel.impairment {
        Impairment::Random { delay_mean_s, delay_std_s, loss, outages, .. } => {
            let outages: Vec<String> = outages.iter().map(|o| format!("{}–{} s", o.from_s, o.to_s)).collect();
            format!(
                "delay Normal({delay_mean_s} s, {delay_std_s} s) truncated at 0, loss {} %, silent in {}",
                loss * 100.0,
                if outages.is_empty() { "no time".into() } else { outages.join(", ") }
            )
        }
        Impairment::Recorded(_) => "as recorded".into(),
    };
    facts.push(("channel".into(), channel));
    let applies_to = match &scenario.channel.applies_to {
        AppliesTo::All => "every link".into(),
        AppliesTo::Vehicles(vehicles) => {
            let names: Vec<String> = vehicles.iter().map(|index| name(scenario, *index)).collect();
            format!("links of {}; the others are clean", names.join(", "))
        }
    };
    facts.push(("impaired".into(), applies_to));
    let envelope = if scenario.envelope.engaged { "engaged" } else { "not engaged" };
    facts.push(("envelope".into(), envelope.into()));
    facts
}

fn reasons(summary: &Summary, failures: &[String]) -> Vec<String> {
    if !failures.is_empty() {
        return failures.to_vec();
    }
    let error = summary.ours.max_position_error_m.map_or("-".into(), |error| format!("{error:.3} m"));
    let stops = if summary.full_stops == 0 { ", and nobody had to stop" } else { "" };
    vec![format!(
        "No collision{stops}; the estimate was never off by more than {error}, the truth never outside its bound."
    )]
}

fn rows(summary: &Summary) -> Vec<SummaryRow> {
    let row = |metric: &str, ours, paper, unit: &str, limit| SummaryRow {
        metric: metric.into(),
        ours,
        paper,
        unit: unit.into(),
        limit,
    };
    let (ours, paper) = (summary.ours, summary.paper);
    let count = |count: usize| Some(count as f64);
    let limited = summary.envelope.engaged.then_some(100.0 * summary.envelope.limited_share);
    vec![
        row("Largest position error", ours.max_position_error_m, paper.max_position_error_m, "m", None),
        row("99th percentile", ours.p99_position_error_m, paper.p99_position_error_m, "m", None),
        row("Root of the mean square", ours.rms_position_error_m, paper.rms_position_error_m, "m", None),
        row("Largest error that the paper reports", None, Some(PAPER_ERROR_M), "m", None),
        row("Smallest gap along the virtual lane", summary.min_gap_m, None, "m", Some(Limit::AtLeast(0.0))),
        row("Lowest speed", summary.min_speed_mps, None, "m/s", None),
        row("Full stops", count(summary.full_stops), None, "", None),
        row("Collisions", count(summary.collisions), None, "", Some(Limit::AtMost(0.0))),
        row("Median width of the bound", summary.bound.median_width_m, None, "m", None),
        row(
            "Ticks with a target outside its bound",
            count(summary.bound.violations),
            None,
            "",
            Some(Limit::AtMost(0.0)),
        ),
        row("Time limited by the envelope", limited, None, "%", None),
    ]
}

/// The times in which the link to the measuring vehicle was silent for longer than two and a half intervals between
/// messages.
fn silences(scenario: &Scenario, trace: &Trace) -> Vec<Interval> {
    let Some(link) = trace.channel.link(measured_link(trace)) else { return Vec::new() };
    // Where only some messages are recorded, there are gaps between them.
    if link.thinning.stride() > 1 {
        return Vec::new();
    }
    let longer_than_s = 2.5 / scenario.message_rate_hz;
    let end_s = trace.times_s.last().copied().unwrap_or(0.0);
    link.silences(longer_than_s.max(0.5), 0.0, end_s)
        .into_iter()
        .map(|window| Interval::new(window.from_s, window.to_s, "silence"))
        .collect()
}

fn channel(trace: &Trace) -> Vec<(f64, Option<f64>)> {
    trace.channel.link(measured_link(trace)).map(|link| link.messages.clone()).unwrap_or_default()
}

fn measured_link(trace: &Trace) -> Link {
    Link { from: trace.measured.vehicle, to: trace.measured.by }
}

fn modes(trace: &Trace, names: &[String]) -> Vec<ModeTrack> {
    let changes = |index: usize| {
        trace.times_s.iter().zip(&trace.vehicles[index]).map(|(at_s, tick)| (*at_s, mode_name(tick.mode).to_owned()))
    };
    names
        .iter()
        .enumerate()
        .map(|(index, name)| ModeTrack { vehicle: name.clone(), changes: changes(index).collect() })
        .collect()
}

/// The bound of the measured vehicle on the bus, relative to the estimate.
fn bound(trace: &Trace) -> Vec<BoundSample> {
    let (measured, by) = (&trace.vehicles[trace.measured.vehicle], &trace.vehicles[trace.measured.by]);
    let ticks = trace.times_s.iter().zip(measured.iter().zip(by));
    let sample = |(at_s, (truth, seen)): (&f64, (&Tick, &Tick))| {
        let target = seen.target?;
        let bound = target.bound?;
        Some(BoundSample {
            at_s: *at_s,
            lowest_m: bound.lowest_position_m - target.position_m,
            truth_m: truth.position_m - target.position_m,
            highest_m: bound.highest_position_m - target.position_m,
        })
    };
    ticks.filter_map(sample).filter(|sample| sample.at_s >= SETTLED_FROM_S - 1e-9).collect()
}

fn drive(scenario: &Scenario, trace: &Trace, names: &[String]) -> Drive {
    let by = trace.measured.by;
    let over_time = |value: fn(&Tick) -> f64| {
        trace.times_s.iter().zip(&trace.vehicles[by]).map(move |(at_s, tick)| (*at_s, value(tick)))
    };
    Drive {
        vehicle: names[by].clone(),
        engaged: scenario.envelope.engaged,
        command: Series::new("commanded", over_time(|tick| tick.command_mps2)),
        reached: Series::new("reached", over_time(|tick| tick.acceleration_mps2)),
        limited_s: trace
            .times_s
            .iter()
            .zip(&trace.vehicles[by])
            .filter(|(_, tick)| tick.limited)
            .map(|(at_s, _)| *at_s)
            .collect(),
    }
}

fn notes(trace: &Trace, summary: &Summary) -> Vec<String> {
    let mut notes = vec![
        "The literal paper keeps no standstill distance, and knows of no lag and no limit on acceleration and jerk; the \
         simulated vehicles have all of these. Part of its error is that."
            .to_owned(),
        "Errors count from 1 s on.".to_owned(),
        "A unit trusts an identifier of its bus from the second good frame on, so the first frame of each is refused."
            .to_owned(),
    ];
    if summary.bound.beyond_limits > 0 {
        notes.push(format!(
            "At {} ticks the recorded leader was outside its bound right after its recording had changed its speed as no \
             road vehicle can; a bound is of vehicles only, so these do not count.",
            summary.bound.beyond_limits
        ));
    }
    if summary.envelope.engaged && summary.envelope.limited_share > 0.0 {
        notes.push(
            "No vehicle can know that the envelope of another one is limiting it for want of messages: meanwhile the \
             estimate goes by the law that the other one published, and is wrong by what the envelope does. The bound holds."
                .to_owned(),
        );
    }
    if trace.thinning.stride() > 1 {
        notes.push(format!(
            "The run is long: figures over time are of one tick in {}. Largest, smallest and counted figures of the table are of all.",
            trace.thinning.stride()
        ));
    }
    let link = trace.channel.link(measured_link(trace)).filter(|link| link.thinning.stride() > 1);
    if let Some(link) = link {
        notes.push(format!(
            "Of the messages over the ego’s link one in {} is shown, and silences are not shaded; {} of {} were lost.",
            link.thinning.stride(),
            link.counts.sent - link.counts.delivered,
            link.counts.sent
        ));
    }
    if trace.turned_away > 0 {
        notes.push(format!("{} messages found no free slot in a modem.", trace.turned_away));
    }
    notes
}
