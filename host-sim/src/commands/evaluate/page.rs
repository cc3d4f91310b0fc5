//! The report of an evaluation: options, outcomes and figures enter, the page's content leaves.

use super::figures::{Figures, Results};
use super::options::{EvaluateOptions, Impairment, Recording};
use super::sample::{NAMES, Outcome, Sample, refusals};
use crate::report::EvaluateReport;
use crate::report::evaluate::{Classes, Drive, Method};
use crate::report::plot::{Interval, Series};
use crate::sim::channel::LinkRecord;
use std::path::Path;

/// A time without arrivals longer than this is a silence.
const SILENCE_S: f64 = 0.5;

/// Time between the ends of two silences of one length: that between two messages.
const CYCLE_S: f64 = 0.1;

/// The length of silence that is shown, if it was measured.
const SHOWN_S: f64 = 2.0;

/// The content of the page.
pub fn report(options: &EvaluateOptions, outcomes: &[Outcome], results: &Results) -> EvaluateReport {
    let classes = match options.lengths_s() {
        None => Classes::Age,
        Some(lengths_s) => Classes::Outage(shown(lengths_s)),
    };
    let is_shown = |sample: &&Sample| match classes {
        Classes::Age => true,
        Classes::Outage(length_s) => sample.outage_s == Some(length_s),
    };
    let samples: Vec<&Sample> = outcomes.iter().flat_map(|outcome| &outcome.samples).filter(is_shown).collect();
    let methods = results.methods().into_iter().enumerate().map(|(index, (name, figures))| Method {
        name: name.into(),
        rms_m: figures.rms_position_m,
        p99_m: figures.p99_position_m,
        max_m: figures.max_position_m,
        rms_mps: figures.rms_speed_mps,
        classes: rms_and_max(figures),
        errors: samples.iter().filter_map(|sample| sample.position_error(index)).collect(),
    });
    let methods: Vec<Method> = methods.collect();
    let lines = lines(&methods, classes, options.lengths_s());
    let drive = |(recording, outcome): (&Recording, &Outcome)| {
        let samples: Vec<&Sample> = outcome.samples.iter().filter(is_shown).collect();
        drive(recording, outcome, &samples, &lines, (classes, options.step_s))
    };
    EvaluateReport {
        title: title(options),
        facts: facts(options, outcomes, results),
        command: command(options),
        classes,
        class_names: super::table::heads(&results.ours),
        failures: results.failures.clone(),
        drives: options.recordings.iter().zip(outcomes).map(drive).collect(),
        methods,
    }
}

/// The length of 2 s if it was measured, or else the middle one.
fn shown(lengths_s: &[f64]) -> f64 {
    let mut sorted = lengths_s.to_vec();
    sorted.sort_by(f64::total_cmp);
    if sorted.contains(&SHOWN_S) { SHOWN_S } else { sorted.get(sorted.len() / 2).copied().unwrap_or(SHOWN_S) }
}

fn rms_and_max(figures: &Figures) -> Vec<(Option<f64>, Option<f64>)> {
    let ages = figures.by_age.iter().flatten().map(|class| (class.rms_position_m, class.max_position_m));
    let outages = figures.by_outage.iter().flatten().map(|class| (class.rms_position_m, class.max_position_m));
    ages.chain(outages).collect()
}

/// The methods that are drawn over time: the unit, the best baseline and the literal paper.
fn lines(methods: &[Method], classes: Classes, lengths_s: Option<&[f64]>) -> Vec<usize> {
    let class = match classes {
        Classes::Age => None,
        Classes::Outage(length_s) => lengths_s.and_then(|all| all.iter().position(|other| *other == length_s)),
    };
    let rms = |method: &Method| class.map_or(method.rms_m, |class| method.classes[class].0).unwrap_or(f64::INFINITY);
    let best = (1..methods.len()).min_by(|a, b| rms(&methods[*a]).total_cmp(&rms(&methods[*b])));
    let paper = methods.iter().position(|method| method.name == "paper");
    let mut lines: Vec<usize> = [Some(0), best, paper].into_iter().flatten().collect();
    lines.dedup();
    lines
}

fn drive(
    recording: &Recording,
    outcome: &Outcome,
    samples: &[&Sample],
    lines: &[usize],
    (classes, step_s): (Classes, f64),
) -> Drive {
    // A comparison at every tick, or at every message that began a silence.
    let joined_s = 1.5 * if classes == Classes::Age { step_s } else { CYCLE_S };
    let errors = |&method: &usize| {
        let errors = samples.iter().filter_map(|s| Some((s.at_s, s.position_error(method)?)));
        Series::new(NAMES[method], errors).joined_within(joined_s)
    };
    let rows = recording.motion.rows().iter().filter(|row| row.t_s <= outcome.end_s);
    let drive = Drive {
        name: name(&recording.file),
        speed: Series::new("", rows.map(|row| (row.t_s, row.speed_mps)))
            .joined_within(recording.motion.longest_interval_s()),
        errors: lines.iter().map(errors).collect(),
        ..Drive::default()
    };
    if let Classes::Outage(_) = classes {
        return drive;
    }
    let link = LinkRecord { messages: outcome.messages.clone(), ..LinkRecord::default() };
    let start_s = recording.motion.start_s();
    let silences = link.silences(SILENCE_S, start_s, outcome.end_s).into_iter();
    Drive {
        age: Series::new("", samples.iter().map(|sample| (sample.at_s, sample.age_s))),
        silences: silences.map(|window| Interval::new(window.from_s, window.to_s, "silence")).collect(),
        messages: outcome.messages.clone(),
        ..drive
    }
}

fn name(file: &Path) -> String {
    file.file_stem().map_or("a drive".into(), |stem| stem.to_string_lossy().into_owned())
}

fn title(options: &EvaluateOptions) -> String {
    let drives = match options.recordings.as_slice() {
        [only] => name(&only.file),
        several => format!("{} recorded drives", several.len()),
    };
    match &options.impairment {
        Impairment::Channel(file, _) => format!("{drives} over {}", name(file)),
        Impairment::Outages(_) => format!("{drives} in silence"),
    }
}

fn facts(options: &EvaluateOptions, outcomes: &[Outcome], results: &Results) -> Vec<(String, String)> {
    use crate::report::markup::count;
    let mut facts: Vec<(String, String)> = Vec::new();
    for recording in &options.recordings {
        facts.push(("drive".into(), format!("{}, {:.1} s", name(&recording.file), recording.motion.duration_s())));
        facts.extend(recording.predecessor.iter().map(|(file, _)| ("vehicle ahead".into(), name(file))));
    }
    match &options.impairment {
        Impairment::Channel(file, _) => facts.push(("link".into(), name(file))),
        Impairment::Outages(lengths_s) => {
            let lengths: Vec<String> = lengths_s.iter().map(f64::to_string).collect();
            facts.push(("silences".into(), format!("{} s, from every message on", lengths.join(", "))));
        }
    }
    facts.push(("prediction step δt, tick".into(), format!("{} s", options.step_s)));
    facts.push(("comparisons".into(), count(results.ticks as u64)));
    facts.push(("messages sent".into(), count(results.messages_sent as u64)));
    facts.push(("messages delivered".into(), count(results.messages_delivered as u64)));
    facts.extend(refusals(outcomes).into_iter().map(|(cause, times)| (format!("refused: {cause}"), count(times))));
    facts
}

fn command(options: &EvaluateOptions) -> String {
    let mut words = vec!["holdover-sim evaluate --motion".to_owned()];
    words.extend(options.recordings.iter().map(|recording| recording.file.display().to_string()));
    let ahead: Vec<String> = options
        .recordings
        .iter()
        .filter_map(|r| r.predecessor.as_ref())
        .map(|(file, _)| file.display().to_string())
        .collect();
    if !ahead.is_empty() {
        words.push(format!("--predecessor {}", ahead.join(" ")));
    }
    words.push(match &options.impairment {
        Impairment::Channel(file, _) => format!("--channel {}", file.display()),
        Impairment::Outages(lengths_s) => {
            format!("--outage {}", lengths_s.iter().map(f64::to_string).collect::<Vec<_>>().join(","))
        }
    });
    words.push(format!("--step {}", options.step_s));
    words.join(" ")
}
