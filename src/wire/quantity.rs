//! Physical quantities as whole steps on the wire: a quantity enters, a raw number leaves, and back.
//!
//! A step is `1/per_unit` of the quantity's unit, so that every factor in the catalogue is an exact decimal. Steps to
//! quantity rounds to the nearest word of the quantity's format, quantity to steps to the nearest step (ties away from
//! zero) or, for what must not be understated, up.

use crate::units::{Acceleration, Distance, FineSeconds, Gain, Jerk, Seconds, Speed};

/// A quantity that can stand in a field.
pub trait Quantity: Copy + PartialOrd {
    /// So many steps, saturating at the ends of the format.
    fn from_steps(steps: i64, per_unit: i64) -> Self;

    /// To the nearest step.
    fn to_steps(self, per_unit: i64) -> i64;

    /// To the smallest number of steps that is not below the quantity.
    #[must_use]
    fn to_steps_up(self, per_unit: i64) -> i64 {
        let nearest = self.to_steps(per_unit);
        if Self::from_steps(nearest, per_unit) < self { nearest.saturating_add(1) } else { nearest }
    }
}

macro_rules! quantity {
    ($($name:ident),*) => {$(
        impl Quantity for $name {
            #[inline]
            fn from_steps(steps: i64, per_unit: i64) -> Self {
                Self::from_ratio(steps, per_unit)
            }

            #[inline]
            fn to_steps(self, per_unit: i64) -> i64 {
                self.to_multiple_of(per_unit)
            }
        }
    )*};
}

quantity!(Acceleration, Distance, FineSeconds, Gain, Jerk, Seconds, Speed);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_come_back_from_every_quantity_both_ways() {
        for steps in -32_767..=32_767i64 {
            let speed = Speed::from_steps(steps, 500);
            assert_eq!((speed.to_steps(500), speed.to_steps_up(500)), (steps, steps));
        }
        for steps in 0..=3_999i64 {
            assert_eq!(Gain::from_steps(steps, 1000).to_steps(1000), steps);
            assert_eq!(Seconds::from_steps(steps, 1000).to_steps(1000), steps);
        }
        for steps in 0..=999i64 {
            assert_eq!(FineSeconds::from_steps(steps, 500).to_steps(500), steps);
        }
    }

    #[test]
    fn rounding_up_understates_nothing() {
        for bits in (0..2_000_000).step_by(997) {
            let distance = Distance::from_bits(bits);
            let steps = distance.to_steps_up(20);
            assert!(Distance::from_steps(steps, 20) >= distance);
            assert!(Distance::from_steps(steps - 1, 20) < distance);
        }
    }
}
