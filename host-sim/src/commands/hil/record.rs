//! What is kept of a run on the bench: the world enters at each tick; the trace, the figures of every tick, and the times at which a
//! target was outside its bound leave. Once the trace is full, only those times take more memory.

use std::io;

use super::session::Setup;
use crate::measure::figures::{Summary, Tally};
use crate::measure::paper_beside::PaperBeside;
use crate::sim::world::{Trace, World};

/// The most ticks that are kept of a run that nobody judges.
const UNJUDGED: usize = 1000;

/// The record of a run while it runs.
pub struct Record<'a> {
    trace: Trace,
    paper: PaperBeside,
    tally: Tally<'a>,
    is_judged: bool,
    outside_s: Vec<f64>,
    ticks: i64,
}

/// The record at the end of a run.
pub struct Recorded {
    /// The ticks that were kept, and what else is known of the world.
    pub trace: Trace,
    /// The figures of every tick.
    pub summary: Summary,
    /// For each target that was outside its bound, and each tick: the time of the run, in seconds. Empty if nobody judges the run.
    pub outside_s: Vec<f64>,
}

impl<'a> Record<'a> {
    /// Before the first tick.
    #[must_use]
    pub fn of(world: &World<'_>, setup: &'a Setup, is_judged: bool) -> Self {
        Self {
            trace: world.trace().of_at_most(if is_judged { setup.most_ticks } else { UNJUDGED }),
            paper: PaperBeside::of(world, &setup.scenario),
            tally: Tally::new(&setup.scenario),
            is_judged,
            outside_s: Vec::new(),
            ticks: 0,
        }
    }

    /// A tick, after the units have acted in it.
    ///
    /// # Errors
    /// Errors of the buses.
    pub fn note(&mut self, world: &World<'_>, at_s: f64) -> io::Result<()> {
        world.note(at_s, &mut self.trace);
        let paper_m = self.paper.note(world, at_s, &mut self.trace)?;
        let outside = self.tally.note(at_s, &self.trace.latest, paper_m);
        if self.is_judged {
            self.outside_s.extend(std::iter::repeat_n(at_s, outside));
        }
        self.ticks += 1;
        Ok(())
    }

    /// The number of ticks so far.
    #[must_use]
    pub const fn ticks(&self) -> i64 {
        self.ticks
    }

    /// After the last tick. `realtime_factor` is the number of simulated seconds per second.
    ///
    /// # Errors
    /// Errors of the buses.
    pub fn finish(self, world: World<'_>, realtime_factor: f64) -> io::Result<Recorded> {
        Ok(Recorded {
            trace: world.finish(self.trace)?,
            summary: self.tally.finish(realtime_factor),
            outside_s: self.outside_s,
        })
    }
}
