//! Algorithm 3: the speeds at both ends of a step enter, the position at its end leaves.
//!
//! Eq. 9 as printed is `r(t+k) = r(t+k-1) + v(t+k-1) δt` (forward Euler), which costs metres at δt = 1 s. The default is
//! the trapezoid `½ (v(t+k-1) + v(t+k)) δt`.

use crate::fixed::Rest;
use crate::time::Duration;
use crate::units::{RingPosition, Seconds, Speed};

/// How a step adds to the position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Path {
    /// The step as a word of [`Seconds`], not negative.
    step: u32,
    trapezoid: bool,
}

impl Path {
    /// For steps of this length: the trapezoid, or eq. 9 as printed.
    #[must_use]
    pub fn over(step: Duration, trapezoid: bool) -> Self {
        Self { step: step.seconds().max(Seconds::ZERO).to_bits().unsigned_abs(), trapezoid }
    }

    /// Whether it is the trapezoid.
    #[must_use]
    pub const fn is_trapezoid(&self) -> bool {
        self.trapezoid
    }

    /// The position at the end of the step, with its rest. Speeds are not negative. `TRAPEZOID` is the value of
    /// [`is_trapezoid`](Self::is_trapezoid), so that a loop of steps need not ask for it.
    #[inline(always)]
    #[must_use]
    #[allow(clippy::arithmetic_side_effects)] // each speed is below 2³¹
    pub const fn follow<const TRAPEZOID: bool>(
        &self,
        position: RingPosition,
        rest: Rest,
        before: Speed,
        after: Speed,
    ) -> (RingPosition, Rest) {
        // Half a bit of a speed is 0.06 µm/s.
        let speed = if TRAPEZOID { (word(before) + word(after)) / 2 } else { word(before) };
        self.advance(position, rest, speed)
    }

    #[inline(always)]
    #[allow(clippy::arithmetic_side_effects)] // 32 by 32 bits
    const fn advance(&self, position: RingPosition, rest: Rest, speed: u32) -> (RingPosition, Rest) {
        // At most 4 s at 256 m/s, which is 2⁶². It is modulo the ring on purpose (`UMLAL`).
        position.along(rest, (speed as u64 * self.step as u64).cast_signed())
    }
}

/// The word of a speed that is not negative.
#[inline(always)]
#[allow(clippy::cast_sign_loss)] // as said
const fn word(speed: Speed) -> u32 {
    speed.to_bits() as u32
}
