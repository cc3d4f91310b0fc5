//! The journal of a run, for its charts: the sightings enter; trajectories, the ego's errors and the frames on its bus
//! leave.

use std::collections::BTreeMap;

use super::watch::{Sighting, Watch};
use crate::bus::Frame;
use crate::input::impairment::Window;

/// Time from one entry of a trajectory to the next.
pub const EVERY_S: f64 = 0.25;

/// The trajectory of one vehicle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// Its road.
    pub road: usize,
    /// Time, and distance along the road.
    pub points: Vec<(f64, f64)>,
}

/// The journal.
#[derive(Clone, Debug, Default)]
pub struct Journal {
    /// The trip of the ego.
    pub ego: Option<usize>,
    /// The trajectories of all vehicles, by trip.
    pub tracks: BTreeMap<usize, Track>,
    /// The time in which the ego's radio is silent.
    pub dark: Option<Window>,
    /// Error of the ego's target estimate over time.
    pub errors: Vec<(f64, f64)>,
    /// The frames on the ego's bus.
    pub log: Vec<(f64, Frame)>,
    last_s: Option<f64>,
}

impl Journal {
    /// An empty journal.
    #[must_use]
    pub fn new(ego: Option<usize>) -> Self {
        Self { ego, ..Self::default() }
    }
}

impl Watch for Journal {
    fn tick(&mut self, at_s: f64, sightings: &[Sighting]) {
        if sightings.iter().any(|own| Some(own.trip) == self.ego && own.dark) {
            self.dark.get_or_insert(Window { from_s: at_s, to_s: at_s }).to_s = at_s;
        }
        if self.last_s.is_some_and(|last_s| at_s - last_s < EVERY_S - 1e-9) {
            return;
        }
        self.last_s = Some(at_s);
        for own in sightings {
            let track = self.tracks.entry(own.trip).or_default();
            track.road = own.road;
            track.points.push((at_s, own.way_m));
        }
    }

    fn left(&mut self, _: f64, _: usize) {}
}
