//! The frames of a unit in one tick by which two units are compared: frames enter, its command and estimate leave.

use holdover::time::Instant;
use holdover::wire::command::Command;
use holdover::wire::estimate::TargetEstimate;
use holdover::wire::{Frame, Identifiers, Message, Received, Receiver, Role};

use super::content::{recounted, transport_of};

/// The command and the estimate of one tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Said {
    /// The command.
    pub command: Command,
    /// The estimate, if there is a target.
    pub estimate: Option<TargetEstimate>,
}

/// The content of the frames of one answer, without a check of their counters.
#[must_use]
pub fn said(identifiers: &Identifiers, frames: &[Frame]) -> Option<Said> {
    let (mut command, mut estimate) = (None, None);
    // Twice, because a receiver does not trust the first frame of an identifier. The repeated counters are then
    // refused.
    let mut receiver = Receiver::<1>::new(*identifiers, Role::Modem).over(transport_of(frames));
    for round in 0..2 {
        for frame in frames {
            match receiver.receive(Instant::ZERO, &recounted(identifiers, frame, round)) {
                Ok(Received::Whole(Message::Command(said))) => command = Some(said),
                Ok(Received::Whole(Message::Estimate(said))) => estimate = Some(said),
                _ => {}
            }
        }
    }
    Some(Said { command: command?, estimate })
}
