//! The world of a run: a scenario enters; in every tick the vehicles sense, hear, tick, send and move; a trace of every
//! tick leaves.
//!
//! The order within a tick is that of [`Stages`].

use std::io;
use std::rc::Rc;

use holdover::ConfigError;
use holdover::health::Cause;
use holdover::time::Instant;

use crate::bus::Bus;
use crate::bus::memory::MemoryNode;
use crate::input::scenario::{Driver, Event, Scenario};
use crate::sim::channel::Channel;
use crate::sim::person::Manner;
use crate::sim::plant::Plant;
use crate::sim::sensors::Sensors;
use crate::sim::stages::Stages;
use crate::sim::station::request;
use crate::sim::vehicle::{Alias, Vehicle};
use crate::streams::{Purpose, stream, unit};
use crate::thinned::Thinning;

mod config;
mod events;
mod tick;
mod trace;

use crate::sim::air::{Air, Arrived};
pub use config::{HORIZON_S, config, horizon, machine};
pub use tick::{Bounds, TargetBelief, Tick};
pub use trace::{MOST_TICKS, Trace};

/// Least time for which the units tick before the run, in seconds. A unit trusts its time base after two
/// synchronisations.
pub const WARM_UP_S: f64 = 1.0;

/// The vehicle whose position is estimated, and the vehicle that estimates it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measured {
    /// The vehicle whose position is estimated.
    pub vehicle: usize,
    /// The vehicle that follows it and estimates.
    pub by: usize,
}

impl Measured {
    /// The ego, as its follower estimates it. If no vehicle follows the ego: the vehicle ahead, as the ego estimates
    /// it.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        let ego = scenario.ego;
        if ego + 1 < scenario.vehicles.len() {
            Self { vehicle: ego, by: ego + 1 }
        } else {
            Self { vehicle: ego - 1, by: ego }
        }
    }
}

/// The world. A copy of it goes on in the same way.
pub struct World<'a> {
    scenario: &'a Scenario,
    vehicles: Vec<Vehicle>,
    air: Air,
    /// The logged vehicle, and a node that listens on its bus.
    log: Option<(usize, MemoryNode)>,
    measured: Measured,
    /// Where the vehicles start.
    starts_m: Vec<f64>,
    /// What is driven and changed, and how much of it has happened.
    events: Vec<Event>,
    happened: usize,
}

impl<'a> World<'a> {
    /// The world of a scenario with a seed. The bus of the vehicle `logged` is recorded.
    ///
    /// # Errors
    /// An error that a unit finds in the configuration from the scenario.
    pub fn new(scenario: &'a Scenario, seed: u64, logged: Option<usize>) -> Result<Self, ConfigError> {
        let mut vehicles = Vec::new();
        for (index, state) in scenario.initial_states(seed).iter().enumerate() {
            let described = &scenario.vehicles[index];
            let config = config(scenario, index);
            let is_recorded = index == 0 && scenario.leader.motion.is_some();
            let plant = Plant::cruising(machine(scenario, index), state.position_m, state.speed_mps);
            let request = request(
                index.checked_sub(1),
                !is_recorded && described.driver == Driver::Unit,
                scenario.leader.followers_target_speed_mps(),
                described.time_gap_s,
            );
            let clock_offset_us = clock_offset(seed, index);
            let sensors = Sensors::new(described, seed, index);
            let mut vehicle =
                Vehicle::new(index, &config, plant, described.length_m, request, clock_offset_us, sensors)?;
            vehicle.acknowledge(scenario.bus.actuator_state);
            vehicles.push(vehicle);
        }
        let measured = Measured::of(scenario);
        let starts_m = vehicles.iter().map(|vehicle: &Vehicle| vehicle.plant.position_m).collect();
        let mut world = Self {
            scenario,
            air: Air::new(&scenario.channel, seed),
            log: logged.and_then(|index| Some((index, vehicles.get(index)?.listen()))),
            vehicles,
            measured,
            starts_m,
            events: scenario.events.clone(),
            happened: 0,
        };
        if world.needs_twins() {
            world.fit_twins()?;
        }
        Ok(world)
    }

    /// Runs the world to its end. `progress` is called from time to time with the fraction that is done.
    ///
    /// # Errors
    /// Errors of the buses.
    pub fn run(self, progress: impl FnMut(f64)) -> io::Result<Trace> {
        self.run_beside(|_, _, _| Ok(()), progress)
    }

    /// Runs the world to its end. `beside` sees every tick before the vehicles move on.
    ///
    /// # Errors
    /// Errors of the buses, and those of `beside`.
    pub fn run_beside(
        mut self,
        mut beside: impl FnMut(&Self, f64, &mut Trace) -> io::Result<()>,
        mut progress: impl FnMut(f64),
    ) -> io::Result<Trace> {
        self.warm_up()?;
        let period_s = self.scenario.period_s;
        let ticks = self.ticks();
        let mut trace = self.trace().of_at_most(MOST_TICKS);
        for tick in 0..ticks {
            let at_s = tick as f64 * period_s;
            self.tick(at_s, |world| {
                world.note(at_s, &mut trace);
                beside(world, at_s, &mut trace)
            })?;
            if let Some(upto) = self.log.as_ref().map(|(index, _)| self.vehicles[*index].instant(at_s)) {
                self.log_until(upto, &mut trace)?;
            }
            if tick % 100 == 0 {
                progress(tick as f64 / ticks as f64);
            }
        }
        self.finish(trace)
    }

    /// Gives the unit's place on a vehicle's bus to a unit outside, which calls the stations by `alias`. All that the
    /// unit outside sends up to a time has to be on the bus before the world goes on from that time.
    pub fn give_seat(&mut self, vehicle: usize, alias: Alias) -> MemoryNode {
        self.vehicles[vehicle].give_seat(alias)
    }

    /// The vehicles.
    #[must_use]
    pub fn vehicles(&self) -> &[Vehicle] {
        &self.vehicles
    }

    /// The vehicle whose position is estimated, and the vehicle that estimates it.
    #[must_use]
    pub fn measured(&self) -> Measured {
        self.measured
    }

    /// Number of ticks of the run.
    #[must_use]
    pub fn ticks(&self) -> usize {
        (self.scenario.duration_s / self.scenario.period_s).round() as usize
    }

    /// Number of ticks of a time before the run, at least this long in seconds. It ends so that the own messages, which
    /// are sent from the first tick on, are due at time 0.
    #[must_use]
    pub fn warm_up_ticks(&self, at_least_s: f64) -> u32 {
        warm_up_ticks(at_least_s, self.scenario.message_rate_hz, self.scenario.period_s)
    }

    /// The trace of a run that has not begun.
    #[must_use]
    pub fn trace(&self) -> Trace {
        Trace {
            times_s: Vec::new(),
            vehicles: vec![Vec::new(); self.vehicles.len()],
            paper: Vec::new(),
            measured: self.measured,
            refusals: Vec::new(),
            channel: Channel::new(&self.scenario.channel, 0),
            log: Vec::new(),
            turned_away: 0,
            latest: Vec::new(),
            thinning: Thinning::default(),
        }
    }

    /// The ticks before the run, and its beginning.
    ///
    /// # Errors
    /// Errors of the buses.
    pub fn warm_up(&mut self) -> io::Result<()> {
        for tick in (1..=self.warm_up_ticks(WARM_UP_S)).rev() {
            let at_s = -f64::from(tick) * self.scenario.period_s;
            self.approach(at_s)?;
            self.answer(at_s)?;
        }
        self.begin()
    }

    /// A tick before the run. As in every real vehicle, the unit is powered and ticks, and its time base and sensors
    /// send. The drivers drive at constant speed, no driver has engaged the unit yet, and no other vehicle is within
    /// radio range. `at_s` is negative; [`answer`](Self::answer) has to follow.
    ///
    /// # Errors
    /// Errors of the buses.
    pub fn approach(&mut self, at_s: f64) -> io::Result<()> {
        self.place_recorded_leader(0.0);
        for (vehicle, start_m) in self.vehicles.iter_mut().zip(&self.starts_m) {
            vehicle.engage(false);
            vehicle.approach(*start_m, (at_s, -at_s), self.scenario.period_s)?;
        }
        Ok(())
    }

    /// The units tick and answer before the run.
    ///
    /// # Errors
    /// Errors of the buses.
    pub fn answer(&mut self, at_s: f64) -> io::Result<()> {
        self.vehicles.iter_mut().try_for_each(|vehicle| vehicle.tick(at_s))
    }

    /// The drivers engage their units; the run begins.
    ///
    /// # Errors
    /// Errors of the buses.
    pub fn begin(&mut self) -> io::Result<()> {
        for (vehicle, start_m) in self.vehicles.iter_mut().zip(&self.starts_m) {
            vehicle.plant.position_m = *start_m;
            vehicle.engage(true);
            vehicle.appear(0.0)?;
        }
        Ok(())
    }

    /// Adds a tick to the trace; called after [`act`](Stages::act).
    pub fn note(&self, at_s: f64, trace: &mut Trace) {
        trace.latest.clear();
        trace.latest.extend(self.vehicles.iter().map(|vehicle| Tick::of(vehicle, at_s, self.scenario.period_s)));
        trace.push(at_s);
    }

    /// Ends the run and completes the trace.
    ///
    /// # Errors
    /// Errors of the buses.
    pub fn finish(mut self, mut trace: Trace) -> io::Result<Trace> {
        trace.refusals = Cause::ALL
            .iter()
            .map(|cause| (*cause, self.vehicles.iter().map(|v| u64::from(v.unit.health().of(*cause))).sum()))
            .collect();
        self.log_until(Instant::from_micros(u64::MAX), &mut trace)?;
        trace.turned_away = self.vehicles.iter().map(Vehicle::turned_away).sum();
        trace.channel = self.air.into_channel();
        Ok(trace)
    }

    /// Adds the frames on the logged bus up to a time to the trace.
    fn log_until(&mut self, upto: Instant, trace: &mut Trace) -> io::Result<()> {
        let Some((index, node)) = &mut self.log else { return Ok(()) };
        while let Some((at, frame)) = node.receive(upto)? {
            trace.log.push((self.vehicles[*index].time_of(at), frame));
        }
        Ok(())
    }

    /// Delivers all messages that have arrived by now, in the order of arrival.
    fn deliver(&mut self, at_s: f64) -> io::Result<()> {
        while let Some(Arrived { at_s, to, message }) = self.air.arrived(at_s) {
            self.vehicles[to].hear(at_s, &message)?;
        }
        Ok(())
    }

    /// Those who drive by hand look ahead and drive.
    fn let_people_drive(&mut self) {
        for index in 1..self.vehicles.len() {
            let described = &self.scenario.vehicles[index];
            if described.driver == Driver::Unit {
                continue;
            }
            let manner = Manner {
                wanted_mps: self.scenario.leader.followers_target_speed_mps(),
                time_gap_s: described.time_gap_s,
                standstill_m: described.standstill_m,
            };
            let ahead = self.vehicles[index - 1].seen_from_behind();
            let own = &mut self.vehicles[index];
            let gap_m = ahead.rear_m - own.plant.position_m;
            own.drive_by_hand(manner.behind(own.plant.speed_mps, gap_m, ahead.speed_mps));
        }
    }

    /// Puts a leader that replays a recording at its recorded place.
    fn place_recorded_leader(&mut self, at_s: f64) {
        let Some(motion) = &self.scenario.leader.motion else { return };
        let state = motion.at(motion.start_s() + at_s);
        let leader = &mut self.vehicles[0];
        leader.plant.position_m = self.starts_m[0] + state.position_m - motion.at(motion.start_s()).position_m;
        leader.plant.speed_mps = state.speed_mps.max(0.0);
        leader.plant.acceleration_mps2 = motion.past_slope(motion.start_s() + at_s);
        leader.command_mps2 = leader.plant.acceleration_mps2;
    }
}

impl Clone for World<'_> {
    fn clone(&self) -> Self {
        let vehicles = self.vehicles.clone();
        let log = self.log.as_ref().map(|(index, node)| (*index, vehicles[*index].adopt(node)));
        let (air, starts_m, events) = (self.air.clone(), self.starts_m.clone(), self.events.clone());
        Self { vehicles, air, log, starts_m, events, ..*self }
    }
}

impl Stages for World<'_> {
    fn speak(&mut self, at_s: f64) -> io::Result<()> {
        self.happen(at_s);
        self.deliver(at_s)?;
        self.place_recorded_leader(at_s);
        let program = &self.scenario.leader.program;
        if let Some((_, speed_mps)) = program.iter().rfind(|(from_s, _)| *from_s <= at_s + 1e-9) {
            self.vehicles[0].want(*speed_mps);
        }
        let mut ahead = None;
        for vehicle in &mut self.vehicles {
            vehicle.speak(at_s, self.scenario.period_s, ahead)?;
            ahead = Some(vehicle.seen_from_behind());
        }
        Ok(())
    }

    fn act(&mut self, at_s: f64) -> io::Result<()> {
        self.vehicles.iter_mut().try_for_each(|vehicle| vehicle.tick(at_s))?;
        self.let_people_drive();
        let mut ahead_length_m = 0.0;
        for vehicle in &mut self.vehicles {
            vehicle.intervene(ahead_length_m, self.scenario.period_s);
            ahead_length_m = vehicle.length_m;
        }
        Ok(())
    }

    fn drive(&mut self, at_s: f64) -> io::Result<()> {
        let vehicles = self.vehicles.len();
        for vehicle in &mut self.vehicles {
            vehicle.drive(at_s, self.scenario.period_s)?;
            let is_heard = self.scenario.vehicles[vehicle.index].driver != Driver::Unequipped;
            for (sent_s, message) in vehicle.broadcasts().into_iter().filter(|_| is_heard) {
                let others = (0..vehicles).filter(|to| *to != vehicle.index);
                self.air.broadcast(sent_s, vehicle.index, others, &Rc::new(message));
            }
        }
        Ok(())
    }
}

/// Number of ticks of a warm-up, in whole cycles of the messages.
#[must_use]
pub fn warm_up_ticks(at_least_s: f64, message_rate_hz: f64, period_s: f64) -> u32 {
    let messages = (at_least_s * message_rate_hz).ceil();
    (messages / message_rate_hz / period_s - 1e-9).ceil() as u32
}

/// The time from the start of a unit's clock to the run, in microseconds: 10 s to 1010 s, by seed and vehicle.
#[must_use]
pub fn clock_offset(seed: u64, index: usize) -> u64 {
    let share = unit(&mut stream(seed, Purpose::ClockOffset(index as u32)));
    10_000_000 + (share * 1e9) as u64
}
