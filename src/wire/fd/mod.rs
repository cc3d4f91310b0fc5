//! The catalogue over CAN FD: whole messages in frames of up to 64 bytes. What stands on classic CAN in several frames, tied by a
//! tag, stands here in one; a vehicle's motion, horizon and driving parameters are one frame ([`State`]). So no frame can be
//! of another message than the rest, and a lost frame is a lost message.
//!
//! ```text
//! payloads of 52 bits, as on classic CAN -> layout: one after the other, without tags and selectors -> bits: up to 64 bytes -> e2e
//! ```
//!
//! Fields, ranges, `encode` and `decode` are those of classic CAN: the parts of a message that it divides are moved as they are.
//! Identifiers and data ids are those of its first frame. No frame has 8 bytes, so neither bus's frames pass for the other's.

mod bits;
pub mod e2e;
pub mod layout;

pub(super) use bits::Bits;

use super::driving_parameters::DrivingParameters;
use super::horizon::Knots;
use super::motion::Motion;

/// What a vehicle says of its motion and of what it will do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct State {
    /// Where it is and how it moves.
    pub motion: Motion,
    /// How it will drive: the parameters of its law. `None`: they are not said this time.
    pub parameters: Option<DrivingParameters>,
    /// Its own horizon from that motion on, if it computed one.
    pub horizon: Option<Knots>,
}
