//! The section `[bus]`: its keys enter; the kind of every vehicle's own bus leaves, and whether the actuators speak on it.

use holdover::wire::Transport;

use super::keys::Section;
use crate::error::Error;

/// Every vehicle's own bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VehicleBus {
    /// The frames on it.
    pub transport: Transport,
    /// Whether the actuators acknowledge the unit's commands (`ActuatorState`).
    pub actuator_state: bool,
}

/// Reads the section; by default classic CAN, and actuators that do not speak.
pub fn read(mut section: Section) -> Result<VehicleBus, Error> {
    const KEY: &str = "kind";
    let transport = match section.value(KEY) {
        None => Transport::Classic,
        Some(value) => match value.get_ref().as_str() {
            Some("classic") => Transport::Classic,
            Some("fd") => Transport::Fd,
            _ => return Err(section.mismatch(KEY, value, "\"classic\" or \"fd\"")),
        },
    };
    let actuator_state = section.flag("actuator_state")?.is_some_and(|flag| flag.value);
    section.finish()?;
    Ok(VehicleBus { transport, actuator_state })
}
