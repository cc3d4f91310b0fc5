//! The report of a sweep: options, rows and failures enter, the page's content leaves.

use super::options::SweepOptions;
use super::reason;
use super::rows::{Failure, Row};
use crate::report::run::Verdict;
use crate::report::sweep::{SweepReport, SweepRow};

/// The content of the page.
pub fn report(options: &SweepOptions, rows: &[Row], failures: &[Failure]) -> SweepReport {
    let name = options.scenario_file.as_ref().and_then(|file| file.file_stem());
    let name = name.map_or("The paper’s scenario".into(), |stem| stem.to_string_lossy().into_owned());
    let passed = || format!("No collision, and nobody stopped without need, in {} runs.", options.runs());
    let reason = reason(options.runs(), failures).map_or_else(passed, |reason| format!("FAILED: {reason}"));
    SweepReport {
        title: format!("{name} over prediction steps"),
        facts: facts(options),
        verdict: Verdict { passed: failures.is_empty(), reasons: vec![reason] },
        command: command(options),
        rows: rows.iter().map(sweep_row).collect(),
    }
}

fn sweep_row(row: &Row) -> SweepRow {
    SweepRow {
        step_s: row.step_s,
        max_ours: row.ours.max_position_error_m,
        p99_ours: row.ours.p99_position_error_m,
        max_paper: row.paper.max_position_error_m,
        p99_paper: row.paper.p99_position_error_m,
        rms: [&row.ours, &row.paper].map(|errors| errors.rms_position_error_m),
        rms_intervals: [&row.ours, &row.paper].map(|errors| errors.rms_interval_m),
        less_rms: row.less_rms,
        ns_per_tick: row.timing.ns_per_tick,
    }
}

fn facts(options: &SweepOptions) -> Vec<(String, String)> {
    let scenario = &options.base;
    [
        ("runs", options.runs().to_string()),
        ("seeds", format!("{} to {}", options.seed, options.last_seed())),
        ("duration of a run", format!("{} s", scenario.duration_s)),
        ("vehicles", scenario.vehicles.len().to_string()),
        ("period of the units", format!("{} s", scenario.period_s)),
        ("messages", format!("{} Hz", scenario.message_rate_hz)),
    ]
    .map(|(name, value)| (name.into(), value))
    .to_vec()
}

fn command(options: &SweepOptions) -> String {
    let steps: Vec<String> = options.scenarios.iter().map(|scenario| scenario.step_s.to_string()).collect();
    let mut words = vec!["holdover-sim sweep".to_owned()];
    words.extend(options.scenario_file.as_ref().map(|file| file.display().to_string()));
    words.push(format!("--seed {} --seeds {} --steps {}", options.seed, options.seeds, steps.join(",")));
    words.join(" ")
}
