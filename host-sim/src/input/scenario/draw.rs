//! Initial states: spans and a seed enter, positions and speeds leave.

use super::start::leader_position;
use super::{InitialState, Scenario, Span, Start};
use crate::streams::{Purpose, stream, unit};

pub fn initial_states(scenario: &Scenario, seed: u64) -> Vec<InitialState> {
    let mut states: Vec<InitialState> = Vec::with_capacity(scenario.vehicles.len());
    let mut rear_m = None;
    for (index, vehicle) in (0..).zip(&scenario.vehicles) {
        let mut generator = stream(seed, Purpose::InitialState(index));
        // Drawn even if the span is a single number, so that fixing one number leaves the others unchanged.
        let (place, pace) = (unit(&mut generator), unit(&mut generator));
        let position_m = match (vehicle.start, rear_m) {
            (Start::Position(span), _) => span.at(place),
            (Start::Gap(span), Some(rear_m)) => rear_m - span.at(place),
            (Start::Gap(_), None) => leader_position(&scenario.vehicles),
        };
        states.push(InitialState { position_m, speed_mps: vehicle.speed_mps.at(pace) });
        rear_m = Some(position_m - vehicle.length_m);
    }
    states
}

impl Span {
    /// The number at a fraction (0 to 1) between the low and the high end.
    fn at(self, share: f64) -> f64 {
        self.low + (self.high - self.low) * share
    }
}
