//! A vehicle's state: at one step of its motion in full, in a horizon as far as it is kept, and as it is read at an instant.

use crate::fixed::Rest;
use crate::units::{Acceleration, Position, RingPosition, Speed};

/// A vehicle's state at one step of a horizon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct State {
    /// Front bumper, modulo 4096 m.
    pub position: RingPosition,
    /// Never negative.
    pub speed: Speed,
    /// Acceleration reached.
    pub acceleration: Acceleration,
    /// Acceleration demanded in the step before.
    pub demand: Acceleration,
    /// What is below the last bits of position and speed.
    pub remainders: Remainders,
}

/// What hundreds of steps would lose of position and speed if each of them were rounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Remainders {
    pub(super) position: Rest,
    pub(super) speed: Rest,
}

impl Remainders {
    /// Of a state that is exactly its words.
    pub const NONE: Self = Self { position: Rest::NONE, speed: Rest::NONE };
    /// Of no state: all zero.
    pub(crate) const UNSET: Self = Self { position: Rest::UNSET, speed: Rest::UNSET };
}

/// One step of a horizon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Step {
    /// Front bumper, modulo 4096 m.
    pub position: RingPosition,
    /// Never negative.
    pub speed: Speed,
}

/// Where a vehicle is at one instant, as read from its horizon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading {
    /// Front bumper.
    pub position: Position,
    /// Never negative.
    pub speed: Speed,
}
