//! The roads of a corridor and where they cross: a description enters; for every road its intersections in the order of
//! travel, with the way along the road to each crossing point, leave.

use super::description::Corridor;
use super::road::Road;
use super::traffic::RUN_OUT_M;

/// A road is a leg of an intersection if it passes within so many metres of its middle.
pub const PASSES_WITHIN_M: f64 = 12.0;

/// Roads that cross at less than this, in degrees, share their pavement or are the two directions of one street.
const LEAST_ANGLE_DEG: f64 = 20.0;

/// The roads reach so far beyond where vehicles appear and vanish, in metres.
const BEYOND_M: f64 = 20.0 + RUN_OUT_M;

/// An intersection on a road.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// The intersection.
    pub intersection: usize,
    /// The road's number among the intersection's legs.
    pub leg: usize,
    /// The way along the road to the crossing point.
    pub at_m: f64,
}

/// A road with its intersections.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    /// Where it lies.
    pub road: Road,
    /// Its intersections in the order of travel; at least one.
    pub stops: Vec<Stop>,
    /// The way along it to where vehicles appear.
    pub entry_m: f64,
    /// The way along it to where they vanish.
    pub exit_m: f64,
}

/// A leg of an intersection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// The road that it is of.
    pub road: usize,
    /// The way along that to the crossing point.
    pub at_m: f64,
    /// Direction of travel at the crossing point, degrees clockwise from north.
    pub heading_deg: f64,
}

/// Where roads cross.
#[derive(Clone, Debug, PartialEq)]
pub struct Junction {
    /// The conflict area reaches so far to either side of the crossing point.
    pub half_m: f64,
    /// The roads through it, in the order of the description.
    pub legs: Vec<Leg>,
}

/// All of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    /// The roads, in the order of the description.
    pub lanes: Vec<Lane>,
    /// The intersections, in the order of the description.
    pub junctions: Vec<Junction>,
}

/// Whether two ways with those directions, in degrees, cross; otherwise they run beside one another, or on one another.
#[must_use]
pub fn cross(a_deg: f64, b_deg: f64) -> bool {
    (LEAST_ANGLE_DEG..=180.0 - LEAST_ANGLE_DEG).contains(&(a_deg - b_deg).rem_euclid(180.0))
}

impl Junction {
    /// Whether vehicles on those two legs can meet: their ways cross.
    #[must_use]
    pub fn conflict(&self, a: usize, b: usize) -> bool {
        a != b && cross(self.legs[a].heading_deg, self.legs[b].heading_deg)
    }
}

impl Network {
    /// Of a description that was checked.
    #[must_use]
    pub fn of(corridor: &Corridor) -> Self {
        let (appear_m, leave_m) = (corridor.traffic.appear_m, corridor.traffic.leave_m);
        let mut junctions: Vec<Junction> = Vec::new();
        junctions.extend(corridor.intersections.iter().map(|plan| Junction { half_m: plan.half_m, legs: Vec::new() }));
        let mut lanes = Vec::new();
        for (index, plan) in corridor.roads.iter().enumerate() {
            let road = Road::new(&plan.points, plan.right_m, appear_m + BEYOND_M, leave_m + BEYOND_M);
            let mut stops = Vec::new();
            for (intersection, (place, junction)) in corridor.intersections.iter().zip(&mut junctions).enumerate() {
                let (at_m, aside_m) = road.nearest(place.at);
                if aside_m <= PASSES_WITHIN_M {
                    stops.push(Stop { intersection, leg: junction.legs.len(), at_m });
                    junction.legs.push(Leg { road: index, at_m, heading_deg: road.at(at_m).1 });
                }
            }
            stops.sort_by(|a, b| a.at_m.total_cmp(&b.at_m));
            let (first_m, last_m) = (stops.first(), stops.last());
            let (first_m, last_m) = (first_m.map_or(0.0, |stop| stop.at_m), last_m.map_or(0.0, |stop| stop.at_m));
            lanes.push(Lane { road, stops, entry_m: first_m - appear_m, exit_m: last_m + leave_m });
        }
        Self { lanes, junctions }
    }
}
