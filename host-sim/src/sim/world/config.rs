//! One vehicle of a scenario: its index enters; its body and the configuration of its unit leave.

use holdover::Config;
use holdover::config::Envelope;
use holdover::time::Duration;

use crate::input::scenario::Scenario;
use crate::sim::plant::Machine;
use crate::sim::quantities::{distance, duration, fine_seconds, seconds, share, speed, thousandths};
use crate::sim::station::station;
use crate::sim::vehicle::STEPS;

/// The body of a vehicle.
#[must_use]
pub fn machine(scenario: &Scenario, index: usize) -> Machine {
    let vehicle = &scenario.vehicles[index];
    Machine::new(vehicle.kind, vehicle.plant_lag_s, &vehicle.difference)
}

/// The configuration of a vehicle's unit.
#[must_use]
pub fn config(scenario: &Scenario, index: usize) -> Config {
    let vehicle = &scenario.vehicles[index];
    let mut config = Config::car(station(index));
    config.transport = scenario.bus.transport;
    config.identifiers = scenario.identifiers;
    config.period = duration(scenario.period_s);
    config.length = distance(vehicle.length_m);
    config.lag = fine_seconds(vehicle.lag_s);
    config.body = vehicle.kind.body();
    config.limits = vehicle.kind.limits();
    config.law.time_gap = seconds(vehicle.time_gap_s);
    config.law.silent_time_gap = seconds(vehicle.silent_time_gap_s);
    config.law.standstill = distance(vehicle.standstill_m);
    config.law.catch_up = share(vehicle.catch_up);
    config.law.feed_forward = thousandths(vehicle.feed_forward);
    config.law.target_speed = speed(scenario.leader.target_speed_mps);
    config.link.period = duration(1.0 / scenario.message_rate_hz);
    config.range_sensor = vehicle.range_sensor.is_some();
    config.prediction.step = duration(scenario.step_s);
    config.prediction.horizon = horizon(HORIZON_S, scenario.step_s);
    // No vehicle brakes harder than it publishes.
    let capable = config.limits.emergency_braking;
    config.envelope =
        scenario.envelope.limits().map(|limits| Envelope { braking: limits.braking.min(capable), ..limits });
    config
}

/// How far the units predict, in seconds: as far as those on an ECU.
pub const HORIZON_S: f64 = 10.7;

/// A horizon of at least this length in whole steps, within the capacity.
#[must_use]
pub fn horizon(horizon_s: f64, step_s: f64) -> Duration {
    let steps = (horizon_s / step_s).ceil().clamp(2.0, (STEPS - 2) as f64);
    duration(steps * step_s)
}
