//! The movements through an intersection: the roads that pass it enter; for each road its leg and exit, and with which
//! others it conflicts, leave.
//!
//! Roads that are one before the intersection have one leg, and roads that are one behind it have one exit.

use holdover::coordination::Movement;

use super::lane::{Lane, Leg, WIDTH_M, cross};
use super::pavement::{CORNERS_M, same};
use crate::sim::globe::Shift;
use crate::sim::ground::Point;
use crate::sim::road::Road;

/// A road that turns by less than this at an intersection, in degrees, goes straight on.
const STRAIGHT_DEG: f64 = 1.0;

/// An exit has the number of the leg from which it is reached with a turn by less than this, in degrees.
const AHEAD_DEG: f64 = 45.0;

/// Distance between the places at which ways are compared, in metres.
const EVERY_M: f64 = 0.25;

/// The way of a road through an intersection whose middle is at `middle`, to which it is nearest at `nearest_m`. It has no
/// numbers yet.
pub(super) fn leg(road: usize, way: &Road, middle: Point, nearest_m: f64) -> Leg {
    let [before, beyond] = [-CORNERS_M, CORNERS_M].map(|by_m| way.at(nearest_m + by_m));
    let turn_deg =
        Some(turned_deg(before.1, beyond.1)).filter(|turn_deg| turn_deg.abs() >= STRAIGHT_DEG).unwrap_or(0.0);
    let (at_m, exits_m) = if turn_deg == 0.0 {
        (nearest_m, 0.0)
    } else {
        // Where the middle is beside the lanes of the leg and of the exit, if these went on straight.
        let foot = |(place, heading_deg): (Point, f64)| Shift::between(place, middle).along(along(heading_deg));
        let [entry_m, exit_m] = [nearest_m - CORNERS_M + foot(before), nearest_m + CORNERS_M + foot(beyond)];
        (entry_m, exit_m - entry_m)
    };
    Leg { road, at_m, heading_deg: way.at(at_m).1, turn_deg, exits_m, movement: Movement::default() }
}

/// An index of an intersection or of a leg; both are few.
pub(super) fn number(index: usize) -> u8 {
    u8::try_from(index).unwrap_or(u8::MAX)
}

/// Numbers the legs and the exits of an intersection, in the order of the roads.
pub(super) fn numbered(legs: &mut [Leg], lanes: &[Lane]) {
    let groups = |by_m: f64| {
        let mut groups: Vec<usize> = Vec::new();
        for (index, own) in legs.iter().enumerate() {
            let way = &lanes[own.road].road;
            let is_one = |other: &Leg| same(way, own.at_m + by_m, &lanes[other.road].road).is_some();
            let found = legs[..index].iter().position(is_one).map(|found| groups[found]);
            groups.push(found.unwrap_or_else(|| groups.iter().max().map_or(0, |last| last + 1)));
        }
        groups
    };
    let (entries, exits) = (groups(-CORNERS_M), groups(CORNERS_M));
    let count = exits.iter().max().map_or(0, |last| last + 1);
    // The exit straight on from a leg has its number, if it has no other one already.
    let mut numbers: Vec<Option<usize>> = vec![None; count];
    for exit in 0..count {
        let of_exit = (0..legs.len()).filter(|index| exits[*index] == exit);
        let straightest = of_exit.min_by(|a, b| legs[*a].turn_deg.abs().total_cmp(&legs[*b].turn_deg.abs()));
        let ahead = straightest.filter(|index| legs[*index].turn_deg.abs() < AHEAD_DEG).map(|index| entries[index]);
        numbers[exit] = ahead.filter(|leg| !numbers.contains(&Some(*leg)));
    }
    for exit in 0..count {
        if numbers[exit].is_none() {
            numbers[exit] = (0..).find(|free| !numbers.contains(&Some(*free)));
        }
    }
    for (index, leg) in legs.iter_mut().enumerate() {
        let exit = numbers[exits[index]].unwrap_or(exits[index]);
        leg.movement = Movement { leg: number(entries[index]), exit: number(exit) };
    }
}

/// Whether vehicles on two roads through an intersection may not be in its conflict area at once, which reaches `half_m` to
/// either side of each crossing point: they come by different legs, and their ways cross or join.
pub(super) fn conflict(a: &Leg, b: &Leg, lanes: &[Lane], half_m: f64) -> bool {
    if a.movement.leg == b.movement.leg || a.movement.exit == b.movement.exit {
        return a.movement.leg != b.movement.leg;
    }
    if a.is_straight() && b.is_straight() {
        return cross(a.heading_deg, b.heading_deg);
    }
    let places = |leg: &Leg| -> Vec<Point> {
        let steps = (2.0 * half_m / EVERY_M).ceil() as u32;
        let way_m = |step: u32| leg.at_m - half_m + f64::from(step) * EVERY_M;
        (0..=steps).map(|step| lanes[leg.road].road.at(way_m(step)).0).collect()
    };
    let others = places(b);
    places(a).iter().any(|one| others.iter().any(|other| Shift::between(*one, *other).length_m() < WIDTH_M))
}

/// A step of a metre in a direction.
pub(super) fn along(heading_deg: f64) -> Shift {
    let (east_m, north_m) = heading_deg.to_radians().sin_cos();
    Shift { north_m, east_m }
}

/// By how much a direction is turned to the right of another, in degrees from -180 to 180.
fn turned_deg(from_deg: f64, to_deg: f64) -> f64 {
    (to_deg - from_deg + 180.0).rem_euclid(360.0) - 180.0
}
