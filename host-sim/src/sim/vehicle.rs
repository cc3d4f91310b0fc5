//! One vehicle: its body, its unit, its modem, and its own bus between them. What sensors and modem put on the bus
//! enters the unit; what the unit commands moves the body. Each gets a frame when it is whole on the bus.
//!
//! A unit outside of the simulation can take the unit's place on the bus ([`Vehicle::give_seat`]). The wire is then outside
//! too.

use std::io;

use holdover::coordination::{Itinerary, MapError};
use holdover::time::Instant;
use holdover::wire::actuators::ActuatorState;
use holdover::wire::command::{Command, Effort, ModeCode};
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::estimate::TargetEstimate;
use holdover::wire::{Message, Predecessor, Received, Receiver, Role, Sender};
use holdover::{Config, ConfigError};

use crate::bus::memory::{MemoryBus, MemoryNode};
use crate::bus::{Bus, Frame};
use crate::sim::modem::{Course, ECU_PEERS, PEERS, Relay, Transmitter, V2xMessage};
use crate::sim::plant::Plant;
use crate::sim::quantities::speed;
use crate::sim::road::Ground;
use crate::sim::sensors::{Ahead, Sensors};
use crate::sim::time::micros;
use actuators::Actuators;
use backlog::Backlog;
use intervention::Intervention;
use time_master::TimeMaster;

pub mod actuators;
mod air;
pub mod alias;
mod backlog;
mod copy;
mod drive;
mod intervention;
mod speech;
mod time_master;
mod unit;
mod warm_up;

pub use alias::Alias;
pub use unit::Unit;

/// Samples that a simulated unit holds of each peer.
pub const SAMPLES: usize = 8;
/// Steps of the horizons of a simulated unit.
pub const STEPS: usize = 1082;

/// Time for which the target estimate of a unit outside holds, in seconds: the timeout of that message.
const ESTIMATE_TIMEOUT_S: f64 = 0.05;

/// A vehicle of a run.
pub struct Vehicle {
    /// Its place in the string; 0 is the leader.
    pub index: usize,
    /// Its true motion.
    pub plant: Plant,
    /// Length, bumper to bumper.
    pub length_m: f64,
    /// Its unit.
    pub unit: Unit,
    /// Whether the driver has engaged the unit.
    pub engaged: bool,
    /// Acceleration that its unit commanded last.
    pub command_mps2: f64,
    /// Whether the unit's envelope changed that command.
    pub limited: bool,
    /// Mode of the unit at that command.
    pub mode: ModeCode,
    /// The target estimate that its unit sent last.
    pub estimate: Option<TargetEstimate>,
    request: DriverRequest,
    clock_offset_us: u64,
    sensors: Sensors,
    ground: Option<Ground>,
    sender: Sender<0>,
    relay: Relay,
    listener: Receiver<PEERS>,
    /// What the unit inside sends is seen at its tick, for the trace.
    witness: Receiver<0>,
    transmitter: Transmitter,
    backlog: Backlog,
    /// Messages that the modem has broadcast, and when.
    broadcasts: Vec<(f64, V2xMessage)>,
    bus: MemoryBus,
    /// The unit's place on the bus. `None`: a unit outside has that place.
    ecu: Option<MemoryNode>,
    actuators: Actuators,
    /// What the actuators say of the unit's commands, if they speak.
    actuator_state: Option<ActuatorState>,
    /// The effort until the next tick that is not the unit's.
    overriding: Option<Effort>,
    /// What is done to it from outside.
    intervention: Intervention,
    /// Time of the unit's last target estimate.
    estimate_s: f64,
    /// Names of the stations on its bus.
    alias: Alias,
    harness: MemoryNode,
    master: TimeMaster,
    tag: u8,
}

impl Vehicle {
    /// A vehicle at its start, with an empty bus. The clock of its unit started `clock_offset_us` before the run.
    ///
    /// # Errors
    /// An error of the unit's configuration.
    pub fn new(
        index: usize,
        config: &Config,
        plant: Plant,
        length_m: f64,
        request: DriverRequest,
        clock_offset_us: u64,
        sensors: Sensors,
    ) -> Result<Self, ConfigError> {
        let bus = MemoryBus::with_wire();
        let mut relay = Relay::new(config.identifiers).over(config.transport);
        if let Predecessor::Station(ahead) = request.predecessor {
            relay.set_out(Course::behind(ahead));
        }
        Ok(Self {
            index,
            plant,
            length_m,
            unit: Unit::new(config)?,
            engaged: request.engaged,
            command_mps2: 0.0,
            limited: false,
            mode: ModeCode::Standby,
            estimate: None,
            request,
            clock_offset_us,
            sensors,
            ground: None,
            sender: Sender::new(config.identifiers).over(config.transport),
            relay,
            listener: Receiver::new(config.identifiers, Role::Modem).over(config.transport),
            witness: Receiver::new(config.identifiers, Role::Modem).over(config.transport),
            transmitter: Transmitter::default(),
            backlog: Backlog::default(),
            broadcasts: Vec::new(),
            ecu: Some(bus.node()),
            actuators: Actuators::new(f64::INFINITY),
            actuator_state: None,
            overriding: None,
            intervention: Intervention::default(),
            estimate_s: f64::NEG_INFINITY,
            alias: Alias::default(),
            harness: bus.node(),
            master: TimeMaster::on(&bus),
            bus,
            tag: 0,
        })
    }

    /// Sets out on a way through intersections, whose numbers are in `course`. From now on the vehicle knows its
    /// position on the globe.
    ///
    /// # Errors
    /// An error of the map that the unit found.
    pub fn set_out(&mut self, ground: Ground, itinerary: &'static Itinerary, course: Course) -> Result<(), MapError> {
        self.ground = Some(ground);
        self.relay.set_out(course);
        self.intervention.set_out(itinerary)?;
        self.unit.set_out(itinerary)
    }

    /// Limits its modem to `slots` of the unit's slots. It has to be called before the first message is heard.
    pub fn limit_slots(&mut self, slots: usize) {
        self.relay.limit(slots);
    }

    /// Lets the modem repeat the passes that it hears so often; 0: not at all.
    pub fn repeat_passes(&mut self, hz: f64) {
        self.relay.repeat_passes(hz);
    }

    /// Changes the target speed in the driver's request.
    pub fn want(&mut self, target_speed_mps: f64) {
        self.request.target_speed = speed(target_speed_mps);
    }

    /// A node that listens to all frames on the bus from now on. The bus has the time of the unit's own clock.
    #[must_use]
    pub fn listen(&self) -> MemoryNode {
        self.bus.node()
    }

    /// Takes the unit off the bus and returns its place, for a unit outside. On this bus the stations are called by
    /// `alias`.
    pub fn give_seat(&mut self, alias: Alias) -> MemoryNode {
        self.alias = alias;
        self.bus.cut_wire();
        self.actuators = Actuators::new(actuators::COMMAND_TIMEOUT_S);
        self.relay.limit(ECU_PEERS);
        self.ecu.take().unwrap_or_else(|| self.bus.node())
    }

    /// Names of the stations on its bus.
    #[must_use]
    pub fn alias(&self) -> Alias {
        self.alias
    }

    /// Instant of its unit's last target estimate, as a time of the run.
    #[must_use]
    pub fn estimate_s(&self) -> f64 {
        self.estimate_s
    }

    /// Sets whether the driver engages the unit, if the unit drives this vehicle at all.
    pub fn engage(&mut self, engages: bool) {
        self.engaged = engages && self.request.engaged;
    }

    /// Number of messages that its modem had no slot for.
    #[must_use]
    pub fn turned_away(&self) -> u64 {
        self.relay.turned_away()
    }

    /// The instant of the unit's clock at a time of the run.
    #[must_use]
    pub fn instant(&self, at_s: f64) -> Instant {
        Instant::from_micros(self.clock_offset_us.saturating_add_signed(micros(at_s)))
    }

    /// The time of the run at an instant of the unit's clock.
    #[must_use]
    pub fn time_of(&self, at: Instant) -> f64 {
        at.since(Instant::from_micros(self.clock_offset_us)).as_micros() as f64 * 1e-6
    }

    /// The vehicle as a sensor behind it sees it.
    #[must_use]
    pub fn seen_from_behind(&self) -> Ahead {
        Ahead { rear_m: self.plant.position_m - self.length_m, speed_mps: self.plant.speed_mps }
    }

    /// One period of the unit: receive, tick, transmit.
    ///
    /// # Errors
    /// Errors of the bus.
    pub fn tick(&mut self, at_s: f64) -> io::Result<()> {
        let now = self.instant(at_s);
        self.take_in(at_s)?;
        let Some(ecu) = &mut self.ecu else {
            self.estimate = self.estimate.filter(|_| self.estimate_s + ESTIMATE_TIMEOUT_S >= at_s);
            return Ok(());
        };
        while let Some((at, frame)) = ecu.receive(now)? {
            let _ = self.unit.receive(at, &frame); // the unit counts refusals
            self.intervention.receive(at, &frame);
        }
        let frames = self.unit.tick(now).frames;
        self.intervention.tick(now);
        frames.iter().try_for_each(|frame| ecu.send(now, frame.into()))?;
        self.estimate = None;
        for frame in &frames {
            match self.witness.receive(now, frame) {
                Ok(Received::Whole(Message::Estimate(estimate))) => {
                    (self.estimate, self.estimate_s) = (Some(estimate), at_s);
                }
                Ok(Received::Whole(Message::Command(command))) => self.see(&command),
                _ => {}
            }
        }
        Ok(())
    }

    /// Modem and actuators take in what the unit has sent, as far as it is whole on the bus by now. The modem broadcasts.
    fn take_in(&mut self, at_s: f64) -> io::Result<()> {
        let (now, is_outside) = (self.instant(at_s), self.ecu.is_none());
        while let Some((at, frame)) = self.harness.receive(now)? {
            let at_s = self.time_of(at);
            match self.listener.receive(at, &frame) {
                Ok(Received::Whole(Message::Own(said))) => {
                    self.transmitter.take(&said);
                    self.relay.take(&said);
                }
                Ok(Received::Whole(Message::OwnPass(pass))) => {
                    self.transmitter.take_pass(&pass);
                    self.relay.take_pass(&pass);
                }
                // The last of what the unit sends at a time.
                Ok(Received::Whole(Message::Status(_))) => {
                    let message = self
                        .transmitter
                        .broadcast(|| self.relay.repeats(at_s))
                        .map(|message| self.alias.of_message(&message));
                    self.broadcasts.extend(message.map(|message| (at_s, message)));
                }
                Ok(Received::Whole(Message::Estimate(estimate))) if is_outside => {
                    (self.estimate, self.estimate_s) = (Some(estimate), at_s);
                }
                Ok(Received::Whole(Message::Command(command))) => {
                    if is_outside {
                        self.see(&command);
                    }
                    if !is_outside || command.mode != ModeCode::Standby {
                        self.actuators.take(at_s, command.effort);
                    }
                    let stands = self.plant.speed_mps == 0.0;
                    if let Some(state) = &mut self.actuator_state {
                        *state = actuators::acknowledged(&command, stands);
                    }
                }
                _ => self.follow_up()?, // perhaps it was the `Sync`
            }
        }
        self.forward_held(at_s)
    }

    fn see(&mut self, command: &Command) {
        self.command_mps2 = self.intervention.hands().unwrap_or_else(|| command.acceleration.get().to_num());
        self.limited = command.limited;
        self.mode = command.mode;
    }

    fn put(&mut self, at_s: f64, message: &Message) -> io::Result<()> {
        let at = self.instant(at_s);
        let frames = frames(&mut self.sender, message)?;
        frames.iter().try_for_each(|frame| self.harness.send(at, *frame))
    }
}

/// The frames of a message.
fn frames(sender: &mut Sender<0>, message: &Message) -> io::Result<Vec<Frame>> {
    let mut frames = Vec::new();
    let sent = sender.send(message, &mut |frame| frames.push(Frame::from(&frame)));
    sent.map_err(|unsent| io::Error::other(format!("the catalogue has no line for it ({unsent:?})")))?;
    Ok(frames)
}
