//! A listener on a vehicle's bus: the `Peer*` frames that its unit receives enter; the decoded messages leave in
//! float64, for the baselines. So the baselines get exactly the messages that the unit gets.

use std::collections::BTreeMap;
use std::io;

use holdover::time::Instant;
use holdover::units::Position;
use holdover::wire::driving_parameters::DrivingParameters;
use holdover::wire::motion::Motion;
use holdover::wire::{Identifiers, Message, Predecessor, Received, Receiver, Role, Said, Slot, Transport};

use super::heard::{Heard, HeardParameters};
use crate::bus::memory::MemoryNode;
use crate::bus::{Bus, Frame};
use crate::sim::modem::PEERS;
use crate::sim::quantities::metres;
use crate::sim::station::{index_of, station};
use crate::sim::time::{EPOCH_US, gnss};
use crate::sim::vehicle::{Alias, Vehicle};
use crate::sim::world::{Measured, World};

/// The listener.
#[derive(Clone)]
pub struct Observer {
    receiver: Receiver<PEERS>,
    parameters: BTreeMap<u8, HeardParameters>,
}

impl Observer {
    /// A listener on a bus with these identifiers.
    #[must_use]
    pub fn new(identifiers: Identifiers) -> Self {
        Self { receiver: Receiver::new(identifiers, Role::Unit), parameters: BTreeMap::new() }
    }

    /// The same on a bus with these frames.
    #[must_use]
    pub fn over(self, transport: Transport) -> Self {
        Self { receiver: self.receiver.over(transport), ..self }
    }

    /// Takes in a frame that was on the bus at `at_s`. Returns the motion that it completes, with the latest driving
    /// parameters of the same slot. `near` is a position near which positions are unwrapped.
    pub fn observe(&mut self, at_s: f64, frame: &Frame, near: Position) -> Option<Heard> {
        let at = Instant::from_micros(gnss(at_s).as_micros()); // GNSS time has no values before its start
        match self.receiver.receive(at, frame) {
            Ok(Received::Whole(Message::Peer(slot, Said::DrivingParameters(parameters)))) => {
                self.note(slot, &parameters);
                None
            }
            Ok(Received::Whole(Message::Peer(slot, Said::Motion(motion)))) => self.heard(at_s, slot, &motion, near),
            Ok(Received::Whole(Message::Peer(slot, Said::State(state)))) => {
                let heard = self.heard(at_s, slot, &state.motion, near);
                if let Some(parameters) = &state.parameters {
                    self.note(slot, parameters);
                }
                heard
            }
            _ => None,
        }
    }

    fn note(&mut self, slot: Slot, parameters: &DrivingParameters) {
        let predecessor = match parameters.predecessor {
            Predecessor::Station(station) => index_of(station),
            Predecessor::None | Predecessor::Unknown => None,
        };
        self.parameters.insert(slot.0, HeardParameters::from_parameters(parameters, predecessor));
    }

    fn heard(&self, at_s: f64, slot: Slot, motion: &Motion, near: Position) -> Option<Heard> {
        let time = motion.stamp.unwrap_near(gnss(at_s)).as_micros();
        let stamp_s = (time as i64 - EPOCH_US as i64) as f64 * 1e-6;
        let vehicle = index_of(motion.station)?;
        let position = motion.position.nearest_to(near);
        let heard = Heard::from_motion(at_s, stamp_s, vehicle, position, motion);
        Some(match self.parameters.get(&slot.0) {
            Some(parameters) => heard.with_parameters(*parameters),
            None => heard,
        })
    }
}

/// An observer on the bus of the measuring vehicle of a world.
pub struct Tap {
    measured: Measured,
    node: MemoryNode,
    observer: Observer,
}

impl Tap {
    /// Listens from now on.
    #[must_use]
    pub fn of(world: &World<'_>) -> Self {
        Self::between(world, world.measured())
    }

    /// Listens from now on, on the bus of another vehicle.
    #[must_use]
    pub fn between(world: &World<'_>, measured: Measured) -> Self {
        let by = &world.vehicles()[measured.by];
        let observer = Observer::new(by.unit.config().identifiers).over(by.unit.config().transport);
        Self { measured, node: by.listen(), observer }
    }

    /// The same on the bus of a copy of the vehicle.
    #[must_use]
    pub fn on(&self, copy: &Vehicle) -> Self {
        Self { node: copy.adopt(&self.node), observer: self.observer.clone(), ..*self }
    }

    /// The vehicle whose position is estimated, and the vehicle that estimates it.
    #[must_use]
    pub fn measured(&self) -> Measured {
        self.measured
    }

    /// Passes on what that vehicle's unit has received up to now. Vehicles have their indices in the world.
    ///
    /// # Errors
    /// Errors of the bus.
    pub fn hear(&mut self, world: &World<'_>, at_s: f64, mut take: impl FnMut(Heard)) -> io::Result<()> {
        let by = &world.vehicles()[self.measured.by];
        let near = metres(world.vehicles()[self.measured.vehicle].plant.position_m);
        while let Some((at, frame)) = self.node.receive(by.instant(at_s))? {
            if let Some(heard) = self.observer.observe(by.time_of(at), &frame, near) {
                take(renamed(heard, by.alias()));
            }
        }
        Ok(())
    }
}

/// The same message with the exchanged names.
fn renamed(heard: Heard, alias: Alias) -> Heard {
    let vehicle = |index| index_of(alias.of(station(index))).unwrap_or(index);
    let of_parameters = |parameters: HeardParameters| HeardParameters {
        predecessor: parameters.predecessor.map(vehicle),
        ..parameters
    };
    Heard { vehicle: vehicle(heard.vehicle), parameters: heard.parameters.map(of_parameters), ..heard }
}
