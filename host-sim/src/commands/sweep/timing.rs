//! The computing time of a tick: a scenario and a seed enter; the wall time of the follower's `tick` leaves.
//!
//! The frames on the follower's bus are recorded first. Then a unit with the same configuration receives them again,
//! with no other work in between, and only its `tick` is timed. Every pass does the same work tick by tick, and any
//! disturbance makes a tick longer. So the fastest of a few passes counts for each tick.

use std::hint::black_box;
use std::time;

use holdover::Config;
use holdover::time::Instant;
use serde::Serialize;

use crate::bus::Frame;
use crate::error::Error;
use crate::input::scenario::Scenario;
use crate::measure::simulate::simulate;
use crate::sim::time::micros;
use crate::sim::vehicle::Unit;
use crate::sim::world::{Measured, config};

const PASSES: usize = 5;
/// Longest part of a run that is timed, in seconds.
const LONGEST_S: f64 = 20.0;
/// The unit's clock at time 0 of the run. The recorded frames begin before that time.
const POWERED_BEFORE_US: u64 = 60_000_000;

/// The computing time of a tick.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Timing {
    /// Mean wall time of the follower's `tick` over the ticks of a run, each the fastest of five passes.
    pub ns_per_tick: f64,
    /// Ticks per second, if the thread does nothing else.
    pub updates_per_s: f64,
}

/// Measures it on this thread.
///
/// # Errors
/// An error that a unit finds in the configuration from the scenario.
pub fn measure(scenario: &Scenario, seed: u64) -> Result<Timing, Error> {
    let scenario = Scenario { duration_s: scenario.duration_s.min(LONGEST_S), ..scenario.clone() };
    let by = Measured::of(&scenario).by;
    let (trace, _) = simulate(&scenario, seed, Some(by), |_| {})?;
    let config = config(&scenario, by);
    let unit = Unit::new(&config)
        .map_err(|cause| Error::new(format!("the units refuse the scenario: {cause}"), "change it accordingly"))?;
    of_log(&unit, &config, &trace.log).ok_or_else(|| Error::new("nothing was on the bus", "lengthen the run"))
}

/// The computing time of a unit that receives these frames; `None` without frames.
#[must_use]
pub fn of_log(unit: &Unit, config: &Config, log: &[(f64, Frame)]) -> Option<Timing> {
    let mut fastest = pass(unit.clone(), config, log);
    for _ in 1..PASSES {
        let again = pass(unit.clone(), config, log);
        fastest.iter_mut().zip(again).for_each(|(tick, again)| *tick = again.min(*tick));
    }
    if fastest.is_empty() {
        return None;
    }
    let ns_per_tick = fastest.iter().sum::<time::Duration>().as_nanos() as f64 / fastest.len() as f64;
    Some(Timing { ns_per_tick, updates_per_s: 1e9 / ns_per_tick })
}

/// The time of each tick of the run from time 0 on. The unit ticks from the first frame on, as it did in the run.
fn pass(mut unit: Unit, config: &Config, log: &[(f64, Frame)]) -> Vec<time::Duration> {
    let clock = |at_s: f64| Instant::from_micros(POWERED_BEFORE_US.saturating_add_signed(micros(at_s)));
    let (Some((first_s, _)), Some((last_s, _))) = (log.first(), log.last()) else { return Vec::new() };
    let mut frames = log.iter().peekable();
    let mut ticks = Vec::new();
    let mut now = clock(*first_s);
    while now <= clock(*last_s) {
        while let Some((at_s, frame)) = frames.next_if(|(at_s, _)| clock(*at_s) <= now) {
            let _ = unit.receive(clock(*at_s), frame); // the unit counts refusals
        }
        let start = time::Instant::now();
        black_box(unit.tick(black_box(now)));
        let spent = start.elapsed();
        if now >= clock(0.0) {
            ticks.push(spent);
        }
        now = now.plus(config.period);
    }
    ticks
}
