//! Roads that cross without signals: a scenario file and a seed enter; vehicles of all kinds arrive at random, each with the
//! unit's own code, agree on an order by radio, cross and leave; what happened to them leaves.
//!
//! ```text
//! file -> read, fit (does it fit together) -> description -> network (roads, crossing points) -> trips -> traffic (the world)
//!                                               referee (collisions, gaps, stops), beliefs (errors) <-'
//! ```

pub mod alone;
pub mod beliefs;
pub mod command;
pub mod conditions;
pub mod cost;
pub mod demand;
pub mod description;
#[cfg(test)]
mod example;
pub mod experiment;
pub mod figures;
pub mod fit;
pub mod globe;
pub mod journal;
pub mod map;
pub mod network;
pub mod options;
pub mod page;
pub mod picture;
pub mod plots;
pub mod read;
pub mod referee;
pub mod road;
pub mod scale;
pub mod table;
pub mod tally;
pub mod traffic;
pub mod trips;
pub mod verdict;
pub mod watch;

pub use description::Corridor;
pub use network::Network;
