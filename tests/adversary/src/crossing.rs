//! A drive over an intersection.
use crate::random::Random;
use crate::scenario::Scenario;
use crate::verdict::Outcome;
use serde::{Deserialize, Serialize};
/// One that comes to the intersection.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comer {
    /// Street.
    pub street: u8,
}
/// Draws.
pub fn draw(_: &mut Scenario, _: &mut Random) {}
/// Runs.
pub fn run(_: &Scenario) -> Outcome {
    Outcome::default()
}
