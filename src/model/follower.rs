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
//! so that no division is left in the step.
//!
//! *Feed-forward:* a follower that gets the share `φ` of its predecessor's acceleration as well need not wait until the gap has changed,
//!
//! ```text
//! u = -K [ ... ] + φ [ v_p(t+k) - v_p(t+k-1) ] / δt
//! ```
//!
//! The predecessor's speeds are those of its horizon. So the term looks as far ahead as the step does, and it fades out with the
//! acceleration of a predecessor of which nothing else is known. `φ` is 0 in the paper's law.
//!
//! Eq. 5 has no free road: a follower that is far behind would accelerate without end. So the
//! terms other than `(t_g + δt) v` have a lower limit, with which the follower keeps to `v_c`, the speed with which it catches up,
//!
//! ```text
//! (r - r_p) + (l + s_0) + γ (v - v_p) >= -(t_g + δt) v_c,   which makes   u <= K (t_g + δt) (v_c - v).
//! ```
//!
//! Stable iff `k δt² < 4 + 2 k δt (t_g + γ)` ([`is_stable`]).

use super::state::{State, TargetStep};
use crate::fixed::{mul_sum_shl, quotient, saturate_i32};
use crate::time::Duration;
use crate::units::{Acceleration, Distance, Fraction, Gain, Seconds, Speed};

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
    /// `φ/δt` with 25 fraction bits: at most 64 /s.
    feed: i32,
}

/// The constants of the law of eq. 5.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Consensus {
    /// `k`.
    pub gain: Gain,
    /// `γ`.
    pub damping: Seconds,
    /// `t_g`.
    pub time_gap: Seconds,
    /// `φ`.
    pub feed_forward: Fraction,
}

impl Follower {
    /// With these constants and the spacing `l + s_0` (the length of the predecessor and the follower's own standstill distance), over
    /// steps of this length. The follower catches up with at most `catch_up`, if that is given. A step shorter than
    /// [`FEED_FORWARD_STEP`] passes on less of the predecessor's acceleration than `φ` asks for.
    #[must_use]
    pub fn over(step: Duration, law: &Consensus, spacing: Distance, catch_up: Option<Speed>) -> Self {
        let Consensus { gain, damping, time_gap, feed_forward } = *law;
        let (half_gap, saturation_offset) = half_gap(step, time_gap, catch_up);
        Self {
            gain: semi_implicit(gain, damping, time_gap, step).negated(),
            half_gap,
            damping,
            saturation_offset,
            spacing: spacing.minus(saturation_offset),
            feed: feed(feed_forward, step),
        }
    }

    /// Keeps another time gap from now on, over the same steps and with the same speed for catching up. `K` stays, as in the controller,
    /// which takes an opened time gap as a predecessor that is nearer by so much.
    pub fn keep_time_gap(&mut self, step: Duration, time_gap: Seconds, catch_up: Option<Speed>) {
        let spacing = self.spacing.plus(self.saturation_offset);
        (self.half_gap, self.saturation_offset) = half_gap(step, time_gap, catch_up);
        self.spacing = spacing.minus(self.saturation_offset);
    }

    /// Eq. 13 as an acceleration, before the limits.
    #[inline(always)]
    #[must_use]
    pub fn desired(&self, state: &State, ahead: &TargetStep) -> Acceleration {
        let half = state.speed.over(self.half_gap);
        let closing = state.speed.minus(ahead.speed).over(self.damping);
        let behind = state.position.ahead_of(ahead.position).plus(closing).plus(self.spacing);
        let error = behind.plus(self.saturation_offset).plus(half.plus(half)); // `QDADD`
        // 20 and 29 bits, and 24 and 25: both products have 49, and the result has 25.
        let gained = ahead.gained.plus(ahead.gained);
        let by_gap = (error.to_bits(), self.gain.to_bits());
        Acceleration::from_bits(mul_sum_shl::<8>(by_gap, (gained.to_bits(), self.feed)))
    }
}

/// Half of `t_g + δt`, and the offset that limits the sum at `-(t_g + δt) v_c`.
#[inline(always)]
fn half_gap(step: Duration, time_gap: Seconds, catch_up: Option<Speed>) -> (Seconds, Distance) {
    let gap = i64::from(time_gap.to_bits()).saturating_add(i64::from(step.seconds().to_bits()));
    let half_gap = Seconds::from_bits(saturate_i32(gap >> 1));
    let half = catch_up.map_or(Distance::MAX, |speed| speed.over(half_gap));
    (half_gap, half.plus(half).negated().minus(Distance::MIN))
}

/// The shortest step that passes on half of the predecessor's acceleration: `0.5/64` s, rounded up to a microsecond.
pub const FEED_FORWARD_STEP: Duration = Duration::from_micros(7_813);

/// `φ/δt` with 25 fraction bits, from `φ` with 30.
fn feed(share: Fraction, step: Duration) -> i32 {
    let per_second = quotient(i64::from(share.to_bits()).saturating_mul(1_000_000), step.as_micros());
    saturate_i32(per_second >> 5)
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

    /// `k` = 0.5 /s² and `t_g` = 1 s, with this damping in ms and this share of feed-forward in thousandths.
    fn law(damping: i32, feed_forward: i32) -> Consensus {
        Consensus {
            gain: Gain::from_milli(500),
            damping: Seconds::from_millis(damping),
            time_gap: Seconds::from_millis(1_000),
            feed_forward: Fraction::from_milli(feed_forward),
        }
    }

    #[test]
    fn half_of_the_acceleration_ahead_is_added_to_the_wish() {
        for micros in [7_813, 10_000, 20_000, 30_000, 100_000, 1_000_000] {
            let step = Duration::from_micros(micros);
            let over = |share| Follower::over(step, &law(2_000, share), Distance::from_mm(6_800), None);
            for mm_per_s2 in [-8_000, -2_500, -20, 0, 20, 3_000] {
                let gained = Acceleration::from_mm_per_s2(mm_per_s2).over(step.fine_seconds());
                let speed = Speed::from_mm_per_s(11_000);
                let state = State { speed, ..State::default() };
                let ahead = TargetStep { position: Position::from_mm(20_000).ring(), speed, gained };
                let added = over(500).desired(&state, &ahead).minus(over(0).desired(&state, &ahead));
                let exact = f64::from(mm_per_s2) / 2_000.0;
                // The gained speed has a resolution of 2⁻²³ m/s, and each of the two sums one of 2⁻¹⁷ m/s².
                let tolerance = 2f64.powi(-24) / (micros as f64 * 1e-6) + 2f64.powi(-17);
                assert!((added.get().to_num::<f64>() - exact).abs() <= tolerance, "{micros} {mm_per_s2} {added:?}");
            }
        }
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
        let law = Follower::over(step, &law(2_000, 0), spacing, None);
        let speed = Speed::from_mm_per_s(11_000);
        let state = State { speed, ..State::default() };
        // At the end of the step the predecessor is a step further.
        let ahead = Position::ZERO.ring().ahead(spacing).ahead(speed.over(time_gap)).ahead(speed.over(step.seconds()));
        let ahead = TargetStep { position: ahead, speed, gained: Speed::ZERO };
        assert!(law.desired(&state, &ahead).to_bits().abs() < 1 << 10);
    }

    #[test]
    fn far_behind_it_catches_up_and_no_faster() {
        let (step, spacing) = (Duration::from_millis(10), Distance::from_mm(6_800));
        let catch_up = Speed::from_mm_per_s(13_000);
        let over = |catch_up| Follower::over(step, &law(2_000, 0), spacing, catch_up);
        for (mm_per_s, is_faster) in [(12_900, true), (13_000, false), (13_100, false)] {
            let state = State { speed: Speed::from_mm_per_s(mm_per_s), ..State::default() };
            let ahead = |mm_per_s| TargetStep {
                position: Position::from_mm(400_000).ring(),
                speed: Speed::from_mm_per_s(mm_per_s),
                gained: Speed::ZERO,
            };
            let desired = over(Some(catch_up)).desired(&state, &ahead(11_000));
            // K = 0.5/1.015 and t_g + δt = 1.01.
            let exact = 0.5 / 1.015 * 1.01 * f64::from(13_000 - mm_per_s);
            assert!((f64::from(desired.to_mm_per_s2()) - exact).abs() < 1.0, "{mm_per_s} {desired:?}");
            assert_eq!(desired > Acceleration::ZERO, is_faster);
            assert!(over(None).desired(&state, &ahead(mm_per_s)) > Acceleration::from_mm_per_s2(60_000));
        }
    }

    #[test]
    fn the_limit_by_saturation_is_the_larger_of_the_two() {
        let step = Duration::from_millis(10);
        for catch_up in [0, 13_000, 80_000] {
            let catch_up = Speed::from_mm_per_s(catch_up);
            let law = Follower::over(step, &law(0, 0), Distance::from_mm(6_800), Some(catch_up));
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
