//! The configuration in a head: that of a car, with what the scenarios set.

use holdover::Config;
use holdover::config::Envelope;
use holdover::time::Duration;
use holdover::units::{Distance, Fraction, Seconds, Speed};
use holdover::wire::StationHash;

use crate::words::{Put, Take, number};

pub fn put(config: &Config, put: Put) {
    let (law, prediction) = (&config.law, &config.prediction);
    put(config.station.0.into());
    put(config.station_id.into());
    put(law.time_gap.to_bits().into());
    put(law.silent_time_gap.to_bits().into());
    put(law.standstill.to_bits().into());
    put(law.target_speed.to_bits().into());
    put(law.catch_up.to_bits().into());
    put(law.feed_forward.to_bits().into());
    put(prediction.step.as_micros());
    put(prediction.horizon.as_micros());
    put(config.envelope.is_some().into());
    put(config.range_sensor.into());
}

pub fn take(take: Take) -> Option<Config> {
    let mut config = Config::car(StationHash(number(take)?));
    config.station_id = number(take)?;
    config.law.time_gap = Seconds::from_bits(number(take)?);
    config.law.silent_time_gap = Seconds::from_bits(number(take)?);
    config.law.standstill = Distance::from_bits(number(take)?);
    config.law.target_speed = Speed::from_bits(number(take)?);
    config.law.catch_up = Fraction::from_bits(number(take)?);
    config.law.feed_forward = Fraction::from_bits(number(take)?);
    config.prediction.step = Duration::from_micros(take()?);
    config.prediction.horizon = Duration::from_micros(take()?);
    config.envelope = (take()? != 0).then_some(Envelope::CAR);
    config.range_sensor = take()? != 0;
    Some(config)
}
