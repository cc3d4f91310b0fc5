//! A model checker for the rules of passes ([`holdover::passes`]): vehicles come to one conflict area, and every combination of claims,
//! lost and late messages, and entries is tried, in whole steps, up to an end of time.
//!
//! - [`world`] has the state: the vehicles, what they said last, and what each has heard.
//! - [`act`] has what a vehicle may do in its turn, and [`hear`] what a message does to it.
//! - [`broken`] has the rules with one of them taken out; the checker has to find two vehicles in the area then.
//! - [`check`] has the model as the checker sees it, and what has to hold.

pub mod act;
pub mod broken;
pub mod check;
pub mod hear;
pub mod world;
