//! The table of string stability, for a terminal: rows enter, text leaves.

use std::fmt::Write;

use super::amplification::Worst;
use super::disturbance::Disturbance;
use super::options::{StringOptions, shipped_time_gap_s};
use super::rows::{LIMIT, Row, Smallest, smallest, smallest_time_gap_s};
use crate::verdict::Verdict;

/// The table.
#[must_use]
pub fn text(options: &StringOptions, rows: &[Row], failures: &[String]) -> String {
    let mut text = String::from("largest ratio of a vehicle's speed amplitude to its predecessor's\n");
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{:<12}{:<10}{:<6}{:>9}  {:<20}{:>6}{:>12}{:>14}{:>17}{:>8}{:>10}",
        "time gap, s",
        "delay, s",
        "loss",
        "holdover",
        "",
        "runs",
        "runs above",
        "as it stands",
        "age times speed",
        "CACC",
        "degraded"
    );
    for row in rows {
        let place = row.holdover.as_ref().map(|worst| format!("({}, vehicle {})", worst.disturbance, worst.vehicle));
        let _ = writeln!(
            text,
            "{:<12}{:<10}{:<6}{:>9}  {:<20}{:>6}{:>12}{:>14}{:>17}{:>8}{:>10}",
            row.time_gap_s,
            row.delay_s,
            row.loss,
            ratio(row.holdover.as_ref()),
            place.unwrap_or_default(),
            row.runs,
            row.runs_above,
            ratio(row.as_it_stands.as_ref()),
            ratio(row.age_times_speed.as_ref()),
            ratio(row.cacc.as_ref()),
            ratio(row.degraded_cacc.as_ref()),
        );
    }
    if options.time_gaps_s.len() > 1 {
        gaps(&mut text, options, rows);
    }
    match smallest_time_gap_s(rows) {
        Some(gap) => {
            let shipped = shipped(options);
            let _ =
                writeln!(text, "at most {LIMIT} at and above a time gap of {gap} s, of those that were tried{shipped}");
        }
        None => {
            let _ = writeln!(text, "not so at the largest time gap that was tried");
        }
    }
    let _ = writeln!(text, "{}", verdict(options, rows, failures));
    text
}

/// The smallest time gaps at each link.
fn gaps(text: &mut String, options: &StringOptions, rows: &[Row]) {
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "\nsmallest time gap tried, s, at and above which the ratio is at most {LIMIT}\n{:<10}{:<6}{:>9}{:>14}{:>17}{:>8}{:>10}",
        "delay, s", "loss", "holdover", "as it stands", "age times speed", "CACC", "degraded"
    );
    let or = |gap: Option<f64>, nothing: &str| gap.map_or(nothing.to_owned(), |gap| gap.to_string());
    let not_run = not_run(options);
    for Smallest { delay_s, loss, holdover_s, as_it_stands_s, age_times_speed_s, cacc_s, degraded_cacc_s } in
        smallest(rows)
    {
        let ours = or(holdover_s, "none");
        let [stands, moved, cacc, degraded] =
            [as_it_stands_s, age_times_speed_s, cacc_s, degraded_cacc_s].map(|gap| or(gap, not_run));
        let _ = writeln!(text, "{delay_s:<10}{loss:<6}{ours:>9}{stands:>14}{moved:>17}{cacc:>8}{degraded:>10}");
    }
    text.push('\n');
}

/// What is said of the time gap that is shipped: that is one of cars.
#[must_use]
pub fn shipped(options: &StringOptions) -> String {
    let shipped = || format!("; {} s is shipped", shipped_time_gap_s(options.range_sensors));
    if options.has_cars_alone() { shipped() } else { String::new() }
}

/// What is said where another method has no smallest time gap: in a mixed string it was not run.
#[must_use]
pub fn not_run(options: &StringOptions) -> &'static str {
    if options.mixture.is_mixed() { "-" } else { "none" }
}

/// The verdict, and what it is based on.
#[must_use]
pub fn verdict(options: &StringOptions, rows: &[Row], failures: &[String]) -> String {
    format!("{}; {}", Verdict::of(failures).line(failures), runs(options, rows))
}

/// The number of runs, and of seeds of each disturbance.
#[must_use]
pub fn runs(options: &StringOptions, rows: &[Row]) -> String {
    let most = |disturbance: Disturbance| {
        let seeds = options.losses.iter().map(|&loss| options.seeds_of(disturbance, loss)).max().unwrap_or(0);
        let what = if disturbance == Disturbance::Step { "a step" } else { "each sine" };
        format!("{what} with {seeds} {}", if seeds == 1 { "seed" } else { "seeds" })
    };
    let sine = options.disturbances.iter().copied().find(|disturbance| disturbance.frequency_hz().is_some());
    let of: Vec<String> = std::iter::once(Disturbance::Step).chain(sine).map(most).collect();
    let runs = match rows.iter().map(|row| row.runs).sum::<usize>() {
        1 => "1 run".to_owned(),
        runs => format!("{runs} runs"),
    };
    let is_drawn = options.losses.iter().any(|loss| *loss > 0.0);
    let once = if is_drawn && options.losses.contains(&0.0) { ", where nothing is lost with 1" } else { "" };
    format!("{runs}, {}{once}, from seed {} on", of.join(" and "), options.seed)
}

/// A ratio to four digits.
#[must_use]
pub fn ratio(worst: Option<&Worst>) -> String {
    worst.map_or("-".into(), |worst| format!("{:.4}", worst.ratio))
}
