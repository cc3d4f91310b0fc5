//! The actuators of a vehicle: commands with their times of arrival enter, the commands in force during a span of time
//! leave.
//!
//! *Watchdog:* if the unit is outside of the simulation, they brake without a command for [`COMMAND_TIMEOUT_S`], as an
//! actuator has to when it has lost its master. Of such a unit a command in mode standby counts as none.

use std::collections::VecDeque;

use holdover::wire::actuators::{ActuatorState, Control};
use holdover::wire::command::{Command, Effort, ModeCode};

use super::Vehicle;

/// The timeout of the command, as in the catalogue, in seconds.
pub const COMMAND_TIMEOUT_S: f64 = 0.05;
/// Acceleration without a command, in m/s²: braking that surprises no vehicle behind.
pub const WITHOUT_COMMAND_MPS2: f64 = -2.0;

impl Vehicle {
    /// Sets whether the actuators acknowledge the unit's commands.
    pub fn acknowledge(&mut self, acknowledges: bool) {
        self.actuator_state = acknowledges.then(ActuatorState::default);
    }
}

/// What the actuators of a vehicle say once this command is in force.
#[must_use]
pub fn acknowledged(command: &Command, stands: bool) -> ActuatorState {
    let control = if command.mode == ModeCode::Standby { Control::Ready } else { Control::Driving };
    ActuatorState { control, accelerator: false, brake: false, holding: command.hold && stands, tick: command.tick }
}

/// The actuators.
#[derive(Clone, Debug, PartialEq)]
pub struct Actuators {
    /// How long a command holds.
    timeout_s: f64,
    /// The effort in force, and the time from which it is in force.
    current: Option<(f64, Effort)>,
    /// Commands that have arrived and are not in force yet.
    coming: VecDeque<(f64, Effort)>,
}

impl Actuators {
    /// Actuators without a command. A command holds for `timeout_s`.
    #[must_use]
    pub fn new(timeout_s: f64) -> Self {
        Self { timeout_s, current: None, coming: VecDeque::new() }
    }

    /// A command arrives.
    pub fn take(&mut self, at_s: f64, effort: Effort) {
        self.coming.push_back((at_s, effort));
    }

    /// The commands in force from `from_s` to `to_s`: for each piece the command, `None` where there is none, and its
    /// length in seconds.
    pub fn pieces(&mut self, from_s: f64, to_s: f64) -> Vec<(Option<Effort>, f64)> {
        let mut pieces = Vec::new();
        let mut at_s = from_s;
        loop {
            let next_s = self.coming.front().map_or(to_s, |(next_s, _)| next_s.clamp(at_s, to_s));
            self.hold(&mut pieces, at_s, next_s);
            at_s = next_s;
            match self.coming.front() {
                Some((next_s, _)) if *next_s <= at_s => self.current = self.coming.pop_front(),
                _ => return pieces,
            }
        }
    }

    /// Adds one span without a new command.
    fn hold(&self, pieces: &mut Vec<(Option<Effort>, f64)>, from_s: f64, to_s: f64) {
        let until = |(since_s, _): (f64, Effort)| (since_s + self.timeout_s).clamp(from_s, to_s);
        let until_s = self.current.map_or(from_s, until);
        let effort = self.current.map(|(_, effort)| effort);
        let spans = [(effort, until_s - from_s), (None, to_s - until_s)];
        pieces.extend(spans.into_iter().filter(|(_, length_s)| *length_s > 0.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pieces in newtons and microseconds; 0 N stands for no command.
    fn rounded(pieces: &[(Option<Effort>, f64)]) -> Vec<(u16, i32)> {
        let newtons = |effort: &Option<Effort>| match effort {
            Some(Effort::Force(newtons)) => *newtons,
            Some(Effort::BrakeTorque(_)) => panic!("no brakes here"),
            None => 0,
        };
        pieces.iter().map(|(effort, length_s)| (newtons(effort), (length_s * 1e6).round() as i32)).collect()
    }

    #[test]
    fn a_command_is_in_force_from_its_arrival_on() {
        let mut actuators = Actuators::new(COMMAND_TIMEOUT_S);
        actuators.take(1.000, Effort::Force(5));
        actuators.take(1.012, Effort::Force(7));
        assert_eq!(rounded(&actuators.pieces(1.00, 1.01)), [(5, 10_000)]);
        assert_eq!(rounded(&actuators.pieces(1.01, 1.02)), [(5, 2_000), (7, 8_000)]);
        assert_eq!(rounded(&actuators.pieces(1.02, 1.03)), [(7, 10_000)]);
    }

    #[test]
    fn without_a_command_for_fifty_milliseconds_they_brake_until_one_comes() {
        let mut actuators = Actuators::new(COMMAND_TIMEOUT_S);
        assert_eq!(rounded(&actuators.pieces(0.0, 0.01)), [(0, 10_000)]);
        actuators.take(0.02, Effort::Force(10));
        assert_eq!(rounded(&actuators.pieces(0.01, 0.10)), [(0, 10_000), (10, 50_000), (0, 30_000)]);
        actuators.take(0.105, Effort::Force(4));
        assert_eq!(rounded(&actuators.pieces(0.10, 0.11)), [(0, 5_000), (4, 5_000)]);
    }

    #[test]
    fn without_a_timeout_a_command_holds_until_the_next_one() {
        let mut actuators = Actuators::new(f64::INFINITY);
        assert_eq!(rounded(&actuators.pieces(0.0, 0.01)), [(0, 10_000)]);
        actuators.take(0.01, Effort::Force(10));
        assert_eq!(rounded(&actuators.pieces(0.01, 0.41)), [(10, 400_000)]);
    }

    #[test]
    fn commands_that_came_before_the_span_are_in_force_at_once_the_last_one_stays() {
        let mut actuators = Actuators::new(COMMAND_TIMEOUT_S);
        actuators.take(0.0, Effort::Force(10));
        actuators.take(0.005, Effort::Force(20));
        assert_eq!(rounded(&actuators.pieces(0.01, 0.02)), [(20, 10_000)]);
    }
}
