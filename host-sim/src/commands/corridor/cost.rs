//! The computing time of a unit in a corridor: the frames on its bus enter, the wall time of its ticks leaves.

use holdover::Config;
use holdover::coordination::Itinerary;
use serde::Serialize;

use crate::bus::Frame;
use crate::commands::sweep::of_log;
use crate::sim::vehicle::Unit;

/// The computing time of a tick at a prediction step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Prediction step.
    pub step_s: f64,
    /// Mean wall time of a tick.
    pub ns_per_tick: f64,
    /// Ticks per second, if the thread does nothing else.
    pub updates_per_s: f64,
}

/// Measures it on this thread; `None` without frames.
#[must_use]
pub fn measure(step_s: f64, config: &Config, itinerary: &'static Itinerary, log: &[(f64, Frame)]) -> Option<Cost> {
    let mut unit = Unit::new(config).ok()?;
    unit.set_out(itinerary).ok()?;
    let timing = of_log(&unit, config, log)?;
    Some(Cost { step_s, ns_per_tick: timing.ns_per_tick, updates_per_s: timing.updates_per_s })
}
