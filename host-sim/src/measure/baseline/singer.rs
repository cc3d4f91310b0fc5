//! Singer's manoeuvre model: the newest sample's acceleration fades as `a·e^(-t/T)` with `T` = 1.5 s, integrated
//! exactly, until the speed is 0. Then the vehicle stays.

use super::{Baseline, Estimate, Newest};
use crate::measure::heard::Heard;

/// The time constant with which the acceleration fades.
pub const FADING_S: f64 = 1.5;

/// Lets the last acceleration fade.
#[derive(Clone, Debug)]
pub struct Singer {
    newest: Newest,
}

impl Singer {
    /// The method for the vehicle `target`.
    #[must_use]
    pub fn new(target: usize) -> Self {
        Self { newest: Newest::of(target) }
    }
}

/// The motion after `time_s`: with `s(t) = 1 - e^(-t/T)`, speed `v + a T s(t)` and position `r + v t + a T (t - T s(t))`.
/// The vehicle stops where `s(t) = -v/(a T)`, if ever, which is at `t = -T ln(1 + v/(a T))`.
fn after(position_m: f64, speed_mps: f64, acceleration_mps2: f64, time_s: f64) -> Estimate {
    let speed_mps = speed_mps.max(0.0);
    let gain_mps = acceleration_mps2 * FADING_S;
    let stops = speed_mps + gain_mps < 0.0;
    let stop_s = if stops { -FADING_S * (speed_mps / gain_mps).ln_1p() } else { f64::INFINITY };
    let moving_s = time_s.min(stop_s);
    let faded = -(-moving_s / FADING_S).exp_m1();
    Estimate {
        position_m: position_m + speed_mps * moving_s + gain_mps * (moving_s - FADING_S * faded),
        speed_mps: if time_s < stop_s { (speed_mps + gain_mps * faded).max(0.0) } else { 0.0 },
    }
}

impl Baseline for Singer {
    fn name(&self) -> &'static str {
        "singer"
    }

    fn hear(&mut self, heard: &Heard) {
        self.newest.keep(heard);
    }

    fn estimate(&mut self, now_s: f64) -> Option<Estimate> {
        self.newest
            .at(now_s)
            .map(|(sample, age_s)| after(sample.position_m, sample.speed_mps, sample.acceleration_mps2, age_s))
    }

    fn duplicate(&self) -> Box<dyn Baseline> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same by a million small steps of the midpoint rule.
    fn integrated(speed_mps: f64, acceleration_mps2: f64, time_s: f64) -> Estimate {
        let steps = 1_000_000;
        let step_s = time_s / f64::from(steps);
        let (mut position_m, mut speed) = (0.0, speed_mps);
        for step in 0..steps {
            let middle_s = (f64::from(step) + 0.5) * step_s;
            let next = (speed + acceleration_mps2 * (-middle_s / FADING_S).exp() * step_s).max(0.0);
            position_m += 0.5 * (speed + next) * step_s;
            speed = next;
            if speed == 0.0 {
                break;
            }
        }
        Estimate { position_m, speed_mps: speed }
    }

    #[test]
    fn the_closed_form_is_what_small_steps_add_up_to() {
        for (speed, acceleration, time) in
            [(10.0, 1.5, 4.0), (10.0, -2.0, 4.0), (3.0, -2.5, 1.0), (3.0, -2.5, 6.0), (0.0, 1.0, 2.0)]
        {
            let (exact, small) = (after(0.0, speed, acceleration, time), integrated(speed, acceleration, time));
            assert!((exact.position_m - small.position_m).abs() < 1e-5, "{exact:?} {small:?}");
            assert!((exact.speed_mps - small.speed_mps).abs() < 1e-5, "{exact:?} {small:?}");
        }
    }

    #[test]
    fn the_speed_settles_one_time_constant_of_the_acceleration_away() {
        let settled = after(0.0, 10.0, -2.0, 60.0);
        assert!((settled.speed_mps - 7.0).abs() < 1e-12);
        assert!((settled.position_m - (7.0 * 60.0 + 3.0 * 1.5)).abs() < 1e-9);
    }

    #[test]
    fn a_stopped_vehicle_stays() {
        let stopped = after(0.0, 3.0, -4.0, 10.0);
        assert_eq!(stopped, after(0.0, 3.0, -4.0, 1000.0));
        assert_eq!(stopped.speed_mps, 0.0);
        assert_eq!(after(5.0, 0.0, -1.0, 3.0), Estimate { position_m: 5.0, speed_mps: 0.0 });
    }
}
