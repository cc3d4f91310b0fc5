//! What a unit in a corridor costs: the traffic on its bus enters, the wall time of its ticks leaves.

use holdover::Config;
use holdover::coordination::Itinerary;
use serde::Serialize;

use crate::bus::Frame;
use crate::commands::sweep::of_log;
use crate::sim::vehicle::Unit;

/// What a tick costs at a prediction step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Prediction step.
    pub step_s: f64,
    /// Mean wall time of a tick.
    pub ns_per_tick: f64,
    /// Ticks in a second of doing nothing else.
    pub updates_per_s: f64,
}

/// Measures it, on this thread alone; `None` without traffic.
#[must_use]
pub fn measure(step_s: f64, config: &Config, itinerary: &'static Itinerary, log: &[(f64, Frame)]) -> Option<Cost> {
    let mut unit = Unit::new(config).ok()?;
    unit.set_out(itinerary).ok()?;
    let timing = of_log(&unit, config, log)?;
    Some(Cost { step_s, ns_per_tick: timing.ns_per_tick, updates_per_s: timing.updates_per_s })
}
