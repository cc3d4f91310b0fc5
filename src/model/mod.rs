//! The model of one vehicle. Its parameters enter; how its state changes step by step, and the range of what it can do within its limits,
//! leave.
//!
//! The prediction of a peer, the own controller and the last gate share this model, so that a vehicle drives exactly by what others
//! predict of it. The model knows of no messages, no peers, and no time but the length of a step.
//!
//! | what | where |
//! |---|---|
//! | the state at an instant or a step | `state` |
//! | how it drives: free road, following, or nothing known (Algorithms 2 and 4) | `vehicle_model`, `leader`, `follower` |
//! | what limits, lag and integration make of a demand (Algorithm 3) | `actuator`, `exponential`, `position` |
//! | the force or torque for an acceleration (eqs 1 to 3) | `body` |
//! | the least and the most that it can do | `bound` |
//! | which parts of the model are used | `switches` |

mod actuator;
mod body;
pub mod bound;
mod exponential;
pub mod follower;
mod leader;
mod position;
mod state;
mod switches;
mod vehicle_model;

pub use actuator::Actuator;
pub use body::Body;
pub use exponential::Decay;
pub use follower::{Consensus, Follower};
pub use leader::Leader;
pub use position::Path;
pub use state::{Reading, Remainders, State, Step, TargetStep};
pub use switches::Model;
pub use vehicle_model::{Aim, Stride, VehicleModel, catch_up};
