//! Who touches whom: the vehicles at a tick enter; gaps on the roads, and pairs in one conflict area on ways that cross, leave.

use std::collections::BTreeSet;
use std::ops::Bound;

use super::network::Network;
use super::watch::Sighting;

/// The place of a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// On a road: a bumper gap below 0.
    Road(usize),
    /// At an intersection: both vehicles are in its conflict area, on crossing ways.
    Intersection(usize),
}

/// The bumper gap of two vehicles that are neighbours on a road.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The road.
    pub place: Place,
    /// The two trips; the smaller one first.
    pub trips: [usize; 2],
    /// The gap; below 0 they touch.
    pub gap_m: f64,
}

/// A vehicle in a conflict area.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Inside {
    /// The intersection.
    pub junction: usize,
    /// Its trip.
    pub trip: usize,
    /// The leg that it came by.
    pub leg: usize,
}

/// The gaps on the roads. Vehicles that have left are `beyond`; of two of them there is none.
#[must_use]
pub fn gaps(network: &Network, sightings: &[Sighting], beyond: &[Sighting]) -> Vec<Gap> {
    let mut order: Vec<&Sighting> = sightings.iter().chain(beyond).collect();
    order.sort_by(|a, b| a.road.cmp(&b.road).then(b.way_m.total_cmp(&a.way_m)));
    let has_left = |one: &Sighting| one.way_m >= network.lanes[one.road].exit_m;
    let pairs = order.windows(2).filter(|pair| pair[0].road == pair[1].road && !has_left(pair[1]));
    let gap = |pair: &[&Sighting]| Gap {
        place: Place::Road(pair[0].road),
        trips: sorted(pair[0].trip, pair[1].trip),
        gap_m: pair[0].way_m - pair[0].length_m - pair[1].way_m,
    };
    pairs.map(gap).chain(on_shared_pavement(network, sightings, beyond)).collect()
}

/// The same from a vehicle to those on other roads that are ahead of it on pavement which the roads share.
fn on_shared_pavement<'a>(
    network: &'a Network,
    sightings: &'a [Sighting],
    beyond: &'a [Sighting],
) -> impl Iterator<Item = Gap> + 'a {
    let sharing = sightings.iter().filter(|own| !network.shared[own.road].is_empty());
    let pairs = sharing.flat_map(move |own| sightings.iter().chain(beyond).map(move |other| (own, other)));
    pairs.filter(|(own, other)| own.road != other.road).filter_map(|(own, other)| {
        let [rear_m, front_m] = network.on_road(own.road, other.road, other.way_m, other.length_m)?;
        let is_ahead = front_m >= own.way_m;
        let (place, trips) = (Place::Road(own.road), sorted(own.trip, other.trip));
        is_ahead.then_some(Gap { place, trips, gap_m: rear_m - own.way_m })
    })
}

/// The vehicles in conflict areas.
#[must_use]
pub fn inside(network: &Network, sightings: &[Sighting]) -> BTreeSet<Inside> {
    let mut inside = BTreeSet::new();
    for own in sightings {
        for stop in &network.lanes[own.road].stops {
            let half_m = network.junctions[stop.intersection].half_m;
            let front_m = own.way_m - stop.at_m;
            if front_m >= -half_m && front_m - own.length_m <= half_m {
                inside.insert(Inside { junction: stop.intersection, trip: own.trip, leg: stop.leg });
            }
        }
    }
    inside
}

/// The pairs of them whose ways cross.
#[must_use]
pub fn crossing(network: &Network, inside: &BTreeSet<Inside>) -> Vec<(Place, [usize; 2])> {
    let later = move |a| inside.range((Bound::Excluded(a), Bound::Unbounded));
    let pairs = inside.iter().flat_map(move |a| later(a).map(move |b| (a, b)));
    let meets =
        |(a, b): &(&Inside, &Inside)| a.junction == b.junction && network.junctions[a.junction].conflict(a.leg, b.leg);
    pairs.filter(meets).map(|(a, b)| (Place::Intersection(a.junction), sorted(a.trip, b.trip))).collect()
}

fn sorted(a: usize, b: usize) -> [usize; 2] {
    [a.min(b), a.max(b)]
}
