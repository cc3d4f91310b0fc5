//! Constant acceleration: the newest sample's acceleration is held until the speed is 0. Then the vehicle stays.

use super::{Baseline, Estimate, Newest};
use crate::measure::heard::Heard;

/// Holds the last acceleration.
#[derive(Clone, Debug)]
pub struct ConstantAcceleration {
    newest: Newest,
}

impl ConstantAcceleration {
    /// The method for the vehicle `target`.
    #[must_use]
    pub fn new(target: usize) -> Self {
        Self { newest: Newest::of(target) }
    }
}

/// The motion after `time_s` at a constant acceleration: `r + v t + a t²/2` and `v + a t` until the vehicle stops, at
/// `t = -v/a`. A vehicle at standstill (`v <= 0`) stays if it is not accelerated, and starts from 0 if it is.
pub(super) fn after(position_m: f64, speed_mps: f64, acceleration_mps2: f64, time_s: f64) -> Estimate {
    let speed_mps = speed_mps.max(0.0);
    let moving_s = if acceleration_mps2 < 0.0 { time_s.min(-speed_mps / acceleration_mps2) } else { time_s };
    Estimate {
        position_m: position_m + (speed_mps + 0.5 * acceleration_mps2 * moving_s) * moving_s,
        speed_mps: (speed_mps + acceleration_mps2 * time_s).max(0.0),
    }
}

impl Baseline for ConstantAcceleration {
    fn name(&self) -> &'static str {
        "constant_acceleration"
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
    use super::super::tests::state;
    use super::*;

    fn estimate(speed_mps: f64, acceleration_mps2: f64, age_s: f64) -> Estimate {
        let mut constant = ConstantAcceleration::new(0);
        constant.hear(&state(1.0, 10.0, speed_mps, acceleration_mps2));
        constant.estimate(1.0 + age_s).unwrap()
    }

    #[test]
    fn it_speeds_up_as_the_square_of_time() {
        assert_eq!(estimate(8.0, 2.0, 2.0), Estimate { position_m: 30.0, speed_mps: 12.0 });
    }

    #[test]
    fn it_stops_after_the_braking_distance_and_stays() {
        for age_s in [4.0, 4.5, 100.0] {
            assert_eq!(estimate(8.0, -2.0, age_s), Estimate { position_m: 10.0 + 8.0 * 8.0 / 4.0, speed_mps: 0.0 });
        }
    }

    #[test]
    fn a_standing_vehicle_that_brakes_stays() {
        assert_eq!(estimate(0.0, -1.0, 3.0), Estimate { position_m: 10.0, speed_mps: 0.0 });
    }
}
