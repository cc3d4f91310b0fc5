//! Observing a run: what the observers see of every vehicle at every tick.

use holdover::wire::StationHash;
use holdover::wire::command::ModeCode;

use crate::sim::world::TargetBelief;

/// A vehicle at a tick, as the observers see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// Its trip.
    pub trip: usize,
    /// Its station on the air.
    pub station: StationHash,
    /// Its road.
    pub road: usize,
    /// Distance of its front bumper along its road.
    pub way_m: f64,
    /// Length, bumper to bumper.
    pub length_m: f64,
    /// Its speed.
    pub speed_mps: f64,
    /// Acceleration reached.
    pub acceleration_mps2: f64,
    /// Acceleration that its unit commanded.
    pub command_mps2: f64,
    /// Its unit's mode.
    pub mode: ModeCode,
    /// Its odometer where the road begins.
    pub odometer_m: f64,
    /// The intersection that its unit takes for the next one, and whose virtual lane it uses. Between two reviews this
    /// may be an intersection that the vehicle has just left.
    pub next: Option<usize>,
    /// The station that its unit follows.
    pub followed: Option<StationHash>,
    /// Its unit's estimate of the target, on the axis of its own odometer.
    pub belief: Option<TargetBelief>,
    /// The time at which its own horizon has it at the next conflict area, once in [`ASKED_S`](super::entries::ASKED_S).
    pub foreseen_entry_s: Option<f64>,
    /// Whether its envelope changed the command.
    pub limited: bool,
    /// Whether its radio is silent.
    pub dark: bool,
    /// Whether what it takes for GNSS time is off.
    pub mistakes_time: bool,
}

/// An observer of a run.
pub trait Watch {
    /// Called before a tick, with the vehicles that have left and drive on beyond the end of their way.
    fn beyond(&mut self, _sightings: &[Sighting]) {}
    /// Called at a tick, with all vehicles that are on their way, in the order of their trips.
    fn tick(&mut self, at_s: f64, sightings: &[Sighting]);
    /// Called when a vehicle has left.
    fn left(&mut self, at_s: f64, trip: usize);
}
