//! The association: which vehicle the ego follows, and with which gains. The scene enters at every tick; the gains of the law, looked up
//! when the target changes, leave.

use super::scene::Scene;
use crate::controller::Gains;
use crate::model::Reading;
use crate::wire::{Predecessor, StationHash};

/// The vehicle that the ego follows, with the gains that were looked up when the ego began to follow it.
#[derive(Clone, Debug)]
pub(super) struct Association(Option<(StationHash, Gains)>);

impl Association {
    /// Without a target.
    pub const NONE: Self = Self(None);

    /// Looks the gains up when the target changes.
    pub fn update<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
        &mut self,
        scene: &Scene<PEERS, SAMPLES, STEPS>,
        target: Option<Reading>,
    ) {
        let Predecessor::Station(station) = scene.predecessor() else {
            self.0 = None;
            return;
        };
        if self.0.is_some_and(|(associated, _)| associated == station) {
            return;
        }
        let (Some(target), Some(ego)) = (target, scene.ego.as_ref()) else { return };
        let headway = target.position.ahead_of(ego.position);
        self.0 = Some((station, Gains::look_up(&scene.config.law, ego.speed, target.speed, headway)));
    }

    /// The gains.
    pub fn gains(&self) -> Option<Gains> {
        self.0.map(|(_, gains)| gains)
    }
}
