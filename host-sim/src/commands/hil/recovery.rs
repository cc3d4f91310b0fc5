//! The consequences of a fault: the device's commands over time enter; its worst mode leaves, and the time until it
//! drove again.

use holdover::wire::command::ModeCode;
use serde::Serialize;

use super::outcome::Outcome;
use super::session::{AFTERMATH_S, Setup};
use crate::measure::figures::mode_name;

/// Time for which it has to drive without interruption to have recovered, in seconds.
const STEADY_S: f64 = 0.3;
/// A gap longer than this is a silence, in seconds: the timeout of the command.
const SILENCE_S: f64 = 0.05;

/// A fault and its consequences.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Recovery {
    /// The fault.
    pub fault: &'static str,
    /// Beginning of the fault.
    pub from_s: f64,
    /// End of the fault.
    pub to_s: f64,
    /// The worst state of the device until it had recovered: a mode, or `silent`.
    pub worst: &'static str,
    /// Time from the end of the fault until it drove again; `None`: it did not.
    pub recovered_after_s: Option<f64>,
}

impl Recovery {
    /// The reason if this is a failure.
    #[must_use]
    pub fn reason(&self) -> Option<String> {
        let Self { fault, to_s, worst, .. } = self;
        match self.recovered_after_s {
            Some(after_s) if after_s <= AFTERMATH_S => None,
            Some(after_s) => Some(format!("{fault}: it drove again only {after_s:.1} s after {to_s} s")),
            None => Some(format!("{fault}: it did not drive again after {to_s} s; it was {worst}")),
        }
    }
}

/// The consequences of each fault that ended within the run.
#[must_use]
pub fn recoveries(setup: &Setup, outcome: &Outcome) -> Vec<Recovery> {
    let commands: Vec<(f64, ModeCode)> =
        outcome.monitor.commands().iter().map(|command| (outcome.time_of(command.at), command.mode)).collect();
    let ended = setup.faults.iter().filter(|fault| fault.to_s < setup.scenario.duration_s);
    ended
        .map(|fault| {
            let (worst, recovered_after_s) = recovery(&commands, fault.from_s, fault.to_s);
            Recovery { fault: fault.kind.name(), from_s: fault.from_s, to_s: fault.to_s, worst, recovered_after_s }
        })
        .collect()
}

/// The worst state from the beginning of a fault until the device drove again, and the time of that after the end of
/// the fault.
fn recovery(commands: &[(f64, ModeCode)], from_s: f64, to_s: f64) -> (&'static str, Option<f64>) {
    let drives = |mode: ModeCode| matches!(mode, ModeCode::Cooperative | ModeCode::Holdover);
    let is_steady = |first: usize| {
        let until_s = commands[first].0 + STEADY_S;
        let following = || commands[first..].iter().take_while(|(at_s, _)| *at_s <= until_s);
        let reaches = following().last().is_some_and(|(at_s, _)| until_s - at_s < SILENCE_S);
        reaches && following().all(|(_, mode)| drives(*mode))
    };
    let recovered = (0..commands.len()).find(|index| commands[*index].0 >= to_s && is_steady(*index));
    let until_s = recovered.map_or(f64::INFINITY, |index| commands[index].0);
    let within = |at_s: f64| (from_s..=until_s).contains(&at_s);
    let mut silent =
        commands.windows(2).any(|pair| within(pair[1].0) && pair[1].0 - pair[0].0 > SILENCE_S && pair[1].0 > from_s);
    silent |= commands.last().is_none_or(|(at_s, _)| *at_s < from_s);
    let severity = |mode: &ModeCode| match mode {
        ModeCode::Cooperative => 0,
        ModeCode::Holdover => 1,
        ModeCode::Standby => 2,
        ModeCode::Fallback => 3,
        ModeCode::Fault => 4,
    };
    let worst = commands.iter().filter(|(at_s, _)| within(*at_s)).map(|(_, mode)| *mode).max_by_key(severity);
    let worst = if silent { "silent" } else { worst.map_or("silent", mode_name) };
    (worst, recovered.map(|index| (commands[index].0 - to_s).max(0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ModeCode::{Cooperative, Fault, Holdover, Standby};

    /// Commands every 10 ms, in spans of a mode or of silence.
    fn commands(spans: &[(u32, Option<ModeCode>)]) -> Vec<(f64, ModeCode)> {
        let modes = spans.iter().flat_map(|(count, mode)| (0..*count).map(move |_| *mode));
        modes.enumerate().filter_map(|(index, mode)| Some((index as f64 * 0.01, mode?))).collect()
    }

    #[test]
    fn a_device_that_a_fault_does_not_touch_has_recovered_at_once() {
        let (worst, after_s) = recovery(&commands(&[(300, Some(Cooperative))]), 1.0, 2.0);
        assert_eq!((worst, after_s.map(|after_s| after_s < 0.01)), ("cooperative", Some(true)));
        assert_eq!(recovery(&commands(&[(150, Some(Cooperative)), (150, Some(Holdover))]), 1.0, 2.0).0, "holdover");
    }

    #[test]
    fn the_worst_mode_counts_and_the_first_time_that_it_drives_on() {
        let spans = [(100, Some(Cooperative)), (110, Some(Fault)), (5, Some(Cooperative)), (5, Some(Fault))];
        let spans = spans.into_iter().chain([(100, Some(Holdover))]).collect::<Vec<_>>();
        let (worst, after_s) = recovery(&commands(&spans), 1.0, 2.0);
        assert_eq!((worst, (after_s.unwrap() * 100.0).round()), ("fault", 20.0));
    }

    #[test]
    fn silence_is_worse_than_any_mode_and_may_last() {
        let cut = [(100, Some(Cooperative)), (110, None), (30, Some(Standby)), (60, Some(Cooperative))];
        let (worst, after_s) = recovery(&commands(&cut), 1.0, 2.0);
        assert_eq!((worst, (after_s.unwrap() * 100.0).round()), ("silent", 40.0));
        assert_eq!(recovery(&commands(&[(100, Some(Cooperative))]), 1.0, 2.0), ("silent", None));
    }
}
