//! The summary of a replay: counts enter, text for a terminal or JSON leaves.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::Serialize;

use super::tally::Tally;
use crate::report::markup::count;

/// The summary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Frames in the log.
    pub frames: u64,
    /// Good frames by message.
    pub recognised: BTreeMap<String, u64>,
    /// Refused frames by cause.
    pub refused: BTreeMap<&'static str, u64>,
    /// Frames that are not for the unit.
    pub ignored: u64,
    /// Ticks of the unit.
    pub ticks: u64,
    /// Whether the final state of the unit differs from that of a unit that ticked as often and received nothing.
    pub state_changed: bool,
    /// Wall-clock figures.
    pub timing: Timing,
}

/// Wall-clock figures. All other figures are the same for the same log.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Timing {
    /// Frames per second, from opening the log to its end: reading, receiving, and all ticks.
    pub frames_per_s: f64,
}

impl Summary {
    /// The summary of these counts, after `seconds`.
    #[must_use]
    pub fn new(tally: &Tally, state_changed: bool, elapsed_s: f64) -> Self {
        Self {
            frames: tally.frames(),
            recognised: tally.recognised().into_iter().collect(),
            refused: tally.refused().into_iter().collect(),
            ignored: tally.ignored(),
            ticks: tally.ticks(),
            state_changed,
            timing: Timing { frames_per_s: tally.frames() as f64 / elapsed_s.max(1e-9) },
        }
    }

    /// The text for a terminal.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let mut row = |indent: usize, name: &str, number: u64| {
            let _ = writeln!(text, "{:indent$}{name:<width$}{:>12}", "", count(number), width = 24 - indent);
        };
        row(0, "frames", self.frames);
        row(2, "recognised", self.recognised.values().sum());
        self.recognised.iter().for_each(|(name, count)| row(4, name, *count));
        row(2, "refused", self.refused.values().sum());
        self.refused.iter().for_each(|(cause, count)| row(4, cause, *count));
        row(2, "ignored", self.ignored);
        row(0, "ticks", self.ticks);
        row(0, "frames per s", self.timing.frames_per_s as u64);
        let state = if self.state_changed { "changed by what it heard" } else { "as if it had heard nothing" };
        let _ = writeln!(text, "state of the unit: {state}");
        text
    }
}
