//! `e^(-h/T)` for the actuators' lag and the fading acceleration. Two times enter; a fraction leaves. It is within 4e-9 of the true
//! value, and computed in integers only.

use crate::fixed::{divide, quotient, saturate_i32};
use crate::time::Duration;
use crate::units::{FineSeconds, Fraction};

/// ln 2 in 32 fraction bits.
const LN_2: u64 = 2_977_044_472;
/// 1 in 32 fraction bits.
const ONE: u64 = 1 << 32;

/// The part of a deviation that a lag leaves after one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decay {
    /// The fraction `φ = e^(-h/T)` that is left; 0 if there is no lag, 1 if no time passes.
    pub keep: Fraction,
    /// `T (1 - φ)`: what the deviation still adds to the speed while it decays.
    pub slip: FineSeconds,
}

impl Decay {
    /// For a step `h` with time constant `T`.
    #[must_use]
    pub fn over(step: Duration, time_constant: Duration) -> Self {
        let keep = keep(step, time_constant);
        // Fraction and fine seconds both have 30 bits: micros · fraction / 1e6 is in the format of fine seconds.
        let lost = Fraction::ONE.minus(keep);
        let product = time_constant.as_micros().max(0).saturating_mul(i64::from(lost.to_bits()));
        Self { keep, slip: FineSeconds::from_bits(saturate_i32(quotient(product.saturating_add(500_000), 1_000_000))) }
    }
}

/// `e^(-h/T)`.
fn keep(step: Duration, time_constant: Duration) -> Fraction {
    let (step, time_constant) =
        (step.as_micros().max(0).unsigned_abs(), time_constant.as_micros().max(0).unsigned_abs());
    // Beyond 22 time constants nothing is left in 30 bits. Below that, the quotient fits 37 bits.
    if step > 0 && step >= time_constant.saturating_mul(22) {
        return Fraction::ZERO;
    }
    let x = divide(step.saturating_mul(ONE), time_constant);
    let halvings = x / LN_2;
    let rest = x.saturating_sub(halvings.saturating_mul(LN_2));
    Fraction::from_bits(rounded(exp_of_minus(rest), halvings.saturating_add(2)))
}

/// `e^(-x)` for `x` in [0, ln 2), both in 32 fraction bits: the Taylor series by Horner's rule. The first term left out
/// is (ln 2)¹²/12! = 2.6e-11.
#[allow(clippy::cast_possible_truncation)] // halves of products; ln 2 is below 1
fn exp_of_minus(x: u64) -> u64 {
    let product = |a: u32, b: u32| (u64::from(a).wrapping_mul(u64::from(b)) >> 32) as u32;
    let x = x as u32;
    // Each sum is 1 less a subtrahend. Only the subtrahend fits a word.
    let times_sum = |less: u32| if less == 0 { x } else { product(x, less.wrapping_neg()) };
    let less = INVERSES.iter().fold(0, |less, inverse| product(times_sum(less), *inverse));
    ONE.saturating_sub(u64::from(times_sum(less)))
}

/// 1/11 to 1/2 in 32 fraction bits.
#[allow(clippy::indexing_slicing, clippy::arithmetic_side_effects, clippy::cast_possible_truncation)] // in const
const INVERSES: [u32; 10] = {
    let (mut inverses, mut place) = ([0; 10], 0);
    while place < inverses.len() {
        inverses[place] = (ONE / (11 - place as u64)) as u32;
        place += 1;
    }
    inverses
};

/// `x / 2^bits`, to nearest.
#[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap)] // x <= 2³² and bits >= 2
fn rounded(x: u64, bits: u64) -> i32 {
    let bits = (bits as u32).min(40);
    (x.saturating_add(1u64.wrapping_shl(bits.saturating_sub(1))).wrapping_shr(bits)) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_is_within_4e_9_of_the_exponential_everywhere() {
        let mut worst: f64 = 0.0;
        for step in (1..=1_000_000).step_by(997) {
            for lag in (2_000..=2_000_000).step_by(49_999) {
                let Decay { keep, slip } = Decay::over(Duration::from_micros(step), Duration::from_micros(lag));
                let exact = (-(step as f64) / lag as f64).exp();
                worst = worst.max((keep.get().to_num::<f64>() - exact).abs());
                let slip = slip.get().to_num::<f64>();
                assert!((slip - lag as f64 * 1e-6 * (1.0 - exact)).abs() < 1e-8, "{step} {lag} {slip}");
            }
        }
        assert!(worst < 4e-9, "{worst:e}");
    }

    #[test]
    fn without_lag_nothing_is_kept() {
        let nothing = Decay { keep: Fraction::ZERO, slip: FineSeconds::ZERO };
        assert_eq!(Decay::over(Duration::from_millis(10), Duration::ZERO), nothing);
    }

    #[test]
    fn without_time_everything_is_kept() {
        for lag in [0, 300] {
            assert_eq!(keep(Duration::ZERO, Duration::from_millis(lag)), Fraction::ONE);
        }
    }
}
