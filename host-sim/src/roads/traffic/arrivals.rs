//! The arrivals in a corridor: trips whose time has come enter; vehicles on the roads leave, with units that know their
//! surroundings.

use std::io;

use holdover::ConfigError;
use holdover::wire::Predecessor;
use holdover::wire::driver_request::DriverRequest;

use super::drivers::Driver;
use super::emergencies::Emergency;
use super::faults::Fault;
use super::{Traffic, Traveller};
use crate::input::kind::Difference;
use crate::input::scenario::Accuracy;
use crate::roads::conditions::{Identity, config};
use crate::roads::trips::{HEARD_S, Trip};
use crate::sim::air::Arrived;
use crate::sim::globe::Shift;
use crate::sim::ground::Point;
use crate::sim::modem::{Ahead, Course};
use crate::sim::plant::{Machine, Plant};
use crate::sim::quantities::{seconds, speed};
use crate::sim::road::Ground;
use crate::sim::sensors::Sensors;
use crate::sim::vehicle::Vehicle;
use crate::sim::world::{WARM_UP_S, clock_offset, warm_up_ticks};

/// Accuracy of every vehicle's own motion, as measured and published.
const ACCURACY: Accuracy = Accuracy { position_m: 0.05, speed_mps: 0.02 };

/// Before it appears, a vehicle has heard the stations near by for this time, in seconds, as if it had driven up.
pub(super) const LISTENING_S: f64 = 1.0;

/// Hardest braking that a newcomer may need behind a slower vehicle, in m/s².
const ENTRY_BRAKING_MPS2: f64 = 2.0;

/// No vehicle appears nearer than this, in metres, behind a vehicle that was silent in the last [`LISTENING_S`] or will
/// be silent in the next [`HEARD_S`].
const UNHEARD_M: f64 = 100.0;

impl Traffic<'_> {
    /// Lets the vehicles appear whose time has come, if there is room.
    pub(super) fn admit(&mut self, at_s: f64) -> io::Result<()> {
        while let Some(trip) = self.trips.get(self.next).filter(|trip| trip.at_s <= at_s) {
            self.waiting[trip.road].push_back(self.next);
            self.next += 1;
        }
        for road in 0..self.waiting.len() {
            let Some(&index) = self.waiting[road].front() else { continue };
            if self.has_room(at_s, &self.trips[index]) {
                let Some(called) = self.numbers.take(at_s, index) else { continue };
                self.waiting[road].pop_front();
                let traveller = self.appear(at_s, index, called)?;
                self.remains.faults += u64::from(traveller.fault.is_some());
                self.travellers.insert(index, traveller);
            }
        }
        Ok(())
    }

    /// Whether there is room for a newcomer. The gap to the vehicle ahead has to be the newcomer's following distance,
    /// plus the distance for braking down to that vehicle's speed. If the vehicle ahead is near, it must not have been
    /// silent just before, nor fall silent at once: a vehicle that drives up behind it would have heard it long ago,
    /// but a newcomer that has just appeared has not.
    fn has_room(&self, at_s: f64, trip: &Trip) -> bool {
        let entry_m = self.network.lanes[trip.road].entry_m;
        let on_road = |other: &&Traveller| {
            let (road, length_m) = (self.trips[other.trip].road, other.vehicle.length_m);
            self.network.on_road(trip.road, road, other.way_m(), length_m)
        };
        let last = self.travellers.values().filter_map(|other| Some((other, on_road(&other)?)));
        let Some((last, [rear_m, _])) = last.min_by(|(_, [_, a]), (_, [_, b])| a.total_cmp(b)) else { return true };
        let gap_m = rear_m - entry_m;
        let is_dark = last.dark.from_s <= at_s + HEARD_S && last.dark.to_s > at_s - LISTENING_S;
        let is_unheard = is_dark || last.is_mute(at_s + HEARD_S);
        if is_unheard && gap_m < UNHEARD_M {
            return false;
        }
        let (v, w) = (trip.speed_mps, last.vehicle.plant.speed_mps);
        let braking_m = ((v * v - w * w) / (2.0 * ENTRY_BRAKING_MPS2)).max(0.0);
        let traffic = &self.corridor.traffic;
        gap_m >= traffic.standstill_m + v * traffic.time_gap_s + braking_m
    }

    /// Puts into the air the messages that a vehicle heard before it appears at `here`.
    fn overhear(&mut self, at_s: f64, index: usize, here: Point) {
        for (aired_s, from, there, message) in self.aired.iter().filter(|(aired_s, ..)| *aired_s + LISTENING_S >= at_s)
        {
            if Shift::between(here, *there).length_m() <= self.conditions.radio.range_m {
                self.air.broadcast(*aired_s, *from, [index], message);
            }
        }
    }

    fn appear(&mut self, at_s: f64, index: usize, called: usize) -> io::Result<Traveller> {
        let trip = &self.trips[index];
        let lane = &self.network.lanes[trip.road];
        let wrong = &self.conditions.wrong;
        let difference = Difference {
            mass_scale: wrong.mass_scale,
            grade: wrong.grade,
            headwind_mps: wrong.headwind_mps,
            throttle: 1.0,
        };
        let machine = Machine::new(trip.kind, trip.kind.lag_s() * wrong.lag_scale, &difference);
        let odometer_m = trip.odometer_m - lane.entry_m;
        let plant = Plant::cruising(machine, trip.odometer_m, trip.speed_mps);
        let request = DriverRequest {
            engaged: true,
            predecessor: Predecessor::Unknown,
            target_speed: speed(self.corridor.traffic.target_speed_mps),
            time_gap: Some(seconds(self.corridor.traffic.time_gap_s)),
        };
        let fitted = &self.corridor.sensors;
        let identity = Identity::of(self.corridor, &self.conditions, self.seed, index, called);
        let sees = identity.sees;
        let config = config(self.corridor, &self.conditions, identity, trip.kind);
        let (offset_us, length_m) = (clock_offset(self.seed, index), trip.kind.length_m());
        let sensors = Sensors::with(ACCURACY, sees.then_some(fitted.sensor), self.seed, index);
        let mut vehicle = Box::new(
            Vehicle::new(called, &config, plant, length_m, request, offset_us, sensors)
                .map_err(|cause| refused(&cause))?,
        );
        let (fault, driver) = (self.fault_of(at_s, index, lane, sees), Driver::default());
        if let Some(Fault::TimeAheadBy(ahead_s)) = fault {
            vehicle.mistake_time(ahead_s);
        }
        vehicle.limit_slots(self.conditions.slots);
        vehicle.repeat_passes(self.conditions.radio.repeats_hz);
        self.prepare(index, &mut vehicle).map_err(|cause| refused(&cause))?;
        vehicle.acknowledge(self.corridor.bus.actuator_state);
        let ground = Ground { road: lane.road, odometer_m };
        let itinerary = self.itineraries[trip.road];
        let crossings = lane.stops.iter().zip(itinerary.crossings).map(|(stop, crossing)| Ahead {
            intersection: crossing.intersection,
            movement: crossing.movement,
            at_m: stop.at_m - lane.entry_m,
        });
        vehicle.set_out(ground, itinerary, Course::through(crossings.collect())).map_err(|cause| {
            io::Error::new(io::ErrorKind::InvalidInput, format!("the units refuse the map: {cause:?}"))
        })?;
        let period_s = self.corridor.period_s;
        let log = (self.logged == Some(index)).then(|| vehicle.listen());
        self.overhear(at_s, index, ground.road.at(lane.entry_m).0);
        let ticks = warm_up_ticks(WARM_UP_S + LISTENING_S, self.corridor.message_rate_hz, period_s);
        vehicle.warm_up(at_s, period_s, ticks, |at_s| self.air.arrived(at_s))?;
        while let Some(Arrived { at_s, message, .. }) = self.air.arrived(at_s) {
            vehicle.hear(at_s, &message)?;
        }
        let dark = trip.dark(at_s, &self.conditions.radio);
        let emergency = Emergency::of(&self.conditions.emergencies, self.seed, index, lane);
        Ok(Traveller { trip: index, left_s: None, vehicle, ground, dark, log, sees, emergency, fault, driver })
    }
}

fn refused(cause: &ConfigError) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, format!("the units refuse the scenario: {cause}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::kind::Kind;
    use crate::roads::conditions::Conditions;
    use crate::roads::example;
    use crate::roads::experiment::Experiment;
    use crate::roads::watch::{Sighting, Watch};

    /// Time at which the second vehicle appeared.
    #[derive(Default)]
    struct Second {
        from_s: Option<f64>,
        dark_s: f64,
    }

    impl Watch for Second {
        fn tick(&mut self, at_s: f64, sightings: &[Sighting]) {
            let Some(second) = sightings.iter().find(|one| one.trip == 1) else { return };
            self.from_s.get_or_insert(at_s);
            self.dark_s += if second.dark { 0.01 } else { 0.0 };
        }
        fn left(&mut self, _: f64, _: usize) {}
    }

    /// Two vehicles on one road, each with its arrival time and the time until its silence after it appears. The
    /// result: when the second vehicle appears, and for how long it is silent in the next 9 s.
    fn second_appears(first: (f64, f64), second: (f64, f64)) -> (f64, f64) {
        let experiment = Experiment::new(example::corridor());
        let trip = |(at_s, dark_after_s)| Trip {
            road: 0,
            at_s,
            speed_mps: 10.0,
            kind: Kind::Car,
            dark_after_s,
            odometer_m: 0.0,
        };
        let trips = [trip(first), trip(second)];
        let conditions = Conditions::of(&experiment.corridor);
        assert_eq!((conditions.radio.dark_s, LISTENING_S), (4.0, 1.0));
        let Experiment { corridor, network, itineraries } = &experiment;
        let mut traffic = Traffic::new(corridor, network, itineraries, &trips, conditions, 1);
        let mut second = Second::default();
        traffic.advance(9.0, &mut [&mut second]).unwrap();
        let from_s = second.from_s.unwrap();
        traffic.advance(from_s + 9.0, &mut [&mut second]).unwrap();
        (from_s, second.dark_s)
    }

    #[test]
    fn nobody_appears_near_behind_a_vehicle_that_it_has_not_heard() {
        let silent_later = 60.0;
        // There is room, and both vehicles have been on the air.
        assert_eq!(second_appears((0.0, silent_later), (3.0, silent_later)), (3.0, 0.0));
        // The vehicle ahead is silent from 2 s to 6 s.
        let (appears_s, _) = second_appears((0.0, 2.0), (4.0, silent_later));
        assert!((7.0..7.02).contains(&appears_s), "{appears_s}");
    }

    #[test]
    fn who_has_waited_for_room_is_silent_on_the_road_for_as_long_as_anybody() {
        let (appears_s, dark_s) = second_appears((0.0, 2.0), (4.0, 2.5));
        assert!(appears_s > 6.5 && (dark_s - 4.0).abs() < 0.015, "{appears_s} {dark_s}");
    }
}
