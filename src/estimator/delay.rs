//! Eqs 10-12, in paper mode only. The predecessor's step at `t+k-τ` and the delay `τ` enter; its state at `t+k`, as the paper adjusts it,
//! leaves. Over 2 s eq. 12 alone costs metres. So the default brings a sample to now with the model instead.
//!
//! - *Speed:* with `τ < δt` it is taken unchanged (eq. 10). With `τ >= δt` it is `v + τ v̇` (eq. 11), with `v̇` the slope from that
//!   step to the next. The printed `τ/δt` fits a `v̇` per step.
//! - *Position:* `r(t+k-τ) + v(t+k) τ`. Eq. 12 as printed is only dimensionally right at `τ = δt`.

use crate::model::Step;
use crate::time::Duration;
use crate::units::Speed;

/// The predecessor's state at `t+k`, from its step at `t+k-τ` and the step after that. Delays beyond 4 s saturate.
#[must_use]
pub fn adjusted(earlier: Step, next: Step, delay: Duration, step: Duration) -> Step {
    let tau = delay.max(Duration::ZERO);
    let speed = if tau < step {
        earlier.speed
    } else {
        let change = i64::from(next.speed.minus(earlier.speed).to_bits());
        let gained = change.saturating_mul(tau.as_micros()).checked_div(step.as_micros()).unwrap_or(0);
        earlier.speed.plus(Speed::from_bits(crate::fixed::saturate_i32(gained)))
    };
    Step { position: earlier.position.ahead(speed.over(tau.seconds())), speed }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Position;

    const STEP: Duration = Duration::from_millis(10);

    fn after(delay: i64) -> (f64, i32) {
        let at = |mm_per_s| Step { position: Position::ZERO.ring(), speed: Speed::from_mm_per_s(mm_per_s) };
        let Step { position, speed } = adjusted(at(10_000), at(10_010), Duration::from_millis(delay), STEP);
        (position.ahead_of(Position::ZERO.ring()).get().to_num(), speed.to_mm_per_s())
    }

    #[test]
    fn below_one_step_the_speed_is_unchanged_and_from_one_step_on_it_is_extrapolated() {
        assert_eq!(after(9).1, 10_000);
        assert_eq!(after(10).1, 10_010);
        assert_eq!(after(40).1, 10_040);
        assert_eq!(after(45).1, 10_045, "v̇ is per second, not per step");
    }

    #[test]
    fn the_position_moves_on_by_the_delay_at_the_adjusted_speed() {
        assert!((after(40).0 - 0.4016).abs() < 1e-5);
    }
}
