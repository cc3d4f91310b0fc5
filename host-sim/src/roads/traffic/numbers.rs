//! The station numbers on the air: vehicles that appear and vanish enter; a number that no other vehicle has leaves.
//!
//! A unit's bus has room for 255 stations, and a unit that hears two vehicles with one number takes them for one. So a
//! number is used again only when its last vehicle has long vanished. While all numbers are in use, no vehicle appears.

use crate::sim::station::STATIONS as NUMBERS;

/// A number rests for this time after its vehicle has vanished, in seconds. By then no unit remembers that vehicle.
const RESTS_S: f64 = 60.0;

/// The station numbers.
#[derive(Clone)]
pub(super) struct Numbers {
    /// For each number, the time from which it is free.
    free_s: [f64; NUMBERS],
}

impl Numbers {
    /// All numbers are free.
    pub(super) const fn new() -> Self {
        Self { free_s: [f64::NEG_INFINITY; NUMBERS] }
    }

    /// The number for a vehicle that appears now: the first free one, counted from its trip on. `None`: all are in use.
    pub(super) fn take(&mut self, at_s: f64, trip: usize) -> Option<usize> {
        let number = (0..NUMBERS).map(|step| (trip + step) % NUMBERS).find(|number| self.free_s[*number] <= at_s)?;
        self.free_s[number] = f64::INFINITY;
        Some(number)
    }

    /// Frees the number of a vehicle that has vanished.
    pub(super) fn give_back(&mut self, at_s: f64, number: usize) {
        self.free_s[number] = at_s + RESTS_S;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_is_called_as_somebody_who_is_there_or_has_just_vanished() {
        let mut numbers = Numbers::new();
        assert_eq!([0, 254, 255].map(|trip| numbers.take(0.0, trip)), [Some(0), Some(254), Some(1)]);
        numbers.give_back(10.0, 0);
        assert_eq!([0, 0].map(|trip| numbers.take(69.9, trip)), [Some(2), Some(3)]);
        assert_eq!(numbers.take(70.0, 510), Some(0));
    }

    #[test]
    fn while_all_numbers_are_taken_nobody_gets_one() {
        let mut numbers = Numbers::new();
        assert!((0..NUMBERS).all(|trip| numbers.take(0.0, trip) == Some(trip)));
        assert_eq!(numbers.take(0.0, 0), None);
    }
}
