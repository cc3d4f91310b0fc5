//! The consensus law of platoon simulators: messages enter; the target's position as the law assumes it leaves.
//!
//! Whenever the law is evaluated, it takes the message that arrived last and extrapolates its position by its age times
//! its speed, `r + v (now - stamp)`. The speed is unchanged. That is a constant speed. On the same messages it differs
//! from [`ConstantSpeed`](crate::measure::baseline::constant_speed::ConstantSpeed) in one respect: stamps are not
//! compared, so an overtaken message replaces the newer one.

use crate::measure::baseline::{Baseline, Estimate};
use crate::measure::heard::Heard;

/// Keeps the message that arrived last.
#[derive(Clone, Debug)]
pub struct Consensus {
    target: usize,
    last: Option<Heard>,
}

impl Consensus {
    /// The method for the vehicle `target`.
    #[must_use]
    pub fn new(target: usize) -> Self {
        Self { target, last: None }
    }
}

impl Baseline for Consensus {
    fn name(&self) -> &'static str {
        "consensus"
    }

    fn hear(&mut self, heard: &Heard) {
        if heard.vehicle == self.target {
            self.last = Some(*heard);
        }
    }

    fn estimate(&mut self, now_s: f64) -> Option<Estimate> {
        self.last.map(|last| Estimate {
            position_m: last.position_m + last.speed_mps * (now_s - last.stamp_s),
            speed_mps: last.speed_mps,
        })
    }

    fn duplicate(&self) -> Box<dyn Baseline> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::baseline::constant_speed::ConstantSpeed;
    use crate::measure::baseline::tests::state;

    #[test]
    fn in_the_order_of_sending_it_is_a_constant_speed_and_an_overtaken_message_makes_the_difference() {
        let (mut consensus, mut constant) = (Consensus::new(0), ConstantSpeed::new(0));
        let mut hear = |heard: &Heard| {
            consensus.hear(heard);
            constant.hear(heard);
            (consensus.estimate(3.0), constant.estimate(3.0))
        };
        for message in [state(1.0, 10.0, 8.0, -2.0), state(1.1, 10.8, 7.8, -2.0)] {
            let (of_consensus, of_constant) = hear(&message);
            assert_eq!(of_consensus, of_constant);
        }
        let (of_consensus, of_constant) = hear(&state(1.05, 10.4, 7.9, -2.0));
        assert_eq!(of_consensus, Some(Estimate { position_m: 10.4 + 7.9 * (3.0 - 1.05), speed_mps: 7.9 }));
        assert_eq!(of_constant, Some(Estimate { position_m: 10.8 + 7.8 * (3.0 - 1.1), speed_mps: 7.8 }));
    }
}
