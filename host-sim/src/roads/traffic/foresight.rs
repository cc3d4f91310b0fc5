//! When a vehicle foresees to come to its next conflict area: its own horizon enters; the time leaves.

use holdover::units::Distance;
use holdover::wire::command::ModeCode;

use super::Traffic;
use super::traveller::Traveller;
use crate::roads::entries::ASKED_S;

/// Halvings of the horizon: the time is told to less than 3 ms.
const HALVINGS: usize = 12;

impl Traffic<'_> {
    /// Whether vehicles are asked at this tick what they foresee.
    pub(super) fn is_asked(&self) -> bool {
        let every = (ASKED_S / self.corridor.period_s).round().max(1.0) as u64;
        self.ticks.is_multiple_of(every)
    }

    /// The time at which a vehicle's own horizon has it at its next area; `None` if it drives by no law, there is no area ahead, or the
    /// horizon ends before.
    pub(super) fn foreseen_entry_s(&self, at_s: f64, traveller: &Traveller) -> Option<f64> {
        let vehicle = &traveller.vehicle;
        let (_, area_m) = self.network.next_area(self.trips[traveller.trip].road, traveller.way_m());
        let way_mm = (1_000.0 * (area_m? - traveller.way_m())) as i32;
        if !matches!(vehicle.mode, ModeCode::Cooperative | ModeCode::Holdover) {
            return None;
        }
        let estimator = vehicle.unit.estimator();
        let here = estimator.read_own(vehicle.instant(at_s))?.position;
        let area = here.ahead(Distance::from_mm(way_mm));
        let (_, end) = estimator.own_end()?;
        if end.position < area {
            return None;
        }
        let mut within_s = [0.0, vehicle.unit.config().prediction.horizon.as_micros() as f64 / 1e6];
        for _ in 0..HALVINGS {
            let middle_s = 0.5 * (within_s[0] + within_s[1]);
            within_s[usize::from(estimator.is_own_there(vehicle.instant(at_s + middle_s), area))] = middle_s;
        }
        Some(at_s + within_s[1])
    }
}
