//! Algorithm 3: the speeds at both ends of a step enter, the position at its end leaves.
//!
//! Eq. 9 as printed is `r(t+k) = r(t+k-1) + v(t+k-1) δt` (forward Euler), which costs metres at δt = 1 s. The default is
//! the trapezoid `½ (v(t+k-1) + v(t+k)) δt`. Both are `v(t+k-1) w₀ + v(t+k) w₁`, so one piece of code serves both.

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
            Self { before: half, after: half }
        } else {
            Self { before: whole, after: Seconds::ZERO }
        }
    }

    /// The position at the end of the step.
    #[inline(always)]
    #[must_use]
    pub const fn follow(&self, position: RingPosition, before: Speed, after: Speed) -> RingPosition {
        position.ahead(before.over(self.before)).ahead(after.over(self.after))
    }
}
