//! The world of a string of vehicles: a scenario enters, a trace of every tick leaves.
//!
//! ```text
//! world -> vehicle: plant, sensors, unit, modem -> air: channel
//! ```

pub mod air;
pub mod channel;
pub mod globe;
pub mod ground;
pub mod modem;
pub mod person;
pub mod plain;
pub mod plant;
pub mod quantities;
pub mod road;
pub mod sensors;
pub mod stages;
pub mod station;
pub mod time;
pub mod vehicle;
pub mod world;
