//! The tables of an evaluation, for a terminal: figures enter, text leaves.

use std::fmt::Write;

use super::figures::{Figures, Results, figures};
use super::options::EvaluateOptions;
use super::sample::{Outcome, refusals};
use crate::measure::baseline::spoken;
use crate::report::markup::count;
use crate::verdict::Verdict;

/// The tables.
pub fn text(options: &EvaluateOptions, outcomes: &[Outcome], results: &Results) -> String {
    let mut text = String::new();
    let (ticks, sent, delivered) = (results.ticks, results.messages_sent, results.messages_delivered);
    // Writing to a string cannot fail.
    let _ = match options.lengths_s() {
        None => writeln!(
            text,
            "{} ticks, {} messages sent, {} delivered",
            count(ticks as u64),
            count(sent as u64),
            count(delivered as u64)
        ),
        Some(_) => writeln!(text, "{} comparisons, {} messages", count(ticks as u64), count(sent as u64)),
    };
    let verdict = || Verdict::of(&results.failures).line(&results.failures);
    if ticks == 0 {
        let _ = writeln!(text, "{}", verdict());
        return text;
    }
    let refusals: Vec<String> =
        refusals(outcomes).iter().map(|(cause, times)| format!("{cause} {}", count(*times))).collect();
    if !refusals.is_empty() {
        let _ = writeln!(text, "refused by the unit: {}", refusals.join(", "));
    }
    let _ = writeln!(text, "\n{:<23}{:>33}{:>14}", "", "position error, m", "speed, m/s");
    let _ = writeln!(text, "{:<23}{:>11}{:>11}{:>11}{:>14}", "", "rms", "99 %", "maximum", "rms");
    for (name, figures) in results.methods() {
        let Figures { rms_position_m, p99_position_m, max_position_m, rms_speed_mps, .. } = *figures;
        let _ = write!(text, "{:<23}", spoken(name));
        [rms_position_m, p99_position_m, max_position_m].into_iter().for_each(|value| cell(&mut text, value));
        let _ = writeln!(text, "{:>14}", number(rms_speed_mps));
    }
    let heading = match options.lengths_s() {
        None => "position error by age of the data, rms, m",
        Some(_) => "position error after a silence, rms, m",
    };
    let _ = writeln!(text, "\n{heading}");
    classes(&mut text, results);
    if let (true, Some(lengths_s)) = (outcomes.len() > 1, options.lengths_s()) {
        recordings(&mut text, options, outcomes, lengths_s);
    }
    if !results.failures.is_empty() {
        let _ = writeln!(text, "{}", verdict());
    }
    text
}

/// Writes a column for each class and a row for each method.
fn classes(text: &mut String, results: &Results) {
    let heads = heads(&results.ours);
    let row = |text: &mut String, name: &str, cells: Vec<String>| {
        let _ = writeln!(text, "{name:<23}{}", cells.iter().map(|cell| format!("{cell:>11}")).collect::<String>());
    };
    row(text, "", heads.iter().map(|(name, _)| name.clone()).collect());
    for (name, figures) in results.methods() {
        row(text, &spoken(name), class_rms(figures).into_iter().map(number).collect());
    }
    row(text, "count", heads.iter().map(|(_, samples)| count(*samples as u64)).collect());
}

/// Writes the unit's errors after each length of silence, per recording, beside the best baseline's.
fn recordings(text: &mut String, options: &EvaluateOptions, outcomes: &[Outcome], lengths_s: &[f64]) {
    let _ = writeln!(text, "\nholdover / best baseline, recording by recording, rms, m");
    for (recording, outcome) in options.recordings.iter().zip(outcomes) {
        let samples: Vec<_> = outcome.samples.iter().collect();
        let methods = figures(&samples, Some(lengths_s)).map(|figures| class_rms(&figures));
        let _ = writeln!(text, "{}", recording.file.display());
        let _ = write!(text, "{:<23}", "");
        for (index, ours) in methods[0].iter().enumerate() {
            let best = methods[1..].iter().filter_map(|method| method[index]).reduce(f64::min);
            let _ = write!(text, "{:>18}", format!("{} / {}", number(*ours), number(best)));
        }
        text.push('\n');
    }
}

/// The name and the count of each class.
pub fn heads(figures: &Figures) -> Vec<(String, usize)> {
    let ages = figures.by_age.iter().flatten().map(|class| {
        let name = class.to_s.map_or(format!("≥{} s", class.from_s), |to_s| format!("{}–{to_s} s", class.from_s));
        (name, class.count)
    });
    let outages = figures.by_outage.iter().flatten().map(|class| (format!("{} s", class.outage_s), class.count));
    ages.chain(outages).collect()
}

fn class_rms(figures: &Figures) -> Vec<Option<f64>> {
    let ages = figures.by_age.iter().flatten().map(|class| class.rms_position_m);
    ages.chain(figures.by_outage.iter().flatten().map(|class| class.rms_position_m)).collect()
}

fn cell(text: &mut String, value: Option<f64>) {
    let _ = write!(text, "{:>11}", number(value));
}

fn number(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.4}"))
}
