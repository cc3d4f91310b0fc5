//! Pavement that two roads share: before an intersection, where vehicles of one leg turn to different exits, and behind
//! it, where ways join. The bodies of vehicles on one road enter; the parts of them that are on another road leave.

use super::lane::{Lane, WIDTH_M};
use crate::sim::globe::Shift;
use crate::sim::road::Road;

/// Whether two roads share a leg or an exit is looked for this far before and behind the middle of an intersection, in
/// metres. By then every corner is taken.
pub(super) const CORNERS_M: f64 = 20.0;

/// Lanes that are no farther apart than this, in metres, and whose directions differ by no more than [`SAME_DEG`], are
/// one.
const SAME_M: f64 = 0.1;
const SAME_DEG: f64 = 2.0;

/// Length of the steps in which a stretch is followed, in metres.
const STEP_M: f64 = 0.5;

/// A stretch of a road that lies on another one, within the width of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shared {
    /// The other road.
    pub other: usize,
    /// Where the stretch begins and ends along that road.
    pub from_m: f64,
    /// Where it ends.
    pub to_m: f64,
    /// What a place along the other road is less along the own one.
    pub ahead_m: f64,
}

impl Shared {
    /// The stretch around a place where the two roads are one: at `own_m` along the own one and at `other_m` along the other.
    fn around(own: &Lane, (other, lane): (usize, &Lane), [own_m, other_m]: [f64; 2]) -> Self {
        let ahead_m = other_m - own_m;
        let end_m = |step_m: f64| {
            let is_there = |way_m: &f64| {
                let is_on_roads = (0.0..=lane.road.length_m()).contains(way_m)
                    && (0.0..=own.road.length_m()).contains(&(way_m - ahead_m));
                let apart = || Shift::between(own.road.at(way_m - ahead_m).0, lane.road.at(*way_m).0).length_m();
                is_on_roads && apart() < WIDTH_M
            };
            let ways = std::iter::successors(Some(other_m), |way_m| Some(way_m + step_m));
            ways.take_while(is_there).last().unwrap_or(other_m)
        };
        Self { other, from_m: end_m(-STEP_M), to_m: end_m(STEP_M), ahead_m }
    }
}

/// Where a road is at a place of another one, if the two are one there.
pub(super) fn same(own: &Road, way_m: f64, other: &Road) -> Option<f64> {
    let (place, heading_deg) = own.at(way_m);
    let (there_m, aside_m) = other.nearest(place);
    let turned_deg = (other.at(there_m).1 - heading_deg + 180.0).rem_euclid(360.0) - 180.0;
    (aside_m <= SAME_M && turned_deg.abs() <= SAME_DEG).then_some(there_m)
}

/// The stretches that each road shares with others.
pub(super) fn shared(lanes: &[Lane]) -> Vec<Vec<Shared>> {
    let of_pair = |own: &Lane, other: usize| {
        let lane = &lanes[other];
        let mut stretches: Vec<Shared> = Vec::new();
        for stop in &own.stops {
            if !lane.stops.iter().any(|there| there.intersection == stop.intersection) {
                continue;
            }
            for own_m in [stop.at_m - CORNERS_M, stop.at_m + CORNERS_M] {
                let Some(other_m) = same(&own.road, own_m, &lane.road) else { continue };
                let is_in = |held: &Shared| (held.from_m..=held.to_m).contains(&other_m);
                if !stretches.iter().any(is_in) {
                    stretches.push(Shared::around(own, (other, lane), [own_m, other_m]));
                }
            }
        }
        stretches
    };
    let of_lane = |(road, own): (usize, &Lane)| {
        (0..lanes.len()).filter(|other| *other != road).flat_map(|other| of_pair(own, other)).collect()
    };
    lanes.iter().enumerate().map(of_lane).collect()
}
