//! What a corridor is: the roads and intersections, who drives on them, over what channel. A scenario file says it
//! ([`super::read`]); what stands here has been checked.

use crate::input::scenario::{Envelope, Span};
use crate::sim::ground::Point;

/// A network of roads that cross, and its traffic.
#[derive(Clone, Debug, PartialEq)]
pub struct Corridor {
    /// Seed of everything random.
    pub seed: u64,
    /// Vehicles arrive for so long; a run ends when the last of them has left. 10 s to a day.
    pub duration_s: f64,
    /// Tick of every unit and step of the plants; 1 ms to 0.1 s.
    pub period_s: f64,
    /// Prediction step `δt` of the core; 1 ms to 1 s.
    pub step_s: f64,
    /// How far ahead the units look, in seconds.
    pub horizon_s: f64,
    /// How often every vehicle sends its messages; 1 to 100 Hz.
    pub message_rate_hz: f64,
    /// How many peers every unit has slots for; 2 to 16.
    pub slots: usize,
    /// Whose road the figures over time are about.
    pub ego_road: usize,
    /// The ego is the first to arrive there from then on.
    pub ego_after_s: f64,
    /// The traffic.
    pub traffic: Traffic,
    /// Every link.
    pub radio: Radio,
    /// How every vehicle differs from what its unit believes.
    pub wrong: Wrong,
    /// The last gate of every unit.
    pub envelope: Envelope,
    /// What the verdict asks for.
    pub limits: Limits,
    /// The roads: one to 32.
    pub roads: Vec<RoadPlan>,
    /// The intersections: one to 16.
    pub intersections: Vec<IntersectionPlan>,
}

impl Corridor {
    /// The same with so many vehicles a minute in all, each road's share as it was.
    #[must_use]
    pub fn demanding(&self, vehicles_per_min: f64) -> Self {
        let mut other = self.clone();
        let scale = vehicles_per_min / self.vehicles_per_min();
        other.roads.iter_mut().for_each(|road| road.vehicles_per_min *= scale);
        other
    }

    /// How many arrive in a minute, on all roads together.
    #[must_use]
    pub fn vehicles_per_min(&self) -> f64 {
        self.roads.iter().map(|road| road.vehicles_per_min).sum()
    }

    /// More than so many vehicles a minute in all do not fit the least headway on some road.
    #[must_use]
    pub fn most_per_min(&self) -> f64 {
        let busiest = self.roads.iter().map(|road| road.vehicles_per_min).fold(0.0, f64::max);
        60.0 / self.traffic.headway_s * self.vehicles_per_min() / busiest
    }
}

/// How they drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traffic {
    /// Speed that everyone wants on a free road, `v_∞`.
    pub target_speed_mps: f64,
    /// Speed at which they arrive.
    pub entry_speed_mps: Span,
    /// Time gap, `t_g`.
    pub time_gap_s: f64,
    /// Distance kept at standstill, `s_0`.
    pub standstill_m: f64,
    /// Share by which every vehicle exceeds that target speed to catch up with the vehicle ahead.
    pub catch_up: f64,
    /// Least time between two arrivals on the same road.
    pub headway_s: f64,
    /// They appear so far before the first crossing point of their road.
    pub appear_m: f64,
    /// They have left when the front is so far beyond the last one.
    pub leave_m: f64,
    /// Share of vans, 0 to 1.
    pub vans: f64,
    /// Share of buses, 0 to 1.
    pub buses: f64,
}

/// Every link of the radio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radio {
    /// Mean of the delay before truncation at 0.
    pub delay_mean_s: f64,
    /// Standard deviation of the delay before truncation at 0.
    pub delay_std_s: f64,
    /// Share of messages lost, 0 to 1.
    pub loss: f64,
    /// Nobody is heard from farther away.
    pub range_m: f64,
    /// For so long, from a random moment of its way on, a vehicle neither transmits nor receives.
    pub dark_s: f64,
}

impl Radio {
    /// Without delay, loss and silence, to the same distance.
    #[must_use]
    pub fn perfect(self) -> Self {
        Self { delay_mean_s: 0.0, delay_std_s: 0.0, loss: 0.0, dark_s: 0.0, ..self }
    }
}

/// How every vehicle and its road differ from what its unit believes and publishes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrong {
    /// Its mass is this many times as much.
    pub mass_scale: f64,
    /// The road rises by this share of the way.
    pub grade: f64,
    /// Wind against it.
    pub headwind_mps: f64,
    /// The time constant of its actuators is this many times as long.
    pub lag_scale: f64,
}

impl Wrong {
    /// Everything is as believed.
    pub const NOTHING: Self = Self { mass_scale: 1.0, grade: 0.0, headwind_mps: 0.0, lag_scale: 1.0 };
}

/// What the verdict asks for beside no collision, everyone served and the truth inside every bound; `None`: nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest position error of a target whose own association has not changed within a second.
    pub position_error_m: Option<f64>,
    /// Mean travel time, as so many times that with a perfect link.
    pub travel_time_ratio: Option<f64>,
    /// Full stops while the envelope is not engaged.
    pub full_stops: Option<u64>,
}

/// One lane of traffic in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadPlan {
    /// Its name.
    pub name: String,
    /// The line that it lies beside, in the direction of travel.
    pub points: Vec<Point>,
    /// How far to the right of it; negative: to the left.
    pub right_m: f64,
    /// Mean rate of arrivals.
    pub vehicles_per_min: f64,
}

/// Where roads cross.
#[derive(Clone, Debug, PartialEq)]
pub struct IntersectionPlan {
    /// Its name.
    pub name: String,
    /// Its middle.
    pub at: Point,
    /// The conflict area reaches so far to either side of it, on every road.
    pub half_m: f64,
}
