//! Whom a range sensor on the roads sees, and how far away.

use super::*;
use crate::roads::example;

/// 2nd Street in both directions. The third road crosses it at the first intersection.
const NORTHWEST: usize = 0;
const SOUTHEAST: usize = 1;
const HARRISON: usize = 2;
const LENGTH_M: f64 = 5.0;
const RANGE_M: f64 = 100.0;

fn body(road: usize, front_m: f64) -> Body {
    Body { road, front_m, length_m: LENGTH_M, speed_mps: 8.0 }
}

struct Street {
    network: Network,
    sights: Sights,
}

impl Street {
    fn new() -> Self {
        let network = Network::of(&example::corridor());
        let sights = Sights::of(&network);
        Self { network, sights }
    }

    /// The distances along 2nd Street and along Harrison Street to where their lanes cross.
    fn places(&self) -> [f64; 2] {
        self.sights.crossings[NORTHWEST].iter().find(|place| place.other == HARRISON).unwrap().at_m
    }

    /// What a vehicle on 2nd Street sees, 50 m before the crossing, of one whose front is so far beyond the crossing.
    fn sees(&self, front_m: f64) -> Option<Seen> {
        let [own_m, other_m] = self.places();
        let own = body(NORTHWEST, own_m - 50.0);
        self.sights.nearest(&self.network, &own, &[own, body(HARRISON, other_m + front_m)], RANGE_M)
    }
}

#[test]
fn lanes_cross_where_both_are_at_one_point() {
    let street = Street::new();
    let at = |road: usize, way_m: f64| street.network.lanes[road].road.at(way_m).0;
    let mut crossings = 0;
    for (road, places) in street.sights.crossings.iter().enumerate() {
        for place in places {
            let apart_m = Shift::between(at(road, place.at_m[0]), at(place.other, place.at_m[1])).length_m();
            assert!(apart_m < 0.05, "{road} {place:?}: {apart_m}");
            crossings += 1;
        }
    }
    // Both lanes of 2nd Street cross one lane once and two lanes three times, and are crossed as often.
    assert_eq!(crossings, 2 * 2 * (1 + 3 * 2));
}

#[test]
fn a_vehicle_that_crosses_is_seen_while_its_body_is_in_the_conflict_area_and_not_before_or_beyond_it() {
    let street = Street::new();
    // The area reaches 3.5 m to either side of the middle of 2nd Street, and its lanes are 1.75 m beside that.
    let (half_m, out_m, in_m) = (0.5 * WIDTH_M, 3.5 + 1.75, 3.5 - 1.75);
    for beside_m in [-out_m - 0.1, out_m + LENGTH_M + 0.1, -30.0, 30.0] {
        assert_eq!(street.sees(beside_m), None, "{beside_m}");
    }
    for on_way_m in [-in_m + 0.1, -half_m + 0.1, 0.0, 3.0, half_m + LENGTH_M - 0.1, in_m + LENGTH_M - 0.1] {
        let seen = street.sees(on_way_m).expect("it is in the area");
        // The streets cross at a right angle, to within a degree: the side of the body is half its width nearer.
        assert!((seen.gap_m - (50.0 - half_m)).abs() < 0.1 && seen.speed_mps.abs() < 0.15, "{on_way_m}: {seen:?}");
    }
}

#[test]
fn one_beyond_the_range_is_not_seen_and_one_behind_is_not() {
    let street = Street::new();
    let [own_m, other_m] = street.places();
    let others = [body(HARRISON, other_m + 2.0)];
    let sees = |front_m: f64| street.sights.nearest(&street.network, &body(NORTHWEST, front_m), &others, RANGE_M);
    assert_eq!(sees(own_m - RANGE_M - 0.5 * WIDTH_M - 0.2), None);
    assert!(sees(own_m - RANGE_M).is_some());
    // The ego's front is beside the other's body, and then beyond it.
    assert_eq!(sees(own_m).map(|seen| seen.gap_m), Some(0.0));
    assert_eq!(sees(own_m + 0.5 * WIDTH_M + 0.2), None);
}

#[test]
fn on_the_own_road_the_nearest_vehicle_ahead_is_seen_by_its_rear_bumper() {
    let street = Street::new();
    let own = body(NORTHWEST, 100.0);
    let see = |others: &[Body]| street.sights.nearest(&street.network, &own, others, RANGE_M);
    let ahead = [body(NORTHWEST, 160.0), body(NORTHWEST, 140.0), body(NORTHWEST, 90.0), body(SOUTHEAST, 120.0), own];
    assert_eq!(see(&ahead), Some(Seen { gap_m: 35.0, speed_mps: 8.0 }));
    assert_eq!(see(&[body(NORTHWEST, 200.0 + LENGTH_M + 0.1)]), None);
    assert!(see(&[body(NORTHWEST, 200.0 + LENGTH_M - 0.1)]).is_some());
}

#[test]
fn of_a_vehicle_on_the_own_road_and_one_that_crosses_the_nearer_one_is_seen() {
    let street = Street::new();
    let [own_m, other_m] = street.places();
    let (own, across) = (body(NORTHWEST, own_m - 50.0), body(HARRISON, other_m + 2.0));
    let gap_m = |ahead_m: f64| {
        let ahead = body(NORTHWEST, own_m + ahead_m + LENGTH_M);
        street.sights.nearest(&street.network, &own, &[ahead, across], RANGE_M).unwrap().gap_m
    };
    assert!((gap_m(-10.0) - 40.0).abs() < 1e-9 && (gap_m(20.0) - 48.75).abs() < 0.1);
}

#[test]
fn at_an_acute_angle_a_body_begins_where_its_corner_is_and_its_speed_is_the_part_along_the_way() {
    let angle = 60.0_f64.to_radians().sin_cos();
    let place = Crossing { other: 1, at_m: [100.0, 0.0], area_m: [0.0, 0.0], angle };
    let own = body(0, 50.0);
    // The body reaches from 4 m before the crossing to 1 m beyond it.
    let seen = place.seen(&own, &body(1, 1.0)).unwrap();
    assert!((seen.speed_mps - 4.0).abs() < 1e-9);
    // The edge on the right enters the strip at its left side: `s sin 60° + w cos 60° = -w`, `s = -w (1 + ½) / sin 60°`.
    let half_m = 0.5 * WIDTH_M;
    let s = (-half_m - half_m * angle.1) / angle.0;
    let begins_m = s * angle.1 - half_m * angle.0;
    assert!((seen.gap_m - (50.0 + begins_m)).abs() < 1e-9, "{seen:?} {begins_m}");
    // Before the corner of its front is in the strip, nothing is seen.
    let first_m = -half_m / angle.0 - half_m * angle.1 / angle.0;
    assert_eq!(place.seen(&own, &body(1, first_m - 0.05)), None);
    assert!(place.seen(&own, &body(1, first_m + 0.05)).is_some());
}
