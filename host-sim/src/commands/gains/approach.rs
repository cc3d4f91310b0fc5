//! The approach of a law in one situation: own speed, target's speed and headway at the moment of association enter;
//! how near, how hard and how long the approach is leaves. The target keeps its speed. The vehicle is a car with its
//! lag and its limits, in steps of 20 ms.
//!
//! The limits on the demand, 2.5 and -4 m/s² and 5 m/s³, hold by construction: the demand is limited to them, and the
//! lag never exceeds its input. So they are not results.

use super::linear::Law;

const STEP_S: f64 = 0.02;
/// Number of steps that are simulated.
const STEPS: u32 = 3_000;
const LAG_S: f64 = 0.3;
const ACCELERATION_MPS2: f64 = 2.5;
const BRAKING_MPS2: f64 = 4.0;
const JERK_MPS3: f64 = 5.0;
const LENGTH_M: f64 = 4.8;
const STANDSTILL_M: f64 = 2.0;
/// An approach has settled within these differences to the final gap (m) and the target's speed (m/s).
const SETTLED: (f64, f64) = (0.25, 0.1);

/// A situation at the moment of association.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Situation {
    /// Own speed.
    pub own_mps: f64,
    /// Target's speed.
    pub target_mps: f64,
    /// Front bumper to front bumper.
    pub headway_m: f64,
}

/// The figures of an approach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// Smallest bumper gap.
    pub least_gap_m: f64,
    /// How far the gap falls below both the gap at the start and the final gap.
    pub overshoot_m: f64,
    /// Hardest braking reached, as a magnitude.
    pub braking_mps2: f64,
    /// Largest acceleration reached.
    pub acceleration_mps2: f64,
    /// Fastest change of the acceleration reached.
    pub jerk_mps3: f64,
    /// Time from which it stays settled; the whole time if it does not settle.
    pub settled_s: f64,
}

impl Situation {
    fn gap_m(&self) -> f64 {
        self.headway_m - LENGTH_M
    }

    /// The final bumper gap.
    fn wanted_gap_m(&self, time_gap_s: f64) -> f64 {
        STANDSTILL_M + self.target_mps * time_gap_s
    }

    /// The approach by a law.
    #[must_use]
    pub fn by_law(&self, law: Law) -> Approach {
        let Law { pair, time_gap_s, .. } = law; // a target of constant speed gives nothing to feed forward
        self.approach(self.wanted_gap_m(time_gap_s), |gap_m, own_mps| {
            let error = -gap_m + STANDSTILL_M + own_mps * time_gap_s + pair.damping_s * (own_mps - self.target_mps);
            -pair.gain * error
        })
    }

    /// The approach by braking this hard from the start until the speeds are equal; judged by the final gap of this
    /// time gap.
    #[must_use]
    pub fn by_braking(&self, braking_mps2: f64, time_gap_s: f64) -> Approach {
        let desired = |_, own_mps| if own_mps > self.target_mps { -braking_mps2 } else { 0.0 };
        self.approach(self.wanted_gap_m(time_gap_s), desired)
    }

    fn approach(&self, wanted_gap_m: f64, desired: impl Fn(f64, f64) -> f64) -> Approach {
        let keep = (-STEP_S / LAG_S).exp();
        let (mut gap, mut own, mut a, mut demand) = (self.gap_m(), self.own_mps, 0.0f64, 0.0f64);
        let floor = self.gap_m().min(wanted_gap_m);
        let mut seen = Approach {
            least_gap_m: gap,
            overshoot_m: 0.0,
            braking_mps2: 0.0,
            acceleration_mps2: 0.0,
            jerk_mps3: 0.0,
            settled_s: 0.0,
        };
        for step in 1..=STEPS {
            let slew = JERK_MPS3 * STEP_S;
            demand = desired(gap, own).clamp(demand - slew, demand + slew).clamp(-BRAKING_MPS2, ACCELERATION_MPS2);
            let before = (a, own);
            a = demand + (a - demand) * keep;
            own = (own + 0.5 * (before.0 + a) * STEP_S).max(0.0);
            gap += (self.target_mps - 0.5 * (before.1 + own)) * STEP_S;
            seen.least_gap_m = seen.least_gap_m.min(gap);
            seen.braking_mps2 = seen.braking_mps2.max(-a);
            seen.acceleration_mps2 = seen.acceleration_mps2.max(a);
            seen.jerk_mps3 = seen.jerk_mps3.max((a - before.0).abs() / STEP_S);
            if (gap - wanted_gap_m).abs() > SETTLED.0 || (own - self.target_mps).abs() > SETTLED.1 {
                seen.settled_s = f64::from(step) * STEP_S;
            }
        }
        seen.overshoot_m = (floor - seen.least_gap_m).max(0.0);
        seen
    }
}

#[cfg(test)]
mod tests {
    use super::super::linear::Pair;
    use super::*;

    const USUAL: Law = Law { pair: Pair { gain: 0.5, damping_s: 2.0 }, time_gap_s: 1.0, feed_forward: 0.0 };

    #[test]
    fn at_the_gap_and_the_speed_that_are_wanted_nothing_happens() {
        let rest = Situation { own_mps: 10.0, target_mps: 10.0, headway_m: 16.8 }.by_law(USUAL);
        assert!(rest.settled_s == 0.0 && rest.braking_mps2 < 1e-9 && rest.overshoot_m < 1e-9, "{rest:?}");
        let law = Law { time_gap_s: 1.6, ..USUAL };
        let rest = Situation { own_mps: 10.0, target_mps: 10.0, headway_m: 22.8 }.by_law(law);
        assert!(rest.settled_s == 0.0 && rest.braking_mps2 < 1e-9 && rest.overshoot_m < 1e-9, "{rest:?}");
    }

    #[test]
    fn limits_hold_and_a_far_target_is_reached() {
        let far = Situation { own_mps: 20.0, target_mps: 20.0, headway_m: 88.0 }.by_law(USUAL);
        assert!(far.acceleration_mps2 <= 2.5 && far.braking_mps2 <= 4.0 && far.jerk_mps3 <= 5.01, "{far:?}");
        assert!(far.settled_s > 5.0 && far.settled_s < 40.0 && far.least_gap_m > 21.5, "{far:?}");
    }

    #[test]
    fn braking_from_20_to_0_at_4_takes_some_50_metres_more_than_the_ramp() {
        let braking = Situation { own_mps: 20.0, target_mps: 0.0, headway_m: 104.8 }.by_braking(4.0, 1.0);
        // 20²/8 m, plus half of the jerk's ramp of 0.8 s and all of the lag of 0.3 s at 20 m/s.
        assert!((100.0 - braking.least_gap_m - 64.0).abs() < 1.0, "{braking:?}");
    }
}
