//! Algorithm 2, the leader. Its speed enters; the desired acceleration on a free road leaves (the Intelligent Driver Model's free-road
//! term, eq. 8).
//!
//! `a = a_max [1 - (v/v_∞)^σ]` with `σ` = 4. Above `v_∞` the limits of the vehicle keep it from braking harder than is comfortable. A
//! target speed below 0.1 m/s asks for a stop, as hard as the vehicle's own limit on braking allows.

use crate::fixed::{mul_hi, mul_shl_down, ratio, saturate_i32};
use crate::parameters::{FREE_ROAD_RATIO_MILLI, STOP_SPEED};
use crate::units::{Acceleration, Speed};

/// The free-road law of one vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Leader {
    largest: Acceleration,
    /// 1/v_∞ in 26 fraction bits (at most 10 s/m); 0 means stop.
    inverse: i32,
}

/// A stop: harder than the hardest limit that a message can name, which is 20.46 m/s².
const STOP: Acceleration = Acceleration::from_mm_per_s2(-20_460);
/// The largest `v/v_∞` in 28 fraction bits.
const RATIO_MAX: i32 = saturate_i32(ratio(FREE_ROAD_RATIO_MILLI, 1000, 28));

impl Leader {
    /// With this `a_max` and `v_∞`.
    #[must_use]
    pub fn new(largest: Acceleration, target_speed: Speed) -> Self {
        let inverse = if target_speed < STOP_SPEED {
            0
        } else {
            // 1/(bits/2²³) in 26 bits is 2⁴⁹/bits.
            saturate_i32(ratio(1 << 23, i64::from(target_speed.to_bits()), 26))
        };
        Self { largest, inverse }
    }

    /// Eq. 8 before the limits.
    #[inline(always)]
    #[must_use]
    pub fn desired(&self, speed: Speed) -> Acceleration {
        if self.inverse == 0 {
            return STOP;
        }
        // 23 and 26 bits to 28: saturates at 8, and the cut is at 2.8.
        let ratio = mul_shl_down::<11>(speed.to_bits(), self.inverse).min(RATIO_MAX);
        let square = mul_shl_down::<4>(ratio, ratio); // 28 bits: at most 7.84
        let fourth = mul_hi(square, square); // 24 bits: at most 61.5
        let resistance = Acceleration::from_bits(mul_shl_down::<8>(self.largest.to_bits(), fourth)); // 25 and 24 bits to 25
        self.largest.minus(resistance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::BRAKING_MAX;

    #[test]
    fn the_wish_is_the_free_road_term_as_exactly_as_the_target_speed_s_reciprocal_allows() {
        for target in [100, 500, 3_000, 11_000, 13_400, 40_000, 65_534] {
            let largest = Acceleration::from_mm_per_s2(730);
            let leader = Leader::new(largest, Speed::from_mm_per_s(target));
            let largest = largest.get().to_num::<f64>();
            let wanted = Speed::from_mm_per_s(target).get().to_num::<f64>();
            for speed in (0..=i64::from(target) * 27 / 10).step_by(usize::try_from(target / 50).unwrap()) {
                let speed = Speed::from_ratio(speed, 1000);
                let share = speed.get().to_num::<f64>() / wanted;
                let exact = largest * (1.0 - share.powi(4));
                let got = leader.desired(speed).get().to_num::<f64>();
                // Relative to the fourth power, the reciprocal's resolution (26 bits) counts four times: 1.5 µm/s² at
                // 65 m/s. The rest is the resolution of the fourth power and of the acceleration.
                let tolerance = 2e-7 + 0.73 * 4.0 * share.powi(4) * wanted * 2f64.powi(-27);
                assert!((got - exact).abs() < tolerance, "{target} {speed:?} {got} {exact}");
            }
        }
    }

    #[test]
    fn far_above_the_target_the_wish_is_harder_than_any_comfortable_limit() {
        let leader = Leader::new(Acceleration::from_mm_per_s2(100), Speed::from_mm_per_s(1000));
        for speed in [2_800, 10_000, 60_000, 255_000] {
            assert!(leader.desired(Speed::from_mm_per_s(speed)) <= BRAKING_MAX.negated(), "{speed}");
        }
    }

    #[test]
    fn no_target_speed_is_a_wish_to_stop() {
        let leader = Leader::new(Acceleration::from_mm_per_s2(730), Speed::from_mm_per_s(99));
        assert_eq!(leader.desired(Speed::from_mm_per_s(50)), STOP);
    }
}
