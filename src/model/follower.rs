//! Algorithm 4, the follower. The state of the follower, and the state of its predecessor at the end of the step, enter; the desired
//! acceleration leaves.
//!
//! Eq. 13 as printed lacks `δt` and has `v_n(t+k)` on both sides. It is read as a semi-implicit step, with `r_n(t+k)` predicted by eq. 9,
//!
//! ```text
//! v* = [ v - κ ( r + v δt - r_p + l + s_0 - γ v_p ) ] / [ 1 + κ (t_g + γ) ],   κ = α k δt,  α = 1
//! ```
//!
//! and the desired acceleration is `(v* - v)/δt`, which is
//!
//! ```text
//! u = -K [ (r - r_p) + (l + s_0) + (t_g + δt) v + γ (v - v_p) ],   K = k / [ 1 + κ (t_g + γ) ]
//! ```
//!
//! so that no division is left in the step. Eq. 5 has no free road: a follower that is far behind would accelerate without end. So the
//! terms other than `(t_g + δt) v` have a lower limit, with which the follower keeps to `v_c`, the speed with which it catches up,
//!
//! ```text
//! (r - r_p) + (l + s_0) + γ (v - v_p) >= -(t_g + δt) v_c,   which makes   u <= K (t_g + δt) (v_c - v).
//! ```
//!
//! Stable iff `k δt² < 4 + 2 k δt (t_g + γ)` ([`is_stable`]).

use super::state::State;
use crate::fixed::saturate_i32;
use crate::time::Duration;
use crate::units::{Acceleration, Distance, Gain, RingPosition, Seconds, Speed};

/// The law of one follower over steps of one length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Follower {
    /// `-K`.
    gain: Gain,
    /// Half of `t_g + δt`, because the whole of it may be beyond the format's 4 s.
    half_gap: Seconds,
    damping: Seconds,
    /// An offset. It makes a sum saturate at the end of the format just where the sum would be less than `-(t_g + δt) v_c`, so that the
    /// limit needs no comparison. It is added back afterwards.
    saturation_offset: Distance,
    /// `l + s_0`, less the offset.
    spacing: Distance,
}

impl Follower {
    /// With gains `k` and `γ`, time gap `t_g`, and spacing `l + s_0` (the length of the predecessor and the follower's own standstill
    /// distance), over steps of this length. The follower catches up with at most `catch_up`, if that is given.
    #[must_use]
    pub fn over(
        step: Duration,
        gain: Gain,
        damping: Seconds,
        time_gap: Seconds,
        spacing: Distance,
        catch_up: Option<Speed>,
    ) -> Self {
        let gap = i64::from(time_gap.to_bits()).saturating_add(i64::from(step.seconds().to_bits()));
        let half_gap = Seconds::from_bits(saturate_i32(gap >> 1));
        let half = catch_up.map_or(Distance::MAX, |speed| speed.over(half_gap));
        let saturation_offset = half.plus(half).negated().minus(Distance::MIN);
        Self {
            gain: semi_implicit(gain, damping, time_gap, step).negated(),
            half_gap,
            damping,
            saturation_offset,
            spacing: spacing.minus(saturation_offset),
        }
    }

    /// Eq. 13 as an acceleration, before the limits.
    #[inline(always)]
    #[must_use]
    pub fn desired(&self, state: &State, ahead: RingPosition, ahead_speed: Speed) -> Acceleration {
        let half = state.speed.over(self.half_gap);
        let closing = state.speed.minus(ahead_speed).over(self.damping);
        let behind = state.position.ahead_of(ahead).plus(closing).plus(self.spacing);
        let error = behind.plus(self.saturation_offset).plus(half.plus(half)); // `QDADD`
        error.times(self.gain)
    }
}

/// `K = k / (1 + k δt (t_g + γ))`.
#[allow(clippy::arithmetic_side_effects)]
// Words of 29 bits. k < 4 and δt <= 1 s, so that κ < 4; and t_g + γ < 8. So products stay below 2⁶³.
fn semi_implicit(gain: Gain, damping: Seconds, time_gap: Seconds, step: Duration) -> Gain {
    const ONE: i64 = 1 << 29;
    let k = i64::from(gain.to_bits().max(0));
    let kappa = (k * i64::from(step.seconds().to_bits().max(0))) >> 29;
    let sum = i64::from(damping.to_bits().max(0)) + i64::from(time_gap.to_bits().max(0));
    // κ < 4 and the sum < 8, both in 29 bits: their product stays below 2⁶³.
    let divisor = ONE + ((kappa * sum) >> 29);
    Gain::from_bits(saturate_i32(((k << 29) + divisor / 2).checked_div(divisor).unwrap_or(0)))
}

/// Whether the semi-implicit step is stable: `k δt² < 4 + 2 k δt (t_g + γ)`.
///
/// With `x = v δt`, the Jury conditions of the characteristic polynomial of the step's iteration matrix on the gap reduce to this one.
/// The other two hold for all positive gains.
#[must_use]
#[allow(clippy::arithmetic_side_effects)] // thousandths below 4,000, 1,000 and 8,000: products stay below 2⁶³
pub fn is_stable(gain: Gain, damping: Seconds, time_gap: Seconds, step: Duration) -> bool {
    let k = i64::from(gain.to_milli());
    let h = step.as_millis();
    let sum = i64::from(damping.to_millis()) + i64::from(time_gap.to_millis());
    k * h * h < 4_000_000_000 + 2 * k * h * sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Position;

    fn gain(k: f64, damping: f64, time_gap: f64, step: f64) -> f64 {
        semi_implicit(
            Gain::from_ratio((k * 1e6).round() as i64, 1_000_000),
            Seconds::from_millis((damping * 1e3).round() as i32),
            Seconds::from_millis((time_gap * 1e3).round() as i32),
            Duration::from_micros((step * 1e6).round() as i64),
        )
        .get()
        .to_num()
    }

    #[test]
    fn the_gain_is_divided_by_the_implicit_term() {
        for k in [0.01, 0.2, 0.5, 1.0, 3.999] {
            for damping in [0.0, 0.5, 2.0, 3.999] {
                for time_gap in [0.2, 1.0, 3.995] {
                    for step in [0.001, 0.01, 0.1, 1.0] {
                        let exact = k / (1.0 + k * step * (time_gap + damping));
                        // κ is cut off at 2⁻²⁹ and then multiplied by at most 8. Inputs and result are rounded.
                        let tolerance = exact * 8.0 * 2f64.powi(-29) * 1.5 + 3e-9;
                        assert!(
                            (gain(k, damping, time_gap, step) - exact).abs() < tolerance,
                            "{k} {damping} {time_gap} {step}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn at_the_desired_gap_and_the_same_speed_there_is_nothing_to_wish() {
        let step = Duration::from_millis(10);
        let (time_gap, spacing) = (Seconds::from_millis(1000), Distance::from_mm(6800));
        let law = Follower::over(step, Gain::from_milli(500), Seconds::from_millis(2000), time_gap, spacing, None);
        let speed = Speed::from_mm_per_s(11_000);
        let state = State { speed, ..State::default() };
        // At the end of the step the predecessor is a step further.
        let ahead = Position::ZERO.ring().ahead(spacing).ahead(speed.over(time_gap)).ahead(speed.over(step.seconds()));
        assert!(law.desired(&state, ahead, speed).to_bits().abs() < 1 << 10);
    }

    #[test]
    fn far_behind_it_catches_up_and_no_faster() {
        let (step, time_gap, spacing) =
            (Duration::from_millis(10), Seconds::from_millis(1000), Distance::from_mm(6_800));
        let (gain, damping) = (Gain::from_milli(500), Seconds::from_millis(2000));
        let catch_up = Speed::from_mm_per_s(13_000);
        let over = |catch_up| Follower::over(step, gain, damping, time_gap, spacing, catch_up);
        for (mm_per_s, is_faster) in [(12_900, true), (13_000, false), (13_100, false)] {
            let state = State { speed: Speed::from_mm_per_s(mm_per_s), ..State::default() };
            let ahead = Position::from_mm(400_000).ring();
            let desired = over(Some(catch_up)).desired(&state, ahead, Speed::from_mm_per_s(11_000));
            // K = 0.5/1.015 and t_g + δt = 1.01.
            let exact = 0.5 / 1.015 * 1.01 * f64::from(13_000 - mm_per_s);
            assert!((f64::from(desired.to_mm_per_s2()) - exact).abs() < 1.0, "{mm_per_s} {desired:?}");
            assert_eq!(desired > Acceleration::ZERO, is_faster);
            assert!(over(None).desired(&state, ahead, state.speed) > Acceleration::from_mm_per_s2(60_000));
        }
    }

    #[test]
    fn the_limit_by_saturation_is_the_larger_of_the_two() {
        let (step, time_gap) = (Duration::from_millis(10), Seconds::from_millis(1_000));
        for catch_up in [0, 13_000, 80_000] {
            let catch_up = Speed::from_mm_per_s(catch_up);
            let law = Follower::over(
                step,
                Gain::from_milli(500),
                Seconds::ZERO,
                time_gap,
                Distance::from_mm(6_800),
                Some(catch_up),
            );
            let half = catch_up.over(law.half_gap);
            for mm in (-1_000_000..1_000_000).step_by(997).chain([-13_130, -13_131, -6_800, 0]) {
                let behind =
                    Position::from_mm(mm).ring().ahead_of(Position::ZERO.ring()).plus(Distance::from_mm(6_800));
                let larger = behind.max(half.plus(half).negated());
                let limited = Position::from_mm(mm)
                    .ring()
                    .ahead_of(Position::ZERO.ring())
                    .plus(law.spacing)
                    .plus(law.saturation_offset);
                assert!((larger.to_bits() - limited.to_bits()).abs() <= 1, "{mm} {larger:?} {limited:?}");
            }
        }
    }

    #[test]
    fn a_step_is_stable_up_to_the_stated_gain_and_not_beyond() {
        let (damping, time_gap, step) =
            (Seconds::from_millis(100), Seconds::from_millis(200), Duration::from_millis(1000));
        // k (1 - 2 · 0.3) < 4 => k < 10: never reached; with no damping and 0.2 s: k (1 - 0.4) < 4 => k < 6.67.
        assert!(is_stable(Gain::from_milli(3999), damping, time_gap, step));
        assert!(is_stable(Gain::from_milli(3999), Seconds::ZERO, time_gap, step));
    }
}
