//! Constant position: the newest sample's position is held and the speed is 0, as for a receiver that treats silence as
//! standstill.

use super::{Baseline, Estimate, Newest};
use crate::measure::heard::Heard;

/// Holds the last position.
#[derive(Clone, Debug)]
pub struct Freeze {
    newest: Newest,
}

impl Freeze {
    /// The method for the vehicle `target`.
    #[must_use]
    pub fn new(target: usize) -> Self {
        Self { newest: Newest::of(target) }
    }
}

impl Baseline for Freeze {
    fn name(&self) -> &'static str {
        "freeze"
    }

    fn hear(&mut self, heard: &Heard) {
        self.newest.keep(heard);
    }

    fn estimate(&mut self, now_s: f64) -> Option<Estimate> {
        self.newest.at(now_s).map(|(sample, _)| Estimate { position_m: sample.position_m, speed_mps: 0.0 })
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
    fn the_position_stands_at_any_age() {
        let mut freeze = Freeze::new(0);
        freeze.hear(&state(1.0, 12.5, 8.0, 1.0));
        for now_s in [1.02, 2.0, 60.0] {
            assert_eq!(freeze.estimate(now_s), Some(Estimate { position_m: 12.5, speed_mps: 0.0 }));
        }
    }
}
