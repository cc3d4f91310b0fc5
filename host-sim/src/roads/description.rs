//! The description of a corridor: its roads and intersections, the traffic, and the channel. [`super::read`] reads it
//! from a scenario file; the values here have been checked.

use serde::Serialize;

use crate::input::scenario::{Envelope, Event, Fitted, Span, VehicleBus};
use crate::sim::ground::Point;

/// A network of roads that cross, and its traffic.
#[derive(Clone, Debug, PartialEq)]
pub struct Corridor {
    /// Seed of everything random.
    pub seed: u64,
    /// Time in which vehicles arrive; 10 s to a day. A run ends when the last of them has left, or nobody will move any more.
    pub duration_s: f64,
    /// Tick of every unit and step of the plants; 1 ms to 0.1 s.
    pub period_s: f64,
    /// Prediction step `δt` of the core; 1 ms to 1 s.
    pub step_s: f64,
    /// Horizon of the units, in seconds.
    pub horizon_s: f64,
    /// Rate of each vehicle's messages; 1 to 100 Hz.
    pub message_rate_hz: f64,
    /// Number of peer slots of every unit; 2 to 16.
    pub slots: usize,
    /// Road of the ego, which the figures over time are about.
    pub ego_road: usize,
    /// The ego is the first vehicle that arrives on that road at or after this time.
    pub ego_after_s: f64,
    /// The traffic.
    pub traffic: Traffic,
    /// The links.
    pub radio: Radio,
    /// Differences of every vehicle from what its unit assumes.
    pub wrong: Wrong,
    /// The envelope of every unit.
    pub envelope: Envelope,
    /// The vehicles' range sensors.
    pub sensors: Fitted,
    /// The emergency stops and faults of the side with emergencies.
    pub emergencies: Emergencies,
    /// Every vehicle's own bus.
    pub bus: VehicleBus,
    /// What is driven and changed during the run, in the order of time. A vehicle is the index of its trip.
    pub events: Vec<Event>,
    /// Limits for the verdict.
    pub limits: Limits,
    /// The roads; 1 to 32.
    pub roads: Vec<RoadPlan>,
    /// The intersections; 1 to 16.
    pub intersections: Vec<IntersectionPlan>,
}

impl Corridor {
    /// The same corridor with this many vehicles a minute in all. Each road keeps its fraction. They are other vehicles, so nothing
    /// befalls them.
    #[must_use]
    pub fn demanding(&self, vehicles_per_min: f64) -> Self {
        let mut other = Self { events: Vec::new(), ..self.clone() };
        let scale = vehicles_per_min / self.vehicles_per_min();
        other.roads.iter_mut().for_each(|road| road.vehicles_per_min *= scale);
        other
    }

    /// Arrivals per minute on all roads together.
    #[must_use]
    pub fn vehicles_per_min(&self) -> f64 {
        self.roads.iter().map(|road| road.vehicles_per_min).sum()
    }

    /// The largest number of vehicles a minute in all for which every road keeps the least headway.
    #[must_use]
    pub fn most_per_min(&self) -> f64 {
        let busiest = self.roads.iter().map(|road| road.vehicles_per_min).fold(0.0, f64::max);
        60.0 / self.traffic.headway_s * self.vehicles_per_min() / busiest
    }
}

/// The traffic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traffic {
    /// Target speed of all vehicles on a free road, `v_∞`.
    pub target_speed_mps: f64,
    /// Speed at which vehicles arrive.
    pub entry_speed_mps: Span,
    /// Time gap, `t_g`.
    pub time_gap_s: f64,
    /// Time gap to which that opens while the vehicle ahead is neither heard nor seen.
    pub silent_time_gap_s: f64,
    /// Standstill distance, `s_0`.
    pub standstill_m: f64,
    /// Share by which every vehicle exceeds that target speed to catch up with the vehicle ahead.
    pub catch_up: f64,
    /// Share of the acceleration of the vehicle ahead that it passes on; 0 or 0.5. The latter needs `step_s` and `period_s` of at least
    /// 7.813 ms.
    pub feed_forward: f64,
    /// Least time between two arrivals on the same road.
    pub headway_s: f64,
    /// Vehicles appear this far before the first crossing point of their road.
    pub appear_m: f64,
    /// Vehicles have left when their front is this far beyond the last crossing point.
    pub leave_m: f64,
    /// Fraction of vans, 0 to 1.
    pub vans: f64,
    /// Fraction of buses, 0 to 1.
    pub buses: f64,
    /// Fraction of vehicles whose units keep no passes, 0 to 1.
    pub without_passes: f64,
}

/// The radio links.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radio {
    /// Mean of the delay before truncation at 0.
    pub delay_mean_s: f64,
    /// Standard deviation of the delay before truncation at 0.
    pub delay_std_s: f64,
    /// Fraction of messages lost, 0 to 1.
    pub loss: f64,
    /// Radio range.
    pub range_m: f64,
    /// Length of each vehicle's radio silence: it neither transmits nor receives. The silence begins at a random time
    /// on its way.
    pub dark_s: f64,
    /// How often every vehicle repeats the passes that it hears; 0: it does not.
    pub repeats_hz: f64,
}

impl Radio {
    /// The same range, without delay, loss and silence.
    #[must_use]
    pub fn perfect(self) -> Self {
        Self { delay_mean_s: 0.0, delay_std_s: 0.0, loss: 0.0, dark_s: 0.0, ..self }
    }
}

/// Differences of every vehicle and its road from what its unit assumes and publishes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrong {
    /// Factor on the mass.
    pub mass_scale: f64,
    /// Grade of the road: rise per distance.
    pub grade: f64,
    /// Head wind.
    pub headwind_mps: f64,
    /// Factor on the time constant of the actuators.
    pub lag_scale: f64,
}

impl Wrong {
    /// No difference.
    pub const NOTHING: Self = Self { mass_scale: 1.0, grade: 0.0, headwind_mps: 0.0, lag_scale: 1.0 };
}

/// Emergency stops and faults. In an emergency stop a vehicle brakes as hard as it has published, at a random place of its
/// way and whatever its unit commands, until it stands. Its unit does not foresee it, and no other vehicle is told.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Emergencies {
    /// Share of the vehicles that make one, 0 to 1.
    pub share: f64,
    /// How long the vehicle stands after it, 0 to 60 s.
    pub stands_s: f64,
    /// Share of the vehicles that have a fault, 0 to 1.
    pub faults: f64,
    /// How long a vehicle waits before its driver takes over, 0 to 600 s; 0: no driver does.
    pub driver_after_s: f64,
}

impl Emergencies {
    /// No vehicle makes a stop, none has a fault, and no driver takes over.
    pub const NONE: Self = Self { share: 0.0, stands_s: 0.0, faults: 0.0, driver_after_s: 0.0 };
}

/// Limits for the verdict. It also asks that no vehicles collide, that every vehicle is served, and that every bound
/// contains the true motion. `None`: no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest position error of a target whose own association has not changed within a second.
    pub position_error_m: Option<f64>,
    /// Mean travel time, as a ratio to that with a perfect link.
    pub travel_time_ratio: Option<f64>,
    /// Full stops; checked while the envelope is not engaged.
    pub full_stops: Option<u64>,
}

/// One lane of traffic in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadPlan {
    /// Its name.
    pub name: String,
    /// The line beside which the lane lies, in the direction of travel.
    pub points: Vec<Point>,
    /// Offset of the lane to the right of that line; negative: to the left.
    pub right_m: f64,
    /// Radius of its corners; 0: it has none.
    pub corner_m: f64,
    /// Mean rate of arrivals.
    pub vehicles_per_min: f64,
}

/// An intersection.
#[derive(Clone, Debug, PartialEq)]
pub struct IntersectionPlan {
    /// Its name.
    pub name: String,
    /// Its centre.
    pub at: Point,
    /// Half the length of the conflict area, along every road.
    pub half_m: f64,
}
