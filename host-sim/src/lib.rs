//! The host harness of holdover: scenario -> world of vehicles (plant + the same core as on the ECU) -> V2X channel
//! -> CAN bus -> metrics -> report.
//!
//! The modules are floors of a house, and imports go down only (`tests/sim/floors.rs` holds that):
//!
//! ```text
//! commands     one for each command: its arguments, options, run, table and page
//! report       pages and plots
//! roads        the world of a corridor: roads that cross, and the vehicles on them
//! measure      figures of a run, the methods that ours is compared with, and the reference in float64
//! sim          the world of a string: vehicles, plants, sensors, modems and the air between them
//! bus          CAN buses in memory and in Linux, their faults and their logs
//! input        scenarios, recordings and the library of scenarios
//! draft, error, output, parallel, places, progress, provenance, seeds, streams, thinned, verdict    what every
//!              floor stands on
//! ```

pub mod bus;
pub mod commands;
pub mod draft;
pub mod error;
pub mod input;
pub mod measure;
pub mod output;
pub mod parallel;
pub mod places;
pub mod progress;
pub mod provenance;
pub mod report;
pub mod roads;
pub mod seeds;
pub mod sim;
pub mod streams;
pub mod thinned;
pub mod verdict;
