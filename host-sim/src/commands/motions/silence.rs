//! One silence: a motion, a phase and a seed enter; the errors of every method's estimate of the target leave, tick by
//! tick of the silence.
//!
//! The baselines decode the frames that the listener's unit receives, and are evaluated after its tick. The unit's
//! estimate is the one on its bus.

use std::io;
use std::path::Path;

use super::consensus::Consensus;
use super::motion::TargetMotion;
use crate::error::Error;
use crate::input::scenario::{Scenario, SensorShare};
use crate::measure::baseline::{self, Baseline, Estimate};
use crate::measure::heard::Heard;
use crate::measure::observer::Tap;
use crate::sim::stages::Stages;
use crate::sim::world::{Measured, Trace, World};

/// Number of methods: the unit and the baselines.
pub const METHODS: usize = 8;
/// The names of the methods in results.
pub const NAMES: [&str; METHODS] =
    ["holdover", "freeze", "constant_speed", "constant_acceleration", "singer", "kalman", "paper", "consensus"];

/// The errors at one tick of a silence: estimated minus true.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Time since the beginning of the silence.
    pub since_s: f64,
    /// Errors of the position, in m, by method.
    pub position_m: [f64; METHODS],
    /// Errors of the speed, in m/s, by method.
    pub speed_mps: [f64; METHODS],
}

/// Runs the silence.
///
/// # Errors
/// A configuration that the units refuse, errors of the bus, and a target that was never heard.
pub fn run(motion: TargetMotion, phase: u32, seed: u64, range_sensors: SensorShare) -> Result<Vec<Errors>, Error> {
    let scenario = motion.scenario(phase, range_sensors)?;
    let world = World::new(&scenario, seed, None).map_err(|cause| {
        Error::new(format!("the units refuse it: {cause}"), "report this").in_file(Path::new("motions"))
    })?;
    let errors = listen(&scenario, world, motion.silent_from_s(phase));
    errors.map_err(|error| Error::new(format!("the bus failed: {error}"), "see the system's log"))
}

fn listen(scenario: &Scenario, mut world: World<'_>, from_s: f64) -> io::Result<Vec<Errors>> {
    let Measured { vehicle: target, by } = world.measured();
    let mut tap = Tap::of(&world);
    let mut baselines = baseline::all(target, scenario.step_s);
    baselines.push(Box::new(Consensus::new(target)));
    world.warm_up()?;
    let mut trace = world.trace();
    let mut errors = Vec::new();
    for tick in 0..world.ticks() {
        let at_s = tick as f64 * scenario.period_s;
        world.tick(at_s, |world| {
            world.note(at_s, &mut trace);
            tap.hear(world, at_s, |heard| {
                let heard = with_law_only(heard);
                baselines.iter_mut().for_each(|baseline| baseline.hear(&heard));
            })?;
            let since_s = at_s - from_s;
            if since_s >= -1e-9 {
                let beliefs = beliefs(&mut baselines, at_s, ours(&trace, by));
                errors.extend(against(&trace, target, &beliefs, since_s.max(0.0)));
            }
            Ok(())
        })?;
    }
    Ok(errors)
}

/// The estimates of all methods, the unit's first.
fn beliefs(baselines: &mut [Box<dyn Baseline>], at_s: f64, ours: Option<Estimate>) -> [Option<Estimate>; METHODS] {
    let mut baselines = baselines.iter_mut();
    std::array::from_fn(|method| if method == 0 { ours } else { baselines.next()?.estimate(at_s) })
}

/// Removes the driving parameters of a vehicle that a driver drives, because such a vehicle publishes that it follows
/// no law. The paper does not consider such vehicles: it would let this one accelerate to the target speed of its unit.
/// Without driving parameters it assumes 13.4 m/s, at which the vehicle cruises here.
fn with_law_only(heard: Heard) -> Heard {
    Heard {
        parameters: heard.parameters.filter(|parameters| parameters.leads || parameters.predecessor.is_some()),
        ..heard
    }
}

fn ours(trace: &Trace, by: usize) -> Option<Estimate> {
    let belief = trace.vehicles[by].last()?.target?;
    Some(Estimate { position_m: belief.position_m, speed_mps: belief.speed_mps })
}

/// The errors; `None` if a method has no estimate.
fn against(trace: &Trace, target: usize, beliefs: &[Option<Estimate>; METHODS], since_s: f64) -> Option<Errors> {
    let truth = trace.vehicles[target].last()?;
    let mut errors = Errors { since_s, position_m: [0.0; METHODS], speed_mps: [0.0; METHODS] };
    for (method, belief) in beliefs.iter().enumerate() {
        let belief = (*belief)?;
        errors.position_m[method] = belief.position_m - truth.position_m;
        errors.speed_mps[method] = belief.speed_mps - truth.speed_mps;
    }
    Some(errors)
}
