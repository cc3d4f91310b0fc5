//! The referee of a run: the sightings of all vehicles enter, tick by tick; collisions, full stops, travel times and
//! the smallest gaps leave.

use std::collections::{BTreeMap, BTreeSet};

use super::network::Network;
use super::trips::Trip;
use super::watch::{Sighting, Watch};
use crate::measure::metrics::{FULL_STOP_FROM_S, STANDING_BELOW_MPS};

/// The place of a collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// On a road: a bumper gap below 0.
    Road(usize),
    /// At an intersection: both vehicles are in its conflict area, on crossing ways.
    Intersection(usize),
}

/// A collision of two vehicles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// Time at which it began.
    pub at_s: f64,
    /// Where.
    pub place: Place,
    /// The two trips; the smaller one first.
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
    /// Full stops: the time at which each began, and the trip.
    pub stops: Vec<(f64, usize)>,
    /// Time from the arrival until the vehicle has left, by trip.
    pub travel_times_s: Vec<Option<f64>>,
    /// Smallest bumper gap on a road.
    pub smallest_gap_m: Option<f64>,
    /// Shortest time from when one vehicle leaves a conflict area to when the next one enters it on a crossing way.
    pub smallest_clearance_s: Option<f64>,
    /// Lowest speed of any vehicle.
    pub lowest_speed_mps: Option<f64>,
    /// Ticks of all vehicles, and those at which an envelope changed the command.
    pub ticks: [u64; 2],
    /// Vehicles that have left. A vehicle that is still on its way may run into one of them.
    beyond: Vec<Sighting>,
    together: BTreeSet<(Place, [usize; 2])>,
    standing: BTreeMap<usize, (f64, bool)>,
    inside: BTreeSet<Inside>,
    cleared: BTreeMap<(usize, usize), f64>,
}

impl<'a> Referee<'a> {
    /// A referee that has seen no tick.
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

    /// The times at which vehicles have left, by trip.
    #[must_use]
    pub fn exits_s(&self) -> Vec<f64> {
        let exits = self.trips.iter().zip(&self.travel_times_s);
        exits.filter_map(|(trip, travels_s)| Some(trip.at_s + (*travels_s)?)).collect()
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
        self.on_shared_pavement(sightings, together);
    }

    /// The same for vehicles on different roads, where these share pavement.
    fn on_shared_pavement(&mut self, sightings: &[Sighting], together: &mut BTreeSet<(Place, [usize; 2])>) {
        for own in sightings.iter().filter(|own| !self.network.shared[own.road].is_empty()) {
            for other in sightings.iter().chain(&self.beyond).filter(|other| other.road != own.road) {
                let on_road = self.network.on_road(own.road, other.road, other.way_m, other.length_m);
                let Some([rear_m, _]) = on_road.filter(|[_, front_m]| *front_m >= own.way_m) else { continue };
                let gap_m = rear_m - own.way_m;
                self.smallest_gap_m = Some(self.smallest_gap_m.map_or(gap_m, |least| least.min(gap_m)));
                if gap_m < 0.0 {
                    together.insert((Place::Road(own.road), sorted(own.trip, other.trip)));
                }
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

#[cfg(test)]
mod tests {
    use super::super::description::Corridor;
    use super::super::example;
    use super::super::trips::trips;
    use super::*;

    /// 2nd Street in both directions. The third road crosses it at the first intersection.
    const NORTHWEST: usize = 0;
    const SOUTHEAST: usize = 1;
    const HARRISON: usize = 2;
    const LENGTH_M: f64 = 5.0;

    fn the_corridor() -> (Corridor, Network) {
        let corridor = example::corridor();
        let network = Network::of(&corridor);
        (corridor, network)
    }

    fn on_road(trip: usize, road: usize, way_m: f64) -> Sighting {
        Sighting { length_m: LENGTH_M, ..example::sighting(trip, road, way_m) }
    }

    /// A vehicle with its front this far beyond the crossing point of the first intersection.
    fn beyond(network: &Network, trip: usize, road: usize, front_m: f64) -> Sighting {
        let stop = network.lanes[road].stops.iter().find(|stop| stop.intersection == 0).unwrap();
        on_road(trip, road, stop.at_m + front_m)
    }

    /// The collisions of two vehicles, at one tick per second.
    fn collisions(ticks: &[[Sighting; 2]], network: &Network) -> Vec<Collision> {
        let mut referee = Referee::new(network, &[]);
        for (at_s, sightings) in (0..).zip(ticks) {
            referee.tick(f64::from(at_s), sightings);
        }
        referee.collisions
    }

    #[test]
    fn a_bumper_gap_below_0_on_a_road_is_one_collision_as_long_as_it_lasts() {
        let (_, network) = the_corridor();
        let behind = |gap_m: f64| [on_road(1, NORTHWEST, 100.0), on_road(0, NORTHWEST, 100.0 - LENGTH_M - gap_m)];
        assert_eq!(collisions(&[behind(0.5), behind(0.0)], &network), []);
        let collision = |at_s| Collision { at_s, place: Place::Road(NORTHWEST), trips: [0, 1] };
        assert_eq!(collisions(&[behind(0.5), behind(-0.1), behind(-0.5), behind(0.1)], &network), [collision(1.0)]);
        let twice = [behind(-0.1), behind(0.1), behind(-0.1)];
        assert_eq!(collisions(&twice, &network), [collision(0.0), collision(2.0)]);
        let elsewhere = [on_road(1, NORTHWEST, 100.0), on_road(0, SOUTHEAST, 99.0)];
        assert_eq!(collisions(&[elsewhere], &network), []);
    }

    #[test]
    fn whoever_runs_into_one_that_has_left_collides_too_and_those_who_have_both_left_are_nobody_s() {
        let (_, network) = the_corridor();
        let exit_m = network.lanes[NORTHWEST].exit_m;
        let mut referee = Referee::new(&network, &[]);
        referee.beyond(&[on_road(1, NORTHWEST, exit_m + 1.0), on_road(2, NORTHWEST, exit_m + 0.5)]);
        referee.tick(0.0, &[on_road(3, NORTHWEST, exit_m + 0.5 - LENGTH_M - 2.0)]);
        assert_eq!((referee.collisions.len(), referee.smallest_gap_m), (0, Some(2.0)));
        referee.tick(1.0, &[on_road(3, NORTHWEST, exit_m - LENGTH_M + 1.0)]);
        let trips: Vec<_> = referee.collisions.iter().map(|collision| collision.trips).collect();
        assert_eq!(trips, [[2, 3]]);
    }

    #[test]
    fn the_smallest_gap_is_that_of_the_nearest_two_on_one_road() {
        let (_, network) = the_corridor();
        let mut referee = Referee::new(&network, &[]);
        assert_eq!(referee.smallest_gap_m, None);
        let others = [on_road(2, SOUTHEAST, 100.0), on_road(3, HARRISON, 90.0)];
        let [first, second, third] = [100.0, 85.0, 72.0].map(|way_m| on_road(0, NORTHWEST, way_m));
        referee.tick(0.0, &[first, others[0], second, third, others[1]]);
        assert_eq!(referee.smallest_gap_m, Some(8.0));
        referee.tick(1.0, &[first, second]);
        assert_eq!(referee.smallest_gap_m, Some(8.0));
    }

    #[test]
    fn two_in_one_conflict_area_on_ways_that_cross_are_one_collision_as_long_as_they_are() {
        let (_, network) = the_corridor();
        let half_m = network.junctions[0].half_m;
        let both = |a_m: f64, b_m: f64| [beyond(&network, 0, NORTHWEST, a_m), beyond(&network, 1, HARRISON, b_m)];
        let (before_m, in_m, out_m) = (-half_m - 0.1, -half_m + 0.1, half_m + LENGTH_M + 0.1);
        assert_eq!(collisions(&[both(in_m, before_m), both(out_m, in_m)], &network), []);
        let collision = Collision { at_s: 1.0, place: Place::Intersection(0), trips: [0, 1] };
        // At first the rear of the first vehicle is in the area, then it is not.
        let ticks = [both(0.0, before_m), both(out_m - 0.2, in_m), both(out_m - 0.15, 0.0), both(out_m, 0.0)];
        assert_eq!(collisions(&ticks, &network), [collision]);
    }

    #[test]
    fn two_in_one_conflict_area_on_ways_that_do_not_cross_are_none() {
        let (_, network) = the_corridor();
        let oncoming = [beyond(&network, 0, NORTHWEST, 0.0), beyond(&network, 1, SOUTHEAST, 0.0)];
        let behind = [beyond(&network, 0, HARRISON, 4.0), beyond(&network, 1, HARRISON, -3.0)];
        assert_eq!(collisions(&[oncoming, behind], &network), []);
    }

    #[test]
    fn clearance_is_from_leaving_a_conflict_area_to_entering_it_on_a_way_that_crosses() {
        let (_, network) = the_corridor();
        let mut referee = Referee::new(&network, &[]);
        let mut see = |at_s: f64, trip: usize, road: usize, front_m: f64| {
            referee.tick(at_s, &[beyond(&network, trip, road, front_m)]);
            referee.smallest_clearance_s
        };
        assert_eq!(see(1.0, 0, NORTHWEST, 0.0), None);
        assert_eq!(see(2.0, 0, NORTHWEST, 20.0), None);
        assert_eq!(see(2.5, 1, SOUTHEAST, 0.0), None);
        assert_eq!(see(3.0, 1, SOUTHEAST, 20.0), None);
        // The clearance since the second vehicle has left.
        assert_eq!(see(4.5, 2, HARRISON, 0.0), Some(1.5));
        assert_eq!(see(5.0, 2, HARRISON, 20.0), Some(1.5));
        assert_eq!(see(7.0, 3, NORTHWEST, 0.0), Some(1.5));
        assert_eq!(see(8.0, 3, NORTHWEST, 20.0), Some(1.5));
        assert_eq!(see(8.75, 4, HARRISON, 0.0), Some(0.75));
    }

    /// The times at which the full stops begin, of a vehicle with these speeds, a tenth of a second apart.
    fn stops(speeds_mps: &[f64]) -> Vec<(f64, usize)> {
        let (_, network) = the_corridor();
        let mut referee = Referee::new(&network, &[]);
        for (tenth, speed_mps) in (0..).zip(speeds_mps) {
            referee.tick(f64::from(tenth) / 10.0, &[Sighting { speed_mps: *speed_mps, ..on_road(7, NORTHWEST, 50.0) }]);
        }
        assert_eq!(referee.lowest_speed_mps, speeds_mps.iter().copied().reduce(f64::min));
        referee.stops
    }

    #[test]
    fn a_full_stop_is_below_a_tenth_of_a_metre_a_second_for_half_a_second_and_not_shorter() {
        let (slow, fast) = (0.099, 0.1);
        assert_eq!(stops(&[&[fast], &[slow; 6][..]].concat()), [(0.1, 7)]);
        assert_eq!(stops(&[&[fast], &[slow; 5][..], &[fast]].concat()), []);
        assert_eq!(stops(&[fast; 20]), []);
        // One stop for as long as it lasts, and a second stop after the vehicle has moved.
        assert_eq!(stops(&[&[slow; 12][..], &[fast], &[slow; 6]].concat()), [(0.0, 7), (1.3, 7)]);
    }

    #[test]
    fn the_travel_time_is_from_the_arrival_on_and_who_has_left_stands_no_more() {
        let (corridor, network) = the_corridor();
        let trips = trips(&corridor, &network, 1);
        let mut referee = Referee::new(&network, &trips);
        let arrived_s = trips[3].at_s;
        let standing = Sighting { speed_mps: 0.0, ..on_road(3, NORTHWEST, 50.0) };
        referee.tick(arrived_s + 40.0, &[standing]);
        referee.left(arrived_s + 40.25, 3);
        assert!((referee.travel_times_s[3].unwrap() - 40.25).abs() < 1e-9);
        assert!(referee.travel_times_s.iter().enumerate().all(|(trip, time_s)| trip == 3 || time_s.is_none()));
        referee.tick(arrived_s + 41.0, &[standing]);
        assert_eq!(referee.stops, []);
    }

    #[test]
    fn ticks_are_counted_and_those_at_which_an_envelope_changed_the_command() {
        let (_, network) = the_corridor();
        let mut referee = Referee::new(&network, &[]);
        let limited = Sighting { limited: true, ..on_road(0, NORTHWEST, 50.0) };
        referee.tick(0.0, &[limited, on_road(1, HARRISON, 50.0)]);
        referee.tick(0.1, &[on_road(0, NORTHWEST, 50.0)]);
        assert_eq!(referee.ticks, [3, 1]);
    }
}
