//! Ways through an intersection, as two fields: the leg by which a vehicle comes, and where its exit lies from that.

use super::bits::Payload;
use super::field::Field;

/// Legs that an intersection can have, and exits.
pub const LEGS: u8 = 8;

/// A way through an intersection: in by a leg, out by an exit. The exit that goes straight on from a leg has the number of that leg.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Movement {
    /// The leg; below [`LEGS`].
    pub leg: u8,
    /// The exit; below [`LEGS`].
    pub exit: u8,
}

impl Movement {
    /// Straight on from a leg.
    #[must_use]
    pub const fn straight(leg: u8) -> Self {
        Self { leg, exit: leg }
    }

    /// From a leg to the exit that lies so many numbers after it.
    const fn turned(leg: u8, turn: u8) -> Self {
        Self { leg, exit: leg.wrapping_add(turn) % LEGS }
    }

    /// By how many numbers the exit lies after the leg, modulo 8.
    const fn turn(self) -> u8 {
        self.exit.wrapping_sub(self.leg) % LEGS
    }
}

/// The two fields.
pub(super) struct Fields {
    leg: Field,
    turn: Field,
}

/// Both where they start, and in the parts given.
pub(super) const fn fields(leg: (u32, u8), turn: (u32, u8)) -> Fields {
    Fields { leg: Field::unsigned("Leg", leg.0, 3).part(leg.1), turn: Field::unsigned("Turn", turn.0, 3).part(turn.1) }
}

impl Fields {
    pub(super) const fn leg(&self) -> Field {
        self.leg
    }

    pub(super) const fn turn(&self) -> Field {
        self.turn
    }

    pub(super) fn with_leg(&self, payload: Payload, movement: Movement) -> Payload {
        self.leg.with_raw(payload, i64::from(movement.leg))
    }

    pub(super) fn with_turn(&self, payload: Payload, movement: Movement) -> Payload {
        self.turn.with_raw(payload, i64::from(movement.turn()))
    }

    /// From the payload with the leg and the one with the turn.
    pub(super) fn get(&self, leg: Payload, turn: Payload) -> Movement {
        Movement::turned(self.leg.byte(leg), self.turn.byte(turn))
    }
}
