//! The judge: an outcome and the limits enter, figures and a verdict with its reasons leave.
//!
//! *Inconclusive* comes before failed: a harness that was late, or lost frames, has not tested the device properly.
//! Only a device whose process ended by itself has failed however late the harness was.

use std::collections::BTreeMap;

use serde::Serialize;

use super::fault::Kind;
use super::fault_injector::Played;
use super::lateness::{self, LATE_MAX_MS, LATE_P99_MS};
use super::monitor::CommandRecord;
use super::outcome::{Cut, Outcome};
use super::recovery::{Recovery, recoveries};
use super::session::Setup;
use super::spread::Spread;
use crate::measure::figures::{Summary, failures, mode_name};
use crate::verdict::Verdict;

/// Default limit of the time from the vehicle's motion to the device's command, except for one command in a hundred:
/// two periods, because the device need not tick when its vehicle sends.
pub const LATENCY_P99_MS: f64 = 20.0;
/// Fraction of periods that a device in real time may miss on an operating system without real time.
pub const MISSED_SHARE: f64 = 0.01;

/// The figures of the device.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DeviceFigures {
    /// Frames that it sent.
    pub frames: u64,
    /// Commands in the run.
    pub commands: usize,
    /// Number of times that it restarted by itself.
    pub restarts: usize,
    /// Errors of the protection of its frames, except in the aftermath of faults.
    pub e2e_errors: usize,
    /// Its refusals by cause, as it reports them.
    pub refusals: BTreeMap<&'static str, u32>,
    /// Commands by mode.
    pub modes: BTreeMap<&'static str, usize>,
    /// Frames of other nodes on the harness's identifiers.
    pub foreign_frames: u64,
    /// Error frames on the bus.
    pub bus_errors: u64,
}

/// The device beside its twin.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DeviationFigures {
    /// Whether it was in lock step.
    pub lock_step: bool,
    /// Ticks that were compared.
    pub ticks: u64,
    /// Frames that were compared, in lock step.
    pub frames: u64,
    /// Number of those frames that were not the same.
    pub different_frames: u64,
    /// Largest difference of the estimated position.
    pub position_m: f64,
    /// Largest difference of the estimated speed.
    pub speed_mps: f64,
    /// Largest difference of the command.
    pub command_mps2: f64,
    /// Ticks in which the modes differed.
    pub mode_ticks: u64,
    /// Ticks with a difference that the time stamps do not explain.
    pub unexplained: usize,
}

/// Wall-clock figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Timing {
    /// Time on the bus from the vehicle's motion (in lock step: from the step) to the command that rests on it.
    pub latency: Spread,
    /// Periods in which the device sent nothing.
    pub missed_periods: usize,
    /// Commands in these figures, without those in the aftermath of faults.
    pub judged_commands: usize,
    /// Commands that are not in them because the harness was late at that time.
    pub disturbed_commands: usize,
    /// The figures of the harness.
    pub harness: HarnessTiming,
}

/// The figures of the harness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct HarnessTiming {
    /// Frames that it sent.
    pub frames: u64,
    /// Number of those frames that were not seen on the bus.
    pub lost: u64,
    /// Frames that it could not send because the interface was down.
    pub refused: u64,
    /// Lateness of its ticks.
    pub lateness: Spread,
}

/// The whole result.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Results {
    /// `passed`, `failed` or `inconclusive`.
    pub verdict: &'static str,
    /// The reasons.
    pub reasons: Vec<String>,
    /// The device.
    pub device: DeviceFigures,
    /// The device beside its twin.
    pub deviation: DeviationFigures,
    /// The consequences of each fault.
    pub faults: Vec<Recovery>,
    /// The scenario's own figures.
    pub scenario: Summary,
    /// Wall-clock figures.
    pub timing: Timing,
}

impl Results {
    /// The verdict, for the exit code.
    #[must_use]
    pub fn code(&self) -> Verdict {
        match self.verdict {
            "passed" => Verdict::Pass,
            "failed" => Verdict::Failed,
            _ => Verdict::Inconclusive,
        }
    }
}

/// Judges an outcome.
#[must_use]
pub fn judge(setup: &Setup, outcome: &Outcome) -> Results {
    let scenario = figures(setup, outcome);
    let (device, deviation) = (device(setup, outcome), deviation(setup, outcome));
    let timing = timing(setup, outcome);
    let faults = recoveries(setup, outcome);
    let own = inconclusive(outcome, &timing);
    let failed = failed(setup, outcome, &device, &deviation, &timing, &faults, &scenario);
    let has_ended = outcome.cut.as_ref().is_some_and(Cut::has_ended);
    let (verdict, reasons) = match (own.is_empty() || has_ended, failed.is_empty()) {
        (false, _) => ("inconclusive", own.into_iter().chain(failed).collect()),
        (true, false) => ("failed", failed),
        (true, true) => ("passed", Vec::new()),
    };
    Results { verdict, reasons, device, deviation, faults, scenario, timing }
}

fn device(setup: &Setup, outcome: &Outcome) -> DeviceFigures {
    let monitor = &outcome.monitor;
    let in_run = || monitor.commands().iter().filter(|beat| outcome.time_of(beat.at) >= 0.0);
    let mut modes = BTreeMap::new();
    in_run().for_each(|beat| *modes.entry(mode_name(beat.mode)).or_default() += 1);
    DeviceFigures {
        frames: monitor.frames(),
        commands: in_run().count(),
        restarts: monitor.restarts().iter().filter(|at| !setup.is_excused(outcome.time_of(**at))).count(),
        e2e_errors: monitor.e2e().filter(|(at, _)| !setup.is_excused(outcome.time_of(*at))).count(),
        refusals: monitor.refusals(),
        modes,
        foreign_frames: outcome.foreign,
        bus_errors: outcome.bus_errors,
    }
}

fn deviation(setup: &Setup, outcome: &Outcome) -> DeviationFigures {
    let found = &outcome.deviation;
    let figures = DeviationFigures {
        ticks: found.ticks,
        position_m: found.position_m,
        speed_mps: found.speed_mps,
        command_mps2: found.command_mps2,
        mode_ticks: found.modes,
        unexplained: found.unexplained_s.iter().filter(|at_s| !setup.is_excused(**at_s)).count(),
        ..DeviationFigures::default()
    };
    match &outcome.steps {
        Some(steps) => DeviationFigures {
            lock_step: true,
            ticks: steps.steps,
            frames: steps.frames,
            different_frames: steps.different,
            ..figures
        },
        None => figures,
    }
}

fn timing(setup: &Setup, outcome: &Outcome) -> Timing {
    let monitor = &outcome.monitor;
    let Outcome { lateness, .. } = outcome;
    let is_of_device = |at_s: f64| at_s >= 0.0 && !setup.is_excused(at_s);
    let is_disturbed =
        |beat: &&CommandRecord| lateness.excuses(outcome.time_of(beat.at), beat.latency.unwrap_or(setup.config.period));
    let (disturbed, judged): (Vec<&CommandRecord>, Vec<&CommandRecord>) =
        monitor.commands().iter().filter(|beat| is_of_device(outcome.time_of(beat.at))).partition(is_disturbed);
    let latencies: Vec<i64> = judged.iter().filter_map(|beat| Some(beat.latency?.as_micros())).collect();
    // Each period is judged on its own: a late tick of the harness excuses only the missed periods near it, not all
    // periods of the same silence.
    let missed = monitor.missed().into_iter().filter(|_| outcome.steps.is_none());
    let missed = missed.flat_map(|(end, periods)| (1..=periods).map(move |back| (end, back)));
    let missed = missed.map(|(end, back)| outcome.time_of(end.minus(setup.config.period.times(back))));
    let counts = outcome.counts;
    Timing {
        latency: Spread::of(&latencies),
        missed_periods: missed.filter(|at_s| is_of_device(*at_s) && !lateness.is_around(*at_s)).count(),
        judged_commands: judged.len(),
        disturbed_commands: disturbed.len(),
        harness: HarnessTiming {
            frames: counts.sent,
            lost: counts.sent.saturating_sub(counts.confirmed + counts.refused),
            refused: counts.refused,
            lateness: lateness.spread(),
        },
    }
}

/// The figures of the world. Of the ticks at which a target was outside its bound, those are not counted that are in the aftermath of a
/// fault, because a device that receives false values sends false values; nor those around which the harness was late, because it
/// received the device's frames later.
fn figures(setup: &Setup, outcome: &Outcome) -> Summary {
    let recorded = &outcome.recorded;
    let mut figures = recorded.summary.clone();
    let is_judged = |at_s: &&f64| !setup.is_excused(**at_s) && !outcome.lateness.is_around(**at_s);
    figures.bound.violations = recorded.outside_s.iter().filter(is_judged).count();
    figures
}

/// The reasons against the harness.
fn inconclusive(outcome: &Outcome, timing: &Timing) -> Vec<String> {
    let mut reasons = Vec::from_iter(lateness::too_many(timing.disturbed_commands, timing.judged_commands));
    let lateness = timing.harness.lateness;
    if outcome.steps.is_none() {
        for (what, value, limit) in
            [("once", lateness.max_ms, LATE_MAX_MS), ("in one of 100 ticks", lateness.p99_ms, LATE_P99_MS)]
        {
            if let Some(value) = value.filter(|value| *value > limit) {
                reasons.push(format!("the harness was {value:.1} ms late {what}, of at most {limit} ms"));
            }
        }
    }
    let is_down = outcome.faults.iter().any(|played| played.fault.kind == Kind::Interface);
    if timing.harness.lost > 0 && !is_down {
        reasons.push(format!("{} frames of the harness were not seen on the bus", timing.harness.lost));
    }
    for Played { fault, failed, .. } in &outcome.faults {
        if let Some(failed) = failed {
            reasons.push(format!("the fault {} could not be played: {failed}", fault.kind.name()));
        }
    }
    reasons
}

/// The reasons against the device.
fn failed(
    setup: &Setup,
    outcome: &Outcome,
    device: &DeviceFigures,
    deviation: &DeviationFigures,
    timing: &Timing,
    faults: &[Recovery],
    scenario: &Summary,
) -> Vec<String> {
    if let Some(cut) = &outcome.cut {
        return vec![said(cut)];
    }
    let mut reasons = Vec::new();
    let mut limit = |is_met: bool, reason: String| {
        if !is_met {
            reasons.push(reason);
        }
    };
    if let Some(p99) = timing.latency.p99_ms.filter(|_| !deviation.lock_step) {
        limit(
            p99 <= setup.latency_p99_ms,
            format!(
                "late: commands {p99:.1} ms after the motion in one of 100, of at most {} ms",
                setup.latency_p99_ms
            ),
        );
    }
    let share = timing.missed_periods as f64 / (timing.missed_periods + timing.judged_commands).max(1) as f64;
    limit(share <= MISSED_SHARE, format!("late: {} periods without a command", timing.missed_periods));
    limit(device.e2e_errors == 0, format!("{} errors of its end-to-end protection", device.e2e_errors));
    limit(device.restarts == 0, format!("it started anew {} times by itself", device.restarts));
    let first_s = outcome.deviation.unexplained_s.iter().find(|at_s| !setup.is_excused(**at_s)).unwrap_or(&0.0);
    let differ = format!(
        "{} ticks differ from the twin's by more than the time stamps explain; the first at {first_s:.2} s",
        deviation.unexplained
    );
    limit(deviation.unexplained == 0, differ);
    if let Some((at_s, device, twin)) = outcome.steps.as_ref().and_then(|steps| steps.first.as_ref()) {
        let cause = format!(
            "{} of {} frames are not the twin's; the first at {at_s:.2} s: {device} instead of {twin}",
            deviation.different_frames, deviation.frames
        );
        limit(false, cause);
    }
    for fault in faults {
        if let Some(reason) = fault.reason() {
            limit(false, reason);
        }
    }
    reasons.extend(failures(&setup.scenario, scenario));
    reasons
}

/// The reason why a run was cut short, in words.
#[must_use]
pub fn said(cut: &Cut) -> String {
    let ended =
        |ended: &Option<String>| ended.as_ref().map_or(String::new(), |how| format!("; its process ended: {how}"));
    match cut {
        Cut::Silent { waited, ended: how } => {
            format!("the device is silent: not one frame of it in {} s{}", waited.as_millis() / 1000, ended(how))
        }
        Cut::Gone { at_s, ended: how } => {
            format!("the device is gone: its last frame was at {at_s:.2} s{}", ended(how))
        }
        Cut::NotFresh { tick: 1 } => {
            "the device ticks by itself: it gives more answers than it is asked for; start it in lock step".into()
        }
        Cut::NotFresh { tick } => format!(
            "the device has run before: its first answer has the count {tick} instead of 1; for lock step give it power anew"
        ),
    }
}
