//! `evaluate`: recorded vehicles enter, and a recorded link or silences; the errors of the unit's and the baselines'
//! estimates of these vehicles leave, as a table or JSON, a report and a trace.
//!
//! ```text
//! recording -> publisher -> (link | silence) -> listener: bus -> unit      -> sample -> figures -> table, JSON
//!                                                             -> baselines                      -> report, trace
//! ```

pub mod arguments;
pub mod figures;
pub mod in_silence;
pub mod listener;
pub mod options;
pub mod over_link;
mod page;
pub mod publisher;
pub mod sample;
mod table;
pub mod timeline;
mod trace;

use std::time::Instant;

use holdover::ConfigError;

use crate::error::Error;
use crate::parallel;
use crate::progress::Progress;
use crate::verdict::Verdict;
use figures::{Results, Timing};
use options::{EvaluateOptions, Impairment, Recording};
use sample::Outcome;

/// Evaluates the recordings and writes the output that the options ask for.
///
/// # Errors
/// Output that cannot be written.
pub fn run(options: &EvaluateOptions) -> Result<Verdict, Error> {
    options.destination.warn();
    let start = Instant::now();
    let outcomes = outcomes(options)?;
    let ticks: u64 = outcomes.iter().map(|outcome| outcome.unit_ticks).sum();
    let timing = Timing { ticks_per_s: (ticks as f64 / start.elapsed().as_secs_f64().max(1e-9)).round() };
    let failures = failures(options, &outcomes);
    let results = Results::pooled(&outcomes, options.lengths_s(), failures, timing);
    let page = || page::report(options, &outcomes, &results).page();
    let delivered = options.destination.deliver(&results, &table::text(options, &outcomes, &results), "", page);
    let traced = options.trace.as_ref().map_or(Ok(()), |file| trace::write(file, &outcomes));
    delivered.and(traced)?;
    Ok(Verdict::of(&results.failures))
}

/// The recordings of which nothing could be compared, and why; empty if all could.
fn failures(options: &EvaluateOptions, outcomes: &[Outcome]) -> Vec<String> {
    let reason = |(recording, outcome): (&Recording, &Outcome)| {
        let name = recording.file.display();
        match &options.impairment {
            _ if !outcome.samples.is_empty() => None,
            Impairment::Channel(link, _) => Some(format!("no message of {name} arrives over {}", link.display())),
            Impairment::Outages(_) => Some(format!("{name} is shorter than every silence")),
        }
    };
    options.recordings.iter().zip(outcomes).filter_map(reason).collect()
}

/// The outcome of every recording, in the order of the command line. Over a link the recordings run in parallel. With
/// silences they run one after the other, and the silences of each run in parallel.
fn outcomes(options: &EvaluateOptions) -> Result<Vec<Outcome>, Error> {
    let total_s: f64 = options.recordings.iter().map(|recording| recording.motion.duration_s()).sum();
    let progress = Progress::of_time(total_s);
    let advance = |seconds: f64| progress.inc_s(seconds);
    let (recordings, step_s) = (&options.recordings, options.step_s);
    let over_link = |link, recording| over_link::evaluate(recording, link, step_s, &advance);
    let in_silence = |lengths_s, recording| in_silence::evaluate(recording, lengths_s, step_s, &advance);
    let outcomes: Vec<Result<Outcome, ConfigError>> = match &options.impairment {
        Impairment::Channel(_, link) => parallel::each(recordings, |recording| over_link(link, recording)),
        Impairment::Outages(lengths_s) => recordings.iter().map(|recording| in_silence(lengths_s, recording)).collect(),
    };
    progress.finish();
    let refused = |cause| Error::new(format!("the unit refuses it: {cause}"), "choose another").in_option("--step");
    outcomes.into_iter().map(|outcome| outcome.map_err(refused)).collect()
}
