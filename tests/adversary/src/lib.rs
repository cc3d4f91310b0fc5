//! Random drives through a world of its own. It knows holdover by its CAN frames alone: all values here are float64,
//! the frames are packed by `holdover.dbc`, and no function of the core is used. The README states what is assumed,
//! checked and counted.
#![allow(missing_docs)] // parts of a program: a field whose name and unit say everything needs no doc

pub mod body;
pub mod broken;
pub mod crossing;
pub mod dbc;
pub mod family;
pub mod judge;
mod manoeuvre;
pub mod peer;
pub mod random;
pub mod run;
pub mod scenario;
pub mod shrink;
pub mod vehicle;
pub mod verdict;
pub mod wire;
pub mod world;
