//! Algorithm 3: the speeds at both ends of a step enter, the position at its end leaves.
//!
//! Eq. 9 as printed is `r(t+k) = r(t+k-1) + v(t+k-1) δt` (forward Euler), which costs metres at δt = 1 s. The default is
//! the trapezoid `½ (v(t+k-1) + v(t+k)) δt`. Both are `v(t+k-1) w₀ + v(t+k) w₁`, so one piece of code serves both.

use crate::fixed::Rest;
use crate::time::Duration;
use crate::units::{RingPosition, Seconds, Speed};

/// The two weights of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Path {
    /// Words of [`Seconds`], not negative.
    before: u32,
    after: u32,
}

impl Path {
    /// For steps of this length: the trapezoid, or eq. 9 as printed.
    #[must_use]
    pub fn over(step: Duration, trapezoid: bool) -> Self {
        let whole = step.seconds().max(Seconds::ZERO).to_bits().unsigned_abs();
        let after = if trapezoid { whole / 2 } else { 0 };
        Self { before: whole.saturating_sub(after), after } // the two are the step, to the last bit
    }

    /// The position at the end of the step, with its rest; speeds are not negative.
    #[inline(always)]
    #[must_use]
    pub const fn follow(
        &self,
        position: RingPosition,
        rest: Rest,
        before: Speed,
        after: Speed,
    ) -> (RingPosition, Rest) {
        // One after the other, so that each is a multiplication that adds to the sum (`UMLAL`). Modulo the ring, as it is
        // meant to be.
        let (position, rest) = position.along(rest, times(before, self.before));
        position.along(rest, times(after, self.after))
    }
}

#[inline(always)]
#[allow(clippy::arithmetic_side_effects, clippy::cast_sign_loss)] // 32 by 32 bits; a speed is not negative
const fn times(speed: Speed, seconds: u32) -> i64 {
    (speed.to_bits() as u32 as u64 * seconds as u64).cast_signed()
}
