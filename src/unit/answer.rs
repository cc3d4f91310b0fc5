//! What the unit returns from its two doors: what became of a frame, and the answer of a tick.

use heapless::Vec;

use crate::controller::Mode;
use crate::model::Reading;
use crate::model::bound::Bound;
use crate::time::Duration;
use crate::wire::Frame;
use crate::wire::catalogue::{CATALOGUE, Node};
use crate::wire::command::Command;

/// The most frames that one tick sends: command, estimate (2), motion (2), driving parameters (3), horizon (5), route (2), passes (4),
/// status.
pub const MAX_FRAMES: usize = 20;

/// The number of frames of all messages that the unit sends by the catalogue. The place on the globe is not among them: others hear of
/// the ego by its route.
#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects)] // in const
const SENT: usize = {
    let (mut frames, mut line) = (0, 0);
    while line < CATALOGUE.len() {
        if matches!(CATALOGUE[line].sender, Node::Unit) && CATALOGUE[line].is_sent() {
            frames += CATALOGUE[line].frames as usize;
        }
        line += 1;
    }
    frames
};

const _: () = assert!(SENT == MAX_FRAMES, "an answer has room for every message once, and no more");

/// What became of a frame that was not refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Reception {
    /// The frame is not one of the unit's.
    Foreign,
    /// The frame is part of a message whose other parts are still to come.
    Pending,
    /// A message was taken in.
    Taken,
}

/// Where the target is now, as the unit believes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Estimate {
    /// Position and speed at the tick.
    pub reading: Reading,
    /// Age of the newest sample that the estimate rests on.
    pub age: Duration,
    /// Whether the link to the target is on.
    pub link_on: bool,
    /// What is certain of the target at the tick.
    pub bound: Option<Bound>,
}

/// The answer of a tick.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The command to the actuators.
    pub command: Command,
    /// The mode that it was computed in.
    pub mode: Mode,
    /// The estimate of the target, if it has one.
    pub estimate: Option<Estimate>,
    /// The frames to send, in this order.
    pub frames: Vec<Frame, MAX_FRAMES>,
}
