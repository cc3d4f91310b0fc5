//! The drivers of a corridor: a vehicle that has waited for long enters; its driver takes over, and drives it by sight through the next
//! conflict area. Behind it the unit drives again.
//!
//! A unit whose radio is dead, or that waits for one whose radio is dead, may wait for ever (P12). A driver does not. He waits for a
//! vehicle that he sees ahead of him, and for all that come by a way that crosses his own and could be there before he has left the area.

use super::emergencies::hardest_mps2;
use super::{Traffic, Traveller};
use crate::measure::metrics::STANDING_BELOW_MPS;
use crate::roads::alone;
use crate::roads::lane::Stop;
use crate::roads::watch::Sighting;
use crate::sim::person::Manner;

/// A driver waits for a vehicle that he sees ahead of him, nearer than this, in metres.
const BEHIND_M: f64 = 20.0;
/// A vehicle of another way that has stood for so long, in seconds, waits.
const WAITS_S: f64 = 3.0;
/// A driver is out of the area so long before the next vehicle is there, in seconds.
const APART_S: f64 = 1.5;
/// He expects to accelerate by this, in m/s².
const LEAVES_MPS2: f64 = 1.0;
/// He expects others to accelerate by no more than this, in m/s².
const COMES_MPS2: f64 = 2.5;
/// He stops so far before the area, in metres.
const LINE_M: f64 = 1.0;
/// So much room behind the area, in metres, is more than he needs to leave it behind a vehicle that stands.
const ROOM_M: f64 = 2.0;
/// A vehicle ahead that is slower than this, in m/s, may come to a stand.
const SLOW_MPS: f64 = 3.0;

/// So long after he has taken over, in seconds, a driver waits in any case: the others are to hear of it.
const TOLD_S: f64 = 1.0;

/// What a driver does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Driver {
    /// Since when the vehicle has stood, or had stood when the driver took over.
    waits_since_s: Option<f64>,
    /// How far the driver drives, and since when, if he drives.
    drives: Option<(Until, f64)>,
}

/// How far a driver drives.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Until {
    /// Until the vehicle has left the area of this intersection.
    Behind(usize),
    /// To the end of the way: there is no area ahead, or the radio is dead.
    TheEnd,
}

impl Driver {
    /// How long the vehicle has stood, or had stood when the driver took over, by now.
    fn has_waited_s(&self, at_s: f64) -> f64 {
        self.waits_since_s.map_or(0.0, |since_s| at_s - since_s)
    }

    fn note(&mut self, at_s: f64, stands: bool) {
        if self.drives.is_none() {
            self.waits_since_s = stands.then_some(self.waits_since_s.unwrap_or(at_s));
        }
    }
}

impl<'a> Traffic<'a> {
    /// Lets the drivers drive who have waited for long enough.
    pub(super) fn drive_by_hand(&mut self, at_s: f64) {
        let after_s = self.conditions.emergencies.driver_after_s;
        if after_s <= 0.0 {
            return;
        }
        for traveller in self.travellers.values_mut() {
            let stands = is_standing(traveller) && !traveller.stops_by_itself();
            traveller.driver.note(at_s, stands);
        }
        let acts = |one: &&Traveller| !one.has_left() && one.driver.has_waited_s(at_s) >= after_s;
        let acting: Vec<usize> = self.travellers.values().filter(acts).map(|one| one.trip).collect();
        if acting.is_empty() {
            return;
        }
        let sightings: Vec<Sighting> = self.travellers.values().map(|one| self.sight(at_s, one)).collect();
        for own in sightings.iter().filter(|own| acting.contains(&own.trip)) {
            self.drive_one_by_hand(at_s, own, &sightings);
        }
    }

    fn drive_one_by_hand(&mut self, at_s: f64, own: &Sighting, all: &[Sighting]) {
        let kind = self.trips[own.trip].kind;
        let Some(traveller) = self.travellers.get(&own.trip) else { return };
        let (drives, stops_by_itself) = (traveller.driver.drives, traveller.stops_by_itself());
        let begins = drives.is_none() && self.is_first(own, all);
        let stop = self.next_stop(own);
        let drives = drives.or_else(|| begins.then(|| (self.until(at_s, own, stop), at_s)));
        let is_told = drives.is_some_and(|(_, since_s)| at_s >= since_s + TOLD_S);
        let wanted_mps2 =
            if stops_by_itself { -hardest_mps2(kind) } else { self.wanted_by_hand(at_s, is_told, own, stop, all) };
        let Some(traveller) = self.travellers.get_mut(&own.trip) else { return };
        match drives {
            None => {}
            Some((Until::Behind(intersection), _)) if stop.is_none_or(|stop| stop.intersection != intersection) => {
                traveller.driver = Driver::default();
                traveller.vehicle.let_go();
            }
            Some(drives) => {
                traveller.driver.drives = Some(drives);
                traveller.vehicle.take_over(alone::published(wanted_mps2, kind));
                self.remains.takeovers += u64::from(begins);
            }
        }
    }

    /// How far a driver drives who takes over now, with this intersection ahead.
    fn until(&self, at_s: f64, own: &Sighting, stop: Option<&Stop>) -> Until {
        let is_dead = self.travellers.get(&own.trip).is_some_and(|one| one.is_deaf(at_s) || one.is_mute(at_s));
        stop.filter(|_| !is_dead).map_or(Until::TheEnd, |stop| Until::Behind(stop.intersection))
    }

    /// The first intersection whose area the vehicle has not left.
    fn next_stop(&self, own: &Sighting) -> Option<&'a Stop> {
        let network = self.network;
        network.lanes[own.road].stops.iter().find(|stop| own.way_m - own.length_m <= self.area_m(stop)[1])
    }

    /// The acceleration that the driver asks for by what he sees. `is_told`: whether the others have had time to hear that he drives.
    fn wanted_by_hand(&self, at_s: f64, is_told: bool, own: &Sighting, stop: Option<&Stop>, all: &[Sighting]) -> f64 {
        let traffic = &self.corridor.traffic;
        let goes_mps2 = alone::demand(own, all, self.network, traffic, false);
        let Some(stop) = stop else { return goes_mps2 };
        let to_area_m = self.area_m(stop)[0] - own.way_m;
        let brakes_mps2: f64 = self.trips[own.trip].kind.limits().braking.get().to_num();
        let has_gone = own.speed_mps * own.speed_mps > 2.0 * brakes_mps2 * to_area_m;
        if has_gone && own.speed_mps >= STANDING_BELOW_MPS || is_told && self.is_clear(at_s, own, stop, all) {
            return goes_mps2;
        }
        let manner = Manner { wanted_mps: traffic.target_speed_mps, time_gap_s: 1.0, standstill_m: LINE_M };
        goes_mps2.min(manner.behind(own.speed_mps, to_area_m, 0.0))
    }

    /// Whether the driver may go into the area: there is room behind it, and nobody whose way crosses his own is there before he has left.
    fn is_clear(&self, at_s: f64, own: &Sighting, stop: &Stop, all: &[Sighting]) -> bool {
        let way_m = self.to_leave_m(own, stop);
        let leaves_s = over_s(way_m, own.speed_mps, LEAVES_MPS2, f64::INFINITY);
        let top_mps = self.corridor.traffic.target_speed_mps * (1.0 + self.corridor.traffic.catch_up);
        let is_free = |other: &Sighting| {
            let mut stops = self.network.lanes[other.road].stops.iter();
            let junction = &self.network.junctions[stop.intersection];
            let there = stops.find(|there| there.intersection == stop.intersection);
            let Some(there) = there.filter(|there| junction.conflict(stop.leg, there.leg)) else { return true };
            let [begins_m, ends_m] = self.area_m(there);
            if other.way_m - other.length_m > ends_m {
                return true;
            }
            let comes_s = over_s(begins_m - other.way_m, other.speed_mps, COMES_MPS2, top_mps);
            let lets_pass = || self.waits(at_s, other) && !self.goes_first(at_s, other, there, own, all);
            other.way_m < begins_m && (comes_s > leaves_s + APART_S || lets_pass())
        };
        self.leaves_room(own, stop, all) && all.iter().filter(|other| other.trip != own.trip).all(is_free)
    }

    /// Whether there is room behind the area.
    fn leaves_room(&self, own: &Sighting, stop: &Stop, all: &[Sighting]) -> bool {
        let needed_m = self.to_leave_m(own, stop) + self.corridor.traffic.standstill_m + ROOM_M;
        alone::ahead(own, all, self.network).is_none_or(|(ahead, gap_m)| ahead.speed_mps > SLOW_MPS || gap_m > needed_m)
    }

    /// The way until the vehicle has left the area.
    fn to_leave_m(&self, own: &Sighting, stop: &Stop) -> f64 {
        self.area_m(stop)[1] + own.length_m - own.way_m
    }

    /// Whether a vehicle stands, and has stood for some time.
    fn waits(&self, at_s: f64, one: &Sighting) -> bool {
        let is_waiting = |one: &Traveller| is_standing(one) && one.driver.has_waited_s(at_s) >= WAITS_S;
        self.travellers.get(&one.trip).is_some_and(is_waiting)
    }

    /// Whether another driver goes first: he is first on his way to the area, has room behind it, and has waited for longer.
    fn goes_first(&self, at_s: f64, other: &Sighting, there: &Stop, own: &Sighting, all: &[Sighting]) -> bool {
        let driver = |one: &Sighting| self.travellers.get(&one.trip).map(|one| one.driver).unwrap_or_default();
        let (others, owns) = (driver(other), driver(own));
        let has_waited_longer = (others.has_waited_s(at_s), own.trip) > (owns.has_waited_s(at_s), other.trip);
        let can_go = || self.is_first(other, all) && self.leaves_room(other, there, all);
        others.drives.is_some() && has_waited_longer && can_go()
    }

    /// Whether a driver sees nobody near ahead of him.
    fn is_first(&self, own: &Sighting, all: &[Sighting]) -> bool {
        alone::ahead(own, all, self.network).is_none_or(|(_, gap_m)| gap_m > BEHIND_M)
    }

    /// Where the conflict area begins and ends, along the road.
    fn area_m(&self, stop: &Stop) -> [f64; 2] {
        let half_m = self.network.junctions[stop.intersection].half_m;
        [stop.at_m - half_m, stop.at_m + half_m]
    }
}

fn is_standing(traveller: &Traveller) -> bool {
    traveller.vehicle.plant.speed_mps < STANDING_BELOW_MPS
}

/// The time for a way from a speed on, with an acceleration up to a top speed. No way takes no time.
fn over_s(way_m: f64, speed_mps: f64, acceleration_mps2: f64, top_mps: f64) -> f64 {
    let top_mps = top_mps.max(speed_mps);
    let to_top_m = (top_mps * top_mps - speed_mps * speed_mps) / (2.0 * acceleration_mps2);
    let way_m = way_m.max(0.0);
    if way_m <= to_top_m {
        return ((speed_mps * speed_mps + 2.0 * acceleration_mps2 * way_m).sqrt() - speed_mps) / acceleration_mps2;
    }
    (top_mps - speed_mps) / acceleration_mps2 + (way_m - to_top_m) / top_mps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::conditions::Conditions;
    use crate::roads::description::Emergencies;
    use crate::roads::example;
    use crate::roads::experiment::Experiment;
    use crate::roads::traffic::Remains;
    use crate::roads::traffic::faults::Fault;
    use crate::roads::trips::Trip;
    use crate::roads::watch::Watch;

    #[test]
    fn a_way_takes_as_long_as_at_this_speed_acceleration_and_top_speed() {
        for (way_m, speed_mps, acceleration_mps2, top_mps, expected_s) in [
            (8.0, 0.0, 1.0, f64::INFINITY, 4.0),
            (30.0, 10.0, 1e-9, 10.0, 3.0),
            (10.0, 0.0, 2.0, 2.0, 5.5),
            (20.0, 4.0, 1.0, 2.0, 5.0),
            (0.0, 3.0, 1.0, 5.0, 0.0),
            (-1.0, 0.0, 1.0, 5.0, 0.0),
        ] {
            let took_s = over_s(way_m, speed_mps, acceleration_mps2, top_mps);
            assert!((took_s - expected_s).abs() < 1e-6, "{way_m} m from {speed_mps} m/s: {took_s} s");
        }
    }

    /// When each vehicle was in each conflict area first and last: by trip and intersection.
    struct Areas<'a> {
        experiment: &'a Experiment,
        times_s: std::collections::BTreeMap<(usize, usize), [f64; 2]>,
    }

    impl Watch for Areas<'_> {
        fn tick(&mut self, at_s: f64, sightings: &[Sighting]) {
            for one in sightings {
                for stop in &self.experiment.network.lanes[one.road].stops {
                    let half_m = self.experiment.network.junctions[stop.intersection].half_m;
                    if one.way_m >= stop.at_m - half_m && one.way_m - one.length_m <= stop.at_m + half_m {
                        self.times_s.entry((one.trip, stop.intersection)).or_insert([at_s; 2])[1] = at_s;
                    }
                }
            }
        }
        fn left(&mut self, _: f64, _: usize) {}
    }

    /// When a vehicle was in an area first and last, by its trip and the intersection.
    type Stay = ((usize, usize), [f64; 2]);

    /// When these vehicles were in which area. The receivers of those at `deaf` die after 3 s, and drivers take over after `after_s`.
    fn areas(trips: &[Trip], deaf: &[usize], after_s: f64) -> (Vec<Stay>, Remains) {
        let experiment = Experiment::new(example::corridor());
        let Experiment { corridor, network, itineraries } = &experiment;
        let emergencies = Emergencies { driver_after_s: after_s, ..Emergencies::NONE };
        let conditions = Conditions { emergencies, radio: corridor.radio.perfect(), ..Conditions::of(corridor) };
        let mut traffic = Traffic::new(corridor, network, itineraries, trips, conditions, 1);
        let mut areas = Areas { experiment: &experiment, times_s: Default::default() };
        traffic.advance(3.0, &mut [&mut areas]).unwrap();
        for trip in deaf {
            traffic.travellers.get_mut(trip).unwrap().fault = Some(Fault::DeafFrom(3.0));
        }
        let remains = traffic.run(&mut [&mut areas], &mut Vec::new()).unwrap();
        (areas.times_s.into_iter().collect(), remains)
    }

    const NORTHWEST: usize = 0;
    const HARRISON: usize = 2;
    /// The only intersection of both.
    const AREA: usize = 0;

    fn on(road: usize, at_s: f64) -> Trip {
        Trip { at_s, dark_after_s: 1e6, ..example::trip(road) }
    }

    fn of(areas: &[Stay], trip: usize) -> [f64; 2] {
        areas.iter().find(|((one, area), _)| (*one, *area) == (trip, AREA)).expect("it was in the area").1
    }

    #[test]
    fn who_waits_for_a_vehicle_that_it_does_not_hear_any_more_is_driven_on_after_half_a_minute() {
        let trips = [on(NORTHWEST, 0.0), on(HARRISON, 1.0)];
        let (_, remains) = areas(&trips, &[1], 0.0);
        assert_eq!((remains.unserved, remains.takeovers), (1, 0));
        let (areas, remains) = areas(&trips, &[1], 30.0);
        assert_eq!((remains.unserved, remains.takeovers), (0, 1));
        let waited_s = of(&areas, 1)[0] - of(&areas, 0)[1];
        assert!((25.0..45.0).contains(&waited_s), "{waited_s} s");
    }

    #[test]
    fn a_driver_goes_where_nobody_who_crosses_can_come_before_he_has_left_and_there_is_room() {
        let experiment = Experiment::new(example::corridor());
        let Experiment { corridor, network, itineraries } = &experiment;
        let traffic = Traffic::new(corridor, network, itineraries, &[], Conditions::of(corridor), 1);
        let begins_m = |road: usize| traffic.area_m(&network.lanes[road].stops[0])[0];
        // He stands 1 m before an area of 7 m, and is out of it after 5.1 s.
        let own = Sighting { speed_mps: 0.0, ..example::sighting(0, HARRISON, begins_m(HARRISON) - 1.0) };
        let goes_with = |other: Sighting| {
            traffic.is_clear(0.0, &own, &network.lanes[HARRISON].stops[0], &[own, Sighting { trip: 1, ..other }])
        };
        let on =
            |road, before_m, speed_mps| Sighting { speed_mps, ..example::sighting(1, road, begins_m(road) - before_m) };
        for (before_m, speed_mps, goes) in [
            (92.0, 11.0, true),
            (80.0, 11.0, false),
            (60.0, 0.0, true),
            (40.0, 0.0, false),
            (0.0, 0.0, false),
            (-7.0 - 4.7, 0.0, false),
            (-7.0 - 4.9, 0.0, true),
        ] {
            assert_eq!(goes_with(on(NORTHWEST, before_m, speed_mps)), goes, "{before_m} m before, {speed_mps} m/s");
        }
        for (before_m, speed_mps, goes) in [(-19.0, 0.0, false), (-22.0, 0.0, true), (-16.0, 4.0, true)] {
            assert_eq!(goes_with(on(HARRISON, before_m, speed_mps)), goes, "{before_m} m ahead, {speed_mps} m/s");
        }
    }

    #[test]
    fn of_two_drivers_who_wait_one_goes_after_the_other() {
        let trips = [on(NORTHWEST, 0.0), on(HARRISON, 0.5), on(NORTHWEST, 2.5)];
        let (areas, remains) = areas(&trips, &[1, 2], 30.0);
        assert_eq!(remains.unserved, 0, "{areas:?}");
        assert!(remains.takeovers >= 2, "{}", remains.takeovers);
        let [one, other] = [of(&areas, 1), of(&areas, 2)];
        assert!(one[1] < other[0] || other[1] < one[0], "{one:?} {other:?}");
    }
}
