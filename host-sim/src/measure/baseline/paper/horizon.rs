//! Algorithms 2 to 4 of the paper as printed: a sample enters, and for a follower the horizon of its predecessor; a
//! horizon of speeds and positions leaves.
//!
//! Readings. Eq. 13 gets the `δt` that it lacks (`κ = α k δt`). It has `ṽ_n(t+k)` on both sides, so it is solved for
//! that, with `r̃_n(t+k)` from eq. 9. In eq. 11 `v̇` is per second: the difference to the next step of the
//! predecessor's horizon over `δt`, and 0 at its end. Eq. 12 starts from `r̃_{n-1}(t+k-τ)`. There is no lag, no limit
//! on acceleration or jerk, and no standstill distance.
//!
//! Two limits are added so that results stay finite. A speed is not below 0: eq. 8 far above `v_∞` with `δt` = 1 s
//! would otherwise reverse and diverge. `v_∞` is not below 0.1 m/s.

use super::super::Estimate;
use crate::measure::heard::{Heard, HeardParameters};

/// `a_max` of Algorithm 2, m/s².
pub const LEADER_ACCELERATION_MPS2: f64 = 0.73;
/// `σ` of Algorithm 2.
pub const FREE_EXPONENT: i32 = 4;
/// The least `v_∞` that Algorithm 2 divides by, m/s.
pub const LEAST_TARGET_SPEED_MPS: f64 = 0.1;

/// A vehicle's future motion by steps of `δt` from its anchor; step 0 is the sample itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Horizon {
    anchor_s: f64,
    step_s: f64,
    motion: Vec<Estimate>,
}

/// The predecessor, as a follower knows it.
#[derive(Clone, Copy, Debug)]
pub struct Preceding<'a> {
    /// Its horizon.
    pub horizon: &'a Horizon,
    /// `τ`, the delay of its last message.
    pub delay_s: f64,
    /// `l`, its length.
    pub length_m: f64,
}

impl Horizon {
    /// Algorithms 2 and 3: `ṽ(t+k) = ṽ(t+k-1) + a_max [1 - (ṽ(t+k-1)/v_∞)^σ] δt` (eq. 8), positions by eq. 9.
    #[must_use]
    pub fn of_leader(sample: &Heard, target_speed_mps: f64, step_s: f64, steps: usize) -> Self {
        let target_speed_mps = target_speed_mps.max(LEAST_TARGET_SPEED_MPS);
        Self::by(sample, step_s, steps, |_, speed_mps, _| {
            let share = (speed_mps / target_speed_mps).powi(FREE_EXPONENT);
            speed_mps + LEADER_ACCELERATION_MPS2 * (1.0 - share) * step_s
        })
    }

    /// Algorithms 4 and 3: eqs 10 to 12 for the predecessor, eq. 13 for the speed, positions by eq. 9.
    #[must_use]
    pub fn of_follower(
        sample: &Heard,
        ahead: &Preceding<'_>,
        law: &HeardParameters,
        step_s: f64,
        steps: usize,
    ) -> Self {
        let kappa = law.gain * step_s;
        Self::by(sample, step_s, steps, |at_s, speed_mps, position_m| {
            let predecessor = ahead.at(at_s);
            let distance_m = position_m - predecessor.position_m + ahead.length_m;
            (speed_mps - kappa * (distance_m - law.damping_s * predecessor.speed_mps))
                / (1.0 + kappa * (law.time_gap_s + law.damping_s))
        })
    }

    /// Steps through a horizon: `next_speed` gets the instant `t+k`, the speed at `t+k-1` and the position at `t+k`.
    fn by(sample: &Heard, step_s: f64, steps: usize, next_speed: impl Fn(f64, f64, f64) -> f64) -> Self {
        let mut motion = Vec::with_capacity(steps + 1);
        let mut now = Estimate { position_m: sample.position_m, speed_mps: sample.speed_mps };
        motion.push(now);
        for step in 1..=steps {
            let at_s = sample.stamp_s + step as f64 * step_s;
            let position_m = now.position_m + now.speed_mps * step_s;
            now = Estimate { position_m, speed_mps: next_speed(at_s, now.speed_mps, position_m).max(0.0) };
            motion.push(now);
        }
        Self { anchor_s: sample.stamp_s, step_s, motion }
    }

    /// The motion at an instant: that of the nearest step. Before the first and after the last step, that step holds.
    #[must_use]
    pub fn at(&self, at_s: f64) -> Estimate {
        self.motion[self.nearest(at_s)]
    }

    /// `v̇` at an instant, per second: from the nearest step to the next one, 0 at the last.
    fn acceleration_at(&self, at_s: f64) -> f64 {
        let nearest = self.nearest(at_s);
        let next = (nearest + 1).min(self.motion.len() - 1);
        (self.motion[next].speed_mps - self.motion[nearest].speed_mps) / self.step_s
    }

    fn nearest(&self, at_s: f64) -> usize {
        (((at_s - self.anchor_s) / self.step_s + 0.5).floor() as usize).min(self.motion.len() - 1)
    }
}

impl Preceding<'_> {
    /// Eqs 10 to 12: the predecessor at `t+k` from its horizon at `t+k-τ`.
    fn at(&self, at_s: f64) -> Estimate {
        let delayed_s = at_s - self.delay_s;
        let delayed = self.horizon.at(delayed_s);
        let speed_mps = if self.delay_s < self.horizon.step_s {
            delayed.speed_mps
        } else {
            delayed.speed_mps + self.delay_s * self.horizon.acceleration_at(delayed_s)
        };
        Estimate { position_m: delayed.position_m + speed_mps * self.delay_s, speed_mps }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(position_m: f64, speed_mps: f64) -> Heard {
        let (acceleration_mps2, demand_mps2) = (0.0, 0.0);
        Heard {
            at_s: 1.0,
            stamp_s: 1.0,
            vehicle: 0,
            position_m,
            speed_mps,
            acceleration_mps2,
            demand_mps2,
            parameters: None,
        }
    }

    fn law() -> HeardParameters {
        HeardParameters {
            length_m: 4.8,
            standstill_m: 2.0,
            leads: false,
            predecessor: Some(0),
            target_speed_mps: 11.0,
            catch_up: 0.2,
            time_gap_s: 1.0,
            gain: 0.25,
            damping_s: 2.0,
            feed_forward: 0.0,
            lag_s: 0.3,
            acceleration_mps2: 2.0,
            braking_mps2: 4.0,
            jerk_mps3: 3.0,
        }
    }

    #[test]
    fn a_leader_converges_to_its_target_speed_from_either_side() {
        for start_mps in [0.0, 9.0, 14.0] {
            let end = Horizon::of_leader(&sample(0.0, start_mps), 11.0, 0.1, 1000).at(101.0);
            assert!((end.speed_mps - 11.0).abs() < 1e-6, "{start_mps} {end:?}");
        }
    }

    #[test]
    fn a_leader_at_its_target_speed_keeps_it_and_the_index_advances_from_the_anchor() {
        let horizon = Horizon::of_leader(&sample(100.0, 11.0), 11.0, 0.1, 50);
        for (at_s, steps) in [(0.2, 0.0), (1.0, 0.0), (1.04, 0.0), (1.06, 1.0), (3.0, 20.0), (6.0, 50.0), (60.0, 50.0)]
        {
            assert!((horizon.at(at_s).position_m - (100.0 + 1.1 * steps)).abs() < 1e-9, "{at_s}");
        }
    }

    #[test]
    fn equation_13_holds_with_its_own_solution_on_the_right() {
        let (step_s, law) = (0.1, law());
        let ahead = Horizon::of_leader(&sample(20.0, 10.0), 11.0, step_s, 50);
        let preceding = Preceding { horizon: &ahead, delay_s: 0.04, length_m: 4.8 };
        let own = Horizon::of_follower(&sample(0.0, 9.0), &preceding, &law, step_s, 50);
        for pair in 0..50 {
            let (before, after) = (own.motion[pair], own.motion[pair + 1]);
            let predecessor = preceding.at(1.0 + (pair + 1) as f64 * step_s);
            let spacing = after.position_m - predecessor.position_m + 4.8 + after.speed_mps * law.time_gap_s;
            let closing = law.damping_s * (after.speed_mps - predecessor.speed_mps);
            let residual = after.speed_mps - before.speed_mps + law.gain * step_s * (spacing + closing);
            assert!(residual.abs() < 1e-12, "{residual}");
            assert!((after.position_m - before.position_m - before.speed_mps * step_s).abs() < 1e-12);
        }
    }

    #[test]
    fn a_delay_below_one_step_leaves_the_speed_and_a_longer_one_adds_its_slope() {
        let ahead = Horizon::of_leader(&sample(0.0, 0.0), 11.0, 0.1, 50);
        let at = |delay_s| Preceding { horizon: &ahead, delay_s, length_m: 0.0 }.at(2.0);
        assert_eq!(at(0.0), ahead.at(2.0));
        assert_eq!(at(0.04).speed_mps, ahead.at(1.96).speed_mps);
        assert_eq!(at(0.04).position_m, ahead.at(1.96).position_m + ahead.at(1.96).speed_mps * 0.04);
        let (v8, v9) = (ahead.motion[8].speed_mps, ahead.motion[9].speed_mps);
        let late = at(0.2);
        assert!((late.speed_mps - (v8 + 0.2 * (v9 - v8) / 0.1)).abs() < 1e-12);
        assert!((late.position_m - (ahead.motion[8].position_m + 0.2 * late.speed_mps)).abs() < 1e-12);
    }

    #[test]
    fn far_above_a_low_target_speed_at_a_coarse_step_it_stops_instead_of_running_away() {
        for target_mps in [0.0, 5.0, 13.4] {
            let horizon = Horizon::of_leader(&sample(0.0, 45.0), target_mps, 1.0, 5);
            assert!(horizon.motion.iter().all(|at| (0.0..=45.0).contains(&at.speed_mps)), "{horizon:?}");
        }
    }
}
