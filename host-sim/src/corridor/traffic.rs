//! The world of a corridor: trips enter; vehicles appear, sense, hear, tick, speak, move and leave; every tick, who is where
//! goes to those who watch.
//!
//! Order within a tick as in a string's world: what has arrived is put on the buses, sensors speak, units tick, what they
//! broadcast goes into the air, bodies move on. A vehicle appears when its time has come and there is room for it to follow
//! the one ahead; until then it waits out of sight, and that counts as travel time. Its unit has power before.

use std::collections::{BTreeMap, VecDeque};
use std::io;

use holdover::controller::Mode;
use holdover::coordination::Itinerary;
use holdover::units::Acceleration;
use holdover::wire::ego_intent::EgoIntent;
use holdover::wire::{Predecessor, StationHash};
use holdover::{Config, ConfigError};

use super::alone;
use super::description::{Corridor, Radio, Wrong};
use super::globe::Shift;
use super::network::Network;
use super::trips::Trip;
use crate::channel::{AppliesTo, ChannelModel, Impairment, Window};
use crate::modem::Course;
use crate::plant::{Difference, Kind, Machine, Plant};
use crate::scenario::{Accuracy, Envelope};
use crate::sensors::Sensors;
use crate::vehicle::{Ground, Vehicle, distance, duration, fine_seconds, seconds, speed, station};
use crate::world::{Air, Arrived, TargetBelief, WARM_UP_S, clock_offset, horizon, warm_up_ticks};

/// How well every vehicle knows its own motion, as it publishes it.
const ACCURACY: Accuracy = Accuracy { position_m: 0.05, speed_mps: 0.02 };

/// Braking that a newcomer may need behind a slower vehicle, in m/s², is not more than this.
const ENTRY_BRAKING_MPS2: f64 = 2.0;

/// Beyond the end of their way vehicles drive on for so many metres: when they vanish, nobody who is still on his way minds.
pub const RUN_OUT_M: f64 = 100.0;

/// What is done when the link to the target is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhenLost {
    /// What the unit does: it goes by its estimate.
    Holdover,
    /// The vehicle drives alone, [`alone`].
    Alone,
}

/// What is varied between runs of the same trips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// The links.
    pub radio: Radio,
    /// How vehicles differ from what they publish.
    pub wrong: Wrong,
    /// The last gate.
    pub envelope: Envelope,
    /// The reference drives otherwise.
    pub when_lost: WhenLost,
    /// Prediction step.
    pub step_s: f64,
}

impl Conditions {
    /// As the scenario says.
    #[must_use]
    pub fn of(corridor: &Corridor) -> Self {
        Self {
            radio: corridor.radio,
            wrong: corridor.wrong,
            envelope: corridor.envelope,
            when_lost: WhenLost::Holdover,
            step_s: corridor.step_s,
        }
    }
}

/// A vehicle at a tick, as those who watch see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// Its trip.
    pub trip: usize,
    /// Its road.
    pub road: usize,
    /// The way of its front bumper along its road.
    pub way_m: f64,
    /// Bumper to bumper.
    pub length_m: f64,
    /// Its speed.
    pub speed_mps: f64,
    /// What its odometer shows where the road begins.
    pub odometer_m: f64,
    /// Its unit's mode.
    pub mode: Mode,
    /// Whom its unit follows.
    pub followed: Option<StationHash>,
    /// Where its unit believes that one is, on its own odometer's axis.
    pub belief: Option<TargetBelief>,
    /// Whether its envelope changed the command.
    pub limited: bool,
    /// Whether its radio is silent.
    pub dark: bool,
}

/// Someone who watches a run.
pub trait Watch {
    /// A tick, with everyone on his way in the order of their trips.
    fn tick(&mut self, at_s: f64, sightings: &[Sighting]);
    /// A vehicle has left.
    fn left(&mut self, at_s: f64, trip: usize);
}

/// A vehicle on the roads.
struct Traveller {
    trip: usize,
    has_left: bool,
    vehicle: Box<Vehicle>,
    ground: Ground,
    dark: Window,
}

impl Traveller {
    fn way_m(&self) -> f64 {
        self.vehicle.plant.position_m - self.ground.odometer_m
    }

    fn is_dark(&self, at_s: f64) -> bool {
        (self.dark.from_s..self.dark.to_s).contains(&at_s)
    }
}

/// The world.
pub struct Traffic<'a> {
    corridor: &'a Corridor,
    network: &'a Network,
    itineraries: &'a [&'static Itinerary],
    trips: &'a [Trip],
    conditions: Conditions,
    seed: u64,
    next: usize,
    waiting: Vec<VecDeque<usize>>,
    travellers: BTreeMap<usize, Traveller>,
    air: Air,
    refusals: u64,
    turned_away: u64,
}

/// What is left of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Remains {
    /// Vehicles that had not left when the run was given up.
    pub unserved: usize,
    /// Refusals of all units.
    pub refusals: u64,
    /// Messages that found no slot.
    pub turned_away: u64,
}

impl<'a> Traffic<'a> {
    /// Empty roads.
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
            next: 0,
            waiting: vec![VecDeque::new(); network.lanes.len()],
            travellers: BTreeMap::new(),
            air: Air::new(&ChannelModel { impairment, applies_to: AppliesTo::All }, seed),
            refusals: 0,
            turned_away: 0,
        }
    }

    /// Runs it until everyone has left, or for twice as long as it lasts and five minutes.
    ///
    /// # Errors
    /// The buses', and a configuration that the units refuse, as an error of invalid input.
    pub fn run(mut self, watches: &mut [&mut dyn Watch], mut progress: impl FnMut(f64)) -> io::Result<Remains> {
        let longest_s = 2.0 * self.corridor.duration_s + 300.0;
        let mut tick = 0u64;
        loop {
            #[allow(clippy::cast_precision_loss)]
            let at_s = tick as f64 * self.corridor.period_s;
            let is_over = self.next == self.trips.len()
                && self.travellers.values().all(|traveller| traveller.has_left)
                && self.waiting.iter().all(VecDeque::is_empty);
            if is_over || at_s > longest_s {
                break;
            }
            self.tick(at_s, watches)?;
            if tick.is_multiple_of(1000) {
                progress((at_s / self.corridor.duration_s).min(1.0));
            }
            tick += 1;
        }
        let on_way = self.travellers.values().filter(|traveller| !traveller.has_left).count();
        let unserved = self.trips.len() - self.next + on_way + self.waiting.iter().map(VecDeque::len).sum::<usize>();
        self.travellers.values().for_each(|traveller| {
            self.turned_away += traveller.vehicle.turned_away();
            self.refusals += refusals(&traveller.vehicle);
        });
        Ok(Remains { unserved, refusals: self.refusals, turned_away: self.turned_away })
    }

    fn tick(&mut self, at_s: f64, watches: &mut [&mut dyn Watch]) -> io::Result<()> {
        self.admit(at_s)?;
        while let Some(Arrived { at_s, to, message }) = self.air.arrived(at_s) {
            if let Some(traveller) = self.travellers.get_mut(&to).filter(|traveller| !traveller.is_dark(at_s)) {
                traveller.vehicle.hear(at_s, &message)?;
            }
        }
        let mut broadcasts = Vec::new();
        for (index, traveller) in &mut self.travellers {
            traveller.vehicle.speak(at_s, self.corridor.period_s, None)?;
            let message = traveller.vehicle.tick(at_s)?;
            broadcasts.extend(message.filter(|_| !traveller.is_dark(at_s)).map(|message| (*index, message)));
        }
        if self.conditions.when_lost == WhenLost::Alone {
            self.drive_alone();
        }
        let on_way = self.travellers.values().filter(|traveller| !traveller.has_left);
        let sightings: Vec<Sighting> = on_way.map(|traveller| self.sight(at_s, traveller)).collect();
        watches.iter_mut().for_each(|watch| watch.tick(at_s, &sightings));
        for (from, message) in broadcasts {
            let to: Vec<usize> = self.travellers.keys().copied().filter(|to| self.reaches(from, *to)).collect();
            self.air.broadcast(at_s, from, to, message);
        }
        for traveller in self.travellers.values_mut() {
            traveller.vehicle.plant.drive(traveller.vehicle.effort, self.corridor.period_s);
        }
        self.dismiss(at_s, watches);
        Ok(())
    }

    /// Whether one is within the radio's range of another one.
    fn reaches(&self, from: usize, to: usize) -> bool {
        let (Some(here), Some(there)) = (self.point(from), self.point(to)) else { return false };
        from != to && Shift::between(here, there).length_m() <= self.conditions.radio.range_m
    }

    fn point(&self, index: usize) -> Option<crate::ground::Point> {
        let traveller = self.travellers.get(&index)?;
        Some(traveller.ground.road.at(traveller.way_m()).0)
    }

    fn sight(&self, at_s: f64, traveller: &Traveller) -> Sighting {
        let vehicle = &traveller.vehicle;
        Sighting {
            trip: traveller.trip,
            road: self.trips[traveller.trip].road,
            way_m: traveller.way_m(),
            length_m: vehicle.length_m,
            speed_mps: vehicle.plant.speed_mps,
            odometer_m: traveller.ground.odometer_m,
            mode: vehicle.unit.mode(),
            followed: followed(vehicle),
            belief: vehicle.estimate.map(|estimate| TargetBelief::of(&estimate, vehicle.plant.position_m)),
            limited: vehicle.limited,
            dark: traveller.is_dark(at_s),
        }
    }

    /// Those whose time has come appear, if there is room.
    fn admit(&mut self, at_s: f64) -> io::Result<()> {
        while let Some(trip) = self.trips.get(self.next).filter(|trip| trip.at_s <= at_s) {
            self.waiting[trip.road].push_back(self.next);
            self.next += 1;
        }
        for road in 0..self.waiting.len() {
            let Some(&index) = self.waiting[road].front() else { continue };
            if self.has_room(&self.trips[index]) {
                self.waiting[road].pop_front();
                let traveller = self.appear(at_s, index)?;
                self.travellers.insert(index, traveller);
            }
        }
        Ok(())
    }

    /// Whether the one ahead is as far away as the newcomer would keep it, and braking down to its speed takes.
    fn has_room(&self, trip: &Trip) -> bool {
        let entry_m = self.network.lanes[trip.road].entry_m;
        let last = self.travellers.values().filter(|other| self.trips[other.trip].road == trip.road);
        let Some(last) = last.min_by(|a, b| a.way_m().total_cmp(&b.way_m())) else { return true };
        let gap_m = last.way_m() - last.vehicle.length_m - entry_m;
        let (v, w) = (trip.speed_mps, last.vehicle.plant.speed_mps);
        let braking_m = ((v * v - w * w) / (2.0 * ENTRY_BRAKING_MPS2)).max(0.0);
        let traffic = &self.corridor.traffic;
        gap_m >= traffic.standstill_m + v * traffic.time_gap_s + braking_m
    }

    fn appear(&self, at_s: f64, index: usize) -> io::Result<Traveller> {
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
        let wish = EgoIntent {
            engaged: true,
            predecessor: Predecessor::Unknown,
            target_speed: speed(self.corridor.traffic.target_speed_mps),
            time_gap: Some(seconds(self.corridor.traffic.time_gap_s)),
        };
        let config = self.config(index, trip.kind);
        let (offset_us, length_m) = (clock_offset(self.seed, index), trip.kind.length_m());
        let sensors = Sensors::blind(ACCURACY);
        let mut vehicle = Box::new(
            Vehicle::new(index, &config, plant, length_m, wish, offset_us, sensors).map_err(|cause| refused(&cause))?,
        );
        let ground = Ground { road: lane.road, odometer_m };
        let crossings = lane
            .stops
            .iter()
            .map(|stop| (u8::try_from(stop.intersection).unwrap_or(u8::MAX), stop.at_m - lane.entry_m));
        vehicle.set_out(ground, self.itineraries[trip.road], Course::through(crossings.collect())).map_err(
            |cause| io::Error::new(io::ErrorKind::InvalidInput, format!("the units refuse the map: {cause:?}")),
        )?;
        let period_s = self.corridor.period_s;
        vehicle.warm_up(at_s, period_s, warm_up_ticks(WARM_UP_S, self.corridor.message_rate_hz, period_s))?;
        let from_s = trip.at_s + trip.dark_after_s;
        let dark = Window { from_s, to_s: from_s + self.conditions.radio.dark_s };
        Ok(Traveller { trip: index, has_left: false, vehicle, ground, dark })
    }

    /// The configuration of a vehicle's unit.
    #[must_use]
    pub fn config(&self, index: usize, kind: Kind) -> Config {
        let (corridor, traffic) = (self.corridor, &self.corridor.traffic);
        let mut config = Config::car(station(index));
        config.period = duration(corridor.period_s);
        config.length = distance(kind.length_m());
        config.lag = fine_seconds(kind.lag_s());
        config.body = kind.body();
        config.limits = kind.limits();
        config.law.time_gap = seconds(traffic.time_gap_s);
        config.law.standstill = distance(traffic.standstill_m);
        config.law.target_speed = speed(traffic.target_speed_mps);
        config.link.period = duration(1.0 / corridor.message_rate_hz);
        config.prediction.step = duration(self.conditions.step_s);
        config.prediction.horizon = horizon(self.conditions.step_s);
        let capable: Acceleration = config.limits.emergency_braking;
        let limits = self.conditions.envelope.limits();
        config.envelope =
            limits.map(|limits| holdover::config::Envelope { braking: limits.braking.min(capable), ..limits });
        config
    }

    fn drive_alone(&mut self) {
        let sightings: Vec<Sighting> = self.travellers.values().map(|traveller| self.sight(0.0, traveller)).collect();
        for own in sightings.iter().filter(|own| own.mode != Mode::Cooperative) {
            let wanted = alone::demand(own, &sightings, self.network, &self.corridor.traffic);
            if let Some(traveller) = self.travellers.get_mut(&own.trip) {
                traveller.vehicle.override_with(wanted);
            }
        }
    }

    /// Those who have driven to the end of their way leave, and vanish a little later.
    fn dismiss(&mut self, at_s: f64, watches: &mut [&mut dyn Watch]) {
        let trips = self.trips;
        let beyond_m =
            |traveller: &Traveller| traveller.way_m() - self.network.lanes[trips[traveller.trip].road].exit_m;
        for (index, traveller) in &mut self.travellers {
            if !traveller.has_left && beyond_m(traveller) >= 0.0 {
                traveller.has_left = true;
                watches.iter_mut().for_each(|watch| watch.left(at_s + self.corridor.period_s, *index));
            }
        }
        let has_gone = |traveller: &Traveller| beyond_m(traveller) >= RUN_OUT_M;
        let gone: Vec<usize> =
            self.travellers.iter().filter(|(_, traveller)| has_gone(traveller)).map(|(index, _)| *index).collect();
        for index in gone {
            if let Some(traveller) = self.travellers.remove(&index) {
                self.turned_away += traveller.vehicle.turned_away();
                self.refusals += refusals(&traveller.vehicle);
            }
            self.air.forget(index);
        }
    }
}

/// Whom a vehicle's unit follows.
fn followed(vehicle: &Vehicle) -> Option<StationHash> {
    let target = vehicle.unit.coordination().choice().target?;
    vehicle.unit.peers().get(target.into())?.station()
}

fn refusals(vehicle: &Vehicle) -> u64 {
    holdover::health::Refusal::ALL.iter().map(|cause| u64::from(vehicle.unit.health().of(*cause))).sum()
}

fn refused(cause: &ConfigError) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, format!("the units refuse the scenario: {cause}"))
}
