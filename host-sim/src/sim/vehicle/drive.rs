//! The body of a vehicle between two ticks. Efforts enter, each from when its command was on the bus; the body's motion leaves.

use std::io;

use holdover::wire::command::Effort;

use crate::sim::quantities::{acceleration, speed};
use crate::sim::vehicle::{Vehicle, actuators};

impl Vehicle {
    /// The time from a tick to the next one: the bus carries what the unit has sent, and the vehicle moves. A command is in
    /// force from its arrival on. A vehicle whose driver has not engaged the unit is moved by others.
    ///
    /// # Errors
    /// Errors of the bus.
    pub fn drive(&mut self, at_s: f64, period_s: f64) -> io::Result<()> {
        let overriding = self.overriding.take();
        self.take_in(at_s + period_s)?;
        let hands = self.intervention.hands().map(|wanted_mps2| self.effort_for(wanted_mps2));
        for (effort, length_s) in self.actuators.pieces(at_s, at_s + period_s) {
            if let Some(effort) = hands {
                self.plant.drive(effort, length_s);
            } else if self.engaged {
                let without = || match self.ecu {
                    Some(_) => Effort::Force(0),
                    None => self.effort_for(actuators::WITHOUT_COMMAND_MPS2),
                };
                let effort = overriding.or(effort).unwrap_or_else(without);
                self.plant.drive(effort, length_s);
            }
        }
        Ok(())
    }

    /// Commands another acceleration than the unit does until the next tick, as far as the vehicle is capable of it.
    pub fn override_with(&mut self, wanted_mps2: f64) {
        self.command_mps2 = wanted_mps2;
        self.overriding = Some(self.effort_for(wanted_mps2));
    }

    fn effort_for(&self, wanted_mps2: f64) -> Effort {
        self.unit.config().body.effort(acceleration(wanted_mps2), speed(self.plant.speed_mps))
    }
}
