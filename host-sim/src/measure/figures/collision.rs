//! Who ran into whom: two vehicles enter, tick by tick; when their bumper gap fell below 0, how fast they were, and what the unit of the
//! one behind believed at that moment leave.

use std::fmt;

use serde::Serialize;

use super::mode_name;
use crate::sim::world::Tick;

/// A collision.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Collision {
    /// When the gap fell below 0.
    pub at_s: f64,
    /// The vehicle that ran into another one.
    pub vehicle: usize,
    /// The vehicle ahead of it.
    pub into: usize,
    /// Its speed.
    pub speed_mps: f64,
    /// The speed of the vehicle ahead.
    pub into_speed_mps: f64,
    /// The gap that its unit believed in; `None`: it had no estimate of the vehicle ahead.
    pub believed_gap_m: Option<f64>,
    /// The smallest gap that its unit took for possible; `None`: it had no bound.
    pub least_gap_m: Option<f64>,
    /// The age of the newest sample that its unit had.
    pub age_s: Option<f64>,
    /// The mode of its unit.
    pub mode: &'static str,
    /// The acceleration that its unit commanded.
    pub command_mps2: f64,
}

impl Collision {
    /// The collision of a vehicle with the one ahead, whose length is given.
    pub(super) fn of(at_s: f64, vehicle: usize, (ahead, length_m): (&Tick, f64), behind: &Tick) -> Self {
        let gap = |rear_m: f64| rear_m - length_m - behind.position_m;
        Self {
            at_s,
            vehicle,
            into: vehicle - 1,
            speed_mps: behind.speed_mps,
            into_speed_mps: ahead.speed_mps,
            believed_gap_m: behind.target.map(|target| gap(target.position_m)),
            least_gap_m: behind.target.and_then(|target| target.bound).map(|bound| gap(bound.lowest_position_m)),
            age_s: behind.target.map(|target| target.age_s),
            mode: mode_name(behind.mode),
            command_mps2: behind.command_mps2,
        }
    }
}

impl fmt::Display for Collision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { at_s, vehicle, into, speed_mps, into_speed_mps, mode, .. } = self;
        write!(
            f,
            "vehicle {vehicle} ran into vehicle {into} at {at_s:.2} s, at {speed_mps:.2} m/s against {into_speed_mps:.2} m/s"
        )?;
        match (self.believed_gap_m, self.age_s) {
            (Some(gap_m), Some(age_s)) => {
                write!(f, "; its unit ({mode}) believed in a gap of {gap_m:.2} m, by data {age_s:.2} s old")
            }
            _ => write!(f, "; its unit ({mode}) had no estimate of it"),
        }
    }
}
