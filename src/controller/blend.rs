//! Smooth re-association: the jump of an estimate when news ends a silence enters, and fades out of what the controller
//! sees, so that the command does not jump.

use crate::model::Reading;
use crate::time::Duration;
use crate::units::{Distance, Fraction, Speed};

/// What is still between the estimate and what the controller sees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Blend {
    position: Distance,
    speed: Speed,
}

/// Time constant of the fading: as long as the controller's own reaction at `k (t_g + γ)` = 1.5 /s would take, and short
/// against the age at which an estimate is off by more than comfort allows.
pub const BLEND: Duration = Duration::from_millis(300);

/// Jumps beyond these are not noise of a silence but another situation; they are shown to the controller at once.
const LARGEST: (Distance, Speed) = (Distance::from_mm(5_000), Speed::from_mm_per_s(5_000));

impl Blend {
    /// Nothing between them.
    pub const NONE: Self = Self { position: Distance::ZERO, speed: Speed::ZERO };

    /// Starts from what the controller saw and what the new estimate says of the same instant.
    #[must_use]
    pub fn from(seen: Reading, estimate: Reading) -> Self {
        let position = seen.position.ahead_of(estimate.position);
        let speed = seen.speed.minus(estimate.speed);
        if position.magnitude() > LARGEST.0 || speed.magnitude() > LARGEST.1 {
            return Self::NONE;
        }
        Self { position, speed }
    }

    /// What the controller sees.
    #[must_use]
    pub fn apply(&self, estimate: Reading) -> Reading {
        Reading {
            position: estimate.position.ahead(self.position),
            speed: estimate.speed.plus(self.speed).max(Speed::ZERO),
        }
    }

    /// One period later, `keep` being the share that is left after it.
    #[must_use]
    pub fn faded(&self, keep: Fraction) -> Self {
        Self { position: self.position.fraction(keep), speed: self.speed.fraction(keep) }
    }
}

/// The share that is left after one period.
#[must_use]
pub fn keep_over(period: Duration) -> Fraction {
    crate::model::Decay::over(period, BLEND).keep
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Position;

    fn reading(mm: i64, mm_per_s: i32) -> Reading {
        Reading { position: Position::from_mm(mm), speed: Speed::from_mm_per_s(mm_per_s) }
    }

    #[test]
    fn the_controller_sees_what_it_saw_and_in_the_end_the_estimate() {
        let (seen, estimate) = (reading(10_500, 10_000), reading(10_000, 9_000));
        let mut blend = Blend::from(seen, estimate);
        assert_eq!(blend.apply(estimate), seen);
        let keep = keep_over(Duration::from_millis(10));
        for _ in 0..1000 {
            blend = blend.faded(keep);
        }
        assert_eq!(blend.apply(estimate).position.to_mm(), 10_000);
        assert_eq!(blend.apply(estimate).speed.to_mm_per_s(), 9_000);
    }

    #[test]
    fn after_its_time_constant_a_third_is_left() {
        let mut blend = Blend::from(reading(1_000, 0), reading(0, 0));
        for _ in 0..30 {
            blend = blend.faded(keep_over(Duration::from_millis(10)));
        }
        assert_eq!(blend.apply(reading(0, 0)).position.to_mm(), 368);
    }

    #[test]
    fn another_situation_is_shown_at_once() {
        let estimate = reading(0, 0);
        assert_eq!(Blend::from(reading(5_001, 0), estimate).apply(estimate), estimate);
        assert_ne!(Blend::from(reading(5_000, 0), estimate).apply(estimate), estimate);
    }
}
