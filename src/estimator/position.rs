//! Algorithm 3: the speeds at both ends of a step enter, the position at its end leaves.
//!
//! Eq. 9 as printed is `r(t+k) = r(t+k-1) + v(t+k-1) δt` (forward Euler), which costs metres at δt = 1 s. The default is
//! the trapezoid `½ (v(t+k-1) + v(t+k)) δt`. Both are `v(t+k-1) w₀ + v(t+k) w₁`, so one piece of code serves both.

use crate::fixed::{Rest, product};
use crate::time::Duration;
use crate::units::{RingPosition, Seconds, Speed};

/// The two weights of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Path {
    before: Seconds,
    after: Seconds,
}

impl Path {
    /// For steps of this length: the trapezoid, or eq. 9 as printed.
    #[must_use]
    pub fn over(step: Duration, trapezoid: bool) -> Self {
        let whole = step.seconds();
        if trapezoid {
            let half = Seconds::from_bits(whole.to_bits() / 2);
            Self { before: whole.minus(half), after: half } // so that the two are the step, to the last bit
        } else {
            Self { before: whole, after: Seconds::ZERO }
        }
    }

    /// The position at the end of the step, with its rest.
    #[inline(always)]
    #[must_use]
    pub const fn follow(
        &self,
        position: RingPosition,
        rest: Rest,
        before: Speed,
        after: Speed,
    ) -> (RingPosition, Rest) {
        // Two steps of at most 1 s add up to 2⁵³ 256 m at the most.
        let way = product(before.to_bits(), self.before.to_bits())
            .wrapping_add(product(after.to_bits(), self.after.to_bits()));
        position.along(rest, way)
    }
}
