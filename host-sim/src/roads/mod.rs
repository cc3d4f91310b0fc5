//! Roads that cross without signals. A scenario file and a seed enter. Vehicles of all kinds arrive at random, each
//! with the unit's own code. They agree on an order over V2X, cross, and leave. The figures of the run leave.
//!
//! ```text
//! file -> read, fit (does it fit together) -> description -> network (roads, crossing points) -> trips -> traffic (the world)
//!            referee (collisions, gaps, stops), beliefs (errors), entries (how well they are foreseen) <-'
//! ```

pub mod alone;
pub mod beliefs;
pub mod capacity;
pub mod conditions;
pub mod description;
pub mod entries;
#[cfg(test)]
pub(crate) mod example;
pub mod experiment;
pub mod figures;
pub mod fit;
pub mod journal;
pub mod lane;
pub mod map;
pub mod movements;
pub mod network;
pub mod pavement;
pub mod read;
pub mod referee;
pub mod shares;
pub mod sight;
pub mod tally;
pub mod throughput;
pub mod touching;
pub mod traffic;
pub mod trajectories;
pub mod trips;
pub mod watch;

pub use description::Corridor;
pub use network::Network;
