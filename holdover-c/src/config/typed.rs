//! Integers enter and the core's types leave, and back.
//!
//! What is larger than the core's format saturates at its end, which lies outside the range that the core then checks; only
//! the envelope's limits have no upper end.

use holdover::config;
use holdover::model;
use holdover::time::Duration;
use holdover::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};
use holdover::wire::{BaseId, StationHash, Transport, driving_parameters};

use super::{Body, Config, Envelope, Law, Limits, Link, Model, Prediction};
use crate::status::Status;

/// Thousandths, as the core takes them.
fn milli(magnitude: u32) -> i32 {
    i32::try_from(magnitude).unwrap_or(i32::MAX)
}

fn micros(micros: u32) -> Duration {
    Duration::from_micros(i64::from(micros))
}

/// # Errors
/// [`Status::ConfigSwitch`], so that a struct that nobody filled in is not taken for one.
fn switch(value: u8) -> Result<bool, Status> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(Status::ConfigSwitch),
    }
}

impl TryFrom<&Config> for config::Config {
    type Error = Status;

    /// As the core takes it, which checks it when a unit is made.
    fn try_from(plain: &Config) -> Result<Self, Status> {
        Ok(Self {
            station: StationHash(plain.station),
            station_id: plain.station_id,
            identifiers: plain.identifiers.on(BaseId::new(plain.base_id).ok_or(Status::ConfigBaseId)?)?,
            transport: Transport::Classic,
            period: micros(plain.period_us),
            length: Distance::from_mm(milli(plain.length_mm)),
            lag: FineSeconds::from_millis(milli(plain.lag_ms)),
            limits: plain.limits.into(),
            body: plain.body.into(),
            correction: switch(plain.correction)?,
            law: plain.law.try_into()?,
            prediction: config::Prediction {
                step: micros(plain.prediction.step_us),
                horizon: micros(plain.prediction.horizon_us),
                model: plain.prediction.model.try_into()?,
            },
            link: plain.link.into(),
            envelope: if switch(plain.envelope.engaged)? { Some(plain.envelope.into()) } else { None },
            range_sensor: switch(plain.range_sensor)?,
            passes: switch(plain.passes)?,
        })
    }
}

impl From<Limits> for driving_parameters::Limits {
    fn from(plain: Limits) -> Self {
        Self {
            acceleration: Acceleration::from_mm_per_s2(milli(plain.acceleration_mm_s2)),
            braking: Acceleration::from_mm_per_s2(milli(plain.braking_mm_s2)),
            jerk: Jerk::from_mm_per_s3(milli(plain.jerk_mm_s3)),
            emergency_braking: Acceleration::from_mm_per_s2(milli(plain.emergency_braking_mm_s2)),
        }
    }
}

impl From<Body> for model::Body {
    fn from(plain: Body) -> Self {
        let Body { mass_kg, ratio_milli, drag_milli, friction_milli, mechanical_n } = plain;
        Self { mass_kg, ratio_milli, drag_milli, friction_milli, mechanical_n }
    }
}

impl TryFrom<Law> for config::Law {
    type Error = Status;

    fn try_from(plain: Law) -> Result<Self, Status> {
        Ok(Self {
            time_gap: Seconds::from_millis(milli(plain.time_gap_ms)),
            silent_time_gap: Seconds::from_millis(milli(plain.silent_time_gap_ms)),
            standstill: Distance::from_mm(milli(plain.standstill_mm)),
            table: switch(plain.gain_table)?,
            gain: Gain::from_milli(milli(plain.gain_milli)),
            damping: Seconds::from_millis(milli(plain.damping_ms)),
            feed_forward: Fraction::from_milli(milli(plain.feed_forward_milli)),
            free_road_acceleration: Acceleration::from_mm_per_s2(milli(plain.free_road_acceleration_mm_s2)),
            target_speed: Speed::from_mm_per_s(milli(plain.target_speed_mm_s)),
            catch_up: Fraction::from_milli(milli(plain.catch_up_milli)),
            max_speed: Speed::from_mm_per_s(milli(plain.max_speed_mm_s)),
        })
    }
}

impl TryFrom<Model> for config::Model {
    type Error = Status;

    fn try_from(plain: Model) -> Result<Self, Status> {
        Ok(Self {
            lag: switch(plain.lag)?,
            limits: switch(plain.limits)?,
            last_demand: switch(plain.last_demand)?,
            standstill: switch(plain.standstill)?,
            trapezoid: switch(plain.trapezoid)?,
            interpolate: switch(plain.interpolate)?,
            stamped: switch(plain.stamped)?,
            endless: switch(plain.endless)?,
            received: switch(plain.received)?,
            smooth: switch(plain.smooth)?,
        })
    }
}

impl From<Link> for config::Link {
    fn from(plain: Link) -> Self {
        Self {
            period: micros(plain.period_us),
            tolerance: micros(plain.tolerance_us),
            stale: micros(plain.stale_us),
            future: micros(plain.future_us),
            clock_error: micros(plain.clock_error_us),
            slot_reuse: micros(plain.slot_reuse_us),
            holdover: micros(plain.holdover_us),
            ego_timeout: micros(plain.ego_timeout_us),
            request_timeout: micros(plain.request_timeout_us),
            sync_timeout: micros(plain.sync_timeout_us),
            assumed_delay: micros(plain.assumed_delay_us),
        }
    }
}

impl From<Envelope> for config::Envelope {
    fn from(plain: Envelope) -> Self {
        Self {
            acceleration: Acceleration::from_mm_per_s2(milli(plain.acceleration_mm_s2)),
            braking: Acceleration::from_mm_per_s2(milli(plain.braking_mm_s2)),
            jerk: Jerk::from_mm_per_s3(milli(plain.jerk_mm_s3)),
            speed: Speed::from_mm_per_s(milli(plain.speed_mm_s)),
            margin: Distance::from_mm(milli(plain.margin_mm)),
            delay: micros(plain.delay_us),
            lag_tolerance: Fraction::from_milli(milli(plain.lag_tolerance_milli)),
        }
    }
}

/// Back from thousandths; nothing in a configuration is negative.
fn magnitude(milli: i32) -> u32 {
    milli.unsigned_abs()
}

fn whole(duration: Duration) -> u32 {
    u32::try_from(duration.as_micros()).unwrap_or(u32::MAX)
}

impl From<&config::Config> for Config {
    fn from(typed: &config::Config) -> Self {
        let config::Prediction { step, horizon, model } = typed.prediction;
        Self {
            station: typed.station.0,
            station_id: typed.station_id,
            range_sensor: u8::from(typed.range_sensor),
            base_id: typed.identifiers.base().get(),
            identifiers: (&typed.identifiers).into(),
            period_us: whole(typed.period),
            length_mm: magnitude(typed.length.to_mm()),
            lag_ms: magnitude(typed.lag.to_millis()),
            limits: (&typed.limits).into(),
            body: (&typed.body).into(),
            correction: u8::from(typed.correction),
            passes: u8::from(typed.passes),
            law: (&typed.law).into(),
            prediction: Prediction { step_us: whole(step), horizon_us: whole(horizon), model: (&model).into() },
            link: (&typed.link).into(),
            envelope: match &typed.envelope {
                Some(envelope) => envelope.into(),
                // What a car would have, so that one switch engages it.
                None => Envelope { engaged: 0, ..(&config::Envelope::CAR).into() },
            },
        }
    }
}

impl From<&driving_parameters::Limits> for Limits {
    fn from(typed: &driving_parameters::Limits) -> Self {
        Self {
            acceleration_mm_s2: magnitude(typed.acceleration.to_mm_per_s2()),
            braking_mm_s2: magnitude(typed.braking.to_mm_per_s2()),
            jerk_mm_s3: magnitude(typed.jerk.to_mm_per_s3()),
            emergency_braking_mm_s2: magnitude(typed.emergency_braking.to_mm_per_s2()),
        }
    }
}

impl From<&model::Body> for Body {
    fn from(typed: &model::Body) -> Self {
        let model::Body { mass_kg, ratio_milli, drag_milli, friction_milli, mechanical_n } = *typed;
        Self { mass_kg, ratio_milli, drag_milli, friction_milli, mechanical_n }
    }
}

impl From<&config::Law> for Law {
    fn from(typed: &config::Law) -> Self {
        Self {
            time_gap_ms: magnitude(typed.time_gap.to_millis()),
            silent_time_gap_ms: magnitude(typed.silent_time_gap.to_millis()),
            standstill_mm: magnitude(typed.standstill.to_mm()),
            gain_table: u8::from(typed.table),
            gain_milli: magnitude(typed.gain.to_milli()),
            damping_ms: magnitude(typed.damping.to_millis()),
            feed_forward_milli: magnitude(typed.feed_forward.to_milli()),
            free_road_acceleration_mm_s2: magnitude(typed.free_road_acceleration.to_mm_per_s2()),
            target_speed_mm_s: magnitude(typed.target_speed.to_mm_per_s()),
            catch_up_milli: magnitude(typed.catch_up.to_milli()),
            max_speed_mm_s: magnitude(typed.max_speed.to_mm_per_s()),
        }
    }
}

impl From<&config::Model> for Model {
    fn from(typed: &config::Model) -> Self {
        Self {
            lag: u8::from(typed.lag),
            limits: u8::from(typed.limits),
            last_demand: u8::from(typed.last_demand),
            standstill: u8::from(typed.standstill),
            trapezoid: u8::from(typed.trapezoid),
            interpolate: u8::from(typed.interpolate),
            stamped: u8::from(typed.stamped),
            endless: u8::from(typed.endless),
            received: u8::from(typed.received),
            smooth: u8::from(typed.smooth),
        }
    }
}

impl From<&config::Link> for Link {
    fn from(typed: &config::Link) -> Self {
        Self {
            period_us: whole(typed.period),
            tolerance_us: whole(typed.tolerance),
            stale_us: whole(typed.stale),
            future_us: whole(typed.future),
            clock_error_us: whole(typed.clock_error),
            slot_reuse_us: whole(typed.slot_reuse),
            holdover_us: whole(typed.holdover),
            ego_timeout_us: whole(typed.ego_timeout),
            request_timeout_us: whole(typed.request_timeout),
            sync_timeout_us: whole(typed.sync_timeout),
            assumed_delay_us: whole(typed.assumed_delay),
        }
    }
}

impl From<&config::Envelope> for Envelope {
    fn from(typed: &config::Envelope) -> Self {
        Self {
            engaged: 1,
            acceleration_mm_s2: magnitude(typed.acceleration.to_mm_per_s2()),
            braking_mm_s2: magnitude(typed.braking.to_mm_per_s2()),
            jerk_mm_s3: magnitude(typed.jerk.to_mm_per_s3()),
            speed_mm_s: magnitude(typed.speed.to_mm_per_s()),
            margin_mm: magnitude(typed.margin.to_mm()),
            delay_us: whole(typed.delay),
            lag_tolerance_milli: magnitude(typed.lag_tolerance.to_milli()),
        }
    }
}
