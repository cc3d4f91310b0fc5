//! The map of every unit in a corridor: the network enters; for each road the core's itinerary leaves. It lives as long
//! as the program.

use holdover::coordination::{Approach, Crossing, Intersection, Itinerary, Movements};

use super::lane::{Lane, Leg};
use super::network::{Junction, Network};
use crate::sim::quantities::{distance, metres};

/// The itineraries of the roads, in the order of the description.
#[must_use]
pub fn itineraries(network: &Network) -> Vec<&'static Itinerary> {
    let intersections: Vec<&'static Intersection> =
        (0..).zip(&network.junctions).map(|(id, junction)| intersection(network, id, junction)).collect();
    let itinerary = |lane: &Lane| {
        let crossings: Vec<Crossing> = lane
            .stops
            .iter()
            .map(|stop| Crossing {
                intersection: intersections[stop.intersection],
                movement: network.junctions[stop.intersection].legs[stop.leg].movement,
                at: metres(stop.at_m),
            })
            .collect();
        &*Box::leak(Box::new(Itinerary { path: lane.road.path, crossings: Box::leak(crossings.into_boxed_slice()) }))
    };
    network.lanes.iter().map(itinerary).collect()
}

fn intersection(network: &Network, id: u8, junction: &Junction) -> &'static Intersection {
    let conflicts = |a: usize| {
        let others = junction.legs.iter().enumerate().filter(|(b, _)| junction.conflict(a, *b));
        others.fold(Movements::NONE, |all, (_, other)| all.with(other.movement))
    };
    let approach = |(index, leg): (usize, &Leg)| Approach {
        movement: leg.movement,
        path: network.lanes[leg.road].road.path,
        crossing: metres(leg.at_m),
        exits: distance(leg.exits_m),
        conflicts: conflicts(index),
    };
    // Roads that differ elsewhere may have the same way here.
    let is_first =
        |(index, leg): &(usize, &Leg)| junction.legs[..*index].iter().all(|other| other.movement != leg.movement);
    let approaches: Vec<Approach> = junction.legs.iter().enumerate().filter(is_first).map(approach).collect();
    let half = distance(junction.half_m);
    Box::leak(Box::new(Intersection { id, half, approaches: Box::leak(approaches.into_boxed_slice()) }))
}
