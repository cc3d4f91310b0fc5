//! The number formats of the core, each named once with its range, resolution and rounding, and their products.
//!
//! | format | quantity | range | resolution |
//! |---|---|---|---|
//! | [`DistanceFormat`] `I12F20` | distance, gap | ±2048 m | 0.95 µm |
//! | [`PositionFormat`] `I44F20` | position along the lane | ±8.8e12 m | 0.95 µm |
//! | [`SpeedFormat`] `I9F23` | speed | ±256 m/s | 0.12 µm/s |
//! | [`AccelerationFormat`] `I7F25` | acceleration, jerk | ±64 m/s² | 0.03 µm/s² |
//! | [`SecondsFormat`] `I3F29` | time gap, damping, steps times speed | ±4 s | 1.9 ns |
//! | [`FineSecondsFormat`] `I2F30` | steps times acceleration | ±2 s | 0.93 ns |
//! | [`GainFormat`] `I3F29` | the law's gain `k` | ±4 /s² | 1.9e-9 |
//! | [`FractionFormat`] `I2F30` | a share from 0 to 1 | ±2 | 9.3e-10 |
//!
//! The formats are chosen so that every product of the prediction step is a plain `>> 32`, which is one instruction
//! (`SMMULR`) on a Cortex-M4:
//!
//! | product | formats | rounding |
//! |---|---|---|
//! | speed × seconds = distance | F23 × F29 → F20 | to nearest |
//! | acceleration × fine seconds = speed | F25 × F30 → F23 | to nearest |
//! | distance × gain + gained speed × rate = acceleration | F20 × F29 + F24 × F25 → F49, each `>> 32` → F17, `<< 8` → F25 | each to nearest of F17, saturating |
//! | acceleration × share = acceleration | F25 × F30 → F55, `>> 30` → F25 | to nearest, saturating |
//!
//! Hundreds of products are summed up in the speed and the position of a horizon. There the sum is kept with the 32 bits below its word
//! ([`Rest`]), and nothing is rounded at all. Adding a product is one instruction too (`SMLAL`).
//!
//! Sums saturate, except in ring positions, which are modulo 4096 m on purpose ([`crate::units::RingPosition`]).

use fixed::types::extra::{U20, U23, U25, U29, U30};
use fixed::{FixedI32, FixedI64};

/// Distance and gap in metres.
pub type DistanceFormat = FixedI32<U20>;
/// Position along the lane in metres.
pub type PositionFormat = FixedI64<U20>;
/// Speed in metres per second.
pub type SpeedFormat = FixedI32<U23>;
/// Acceleration in m/s², jerk in m/s³.
pub type AccelerationFormat = FixedI32<U25>;
/// A time that multiplies a speed, in seconds.
pub type SecondsFormat = FixedI32<U29>;
/// A time that multiplies an acceleration, in seconds.
pub type FineSecondsFormat = FixedI32<U30>;
/// The gain `k` of the consensus law, in 1/s².
pub type GainFormat = FixedI32<U29>;
/// A share from 0 to 1, such as `e^(-δt/T)`.
pub type FractionFormat = FixedI32<U30>;

/// `a·b / 2³²`, rounded to nearest (ties towards +∞). It cannot overflow: the product of two 32-bit words is at most 2⁶² in
/// magnitude.
#[inline(always)]
#[must_use]
#[allow(clippy::arithmetic_side_effects, clippy::cast_possible_truncation)] // proved in the doc comment
pub const fn mul_hi(a: i32, b: i32) -> i32 {
    ((a as i64 * b as i64 + (1 << 31)) >> 32) as i32
}

/// The same for a factor `b` that is not negative. Vectors on x86-64 have no signed product before SSE4.1. There it is made from the
/// unsigned product, which is larger by `2³²·b` where `a` is negative. Elsewhere the signed product is one instruction.
#[inline(always)]
#[must_use]
#[allow(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss
)] // a product below 2⁶³ and half a bit; the sign as a mask is meant
pub const fn mul_hi_fraction(a: i32, b: i32) -> i32 {
    if cfg!(target_arch = "x86_64") {
        let unsigned = ((a as u32 as u64 * b as u32 as u64 + (1 << 31)) >> 32) as u32;
        unsigned.wrapping_sub(b as u32 & (a >> 31) as u32) as i32
    } else {
        mul_hi(a, b)
    }
}

/// `x << bits`, saturating: compiles to `SSAT` and a shift.
#[inline(always)]
#[must_use]
#[allow(clippy::arithmetic_side_effects)] // the clamp keeps the shifted value inside 32 bits
pub const fn shl_saturating<const BITS: u32>(x: i32) -> i32 {
    limited::<BITS>(x) << BITS
}

/// The nearest word that can be shifted left by `bits` without overflow: `SSAT`.
#[inline(always)]
#[allow(clippy::arithmetic_side_effects)] // constants
const fn limited<const BITS: u32>(x: i32) -> i32 {
    let limit = 1i32 << (31 - BITS);
    if x < -limit {
        -limit
    } else if x > limit - 1 {
        limit - 1
    } else {
        x
    }
}

/// `numerator / denominator` as a word with `fraction` bits, rounded to nearest (ties away from zero), saturating to
/// 64 bits (exact while `numerator · 2^fraction` fits). A denominator of 0 gives the extreme of the numerator's sign.
#[must_use]
pub const fn ratio(numerator: i64, denominator: i64, fraction: u32) -> i64 {
    if denominator == 0 {
        return if numerator < 0 { i64::MIN } else { i64::MAX };
    }
    divide_rounding(numerator.saturating_mul(1i64.wrapping_shl(fraction)), denominator)
}

/// `word / 2^fraction · denominator`, rounded to nearest (ties away from zero): the inverse of [`ratio`] wherever the
/// format is finer than `1/denominator`. Saturates like it.
#[must_use]
pub const fn unratio(word: i64, denominator: i64, fraction: u32) -> i64 {
    let product = word.saturating_mul(denominator);
    let half = 1u64.wrapping_shl(fraction) >> 1;
    let magnitude = product.unsigned_abs().saturating_add(half).wrapping_shr(fraction).cast_signed(); // at most 2⁶³ >> fraction
    if product < 0 { magnitude.wrapping_neg() } else { magnitude }
}

/// `a·b / 2^(32-BITS)`, rounded to nearest, saturating to within `2^BITS` of the ends.
#[inline(always)]
#[must_use]
#[allow(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss
)]
// as in `mul_hi`; the two halves are meant
pub const fn mul_shl<const BITS: u32>(a: i32, b: i32) -> i32 {
    let product = a as i64 * b as i64 + (1 << (31 - BITS));
    let above = limited::<BITS>((product >> 32) as i32);
    ((((above as u32 as u64) << 32) | product as u32 as u64) >> (32 - BITS)) as i32
}

/// `a·b / 2^(32-BITS)`, rounded down, saturating to within `2^BITS` of the ends. It takes two instructions less than [`mul_shl`]. It is
/// for results whose last bit does not matter, because the format is finer than needed.
#[inline(always)]
#[must_use]
#[allow(clippy::arithmetic_side_effects, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // as above
pub const fn mul_shl_down<const BITS: u32>(a: i32, b: i32) -> i32 {
    let product = a as i64 * b as i64;
    let above = limited::<BITS>((product >> 32) as i32);
    ((((above as u32 as u64) << 32) | product as u32 as u64) >> (32 - BITS)) as i32
}

/// `(a·b + c·d) / 2^(32-BITS)`, each product rounded to nearest of `2^BITS`, saturating to within `2^BITS` of the ends. It is for results
/// that are much finer than they need to be: on a Cortex-M4 the products and the sum are two instructions (`SMMULR`, `SMMLAR`). `d` is not
/// negative.
#[inline(always)]
#[must_use]
pub const fn mul_sum_shl<const BITS: u32>((a, b): (i32, i32), (c, d): (i32, i32)) -> i32 {
    // Each is at most 2³⁰ in magnitude, and the second is less than 2³⁰: the sum is a word.
    shl_saturating::<BITS>(mul_hi(a, b).wrapping_add(mul_hi(c, d)))
}

/// The exact product of two words.
#[inline(always)]
#[must_use]
#[allow(clippy::arithmetic_side_effects)] // at most 2⁶² in magnitude
pub const fn product(a: i32, b: i32) -> i64 {
    a as i64 * b as i64
}

/// The 32 bits below the word of a sum of products. With them the sum is exact, and only its word is rounded, to nearest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rest(u32);

impl Rest {
    /// Nothing below the word. It is stored as half a bit of the word, so that the word is rounded to nearest.
    pub const NONE: Self = Self(1 << 31);
    /// Not set: all zero.
    pub(crate) const UNSET: Self = Self(0);
}

impl Default for Rest {
    fn default() -> Self {
        Self::NONE
    }
}

/// A word and its rest with products added. The word saturates. The products are at most 2⁶² in magnitude.
#[inline(always)]
#[must_use]
#[allow(clippy::arithmetic_side_effects)] // a rest is below 2³²
pub const fn sum(word: i32, rest: Rest, products: i64) -> (i32, Rest) {
    let (gain, rest) = apart(rest.0 as i64 + products);
    (word.saturating_add(gain), rest)
}

/// The same, modulo the range of the word.
#[inline(always)]
#[must_use]
pub const fn sum_around(word: i32, rest: Rest, products: i64) -> (i32, Rest) {
    apart(together(word, rest).wrapping_add(products))
}

const fn together(word: i32, rest: Rest) -> i64 {
    (word as i64) << 32 | rest.0 as i64
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the two halves
const fn apart(sum: i64) -> (i32, Rest) {
    ((sum >> 32) as i32, Rest(sum as u32))
}

/// Narrows to 32 bits, saturating.
#[inline(always)]
#[must_use]
#[allow(clippy::cast_possible_truncation)] // checked
pub const fn saturate_i32(x: i64) -> i32 {
    if x > i32::MAX as i64 {
        i32::MAX
    } else if x < i32::MIN as i64 {
        i32::MIN
    } else {
        x as i32
    }
}

/// Quotient rounded to nearest, ties away from zero; 0 for a divisor of 0.
#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
const fn divide_rounding(dividend: i64, divisor: i64) -> i64 {
    let half = divisor.saturating_abs() / 2;
    quotient(if dividend >= 0 { dividend.saturating_add(half) } else { dividend.saturating_sub(half) }, divisor)
}

/// `dividend / divisor` towards zero, saturating; 0 for a divisor of 0. See [`divide`].
#[must_use]
pub const fn quotient(dividend: i64, divisor: i64) -> i64 {
    let magnitude = divide(dividend.unsigned_abs(), divisor.unsigned_abs());
    let magnitude = if magnitude > i64::MAX as u64 { i64::MAX } else { magnitude.cast_signed() };
    if (dividend < 0) != (divisor < 0) { magnitude.wrapping_neg() } else { magnitude }
}

/// `dividend / divisor`, 0 for a divisor of 0. It is one instruction where words have 64 bits. Elsewhere it is a few 32-bit divisions by
/// hand.
#[must_use]
#[cfg_attr(target_pointer_width = "64", inline)]
#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
pub const fn divide(dividend: u64, divisor: u64) -> u64 {
    if cfg!(target_pointer_width = "64") {
        return match dividend.checked_div(divisor) {
            Some(quotient) => quotient,
            None => 0,
        };
    }
    divide_by_bytes(dividend, divisor)
}

/// [`divide`] by hand. The divisors of the core are nearly all below 2²⁴ (times in µs up to 16 s). For these it takes five 32-bit
/// divisions, each one instruction on a Cortex-M3 and up: the upper word, and the lower word byte by byte. A remainder is below the
/// divisor, which leaves room for the next byte.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::arithmetic_side_effects)] // the words, and checked
const fn divide_by_bytes(dividend: u64, divisor: u64) -> u64 {
    let small = divisor as u32;
    if divisor >= 1 << 24 || small == 0 {
        return match dividend.checked_div(divisor) {
            Some(quotient) => quotient,
            None => 0,
        };
    }
    let (high, low) = ((dividend >> 32) as u32, dividend as u32);
    let first = ((high % small) << 8) | (low >> 24);
    let second = ((first % small) << 8) | ((low >> 16) & 0xFF);
    let third = ((second % small) << 8) | ((low >> 8) & 0xFF);
    let fourth = ((third % small) << 8) | (low & 0xFF);
    let below = ((first / small) << 24) | ((second / small) << 16) | ((third / small) << 8) | (fourth / small);
    (((high / small) as u64) << 32) | below as u64
}

/// `dividend / 10⁶` for a dividend below 2⁶³: `10⁶ = 2⁶·5⁶`.
#[must_use]
pub const fn per_million(dividend: u64) -> u64 {
    per_15_625(dividend >> 6)
}

/// `dividend / 5⁶` for a dividend below 2⁶³, by multiplying with `m = ⌈2⁷⁷/5⁶⌉`. `5⁶ m` exceeds 2⁷⁷ by less than 5⁶.
/// So the product exceeds the quotient by less than `2⁶³/2⁷⁷`, which is less than `1/5⁶`. The fraction of a quotient is at most
/// `1 - 1/5⁶`, so that the product rounds down to the same word.
#[must_use]
#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
#[allow(clippy::cast_possible_truncation, clippy::arithmetic_side_effects)] // the halves; their sums stay below 2⁶⁴
pub const fn per_15_625(dividend: u64) -> u64 {
    const FACTOR: u128 = (1u128 << 77).div_ceil(15_625);
    const { assert!(FACTOR < 1 << 64, "in two words") };
    const { assert!((FACTOR * 15_625 - (1 << 77)) << 63 < 1 << 77, "off by less than what a fraction lacks of 1") };
    const HIGH: u64 = (FACTOR >> 32) as u64;
    const LOW: u64 = FACTOR as u64 & u32::MAX as u64;
    let (high, low) = (dividend >> 32, dividend & u32::MAX as u64);
    let carried = ((low * LOW) >> 32) + low * HIGH;
    let middle = high * LOW + (carried & u32::MAX as u64);
    (high * HIGH + (carried >> 32) + (middle >> 32)) >> 13
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_quotient_is_the_one_that_64_bits_give(dividend: i64, divisor: i64, shift in 0u32..64) {
            let near = [(dividend, divisor % 1_048_577), (dividend, divisor % 16_777_217)];
            for (dividend, divisor) in near.into_iter().chain([(dividend, divisor >> shift), (dividend >> shift, divisor % 1_048_577)]) {
                let exact = i128::from(dividend).checked_div(i128::from(divisor)).unwrap_or(0);
                let saturated = exact.min(i64::MAX.into());
                prop_assert_eq!(i128::from(quotient(dividend, divisor)), saturated, "{} {}", dividend, divisor);
                let [dividend, divisor] = [dividend, divisor].map(i64::unsigned_abs);
                let exact = dividend.checked_div(divisor).unwrap_or(0);
                prop_assert_eq!(divide_by_bytes(dividend, divisor), exact, "{} {}", dividend, divisor);
            }
        }

        #[test]
        fn a_millionth_is_the_one_that_a_division_gives(dividend in 0..=i64::MAX as u64, shift in 0u32..64) {
            let near = dividend / 1_000_000 * 1_000_000;
            for dividend in [dividend, dividend >> shift, near, near.saturating_sub(1), near + 1] {
                prop_assert_eq!(per_million(dividend), dividend / 1_000_000, "{}", dividend);
                let near = dividend / 15_625 * 15_625;
                for dividend in [dividend, near, near.saturating_sub(1)] {
                    prop_assert_eq!(per_15_625(dividend), dividend / 15_625, "{}", dividend);
                }
            }
        }

        #[test]
        fn a_product_is_rounded_to_nearest_and_saturates_near_the_ends(a: i32, b: i32) {
            let exact = i128::from(a) * i128::from(b);
            let nearest = |bits: u32| (exact + (1 << (31 - bits))) >> (32 - bits);
            let near = |got: i32, bits: u32| {
                let saturated = nearest(bits).clamp(i32::MIN.into(), i32::MAX.into());
                (i128::from(got) - saturated).abs() < if saturated == nearest(bits) { 1 } else { 1 << bits }
            };
            prop_assert!(near(mul_shl::<2>(a, b), 2) && near(mul_shl::<8>(a, b), 8));
            prop_assert_eq!(i128::from(mul_hi(a, b)), (exact + (1 << 31)) >> 32);
            prop_assert_eq!(mul_hi_fraction(a, b & i32::MAX), mul_hi(a, b & i32::MAX));
        }

        #[test]
        fn a_sum_of_products_is_rounded_once(start in -1_000_000i32..1_000_000, factors: [(i16, i32); 32]) {
            let (mut word, mut rest, mut exact) = (start, Rest::NONE, i128::from(start) << 32);
            for (a, b) in factors {
                (word, rest) = sum(word, rest, product(a.into(), b));
                exact += i128::from(a) * i128::from(b);
            }
            prop_assert_eq!(i128::from(word), (exact + (1 << 31)) >> 32);
        }
    }

    #[test]
    fn a_sum_saturates_and_one_that_goes_around_does_not() {
        let most = product(i32::MIN, i32::MIN);
        assert_eq!(sum(i32::MAX, Rest::NONE, most).0, i32::MAX);
        assert_eq!(sum(i32::MIN, Rest::NONE, -most).0, i32::MIN);
        assert_eq!(sum_around(i32::MAX, Rest::NONE, 1 << 32).0, i32::MIN);
    }
}
