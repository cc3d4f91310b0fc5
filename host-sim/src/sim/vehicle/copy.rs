//! A copy of a vehicle: one with its bus enters; one of its own, which goes on in the same way, leaves.

use super::Vehicle;
use crate::bus::memory::MemoryNode;

impl Vehicle {
    /// A listener on the bus of the vehicle of which this one is a copy, on this one's bus.
    #[must_use]
    pub fn adopt(&self, listener: &MemoryNode) -> MemoryNode {
        listener.on(&self.bus)
    }
}

impl Clone for Vehicle {
    fn clone(&self) -> Self {
        let bus = self.bus.copy();
        Self {
            unit: self.unit.clone(),
            sensors: self.sensors.clone(),
            sender: self.sender.clone(),
            relay: self.relay.clone(),
            listener: self.listener.clone(),
            witness: self.witness.clone(),
            transmitter: self.transmitter.clone(),
            backlog: self.backlog.clone(),
            broadcasts: self.broadcasts.clone(),
            ecu: self.ecu.as_ref().map(|node| node.on(&bus)),
            actuators: self.actuators.clone(),
            intervention: self.intervention.clone(),
            harness: self.harness.on(&bus),
            master: self.master.beside(&bus),
            bus,
            ..*self
        }
    }
}
