//! The map of every unit in a corridor: the network enters; for each road the core's itinerary leaves. It lives as long
//! as the program.

use holdover::coordination::{Approach, Crossing, Intersection, Itinerary};

use super::network::{Junction, Lane, Leg, Network};
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
                leg: number(stop.leg),
                at: metres(stop.at_m),
            })
            .collect();
        &*Box::leak(Box::new(Itinerary { path: lane.road.path, crossings: Box::leak(crossings.into_boxed_slice()) }))
    };
    network.lanes.iter().map(itinerary).collect()
}

fn intersection(network: &Network, id: u8, junction: &Junction) -> &'static Intersection {
    let legs = 0..junction.legs.len();
    let conflicts = |a: usize| legs.clone().filter(|b| junction.conflict(a, *b)).fold(0, |bits, b| bits | 1 << b);
    let approach = |(number_of, leg): (usize, &Leg)| Approach {
        leg: number(number_of),
        path: network.lanes[leg.road].road.path,
        crossing: metres(leg.at_m),
        conflicts: conflicts(number_of),
    };
    let approaches: Vec<Approach> = junction.legs.iter().enumerate().map(approach).collect();
    let half = distance(junction.half_m);
    Box::leak(Box::new(Intersection { id, half, approaches: Box::leak(approaches.into_boxed_slice()) }))
}

/// An index of an intersection or of a leg; both are few.
pub(super) fn number(index: usize) -> u8 {
    u8::try_from(index).unwrap_or(u8::MAX)
}
