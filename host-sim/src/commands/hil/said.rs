//! The frames of a unit in one tick by which two units are compared: frames enter, its command and estimate leave.

use holdover::time::Instant;
use holdover::wire::command::Command;
use holdover::wire::estimate::TargetEstimate;
use holdover::wire::{Frame, Identifiers, Message, Received, Receiver, Role};

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
    let mut receiver = Receiver::<1>::new(*identifiers, Role::Modem);
    for round in 0..2 {
        for frame in frames {
            match receiver.receive(Instant::ZERO, &counted(identifiers, frame, round)) {
                Ok(Received::Whole(Message::Command(said))) => command = Some(said),
                Ok(Received::Whole(Message::Estimate(said))) => estimate = Some(said),
                _ => {}
            }
        }
    }
    Some(Said { command: command?, estimate })
}

fn counted(identifiers: &Identifiers, frame: &Frame, counter: u8) -> Frame {
    let offset = identifiers.offset_of(frame.id).unwrap_or(0);
    let data_id = holdover::wire::catalogue::data_id(offset);
    Frame { id: frame.id, data: holdover::wire::e2e::protect(frame.data, data_id, counter) }
}
