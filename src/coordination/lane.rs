//! The order of the vehicles on the ego's leg. Pairs that are certain, and how far each vehicle has come, enter; how far the vehicles
//! ahead have come at least leaves.
//!
//! No vehicle passes another on a leg. So a vehicle that is ahead of another for certain stays ahead. Its rear bumper is at least where
//! the front bumper of the other is, however long it is silent.

use super::Slots;
use crate::held::Held;
use crate::units::Position;

/// What is known of the order on the ego's leg.
#[derive(Clone, Debug)]
pub(super) struct Lane<const PEERS: usize> {
    /// For each slot: the vehicles that are behind it for certain.
    behind: [Slots; PEERS],
    /// For each slot: how far its rear bumper has come for certain, because a vehicle behind it has come there.
    passed: [Held<Position>; PEERS],
}

impl<const PEERS: usize> Lane<PEERS> {
    /// Nothing is known: all zero.
    pub(super) const UNKNOWN: Self = Self { behind: [Slots::NONE; PEERS], passed: [Held::Nothing; PEERS] };

    /// Notes that the vehicle `ahead` is ahead of the vehicle `behind`.
    pub(super) fn note_behind(&mut self, ahead: usize, behind: usize) {
        if let Some(slots) = self.behind.get_mut(ahead) {
            slots.set(behind, true);
        }
    }

    /// Notes that a vehicle has come at least to `near`. Every vehicle ahead of it has come there too.
    pub(super) fn note_passed(&mut self, index: usize, near: Position) {
        for (behind, passed) in self.behind.iter().zip(&mut self.passed) {
            if behind.contains(index) && passed.get().is_none_or(|before| before < near) {
                passed.set(near);
            }
        }
    }

    /// How far the rear bumper of a vehicle has come at least, by the vehicles behind it.
    pub(super) fn passed(&self, index: usize) -> Option<Position> {
        self.passed.get(index)?.get()
    }

    /// Forgets all that is known of a vehicle.
    pub(super) fn forget(&mut self, index: usize) {
        self.behind.iter_mut().for_each(|behind| behind.set(index, false));
        if let (Some(behind), Some(passed)) = (self.behind.get_mut(index), self.passed.get_mut(index)) {
            *behind = Slots::NONE;
            passed.clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_is_ahead_has_come_as_far_as_anybody_behind_it() {
        let at = |metres: i64| Position::from_mm(metres * 1000);
        let mut lane = Lane::<4>::UNKNOWN;
        lane.note_passed(1, at(50));
        assert_eq!(lane.passed(0), None, "it is not known to be ahead of that one");
        lane.note_behind(0, 1);
        lane.note_behind(0, 2);
        lane.note_passed(1, at(60));
        lane.note_passed(2, at(40));
        assert_eq!((lane.passed(0), lane.passed(1)), (Some(at(60)), None));
        lane.forget(1);
        lane.note_passed(1, at(90));
        assert_eq!(lane.passed(0), Some(at(60)), "what was certain remains so");
        lane.forget(0);
        assert_eq!(lane.passed(0), None);
        lane.note_passed(2, at(70));
        assert_eq!(lane.passed(0), None);
    }
}
