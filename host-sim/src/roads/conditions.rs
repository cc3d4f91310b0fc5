//! The conditions that vary between runs of the same trips: a description enters; the conditions of a run leave, and
//! under them the configuration of a vehicle's unit.

use holdover::Config;

use super::description::{Corridor, Emergencies, Radio, Wrong};
use crate::input::kind::Kind;
use crate::input::scenario::Envelope;
use crate::sim::quantities::{distance, duration, fine_seconds, seconds, share, speed, thousandths};
use crate::sim::sensors::faults::is_fitted;
use crate::sim::station::station;
use crate::sim::world::horizon;
use crate::streams::{Purpose, stream, unit};

/// What a vehicle does when the link to a vehicle just ahead is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhenLost {
    /// The unit drives by its estimate.
    Holdover,
    /// The vehicle drives alone; see [`alone`](super::alone).
    Alone,
}

/// Which events of the scenario a run heeds. The others are what it is compared with others in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Heeds {
    /// Delay, loss and outages.
    pub links: bool,
    /// Switches of the envelope.
    pub envelope: bool,
}

/// The conditions of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// The links.
    pub radio: Radio,
    /// Differences of the vehicles from what they publish.
    pub wrong: Wrong,
    /// The envelope of every unit.
    pub envelope: Envelope,
    /// What a vehicle does when a link is lost: holdover, or the reference.
    pub when_lost: WhenLost,
    /// Prediction step.
    pub step_s: f64,
    /// Number of peer slots of a unit.
    pub slots: usize,
    /// Share of the vehicles whose units keep no passes.
    pub without_passes: f64,
    /// Emergency stops and faults.
    pub emergencies: Emergencies,
    /// The events that it heeds.
    pub heeds: Heeds,
}

impl Conditions {
    /// The conditions of the scenario, without emergency stops and faults.
    #[must_use]
    pub fn of(corridor: &Corridor) -> Self {
        Self {
            radio: corridor.radio,
            wrong: corridor.wrong,
            envelope: corridor.envelope,
            when_lost: WhenLost::Holdover,
            step_s: corridor.step_s,
            slots: corridor.slots,
            without_passes: corridor.traffic.without_passes,
            emergencies: Emergencies::NONE,
            heeds: Heeds { links: true, envelope: true },
        }
    }
}

/// Which vehicle it is.
#[derive(Clone, Copy, Debug)]
pub struct Identity {
    /// The index of its trip.
    pub trip: usize,
    /// The number of its station, which another vehicle may have later.
    pub called: usize,
    /// Whether it has a range sensor.
    pub sees: bool,
    /// Whether its unit keeps passes.
    pub passes: bool,
}

impl Identity {
    /// Of a trip of a seed, by the number of its station.
    #[must_use]
    pub fn of(corridor: &Corridor, conditions: &Conditions, seed: u64, trip: usize, called: usize) -> Self {
        let sees = is_fitted(corridor.sensors.share, seed, trip as u32);
        Self { trip, called, sees, passes: !lacks_passes(conditions.without_passes, seed, trip as u32) }
    }
}

/// Whether the unit of the vehicle with this index keeps no passes, if this share of the vehicles keeps none. A vehicle that keeps none at
/// a share keeps none at every larger share.
fn lacks_passes(share: f64, seed: u64, index: u32) -> bool {
    unit(&mut stream(seed, Purpose::Passes(index))) < share
}

/// The configuration of the unit of a vehicle.
#[must_use]
pub fn config(corridor: &Corridor, conditions: &Conditions, identity: Identity, kind: Kind) -> Config {
    let traffic = &corridor.traffic;
    let Identity { trip, called, sees, passes } = identity;
    let mut config = Config::car(station(called));
    config.station_id = (trip as u32) << 8 | u32::from(config.station.0);
    config.range_sensor = sees;
    config.passes = passes;
    config.transport = corridor.bus.transport;
    config.period = duration(corridor.period_s);
    config.length = distance(kind.length_m());
    config.lag = fine_seconds(kind.lag_s());
    config.body = kind.body();
    config.limits = kind.limits();
    config.law.time_gap = seconds(traffic.time_gap_s);
    config.law.silent_time_gap = seconds(traffic.silent_time_gap_s);
    config.law.standstill = distance(traffic.standstill_m);
    config.law.catch_up = share(traffic.catch_up);
    config.law.feed_forward = thousandths(traffic.feed_forward);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roads::example;
    use crate::sim::vehicle::STEPS;

    const FIRST: Identity = Identity { trip: 0, called: 0, sees: false, passes: true };

    #[test]
    fn who_keeps_no_passes_at_a_share_keeps_none_at_every_larger_one() {
        let without = |share: f64| (0..1000).filter(|index| lacks_passes(share, 1, *index)).collect::<Vec<_>>();
        let (few, many) = (without(0.1), without(0.5));
        assert!((70..=130).contains(&few.len()) && (450..=550).contains(&many.len()), "{} {}", few.len(), many.len());
        assert!(few.iter().all(|one| many.contains(one)));
        assert_eq!((without(0.0).len(), without(1.0).len()), (0, 1000));
    }

    #[test]
    fn the_units_of_a_share_of_the_file_keep_no_passes() {
        let text = example::TEXT.replacen("without_passes = 0.0", "without_passes = 0.5", 1);
        let keeps = |text: &str| {
            let corridor = example::of(text);
            let conditions = Conditions::of(&corridor);
            let of = |trip| config(&corridor, &conditions, Identity::of(&corridor, &conditions, 1, trip, 0), Kind::Car);
            (0..100).filter(|trip| of(*trip).passes).count()
        };
        assert_eq!(keeps(example::TEXT), 100);
        assert!((35..=65).contains(&keeps(&text)), "{}", keeps(&text));
    }

    #[test]
    fn the_units_drive_by_the_law_of_the_file() {
        let mut text = example::TEXT.to_owned();
        for (from, to) in [
            ("time_gap_s = 1.0", "time_gap_s = 1.25"),
            ("silent_time_gap_s = 1.8", "silent_time_gap_s = 2.5"),
            ("standstill_m = 2.0", "standstill_m = 3.5"),
            ("feed_forward = 0 ", "feed_forward = 0.5 "),
            ("catch_up = 0.2", "catch_up = 0.1"),
            ("target_speed_mps = 11.0", "target_speed_mps = 12.5"),
        ] {
            assert!(text.contains(from), "{from}");
            text = text.replacen(from, to, 1);
        }
        let corridor = example::of(&text);
        let law = config(&corridor, &Conditions::of(&corridor), FIRST, Kind::Car).law;
        let gaps = [law.time_gap, law.silent_time_gap].map(holdover::units::Seconds::to_millis);
        assert_eq!(gaps, [1_250, 2_500]);
        assert_eq!((law.standstill.to_mm(), law.target_speed.to_mm_per_s()), (3_500, 12_500));
        assert_eq!((law.feed_forward.to_milli(), law.catch_up.to_milli()), (500, 100));
    }

    #[test]
    fn whatever_a_file_may_say_the_units_take() {
        let extremes: [(&str, &[&str]); 14] = [
            ("period_s = 0.01 ", &["period_s = 0.001", "period_s = 0.1"]),
            ("step_s = 0.03 ", &["step_s = 0.001", "step_s = 1"]),
            ("horizon_s = 10.7", &["horizon_s = 0.5"]),
            ("message_rate_hz = 10.0", &["message_rate_hz = 1", "message_rate_hz = 100"]),
            ("target_speed_mps = 11.0", &["target_speed_mps = 1", "target_speed_mps = 50"]),
            ("time_gap_s = 1.0", &["time_gap_s = 0.1", "time_gap_s = 3.995"]),
            ("silent_time_gap_s = 1.8", &["silent_time_gap_s = 0.1", "silent_time_gap_s = 3.995"]),
            ("standstill_m = 2.0", &["standstill_m = 0", "standstill_m = 10.23"]),
            ("engaged = true ", &["engaged = false"]),
            ("acceleration_mps2 = 3.0", &["acceleration_mps2 = 0.1", "acceleration_mps2 = 20.46"]),
            ("braking_mps2 = 8.0", &["braking_mps2 = 0.5"]),
            ("jerk_mps3 = 25.0", &["jerk_mps3 = 1", "jerk_mps3 = 51.15"]),
            ("speed_mps = 50.0", &["speed_mps = 1", "speed_mps = 65.534"]),
            ("margin_m = 0.5", &["margin_m = 0", "margin_m = 10"]),
        ];
        let text = example::TEXT;
        for (from, tos) in extremes {
            for to in tos {
                let text = text.replacen(from, to, 1);
                let corridor = example::of(&text);
                for kind in [Kind::Car, Kind::Van, Kind::Bus] {
                    let config = config(&corridor, &Conditions::of(&corridor), FIRST, kind);
                    assert_eq!(config.check(STEPS), Ok(()), "{to}");
                }
            }
        }
        // A coarse step and a short horizon at once.
        let text = text.replacen("step_s = 0.03 ", "step_s = 1 ", 1).replacen("horizon_s = 10.7", "horizon_s = 0.5", 1);
        let corridor = example::of(&text);
        assert_eq!(config(&corridor, &Conditions::of(&corridor), FIRST, Kind::Car).check(STEPS), Ok(()));
    }
}
