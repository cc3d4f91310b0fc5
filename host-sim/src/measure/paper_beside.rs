//! The literal paper's method beside a unit: the messages that the unit receives enter; the method's estimate of the
//! measured vehicle's position goes into the trace.

use std::io;

use super::baseline::Baseline;
use super::baseline::paper::Paper;
use super::observer::Tap;
use crate::input::scenario::Scenario;
use crate::sim::world::{Trace, World};

/// The literal paper's method, and its listener on the bus of the measuring vehicle.
pub struct PaperBeside {
    tap: Tap,
    paper: Paper,
}

impl PaperBeside {
    /// Listens from now on.
    #[must_use]
    pub fn of(world: &World<'_>, scenario: &Scenario) -> Self {
        let tap = Tap::of(world);
        Self { paper: Paper::new(tap.measured().vehicle, scenario.step_s), tap }
    }

    /// Records the estimate of a tick, and returns it. It has to be called after the units have acted in that tick.
    ///
    /// # Errors
    /// Errors of the bus.
    pub fn note(&mut self, world: &World<'_>, at_s: f64, trace: &mut Trace) -> io::Result<Option<f64>> {
        self.tap.hear(world, at_s, |heard| self.paper.hear(&heard))?;
        let position_m = self.paper.estimate(at_s).map(|estimate| estimate.position_m);
        trace.push_paper(position_m);
        Ok(position_m)
    }
}
