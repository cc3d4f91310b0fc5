//! Watching a run: what those who watch it are shown of every vehicle at every tick.

use holdover::wire::StationHash;

use crate::sim::world::TargetBelief;

/// A vehicle at a tick, as those who watch see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// Its trip.
    pub trip: usize,
    /// What it is called on the air.
    pub station: StationHash,
    /// Its road.
    pub road: usize,
    /// The way of its front bumper along its road.
    pub way_m: f64,
    /// Bumper to bumper.
    pub length_m: f64,
    /// Its speed.
    pub speed_mps: f64,
    /// What its odometer shows where the road begins.
    pub odometer_m: f64,
    /// The intersection that its unit takes for the next one: its virtual lane is that one's. Between two reviews it may be
    /// one that the vehicle has just left.
    pub next: Option<usize>,
    /// Whom its unit follows.
    pub followed: Option<StationHash>,
    /// Where its unit believes that one is, on its own odometer's axis.
    pub belief: Option<TargetBelief>,
    /// Whether its envelope changed the command.
    pub limited: bool,
    /// Whether its radio is silent.
    pub dark: bool,
}

/// Someone who watches a run.
pub trait Watch {
    /// Before a tick: those who have left and drive on beyond the end of their way.
    fn beyond(&mut self, _sightings: &[Sighting]) {}
    /// A tick, with everyone on his way in the order of their trips.
    fn tick(&mut self, at_s: f64, sightings: &[Sighting]);
    /// A vehicle has left.
    fn left(&mut self, at_s: f64, trip: usize);
}
