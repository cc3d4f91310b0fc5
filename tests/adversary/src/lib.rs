//! Random drives through a world of its own. It knows holdover by its CAN frames alone: everything here is float64, the frames
//! are packed by `holdover.dbc`, and no helper of the core is used. Its README says what is assumed, checked and counted.
#![allow(missing_docs)] // a program's parts: of a field whose name and unit say all, nothing else is said

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
