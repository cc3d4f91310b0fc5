//! The referee of a run: who is where enters, tick by tick; collisions, full stops, travel times and the smallest gaps leave.

use std::collections::{BTreeMap, BTreeSet};

use super::network::Network;
use super::trips::Trip;
use super::watch::{Sighting, Watch};
use crate::metrics::{FULL_STOP_FROM_S, STANDING_BELOW_MPS};

/// Where two vehicles can meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// On a road: a bumper gap below 0.
    Road(usize),
    /// At an intersection: both in its conflict area on ways that cross.
    Intersection(usize),
}

/// Two vehicles that have met; the smaller trip first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// When it began.
    pub at_s: f64,
    /// Where.
    pub place: Place,
    /// Who.
    pub trips: [usize; 2],
}

/// A vehicle in a conflict area.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Inside {
    junction: usize,
    trip: usize,
    leg: usize,
}

/// The referee.
pub struct Referee<'a> {
    network: &'a Network,
    trips: &'a [Trip],
    /// Collisions, in the order in which they began.
    pub collisions: Vec<Collision>,
    /// When each full stop began, and whose it is.
    pub stops: Vec<(f64, usize)>,
    /// From the arrival until it has left, by trip.
    pub travel_times_s: Vec<Option<f64>>,
    /// Smallest bumper gap on a road.
    pub smallest_gap_m: Option<f64>,
    /// Shortest time from when one has left a conflict area to when the next one enters it on a way that crosses.
    pub smallest_clearance_s: Option<f64>,
    /// Lowest speed of any vehicle.
    pub lowest_speed_mps: Option<f64>,
    /// Ticks of all vehicles, and those at which an envelope changed the command.
    pub ticks: [u64; 2],
    /// Those who have left: whoever is still on his way may run into one.
    beyond: Vec<Sighting>,
    together: BTreeSet<(Place, [usize; 2])>,
    standing: BTreeMap<usize, (f64, bool)>,
    inside: BTreeSet<Inside>,
    cleared: BTreeMap<(usize, usize), f64>,
}

impl<'a> Referee<'a> {
    /// Nothing has happened yet.
    #[must_use]
    pub fn new(network: &'a Network, trips: &'a [Trip]) -> Self {
        Self {
            network,
            trips,
            collisions: Vec::new(),
            stops: Vec::new(),
            travel_times_s: vec![None; trips.len()],
            smallest_gap_m: None,
            smallest_clearance_s: None,
            lowest_speed_mps: None,
            ticks: [0, 0],
            beyond: Vec::new(),
            together: BTreeSet::new(),
            standing: BTreeMap::new(),
            inside: BTreeSet::new(),
            cleared: BTreeMap::new(),
        }
    }

    fn on_roads(&mut self, sightings: &[Sighting], together: &mut BTreeSet<(Place, [usize; 2])>) {
        let mut order: Vec<&Sighting> = sightings.iter().chain(&self.beyond).collect();
        order.sort_by(|a, b| a.road.cmp(&b.road).then(b.way_m.total_cmp(&a.way_m)));
        let has_left = |one: &Sighting| one.way_m >= self.network.lanes[one.road].exit_m;
        for pair in order.windows(2).filter(|pair| pair[0].road == pair[1].road && !has_left(pair[1])) {
            let gap_m = pair[0].way_m - pair[0].length_m - pair[1].way_m;
            self.smallest_gap_m = Some(self.smallest_gap_m.map_or(gap_m, |least| least.min(gap_m)));
            if gap_m < 0.0 {
                together.insert((Place::Road(pair[0].road), sorted(pair[0].trip, pair[1].trip)));
            }
        }
    }

    fn at_intersections(&mut self, at_s: f64, sightings: &[Sighting], together: &mut BTreeSet<(Place, [usize; 2])>) {
        let mut inside = BTreeSet::new();
        for own in sightings {
            for stop in &self.network.lanes[own.road].stops {
                let half_m = self.network.junctions[stop.intersection].half_m;
                let front_m = own.way_m - stop.at_m;
                if front_m >= -half_m && front_m - own.length_m <= half_m {
                    inside.insert(Inside { junction: stop.intersection, trip: own.trip, leg: stop.leg });
                }
            }
        }
        for gone in self.inside.difference(&inside) {
            self.cleared.insert((gone.junction, gone.leg), at_s);
        }
        for new in inside.difference(&self.inside) {
            let junction = &self.network.junctions[new.junction];
            let cleared =
                self.cleared.iter().filter(|((at, leg), _)| *at == new.junction && junction.conflict(*leg, new.leg));
            if let Some(last_s) = cleared.map(|(_, cleared_s)| *cleared_s).reduce(f64::max) {
                let clearance_s = at_s - last_s;
                self.smallest_clearance_s =
                    Some(self.smallest_clearance_s.map_or(clearance_s, |least| least.min(clearance_s)));
            }
        }
        for a in &inside {
            for b in inside.range((std::ops::Bound::Excluded(a), std::ops::Bound::Unbounded)) {
                if a.junction == b.junction && self.network.junctions[a.junction].conflict(a.leg, b.leg) {
                    together.insert((Place::Intersection(a.junction), sorted(a.trip, b.trip)));
                }
            }
        }
        self.inside = inside;
    }

    fn stands(&mut self, at_s: f64, own: &Sighting) {
        if own.speed_mps >= STANDING_BELOW_MPS {
            self.standing.remove(&own.trip);
            return;
        }
        let (since_s, is_counted) = self.standing.entry(own.trip).or_insert((at_s, false));
        if !*is_counted && at_s - *since_s >= FULL_STOP_FROM_S - 1e-9 {
            *is_counted = true;
            self.stops.push((*since_s, own.trip));
        }
    }
}

fn sorted(a: usize, b: usize) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

impl Watch for Referee<'_> {
    fn beyond(&mut self, sightings: &[Sighting]) {
        self.beyond = sightings.to_vec();
    }

    fn tick(&mut self, at_s: f64, sightings: &[Sighting]) {
        let mut together = BTreeSet::new();
        self.on_roads(sightings, &mut together);
        self.at_intersections(at_s, sightings, &mut together);
        for (place, trips) in together.difference(&self.together) {
            self.collisions.push(Collision { at_s, place: *place, trips: *trips });
        }
        self.together = together;
        for own in sightings {
            self.stands(at_s, own);
            self.lowest_speed_mps = Some(self.lowest_speed_mps.map_or(own.speed_mps, |least| least.min(own.speed_mps)));
            self.ticks[0] += 1;
            self.ticks[1] += u64::from(own.limited);
        }
    }

    fn left(&mut self, at_s: f64, trip: usize) {
        self.travel_times_s[trip] = Some(at_s - self.trips[trip].at_s);
        self.standing.remove(&trip);
    }
}
