//! Physical quantities as whole steps on the wire: a quantity enters, a raw number leaves, and back.
//!
//! A step is `1/per_unit` of the quantity's unit, so that every factor in the catalogue is an exact decimal. Steps to
//! quantity rounds to the nearest word of the quantity's format, quantity to steps to the nearest step (ties away from
//! zero) or, for what must not be understated, up.

use crate::fixed::{
    AccelerationFormat, DistanceFormat, FineSecondsFormat, FractionFormat, GainFormat, SecondsFormat, SpeedFormat,
    divide, saturate_i32,
};
use crate::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};

/// A quantity that can stand in a field.
pub trait Quantity: Copy + PartialOrd {
    /// So many steps, saturating at the ends of the format.
    fn from_steps(steps: i64, per_unit: i64) -> Self;

    /// To the nearest step.
    fn to_steps(self, per_unit: i64) -> i64;

    /// To the smallest number of steps that is not below the quantity: `from_steps` of one less is.
    fn to_steps_up(self, per_unit: i64) -> i64;
}

/// `steps / per_unit` as a word with so many fraction bits. Fields have at most 32 bits and formats at most 30 fraction
/// bits, so that 64 bits hold it; 128-bit division, as of [`crate::fixed::ratio`], takes ten times as long on a
/// Cortex-M.
fn word(steps: i64, per_unit: i64, fraction: u32) -> i32 {
    let (magnitude, per_unit) = (steps.unsigned_abs(), per_unit.unsigned_abs());
    let word = match (u16::try_from(magnitude), u16::try_from(per_unit)) {
        (Ok(steps), Ok(per_unit)) => short_word(steps.into(), per_unit.into(), fraction),
        _ => divide(magnitude.wrapping_shl(fraction).wrapping_add(per_unit / 2), per_unit),
    };
    let word = word.cast_signed(); // below 2⁶³
    saturate_i32(if steps < 0 { word.wrapping_neg() } else { word })
}

/// The same of fewer than 2¹⁶ steps, of which a unit has fewer than 2¹⁶: `2^fraction = whole·per_unit + rest`, and so 32 bits are enough.
#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
fn short_word(steps: u32, per_unit: u32, fraction: u32) -> u64 {
    let (one, per_unit) = (1u32.wrapping_shl(fraction), per_unit.max(1));
    let whole = one.checked_div(per_unit).unwrap_or(0);
    let rest = one.wrapping_sub(whole.wrapping_mul(per_unit));
    // Below 2³², because the rest is below 2¹⁶ - 1.
    let part = steps.wrapping_mul(rest).wrapping_add(per_unit / 2).checked_div(per_unit).unwrap_or(0);
    u64::from(steps).wrapping_mul(whole.into()).wrapping_add(part.into())
}

/// How many `1/per_unit` a word with so many fraction bits is. Units have at most 10⁷ steps, so that 64 bits hold it.
#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
fn steps(word: i32, per_unit: i64, fraction: u32) -> i64 {
    let product = i64::from(word).saturating_mul(per_unit);
    let half = 1i64.wrapping_shl(fraction.saturating_sub(1));
    let magnitude = product.saturating_abs().saturating_add(half).wrapping_shr(fraction);
    if product < 0 { magnitude.saturating_neg() } else { magnitude }
}

/// How many `1/per_unit` a word is, so that [`word`] of it is not below. Whether it would be below needs no division:
/// `⌊(n·2^f + p/2)/p⌋ < w` is `n·2^f + p/2 < w·p`, and where the dividend is negative `⌈(n·2^f - p/2)/p⌉ < w` is
/// `n·2^f - p/2 <= (w - 1)·p`.
fn steps_up(bits: i32, per_unit: i64, fraction: u32) -> i64 {
    let nearest = steps(bits, per_unit, fraction);
    let scaled = nearest.wrapping_shl(fraction); // about the product below, so it fits
    let product = i64::from(bits).saturating_mul(per_unit);
    let half = per_unit / 2;
    let is_below = if scaled < 0 {
        scaled.saturating_sub(half) <= product.saturating_sub(per_unit)
    } else {
        scaled.saturating_add(half) < product
    };
    nearest.saturating_add(i64::from(is_below))
}

macro_rules! quantity {
    ($($name:ident: $format:ty),*) => {$(
        impl Quantity for $name {
            #[inline]
            fn from_steps(steps: i64, per_unit: i64) -> Self {
                Self::from_bits(word(steps, per_unit, <$format>::FRAC_NBITS))
            }

            #[inline]
            fn to_steps(self, per_unit: i64) -> i64 {
                steps(self.to_bits(), per_unit, <$format>::FRAC_NBITS)
            }

            #[inline]
            fn to_steps_up(self, per_unit: i64) -> i64 {
                steps_up(self.to_bits(), per_unit, <$format>::FRAC_NBITS)
            }
        }
    )*};
}

quantity!(
    Acceleration: AccelerationFormat,
    Distance: DistanceFormat,
    FineSeconds: FineSecondsFormat,
    Fraction: FractionFormat,
    Gain: GainFormat,
    Jerk: AccelerationFormat,
    Seconds: SecondsFormat,
    Speed: SpeedFormat
);

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
    fn steps_are_the_ratios_of_the_units() {
        for raw in (-262_143..=262_143i64).step_by(131) {
            assert_eq!(Distance::from_steps(raw, 1000), Distance::from_ratio(raw, 1000));
            assert_eq!(Speed::from_steps(raw, 500), Speed::from_ratio(raw, 500));
            assert_eq!(Acceleration::from_steps(raw, 50), Acceleration::from_ratio(raw, 50));
            let bits = raw as i32 * 8191;
            assert_eq!(Speed::from_bits(bits).to_steps(500), Speed::from_bits(bits).to_multiple_of(500));
            assert_eq!(Gain::from_bits(bits).to_steps(1000), Gain::from_bits(bits).to_multiple_of(1000));
        }
    }

    #[test]
    fn short_words_are_those_that_64_bits_give() {
        for per_unit in [1i64, 2, 3, 7, 20, 50, 500, 1000, 4096, 65_535, 65_536] {
            for fraction in [20, 23, 25, 29, 30] {
                for steps in (0..=65_536i64).step_by(257).chain([1, 2, 65_534, 65_535, 65_536]) {
                    let exact = ((i128::from(steps) << fraction) + i128::from(per_unit / 2)) / i128::from(per_unit);
                    let exact = exact.min(i32::MAX.into()) as i32;
                    assert_eq!(word(steps, per_unit, fraction), exact, "{steps} {per_unit} {fraction}");
                    assert_eq!(word(-steps, per_unit, fraction).unsigned_abs().min(i32::MAX as u32), exact as u32);
                }
            }
        }
    }

    #[test]
    fn rounding_up_takes_one_step_more_where_the_nearest_number_of_steps_is_below() {
        let nearest_or_more = |speed: Speed, per_unit| {
            let nearest = speed.to_steps(per_unit);
            if Speed::from_steps(nearest, per_unit) < speed { nearest + 1 } else { nearest }
        };
        for per_unit in [1, 2, 3, 5, 10, 20, 50, 500, 1000, 4096, 1 << 23, 10_000_000] {
            let ends = [i32::MIN, i32::MIN + 1, i32::MAX - 1, i32::MAX];
            for bits in (-2_000_000_000..2_000_000_000).step_by(1_999_993).chain(-2_000..2_000).chain(ends) {
                let speed = Speed::from_bits(bits);
                assert_eq!(speed.to_steps_up(per_unit), nearest_or_more(speed, per_unit), "{bits} {per_unit}");
            }
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
