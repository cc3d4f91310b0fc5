//! The roads of a corridor and where they cross: a description enters; for every road its intersections leave, in the
//! order of travel, with the distance along the road to each crossing point.

use super::description::Corridor;
use super::lane::{Lane, Leg, Stop};
use super::movements;
use super::pavement::{Shared, shared};
use crate::sim::road::Road;

/// A road is a leg of an intersection if it passes within this distance of its centre, in metres.
pub const PASSES_WITHIN_M: f64 = 12.0;

/// Vehicles drive on for this distance beyond the end of their way, in metres. When they vanish there, no vehicle on
/// its way depends on them.
pub const RUN_OUT_M: f64 = 60.0;

/// The roads extend this far beyond the places where vehicles appear and vanish, in metres.
const BEYOND_M: f64 = 20.0 + RUN_OUT_M;

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

    /// The next conflict area of a vehicle on a road with its front at `front_m`: how many it has come to already, and where the next one
    /// begins along the road.
    #[must_use]
    pub fn next_area(&self, road: usize, front_m: f64) -> (usize, Option<f64>) {
        let begins_m = |stop: &Stop| stop.at_m - self.junctions[stop.intersection].half_m;
        let stops = &self.lanes[road].stops;
        let next = stops.iter().position(|stop| begins_m(stop) > front_m).unwrap_or(stops.len());
        (next, stops.get(next).map(begins_m))
    }

    /// Where the rear and the front of a vehicle are along a road, as far as it is on that road. It drives on the road `other`,
    /// with its front at `front_m`.
    #[must_use]
    pub fn on_road(&self, road: usize, other: usize, front_m: f64, length_m: f64) -> Option<[f64; 2]> {
        let rear_m = front_m - length_m;
        if road == other {
            return Some([rear_m, front_m]);
        }
        let touches = |one: &&Shared| one.other == other && rear_m <= one.to_m && front_m >= one.from_m;
        let one = self.shared[road].iter().find(touches)?;
        Some([rear_m.max(one.from_m), front_m.min(one.to_m)].map(|way_m| way_m - one.ahead_m))
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
}
