//! How a person drives behind another vehicle: the Intelligent Driver Model (Treiber, Hennecke, Helbing, Physical Review E 62, 2000) on
//! what is really there. Own motion, gap and the speed ahead enter; an acceleration leaves.

/// Largest acceleration of the model.
pub const ACCELERATION_MPS2: f64 = 1.5;
/// Comfortable braking of the model.
pub const BRAKING_MPS2: f64 = 2.0;
/// Braking beyond which no road vehicle goes: that of a bus.
pub const EMERGENCY_MPS2: f64 = 6.0;

/// How a person likes to drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manner {
    /// Speed on a free road.
    pub wanted_mps: f64,
    /// Time gap.
    pub time_gap_s: f64,
    /// Bumper gap at rest.
    pub standstill_m: f64,
}

impl Manner {
    /// The share of the largest acceleration that the free road would give at this speed.
    #[must_use]
    pub fn free(&self, speed_mps: f64) -> f64 {
        1.0 - (speed_mps / self.wanted_mps).powi(4)
    }

    /// What a vehicle ahead takes of that share, by its gap and its speed.
    #[must_use]
    pub fn pressed(&self, speed_mps: f64, gap_m: f64, ahead_mps: f64) -> f64 {
        let closing = speed_mps * (speed_mps - ahead_mps) / (2.0 * (ACCELERATION_MPS2 * BRAKING_MPS2).sqrt());
        let wanted_m = self.standstill_m + (speed_mps * self.time_gap_s + closing).max(0.0);
        (wanted_m / gap_m.max(0.1)).powi(2)
    }

    /// The acceleration behind a vehicle.
    #[must_use]
    pub fn behind(&self, speed_mps: f64, gap_m: f64, ahead_mps: f64) -> f64 {
        let share = self.free(speed_mps) - self.pressed(speed_mps, gap_m, ahead_mps);
        (ACCELERATION_MPS2 * share).max(-EMERGENCY_MPS2)
    }

    /// The gap that stays as it is behind a vehicle of the same speed.
    #[must_use]
    pub fn steady_gap_m(&self, speed_mps: f64) -> f64 {
        (self.standstill_m + speed_mps * self.time_gap_s) / self.free(speed_mps).max(f64::MIN_POSITIVE).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MANNER: Manner = Manner { wanted_mps: 30.0, time_gap_s: 1.5, standstill_m: 2.0 };

    #[test]
    fn at_the_steady_gap_nothing_changes_and_nearer_or_faster_it_brakes() {
        let gap_m = MANNER.steady_gap_m(15.0);
        assert!((gap_m - 24.5 / 0.9375f64.sqrt()).abs() < 1e-9, "{gap_m}");
        assert!(MANNER.behind(15.0, gap_m, 15.0).abs() < 1e-9);
        assert!(MANNER.behind(15.0, gap_m - 1.0, 15.0) < -0.1 && MANNER.behind(15.0, gap_m, 13.0) < -0.5);
        assert!(MANNER.behind(15.0, gap_m + 5.0, 15.0) > 0.3);
    }

    #[test]
    fn it_never_brakes_harder_than_a_bus_can() {
        assert_eq!(MANNER.behind(30.0, 0.0, 0.0), -EMERGENCY_MPS2);
    }
}
