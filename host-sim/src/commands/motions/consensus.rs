//! The consensus law of platoon simulators: messages enter, what the law takes for the target's position leaves.
//!
//! Whenever it is evaluated it takes the message that came last and moves its position on by its age times its own speed,
//! `r + v (now - stamp)`; the speed stands as it is. That is a constant speed, and on the same messages it differs from
//! [`ConstantSpeed`](crate::measure::baseline::constant_speed::ConstantSpeed) in one thing: a message that was overtaken replaces
//! the newer one, because stamps are not compared.

use crate::measure::baseline::{Baseline, Estimate};
use crate::measure::heard::Heard;

/// Keeps the message that came last.
#[derive(Clone, Debug)]
pub struct Consensus {
    target: usize,
    last: Option<Heard>,
}

impl Consensus {
    /// For that vehicle.
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
