//! Constant speed: the newest sample's speed is held, `r + v t`.

use super::{Baseline, Estimate, Newest};
use crate::measure::heard::Heard;

/// Holds the last speed.
#[derive(Clone, Debug)]
pub struct ConstantSpeed {
    newest: Newest,
}

impl ConstantSpeed {
    /// The method for the vehicle `target`.
    #[must_use]
    pub fn new(target: usize) -> Self {
        Self { newest: Newest::of(target) }
    }
}

impl Baseline for ConstantSpeed {
    fn name(&self) -> &'static str {
        "constant_speed"
    }

    fn hear(&mut self, heard: &Heard) {
        self.newest.keep(heard);
    }

    fn estimate(&mut self, now_s: f64) -> Option<Estimate> {
        self.newest.at(now_s).map(|(sample, age_s)| Estimate {
            position_m: sample.position_m + sample.speed_mps * age_s,
            speed_mps: sample.speed_mps,
        })
    }

    fn duplicate(&self) -> Box<dyn Baseline> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::state;
    use super::*;

    #[test]
    fn the_age_counts_from_the_stamp_not_from_the_arrival() {
        let mut constant = ConstantSpeed::new(0);
        constant.hear(&state(1.0, 10.0, 8.0, 1.0));
        assert_eq!(constant.estimate(3.5), Some(Estimate { position_m: 30.0, speed_mps: 8.0 }));
    }

    #[test]
    fn a_sample_from_the_future_is_not_taken_backwards() {
        let mut constant = ConstantSpeed::new(0);
        constant.hear(&state(1.0, 10.0, 8.0, 1.0));
        assert_eq!(constant.estimate(0.5), Some(Estimate { position_m: 10.0, speed_mps: 8.0 }));
    }
}
