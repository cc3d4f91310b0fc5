//! What vehicles are called on the air: who appears and who vanishes enters; a number that nobody else has leaves.
//!
//! A unit's bus has room for 255 stations, and a unit that hears two by one name takes them for one. So a number is given
//! again only when whoever had it has long vanished; while all are taken nobody appears.

/// Numbers that there are.
const NUMBERS: usize = 255;

/// A number rests for so long after its vehicle has vanished, in seconds: nobody remembers that one any more.
const RESTS_S: f64 = 60.0;

/// The numbers.
pub(super) struct Numbers {
    /// From when on each is free.
    free_s: [f64; NUMBERS],
}

impl Numbers {
    /// All of them are free.
    pub(super) const fn new() -> Self {
        Self { free_s: [f64::NEG_INFINITY; NUMBERS] }
    }

    /// The number for a vehicle that appears now: the first free one from its trip's on. `None`: all are taken.
    pub(super) fn take(&mut self, at_s: f64, trip: usize) -> Option<usize> {
        let number = (0..NUMBERS).map(|step| (trip + step) % NUMBERS).find(|number| self.free_s[*number] <= at_s)?;
        self.free_s[number] = f64::INFINITY;
        Some(number)
    }

    /// A vehicle has vanished.
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
