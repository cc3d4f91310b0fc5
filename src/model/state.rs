//! The state of a vehicle: in full at one step of its motion, as kept in a horizon, and as read at an instant.

use crate::fixed::Rest;
use crate::units::{Acceleration, Position, RingPosition, Speed};

/// A vehicle's state at one step of a horizon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct State {
    /// Front bumper, modulo 4096 m.
    pub position: RingPosition,
    /// Speed, never negative.
    pub speed: Speed,
    /// Acceleration reached.
    pub acceleration: Acceleration,
    /// Acceleration demanded in the step before.
    pub demand: Acceleration,
    /// The parts of position and speed below their last bits.
    pub remainders: Remainders,
}

/// The parts that hundreds of steps would lose of position and speed if each step were rounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Remainders {
    pub(super) position: Rest,
    pub(super) speed: Rest,
}

impl Remainders {
    /// The remainders of a state that is exactly its words.
    pub const NONE: Self = Self { position: Rest::NONE, speed: Rest::NONE };
    /// Not set: all zero.
    pub(crate) const UNSET: Self = Self { position: Rest::UNSET, speed: Rest::UNSET };
}

/// One step of a horizon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Step {
    /// Front bumper, modulo 4096 m.
    pub position: RingPosition,
    /// Speed, never negative.
    pub speed: Speed,
}

/// The predecessor over one step of its follower.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TargetStep {
    /// Its front bumper at the end of the step.
    pub position: RingPosition,
    /// Its speed at the end of the step.
    pub speed: Speed,
    /// By how much its speed grew over the step.
    pub gained: Speed,
}

impl TargetStep {
    /// From its speed at the beginning of the step, and its state at the end.
    #[inline(always)]
    #[must_use]
    pub const fn between(before: Speed, end: &Step) -> Self {
        Self { position: end.position, speed: end.speed, gained: end.speed.minus(before) }
    }
}

/// Where a vehicle is at one instant, as read from its horizon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading {
    /// Front bumper.
    pub position: Position,
    /// Speed, never negative.
    pub speed: Speed,
}
