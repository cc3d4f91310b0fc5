//! The world of a corridor: trips enter; vehicles appear, sense, hear, tick, send, move and leave; the sightings of
//! every tick go to the observers.
//!
//! The order within a tick is that of [`Stages`]. A vehicle appears when its time has come and there is room behind the
//! vehicle ahead. Until then it waits out of sight, and that counts as travel time. Its unit is powered before it
//! appears.

use std::collections::{BTreeMap, VecDeque};
use std::io;
use std::rc::Rc;

use holdover::coordination::Itinerary;
use holdover::health::Cause;
use holdover::wire::StationHash;

use super::alone::{self, Lost};
use super::conditions::{Conditions, WhenLost};
use super::description::{Corridor, Radio};
use super::network::Network;
use super::sight::{Body, Sights};
use super::tally::Tally;
use super::trips::Trip;
use super::watch::{Sighting, Watch};
use crate::bus::Frame;
use crate::input::impairment::{AppliesTo, ChannelModel, Impairment};
use crate::sim::air::{Air, Arrived};
use crate::sim::globe::Shift;
use crate::sim::ground::Point;
use crate::sim::modem::V2xMessage;
use crate::sim::sensors::Ahead;
use crate::sim::stages::Stages;
use crate::sim::station::station;
use crate::sim::vehicle::Vehicle;
use crate::sim::world::TargetBelief;

mod arrivals;
mod departures;
mod drivers;
mod emergencies;
mod events;
mod faults;
mod foresight;
mod looks;
mod numbers;
mod stuck;
mod traveller;

use arrivals::LISTENING_S;
use events::Happenings;
use numbers::Numbers;
pub use traveller::Traveller;

/// The world. A copy of it goes on in the same way.
#[derive(Clone)]
pub struct Traffic<'a> {
    corridor: &'a Corridor,
    network: &'a Network,
    itineraries: &'a [&'static Itinerary],
    trips: &'a [Trip],
    conditions: Conditions,
    seed: u64,
    ticks: u64,
    next: usize,
    waiting: Vec<VecDeque<usize>>,
    travellers: BTreeMap<usize, Traveller>,
    numbers: Numbers,
    air: Air,
    /// Recent broadcasts: time, trip of the sender, its position, and the message.
    aired: VecDeque<(f64, usize, Point, Rc<V2xMessage>)>,
    remains: Remains,
    tally: Tally,
    logged: Option<usize>,
    sights: Sights,
    happenings: Happenings,
    /// When something happened last.
    alive_s: f64,
}

/// The counts at the end of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Remains {
    /// Vehicles that had not left when the run was stopped.
    pub unserved: usize,
    /// Refusals of all units.
    pub refusals: u64,
    /// Number of times that a unit yielded to a vehicle that did not heed it.
    pub disagreements: u64,
    /// Messages that found no slot in a modem.
    pub turned_away: u64,
    /// Emergency stops.
    pub emergencies: u64,
    /// Vehicles with a fault.
    pub faults: u64,
    /// Number of times that a driver took over.
    pub takeovers: u64,
}

impl Remains {
    fn add(&mut self, vehicle: &Vehicle) {
        let health = vehicle.unit.health();
        self.refusals += Cause::ALL.iter().map(|cause| u64::from(health.of(*cause))).sum::<u64>();
        self.disagreements += u64::from(health.of(Cause::Overlooked));
        self.turned_away += vehicle.turned_away();
    }
}

impl<'a> Traffic<'a> {
    /// A world with empty roads.
    #[must_use]
    pub fn new(
        corridor: &'a Corridor,
        network: &'a Network,
        itineraries: &'a [&'static Itinerary],
        trips: &'a [Trip],
        conditions: Conditions,
        seed: u64,
    ) -> Self {
        let Radio { delay_mean_s, delay_std_s, loss, .. } = conditions.radio;
        let outages = Vec::new();
        let impairment = Impairment::Random { delay_mean_s, delay_std_s, loss, duplicate: 0.0, outages };
        Self {
            corridor,
            network,
            itineraries,
            trips,
            conditions,
            seed,
            ticks: 0,
            next: 0,
            waiting: vec![VecDeque::new(); network.lanes.len()],
            travellers: BTreeMap::new(),
            numbers: Numbers::new(),
            air: Air::new(&ChannelModel { impairment, applies_to: AppliesTo::All }, seed).unrecorded(),
            aired: VecDeque::new(),
            remains: Remains::default(),
            tally: Tally::default(),
            logged: None,
            sights: Sights::of(network),
            happenings: Happenings::of(&corridor.events, conditions.heeds),
            alive_s: 0.0,
        }
    }

    /// Logs the bus of the vehicle with this trip.
    pub fn log(&mut self, trip: Option<usize>) {
        self.logged = trip;
    }

    /// Runs the world until every vehicle has left. It gives up when nobody will move any more, and at the latest after twice the duration
    /// and five minutes.
    ///
    /// # Errors
    /// Errors of the buses. A configuration that the units refuse is an error of invalid input.
    pub fn run(mut self, watches: &mut [&mut dyn Watch], log: &mut Vec<(f64, Frame)>) -> io::Result<Remains> {
        let longest_s = 2.0 * self.corridor.duration_s + 300.0;
        while !self.is_over() && !self.is_stuck() && self.at_s() <= longest_s {
            self.step(watches, log)?;
        }
        let on_way = self.travellers.values().filter(|traveller| !traveller.has_left()).count();
        let unserved = self.trips.len() - self.next + on_way + self.waiting.iter().map(VecDeque::len).sum::<usize>();
        for mut traveller in std::mem::take(&mut self.travellers).into_values() {
            self.remains.add(&traveller.vehicle);
            traveller.hand_in(log)?;
        }
        Ok(Remains { unserved, ..self.remains })
    }

    /// Runs the world until `to_s`, without a log.
    ///
    /// # Errors
    /// As for [`run`](Self::run).
    pub fn advance(&mut self, to_s: f64, watches: &mut [&mut dyn Watch]) -> io::Result<()> {
        while self.at_s() < to_s {
            self.step(watches, &mut Vec::new())?;
        }
        Ok(())
    }

    /// The work up to now.
    #[must_use]
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// The time of the next tick.
    #[must_use]
    pub fn at_s(&self) -> f64 {
        self.ticks as f64 * self.corridor.period_s
    }

    /// Whether every vehicle has left.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.next == self.trips.len()
            && self.travellers.values().all(|traveller| traveller.has_left())
            && self.waiting.iter().all(VecDeque::is_empty)
    }

    /// One tick. What was on the logged bus of a vehicle that vanishes is appended to the log.
    ///
    /// # Errors
    /// As for [`run`](Self::run).
    pub fn step(&mut self, watches: &mut [&mut dyn Watch], log: &mut Vec<(f64, Frame)>) -> io::Result<()> {
        let at_s = self.at_s();
        self.ticks += 1;
        self.tick(at_s, |traffic| {
            traffic.show(at_s, watches);
            traffic.note_life(at_s);
            Ok(())
        })?;
        self.dismiss(at_s, watches, log)
    }

    /// Shows the sightings of all vehicles to the observers.
    fn show(&mut self, at_s: f64, watches: &mut [&mut dyn Watch]) {
        let (beyond, on_way): (Vec<&Traveller>, Vec<&Traveller>) =
            self.travellers.values().partition(|traveller| traveller.has_left());
        let beyond: Vec<Sighting> = beyond.into_iter().map(|traveller| self.sight(at_s, traveller)).collect();
        let foreseen = |one: &Traveller| self.is_asked().then(|| self.foreseen_entry_s(at_s, one)).flatten();
        let sight = |one: &Traveller| Sighting { foreseen_entry_s: foreseen(one), ..self.sight(at_s, one) };
        let on_way: Vec<Sighting> = on_way.into_iter().map(sight).collect();
        self.tally.on_way += on_way.len() as u64;
        for watch in watches.iter_mut() {
            watch.beyond(&beyond);
            watch.tick(at_s, &on_way);
        }
    }

    /// Sends the messages to all vehicles within radio range. They were sent since `at_s`.
    fn broadcast(&mut self, at_s: f64, messages: Vec<(f64, usize, V2xMessage)>) {
        if messages.is_empty() {
            return;
        }
        let place = |traveller: &Traveller| traveller.ground.road.at(traveller.way_m()).0;
        let places: BTreeMap<usize, Point> = self.travellers.iter().map(|(index, one)| (*index, place(one))).collect();
        let range_m = self.conditions.radio.range_m;
        for (sent_s, from, message) in messages {
            let Some(here) = places.get(&from) else { continue };
            let reaches =
                |(to, there): &(&usize, &Point)| **to != from && Shift::between(*here, **there).length_m() <= range_m;
            let message = Rc::new(message);
            self.air.broadcast(sent_s, from, places.iter().filter(reaches).map(|(to, _)| *to), &message);
            self.aired.push_back((sent_s, from, *here, message));
        }
        while self.aired.front().is_some_and(|(aired_s, ..)| aired_s + LISTENING_S < at_s) {
            self.aired.pop_front();
        }
    }

    fn sight(&self, at_s: f64, traveller: &Traveller) -> Sighting {
        let vehicle = &traveller.vehicle;
        Sighting {
            trip: traveller.trip,
            station: station(vehicle.index),
            road: self.trips[traveller.trip].road,
            way_m: traveller.way_m(),
            length_m: vehicle.length_m,
            speed_mps: vehicle.plant.speed_mps,
            acceleration_mps2: vehicle.plant.acceleration_mps2,
            command_mps2: vehicle.command_mps2,
            mode: vehicle.mode,
            odometer_m: traveller.ground.odometer_m,
            next: vehicle.unit.coordination().crossing().map(|crossing| usize::from(crossing.intersection.id)),
            followed: followed(vehicle),
            foreseen_entry_s: None,
            belief: vehicle.estimate.map(|estimate| TargetBelief::of(&estimate, vehicle.plant.position_m)),
            limited: vehicle.limited,
            dark: traveller.is_dark(at_s),
            mistakes_time: traveller.mistakes_time(),
        }
    }

    /// Sensors and time base of every vehicle send.
    fn sense(&mut self, at_s: f64) -> io::Result<()> {
        let (period_s, range_m) = (self.corridor.period_s, self.corridor.sensors.sensor.sees_up_to_m);
        let bodies: Vec<Body> =
            self.travellers.values().map(|traveller| traveller.body(self.trips[traveller.trip].road)).collect();
        for (traveller, own) in self.travellers.values_mut().zip(&bodies) {
            let ahead =
                traveller.sees_at(at_s).then(|| match self.sights.nearest(self.network, own, &bodies, range_m) {
                    None => Ahead::NOBODY,
                    Some(seen) => {
                        let rear_m = traveller.vehicle.plant.position_m + seen.gap_m;
                        Ahead { rear_m, speed_mps: seen.speed_mps }
                    }
                });
            traveller.vehicle.speak(at_s, period_s, ahead)?;
        }
        Ok(())
    }

    fn drive_alone(&mut self, at_s: f64) {
        let sightings: Vec<Sighting> = self.travellers.values().map(|traveller| self.sight(at_s, traveller)).collect();
        for own in &sightings {
            let Some(traveller) = self.travellers.get_mut(&own.trip) else { continue };
            let vehicle = &mut traveller.vehicle;
            let Some(lost) = Lost::of(&vehicle.unit, vehicle.instant(at_s)) else { continue };
            let wanted = alone::demand(own, &sightings, self.network, &self.corridor.traffic, lost.crossing);
            let choice = vehicle.unit.coordination().choice();
            vehicle.override_with(alone::still_given_way(lost, choice, wanted, vehicle.command_mps2));
        }
    }
}

impl Stages for Traffic<'_> {
    fn speak(&mut self, at_s: f64) -> io::Result<()> {
        self.happen(at_s);
        while let Some(Arrived { at_s, to, message }) = self.air.arrived(at_s) {
            if let Some(traveller) = self.travellers.get_mut(&to).filter(|traveller| traveller.hears(at_s)) {
                self.tally.heard += u64::from(!traveller.has_left());
                traveller.vehicle.hear(at_s, &message)?;
            }
        }
        self.admit(at_s)?;
        self.sense(at_s)
    }

    fn act(&mut self, at_s: f64) -> io::Result<()> {
        self.travellers.values_mut().try_for_each(|traveller| traveller.vehicle.tick(at_s))?;
        if self.conditions.when_lost == WhenLost::Alone {
            self.drive_alone(at_s);
        }
        self.drive_by_hand(at_s);
        self.intervene();
        self.run_out(at_s);
        self.brake_in_emergencies(at_s);
        Ok(())
    }

    fn drive(&mut self, at_s: f64) -> io::Result<()> {
        let mut broadcasts = Vec::new();
        for (index, traveller) in &mut self.travellers {
            traveller.vehicle.drive(at_s, self.corridor.period_s)?;
            let sent = traveller.vehicle.broadcasts().into_iter().filter(|(sent_s, _)| traveller.sends(*sent_s));
            broadcasts.extend(sent.map(|(sent_s, message)| (sent_s, *index, message)));
        }
        self.broadcast(at_s, broadcasts);
        Ok(())
    }
}

/// The station that a vehicle's unit follows.
fn followed(vehicle: &Vehicle) -> Option<StationHash> {
    let target = vehicle.unit.coordination().choice().target?;
    vehicle.unit.peers().get(target.into())?.station()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::example;
    use crate::roads::experiment::Experiment;
    use crate::roads::network::RUN_OUT_M;

    /// The largest distance along the road, of a vehicle on its way and of a vehicle that has left.
    #[derive(Default)]
    struct Farthest {
        on_way_m: f64,
        beyond_m: f64,
    }

    fn farthest_m(sightings: &[Sighting]) -> f64 {
        sightings.iter().map(|one| one.way_m).fold(0.0, f64::max)
    }

    impl Watch for Farthest {
        fn beyond(&mut self, sightings: &[Sighting]) {
            self.beyond_m = self.beyond_m.max(farthest_m(sightings));
        }
        fn tick(&mut self, _: f64, sightings: &[Sighting]) {
            self.on_way_m = self.on_way_m.max(farthest_m(sightings));
        }
        fn left(&mut self, _: f64, _: usize) {}
    }

    #[test]
    fn who_has_left_is_still_seen_until_it_vanishes() {
        let experiment = Experiment::new(example::corridor());
        let Experiment { corridor, network, itineraries } = &experiment;
        let trips = [example::trip(2)];
        let mut traffic = Traffic::new(corridor, network, itineraries, &trips, Conditions::of(corridor), 1);
        let mut farthest = Farthest::default();
        traffic.advance(60.0, &mut [&mut farthest]).unwrap();
        let exit_m = network.lanes[2].exit_m;
        assert!((exit_m - 0.2..exit_m).contains(&farthest.on_way_m), "{}", farthest.on_way_m);
        assert!((exit_m + RUN_OUT_M - 0.2..exit_m + RUN_OUT_M).contains(&farthest.beyond_m), "{}", farthest.beyond_m);
    }
}
