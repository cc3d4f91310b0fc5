//! Roads that join and turn: the map that the units get against a geometry of its own, and short runs in which nobody is hurt, everyone is
//! served and no truth is outside its bound.

use std::path::Path;

use holdover::coordination::{Intersection, Movement};
use holdover_sim::input::scenario::{Envelope, Overrides};
use holdover_sim::roads::conditions::Conditions;
use holdover_sim::roads::experiment::Experiment;
use holdover_sim::roads::figures::Outcome;
use holdover_sim::roads::{Corridor, read};
use holdover_sim::sim::globe::Shift;
use holdover_sim::sim::ground::Point;

fn experiment(name: &str, duration_s: f64) -> Experiment {
    let file = format!("scenarios/{name}.toml");
    let text = std::fs::read_to_string(&file).unwrap();
    let corridor = read::corridor(Path::new(&file), &text, &Overrides::default()).unwrap();
    Experiment::new(Corridor { duration_s, ..corridor })
}

/// The corners of the widest body, 0.5 m long, with its middle at this place of a road, around the middle of the intersection.
fn body(experiment: &Experiment, road: usize, way_m: f64, middle: Point) -> [[f64; 2]; 4] {
    let (place, heading_deg) = experiment.network.lanes[road].road.at(way_m);
    let (east, north) = heading_deg.to_radians().sin_cos();
    let Shift { north_m, east_m } = Shift::between(middle, place);
    [(0.25, 1.25), (0.25, -1.25), (-0.25, -1.25), (-0.25, 1.25)].map(|(ahead_m, right_m)| {
        [north_m + ahead_m * north - right_m * east, east_m + ahead_m * east + right_m * north]
    })
}

/// Whether two rectangles overlap: no side of either separates them.
fn overlap(a: &[[f64; 2]; 4], b: &[[f64; 2]; 4]) -> bool {
    let separates = |corners: &[[f64; 2]; 4], side: usize| {
        let [from, to] = [corners[side], corners[(side + 1) % 4]];
        let across = |point: &[f64; 2]| (to[0] - from[0]) * point[1] - (to[1] - from[1]) * point[0];
        let [one, other] = [a, b].map(|all| all.map(|point| across(&point)));
        let span = |all: [f64; 4]| {
            all.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)])
        };
        let ([low, high], [least, most]) = (span(one), span(other));
        high <= least || most <= low
    };
    !(0..4).any(|side| separates(a, side) || separates(b, side))
}

#[test]
fn movements_conflict_exactly_where_bodies_that_come_by_different_legs_can_touch() {
    for (name, conflicts) in [("on-ramp", 2), ("turns", 60)] {
        let experiment = experiment(name, 10.0);
        let (plan, junction) = (&experiment.corridor.intersections[0], &experiment.network.junctions[0]);
        let map: &Intersection = experiment.itineraries[0].crossings[0].intersection;
        let legs = &junction.legs;
        // Each place of the ways through the area, from its beginning to its end.
        let sweep = |road: usize, at_m: f64| -> Vec<[[f64; 2]; 4]> {
            let way_m = |step: u32| at_m - junction.half_m + 0.25 * f64::from(step);
            (0..=(8.0 * junction.half_m) as u32).map(|step| body(&experiment, road, way_m(step), plan.at)).collect()
        };
        let sweeps: Vec<_> = legs.iter().map(|leg| sweep(leg.road, leg.at_m)).collect();
        let mut found = 0;
        for (index, a) in legs.iter().enumerate() {
            for (other, b) in legs.iter().enumerate() {
                let touch = || sweeps[index].iter().any(|one| sweeps[other].iter().any(|two| overlap(one, two)));
                let expected = a.movement.leg != b.movement.leg && touch();
                assert_eq!(map.conflict(a.movement, b.movement), expected, "{name}: {a:?} {b:?}");
                found += u32::from(expected);
            }
        }
        assert_eq!(found, conflicts, "{name}");
    }
}

#[test]
fn ways_of_one_street_have_one_leg_and_ways_to_one_street_one_exit() {
    let experiment = experiment("turns", 10.0);
    let [south, west, north, east] = [0, 1, 2, 3];
    let of_leg = |leg, [straight, left, right]: [u8; 3]| [straight, left, right].map(|exit| Movement { leg, exit });
    // Straight on has the number of the leg: from the south to the north it is 0, the exit to the south is 2.
    let expected =
        [of_leg(south, [0, 3, 1]), of_leg(west, [1, 0, 2]), of_leg(north, [2, 1, 3]), of_leg(east, [3, 2, 0])];
    let found: Vec<Movement> = experiment.network.junctions[0].legs.iter().map(|leg| leg.movement).collect();
    assert_eq!(found, expected.concat());
}

/// Runs with the envelope or without, with emergencies or without, with 16 vehicles a minute. Nobody is hurt, and everyone is served.
fn safe(name: &str, engaged: bool, emergencies: bool) -> Outcome {
    let experiment = Experiment::new(experiment(name, 60.0).corridor.demanding(16.0));
    let scenario = Conditions::of(&experiment.corridor);
    let envelope = Envelope { engaged, ..scenario.envelope };
    // Every second vehicle brakes to a stand somewhere, and none has a fault.
    let mut plan = experiment.corridor.emergencies;
    (plan.share, plan.faults) = (0.5, 0.0);
    let emergencies = if emergencies { plan } else { scenario.emergencies };
    let outcome = experiment.run(1, Conditions { envelope, emergencies, ..scenario }, None).unwrap();
    let facts = (outcome.collisions, outcome.violations, outcome.remains.unserved);
    assert_eq!(facts, ([0, 0], [0, 0], 0), "{name} {engaged}");
    outcome
}

#[test]
fn vehicles_of_a_ramp_and_a_road_go_on_as_one_lane() {
    for engaged in [false, true] {
        let outcome = safe("on-ramp", engaged, false);
        assert_eq!(outcome.travel_times_s.len(), 18, "{engaged}");
        assert_eq!(outcome.full_stops, 0, "{engaged}");
        assert!(outcome.errors[0].max_m().unwrap() < 0.2 || engaged, "{:?}", outcome.errors[0]);
    }
    assert!(safe("on-ramp", true, true).remains.emergencies > 3);
}

#[test]
fn vehicles_turn_left_and_right() {
    for engaged in [false, true] {
        let outcome = safe("turns", engaged, false);
        assert_eq!(outcome.travel_times_s.len(), 15, "{engaged}");
        assert!(outcome.full_stops <= 3, "{engaged}: {}", outcome.full_stops);
    }
    assert!(safe("turns", true, true).remains.emergencies > 3);
}
