//! The roads of a corridor and where they cross: a description enters; for every road its intersections leave, in the
//! order of travel, with the distance along the road to each crossing point.

use holdover::coordination::Movement;

use super::description::Corridor;
use super::movements;
use super::pavement::{Shared, shared};
use crate::sim::road::Road;

/// A road is a leg of an intersection if it passes within this distance of its centre, in metres.
pub const PASSES_WITHIN_M: f64 = 12.0;

/// Two ways whose directions differ by less than this, in degrees, do not cross: they share their pavement, or are the
/// two directions of one street.
const LEAST_ANGLE_DEG: f64 = 20.0;

/// Width of the widest vehicle, a bus, in metres. The way of every vehicle is as wide.
pub const WIDTH_M: f64 = 2.5;

/// Vehicles drive on for this distance beyond the end of their way, in metres. When they vanish there, no vehicle on
/// its way depends on them.
pub const RUN_OUT_M: f64 = 60.0;

/// The roads extend this far beyond the places where vehicles appear and vanish, in metres.
const BEYOND_M: f64 = 20.0 + RUN_OUT_M;

/// An intersection on a road.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// The intersection.
    pub intersection: usize,
    /// The road's number among the ways through the intersection.
    pub leg: usize,
    /// Distance along the road to the crossing point.
    pub at_m: f64,
}

/// A road with its intersections.
#[derive(Clone, Debug, PartialEq)]
pub struct Lane {
    /// Its geometry.
    pub road: Road,
    /// Its intersections in the order of travel; at least one.
    pub stops: Vec<Stop>,
    /// Distance along it to the place where vehicles appear.
    pub entry_m: f64,
    /// Distance along it to the place where their way ends.
    pub exit_m: f64,
}

/// The way of a road through an intersection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// The road.
    pub road: usize,
    /// Distance along that road to the crossing point.
    pub at_m: f64,
    /// Direction of travel at the crossing point, degrees clockwise from north.
    pub heading_deg: f64,
    /// By how much it turns to the right there, in degrees.
    pub turn_deg: f64,
    /// The way from the crossing point to where the middle of the intersection is beside the lane of the exit.
    pub exits_m: f64,
    /// The leg by which it comes and the exit by which it leaves.
    pub movement: Movement,
}

/// An intersection with the ways through it.
#[derive(Clone, Debug, PartialEq)]
pub struct Junction {
    /// Half the length of the conflict area, along every road.
    pub half_m: f64,
    /// The roads through it, in the order of the description.
    pub legs: Vec<Leg>,
    /// For each of them, whether it conflicts with each of them.
    conflicts: Vec<Vec<bool>>,
}

/// All roads and intersections.
#[derive(Clone, Debug, PartialEq)]
pub struct Network {
    /// The roads, in the order of the description.
    pub lanes: Vec<Lane>,
    /// The intersections, in the order of the description.
    pub junctions: Vec<Junction>,
    /// For each road, the stretches of it that lie on other roads.
    pub(super) shared: Vec<Vec<Shared>>,
}

/// Whether two ways with these directions, in degrees, cross. Otherwise they run side by side, or on one another.
#[must_use]
pub fn cross(a_deg: f64, b_deg: f64) -> bool {
    (LEAST_ANGLE_DEG..=180.0 - LEAST_ANGLE_DEG).contains(&(a_deg - b_deg).rem_euclid(180.0))
}

impl Leg {
    /// Whether it goes straight on.
    #[must_use]
    pub fn is_straight(&self) -> bool {
        self.turn_deg == 0.0
    }
}

impl Junction {
    /// Whether vehicles on these two ways can meet in the conflict area: they come by different legs, and their ways cross or
    /// join.
    #[must_use]
    pub fn conflict(&self, a: usize, b: usize) -> bool {
        self.conflicts[a][b]
    }

    /// Numbers its ways, and compares each with each.
    fn compare(&mut self, lanes: &[Lane]) {
        movements::numbered(&mut self.legs, lanes);
        let (legs, half_m) = (&self.legs, self.half_m);
        let conflicts = |a: &Leg| legs.iter().map(|b| movements::conflict(a, b, lanes, half_m)).collect();
        self.conflicts = legs.iter().map(conflicts).collect();
    }
}

impl Network {
    /// The network of a checked description.
    #[must_use]
    pub fn of(corridor: &Corridor) -> Self {
        let (appear_m, leave_m) = (corridor.traffic.appear_m, corridor.traffic.leave_m);
        let mut junctions: Vec<Junction> = Vec::new();
        let junction = |half_m| Junction { half_m, legs: Vec::new(), conflicts: Vec::new() };
        junctions.extend(corridor.intersections.iter().map(|plan| junction(plan.half_m)));
        let mut lanes = Vec::new();
        for (index, plan) in corridor.roads.iter().enumerate() {
            let ends_m = [appear_m + BEYOND_M, leave_m + BEYOND_M];
            let road = Road::new(&plan.points, plan.right_m, plan.corner_m, ends_m);
            let mut stops = Vec::new();
            for (intersection, (place, junction)) in corridor.intersections.iter().zip(&mut junctions).enumerate() {
                let (nearest_m, aside_m) = road.nearest(place.at);
                if aside_m <= PASSES_WITHIN_M {
                    let leg = movements::leg(index, &road, place.at, nearest_m);
                    stops.push(Stop { intersection, leg: junction.legs.len(), at_m: leg.at_m });
                    junction.legs.push(leg);
                }
            }
            stops.sort_by(|a, b| a.at_m.total_cmp(&b.at_m));
            let (first_m, last_m) = (stops.first(), stops.last());
            let (first_m, last_m) = (first_m.map_or(0.0, |stop| stop.at_m), last_m.map_or(0.0, |stop| stop.at_m));
            lanes.push(Lane { road, stops, entry_m: first_m - appear_m, exit_m: last_m + leave_m });
        }
        junctions.iter_mut().for_each(|junction| junction.compare(&lanes));
        let shared = shared(&lanes);
        Self { lanes, junctions, shared }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::example;

    fn the_corridor() -> Network {
        Network::of(&example::corridor())
    }

    #[test]
    fn the_first_intersection_has_three_legs_and_the_others_four() {
        let network = the_corridor();
        assert_eq!(network.junctions.iter().map(|junction| junction.legs.len()).collect::<Vec<_>>(), [3, 4, 4, 4]);
        for (road, lane) in network.lanes.iter().enumerate() {
            for stop in &lane.stops {
                let leg = network.junctions[stop.intersection].legs[stop.leg];
                assert_eq!((leg.road, leg.at_m), (road, stop.at_m));
            }
        }
    }

    #[test]
    fn a_road_meets_its_intersections_in_the_order_of_travel_193_m_apart() {
        let network = the_corridor();
        for (road, order) in [(0, vec![0, 1, 2, 3]), (1, vec![3, 2, 1, 0]), (2, vec![0])] {
            let lane = &network.lanes[road];
            assert_eq!(lane.stops.iter().map(|stop| stop.intersection).collect::<Vec<_>>(), order);
            let ways = lane.stops.windows(2).map(|pair| pair[1].at_m - pair[0].at_m);
            ways.for_each(|way_m| assert!((way_m - 193.0).abs() < 1.0, "{way_m}"));
            let (first, last) = (lane.stops[0], lane.stops[order.len() - 1]);
            let [before_m, beyond_m] = [first.at_m - lane.entry_m, lane.exit_m - last.at_m];
            assert!((before_m - 180.0).abs() < 1e-9 && (beyond_m - 40.0).abs() < 1e-9, "{before_m} {beyond_m}");
        }
    }

    #[test]
    fn legs_conflict_if_their_ways_cross_and_not_if_they_are_of_one_street() {
        let junction = &the_corridor().junctions[1];
        let conflict = |a: usize, b: usize| {
            let leg = |road| junction.legs.iter().position(|leg| leg.road == road).unwrap();
            junction.conflict(leg(a), leg(b))
        };
        // 2nd Street is roads 0 and 1, Folsom Street 3 and 4.
        assert!([(0, 3), (3, 0), (0, 4), (1, 3), (4, 1)].into_iter().all(|(a, b)| conflict(a, b)));
        assert!(![(0, 0), (0, 1), (1, 0), (3, 4)].into_iter().any(|(a, b)| conflict(a, b)));
    }

    #[test]
    fn ways_cross_at_20_degrees_and_more() {
        assert!(cross(0.0, 20.0) && cross(350.0, 10.0) && cross(0.0, 160.0) && cross(90.0, 270.0 - 20.0));
        assert!(!cross(0.0, 19.9) && !cross(0.0, 160.1) && !cross(359.0, 1.0) && !cross(10.0, 190.0));
    }
}
