//! What is varied between runs of the same trips: a description enters; the conditions of a run, and under them the
//! configuration of a vehicle's unit, leave.

use holdover::Config;

use super::description::{Corridor, Radio, Wrong};
use crate::plant::Kind;
use crate::scenario::Envelope;
use crate::vehicle::{distance, duration, fine_seconds, seconds, speed, station};
use crate::world::horizon;

/// What is done when the link to whoever is just ahead is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhenLost {
    /// What the unit does: it goes by its estimate.
    Holdover,
    /// The vehicle drives alone, [`alone`](super::alone).
    Alone,
}

/// What is varied between runs of the same trips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// The links.
    pub radio: Radio,
    /// How vehicles differ from what they publish.
    pub wrong: Wrong,
    /// The last gate.
    pub envelope: Envelope,
    /// The reference drives otherwise.
    pub when_lost: WhenLost,
    /// Prediction step.
    pub step_s: f64,
}

impl Conditions {
    /// As the scenario says.
    #[must_use]
    pub fn of(corridor: &Corridor) -> Self {
        Self {
            radio: corridor.radio,
            wrong: corridor.wrong,
            envelope: corridor.envelope,
            when_lost: WhenLost::Holdover,
            step_s: corridor.step_s,
        }
    }
}

/// The configuration of a vehicle's unit.
#[must_use]
pub fn config(corridor: &Corridor, conditions: &Conditions, index: usize, kind: Kind) -> Config {
    let traffic = &corridor.traffic;
    let mut config = Config::car(station(index));
    config.period = duration(corridor.period_s);
    config.length = distance(kind.length_m());
    config.lag = fine_seconds(kind.lag_s());
    config.body = kind.body();
    config.limits = kind.limits();
    config.law.time_gap = seconds(traffic.time_gap_s);
    config.law.standstill = distance(traffic.standstill_m);
    config.law.target_speed = speed(traffic.target_speed_mps);
    config.link.period = duration(1.0 / corridor.message_rate_hz);
    config.prediction.step = duration(conditions.step_s);
    config.prediction.horizon = horizon(corridor.horizon_s, conditions.step_s);
    let capable = config.limits.emergency_braking;
    let limits = conditions.envelope.limits();
    config.envelope =
        limits.map(|limits| holdover::config::Envelope { braking: limits.braking.min(capable), ..limits });
    config
}
