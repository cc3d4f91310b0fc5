//! The accuracy of the units' target estimates: true places and estimates enter, tick by tick; position errors on the
//! virtual lane leave, in two classes.
//!
//! If a target drives on the same road, its true place on the virtual lane is its front bumper. Otherwise it is as far
//! before the crossing point as the target is on its own road.
//!
//! When a target begins to follow another vehicle, its future motion changes, and a vehicle that heard it before that
//! knows only its announced motion. So errors of the first second after such a change ([`CHANGED_S`]) are a class of
//! their own. Errors after that second count as settled. Those of a unit that has still heard nothing from the target
//! since the change count as settled, and are also shown separately.

use std::collections::BTreeMap;

use holdover::wire::StationHash;

use super::network::Network;
use super::watch::{Sighting, Watch};

/// For this time after a target's own association has changed, errors are a class of their own.
pub const CHANGED_S: f64 = 1.0;

/// Errors of one class.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Class {
    /// Number of ticks.
    pub count: u64,
    /// The error of the largest magnitude.
    pub worst: Option<Worst>,
    /// Sum of the squares.
    pub squares: f64,
}

/// The largest error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Estimated minus true position.
    pub error_m: f64,
    /// Time of the error.
    pub at_s: f64,
    /// Trip of the vehicle whose unit was wrong.
    pub by: usize,
    /// Trip of the target.
    pub target: usize,
    /// Age of the unit's newest sample of the target.
    pub age_s: f64,
}

impl Class {
    fn add(&mut self, worst: Worst) {
        self.count += 1;
        self.squares += worst.error_m * worst.error_m;
        if self.worst.is_none_or(|held| held.error_m.abs() < worst.error_m.abs()) {
            self.worst = Some(worst);
        }
    }

    /// The largest magnitude.
    #[must_use]
    pub fn max_m(&self) -> Option<f64> {
        self.worst.map(|worst| worst.error_m.abs())
    }

    /// Root of the mean square.
    #[must_use]
    pub fn rms_m(&self) -> Option<f64> {
        (self.count > 0).then(|| (self.squares / self.count as f64).sqrt())
    }

    /// The errors of two classes together.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        let worst = [self.worst, other.worst].into_iter().flatten();
        Self {
            count: self.count + other.count,
            squares: self.squares + other.squares,
            worst: worst.reduce(|a, b| if b.error_m.abs() > a.error_m.abs() { b } else { a }),
        }
    }
}

/// The errors of all units.
pub struct Beliefs<'a> {
    network: &'a Network,
    /// Errors while the target's own association has not changed within [`CHANGED_S`].
    pub settled: Class,
    /// Errors within [`CHANGED_S`] after such a change.
    pub changing: Class,
    /// The part of the settled errors where nothing has been heard from the target since its association changed.
    pub unheard: Class,
    /// The magnitude of the largest settled error of each unit and target.
    pub pairs_m: BTreeMap<(usize, usize), f64>,
    /// Number of changes of association, of all units.
    pub changes: u64,
    /// Number of ticks at which the bound did not contain the true motion, in both classes. The second number is of
    /// those where the clock of the unit or of its target is off, because assumption A3 is broken there.
    pub violations: [u64; 2],
    /// Errors over time of the unit that is watched: `(time, error)`.
    pub watched: Vec<(f64, f64)>,
    watch: Option<usize>,
    associations: BTreeMap<usize, (Option<StationHash>, f64)>,
}

impl<'a> Beliefs<'a> {
    /// No errors yet. The errors over time are recorded for the unit of the trip `watch`.
    #[must_use]
    pub fn new(network: &'a Network, watch: Option<usize>) -> Self {
        Self {
            network,
            settled: Class::default(),
            changing: Class::default(),
            unheard: Class::default(),
            pairs_m: BTreeMap::new(),
            changes: 0,
            violations: [0, 0],
            watched: Vec::new(),
            watch,
            associations: BTreeMap::new(),
        }
    }
}

/// The true position of a target, on the axis of the follower's way.
pub(crate) fn on_axis(network: &Network, own: &Sighting, target: &Sighting) -> Option<f64> {
    if own.road == target.road {
        return Some(target.way_m);
    }
    let (own_stops, stops) = (&network.lanes[own.road].stops, &network.lanes[target.road].stops);
    // The two directions of a street share several intersections, so there are several virtual lanes. This is the
    // virtual lane of the intersection that the ego's unit takes for its next. Beyond its last one it has only those with
    // it who have joined it there.
    let next = own_stops.iter().find(|stop| own.next == Some(stop.intersection));
    let here = next.or(own_stops.last().filter(|_| own.next.is_none()))?;
    let there = stops.iter().find(|stop| stop.intersection == here.intersection)?;
    let [own_leg, leg] = [here, there].map(|stop| network.junctions[stop.intersection].legs[stop.leg]);
    let joins = own_leg.movement.leg != leg.movement.leg && own_leg.movement.exit == leg.movement.exit;
    if next.is_none() && !joins {
        return None;
    }
    let shift_m = if joins { own_leg.exits_m - leg.exits_m } else { 0.0 };
    Some(here.at_m - there.at_m + target.way_m + shift_m)
}

impl Watch for Beliefs<'_> {
    fn tick(&mut self, at_s: f64, sightings: &[Sighting]) {
        for own in sightings {
            let known = self.associations.entry(own.trip).or_insert((own.followed, f64::NEG_INFINITY));
            if known.0 != own.followed {
                *known = (own.followed, at_s);
                self.changes += 1;
            }
        }
        for own in sightings {
            let (Some(belief), Some(followed)) = (own.belief, own.followed) else { continue };
            // A target that has left is no longer evaluated.
            let Some(target) = sightings.iter().find(|other| other.station == followed) else { continue };
            let Some(truth_m) = on_axis(self.network, own, target) else { continue };
            let error_m = belief.position_m - own.odometer_m - truth_m;
            let worst = Worst { error_m, at_s, by: own.trip, target: target.trip, age_s: belief.age_s };
            let changed_s = self.associations.get(&target.trip).map_or(f64::NEG_INFINITY, |known| known.1);
            if at_s - changed_s < CHANGED_S {
                self.changing.add(worst);
            } else {
                if at_s - belief.age_s < changed_s {
                    self.unheard.add(worst);
                }
                self.settled.add(worst);
                let largest_m = self.pairs_m.entry((own.trip, target.trip)).or_default();
                *largest_m = largest_m.max(error_m.abs());
            }
            let truth_m = truth_m + own.odometer_m;
            if belief.bound.is_some_and(|bound| !bound.hold(truth_m, target.speed_mps)) {
                self.violations[usize::from(own.mistakes_time || target.mistakes_time)] += 1;
            }
            if self.watch == Some(own.trip) {
                self.watched.push((at_s, error_m));
            }
        }
    }

    fn left(&mut self, _: f64, trip: usize) {
        self.associations.remove(&trip);
    }
}

#[cfg(test)]
mod tests {
    use super::super::example;
    use super::*;
    use crate::sim::station::station;
    use crate::sim::world::{Bounds, TargetBelief};

    fn sighting(trip: usize, road: usize, way_m: f64) -> Sighting {
        Sighting { odometer_m: 500.0, ..example::sighting(trip, road, way_m) }
    }

    /// Number of ticks at which the bound did not contain the true motion. The unit drives in one direction of a
    /// street. Its rear has just left the third intersection, and it takes the stop of this number for its next. Its
    /// target comes from the other direction, 10 m before the third intersection, and the estimate of it is right.
    /// `is_off`: whether its clock is off, and that of the target.
    fn violations_with_next(stop: usize, is_off: [bool; 2]) -> [u64; 2] {
        let network = Network::of(&example::corridor());
        let (own_lane, lane) = (&network.lanes[0], &network.lanes[1]);
        let left = own_lane.stops[2];
        let met = lane.stops.iter().find(|stop| stop.intersection == left.intersection).unwrap();
        let position_m = 500.0 + left.at_m - 10.0;
        let bound = Bounds {
            lowest_position_m: position_m - 0.1,
            highest_position_m: position_m + 0.1,
            lowest_speed_mps: 9.9,
            highest_speed_mps: 10.1,
        };
        let own = Sighting {
            next: Some(own_lane.stops[stop].intersection),
            mistakes_time: is_off[0],
            followed: Some(station(1)),
            belief: Some(TargetBelief { position_m, speed_mps: 10.0, age_s: 0.05, bound: Some(bound) }),
            ..sighting(0, 0, left.at_m + network.junctions[left.intersection].half_m + 4.9)
        };
        let mut beliefs = Beliefs::new(&network, None);
        beliefs.tick(1.0, &[own, Sighting { mistakes_time: is_off[1], ..sighting(1, 1, met.at_m - 10.0) }]);
        beliefs.violations
    }

    #[test]
    fn between_two_reviews_the_virtual_lane_is_that_of_the_intersection_just_left() {
        let nobody = [false; 2];
        assert_eq!(violations_with_next(2, nobody), [0, 0]);
        assert_eq!(violations_with_next(3, nobody), [1, 0]);
    }

    #[test]
    fn a_truth_outside_its_bound_is_told_apart_where_a_clock_is_off() {
        for is_off in [[true, false], [false, true]] {
            assert_eq!(violations_with_next(3, is_off), [0, 1]);
            assert_eq!(violations_with_next(2, is_off), [0, 0]);
        }
    }

    /// The classes of errors given as time, error in metres, and age of the newest sample. The unit drives on the same
    /// road as its target, and the target begins to follow another vehicle at 10 s.
    fn judged(errors: &[(f64, f64, f64)]) -> Judged {
        let network = Network::of(&example::corridor());
        let mut beliefs = Beliefs::new(&network, Some(0));
        let see = |beliefs: &mut Beliefs, at_s: f64, believed: Option<(f64, f64)>| {
            let target_m = 100.0 + 10.0 * at_s;
            let of = |(error_m, age_s)| TargetBelief {
                position_m: 500.0 + target_m + error_m,
                speed_mps: 10.0,
                age_s,
                bound: None,
            };
            let own =
                Sighting { followed: Some(station(1)), belief: believed.map(of), ..sighting(0, 0, target_m - 20.0) };
            let target = Sighting { followed: (at_s >= 10.0).then(|| station(2)), ..sighting(1, 0, target_m) };
            beliefs.tick(at_s, &[own, target]);
        };
        see(&mut beliefs, 9.0, None);
        see(&mut beliefs, 10.0, None);
        for (at_s, error_m, age_s) in errors {
            see(&mut beliefs, *at_s, Some((*error_m, *age_s)));
        }
        assert_eq!(beliefs.changes, 1);
        assert_eq!(beliefs.watched.len(), errors.len());
        Judged {
            counts: [beliefs.settled, beliefs.changing, beliefs.unheard].map(|class| class.count),
            pairs_m: beliefs.pairs_m.into_iter().collect(),
            settled: beliefs.settled,
        }
    }

    struct Judged {
        /// Counts of settled, changing and unheard errors.
        counts: [u64; 3],
        pairs_m: Vec<((usize, usize), f64)>,
        settled: Class,
    }

    #[test]
    fn for_a_second_after_the_target_has_changed_whom_it_follows_errors_stand_apart() {
        assert_eq!(judged(&[(10.01, 0.1, 0.05), (10.99, 0.1, 0.05)]).counts, [0, 2, 0]);
        assert_eq!(judged(&[(11.0, 0.1, 0.05), (60.0, 0.1, 0.05)]).counts, [2, 0, 0]);
    }

    #[test]
    fn later_errors_count_and_are_shown_apart_while_nothing_has_been_heard_since() {
        assert_eq!(judged(&[(11.2, 0.1, 1.3)]).counts, [1, 0, 1]);
        assert_eq!(judged(&[(11.2, 0.1, 1.1)]).counts, [1, 0, 0]);
        assert_eq!(judged(&[(10.5, 0.1, 1.3)]).counts, [0, 1, 0]);
    }

    #[test]
    fn a_pair_counts_once_by_its_largest_error_of_the_first_class() {
        let errors = [(10.5, 3.0, 0.05), (11.5, 0.19, 0.05), (12.0, 0.25, 0.05), (12.5, -0.5, 0.05), (13.0, 0.3, 0.05)];
        let pairs_m = judged(&errors).pairs_m;
        assert_eq!(pairs_m.len(), 1);
        let (pair, error_m) = pairs_m[0];
        assert!(pair == (0, 1) && (error_m - 0.5).abs() < 1e-9, "{pair:?} {error_m}");
    }

    #[test]
    fn the_figures_of_a_class_are_its_largest_magnitude_and_the_root_of_its_mean_square() {
        let settled = judged(&[(12.0, 0.3, 0.05), (13.0, -0.4, 0.05)]).settled;
        assert!(
            (settled.max_m().unwrap() - 0.4).abs() < 1e-9 && (settled.rms_m().unwrap() - 0.125_f64.sqrt()).abs() < 1e-9
        );
        let worst = settled.worst.unwrap();
        assert_eq!((worst.at_s, worst.by, worst.target, worst.age_s), (13.0, 0, 1, 0.05));
        let of_both = judged(&[(12.0, 0.3, 0.05)]).settled.with(judged(&[(13.0, -0.4, 0.05)]).settled);
        assert_eq!((of_both.count, of_both.worst), (2, settled.worst));
        assert_eq!((Class::default().max_m(), Class::default().rms_m()), (None, None));
    }
}
