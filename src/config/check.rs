//! Is a configuration sound? Its values enter; nothing, or the name of the first one that is out of its documented range,
//! leaves.

use super::{Config, Prediction};
use crate::model::follower::FEED_FORWARD_STEP;
use crate::parameters;
use crate::time::Duration;
use crate::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};
use crate::wire::driving_parameters::Limits;
use crate::wire::quantity::Quantity;
use crate::wire::{IdentifierError, Transport};

/// Why a configuration was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ConfigError {
    /// Two lines of the catalogue have one identifier, or one has no room.
    Identifiers(IdentifierError),
    /// `period` is outside 1 to 100 ms.
    Period,
    /// `step` is outside 1 ms to 1 s.
    Step,
    /// `horizon` is shorter than two steps, longer than 25.5 s, or needs more steps than the capacity.
    Horizon,
    /// `length` is outside 0 to 40.95 m.
    Length,
    /// `lag` is outside 0 to 1.998 s.
    Lag,
    /// A limit is zero, negative or beyond the wire's range, or normal braking is harder than 6 m/s² or than emergency
    /// braking.
    Limits,
    /// `time_gap` or `silent_time_gap` is outside 0.1 to 3.995 s.
    TimeGap,
    /// `standstill` is outside 0 to 10.23 m.
    Standstill,
    /// A gain is out of range.
    Gain,
    /// `feed_forward` is neither 0 nor 0.5, or is 0.5 with a step or a period below 7.813 ms.
    FeedForward,
    /// The semi-implicit step is unstable: `k δt² >= 4 + 2 k δt (t_g + γ)`.
    Unstable,
    /// A speed is outside 0 to 65.534 m/s.
    Speed,
    /// `catch_up` is outside 0 to 0.75, or no multiple of 0.05.
    CatchUp,
    /// `a_max` of the free road is below 0.1 m/s² or above the limit on acceleration.
    FreeRoad,
    /// A time of the link is negative, zero where it must not be, or beyond 10 s for stamps; or the clock may be off by more
    /// than what is refused as future.
    Link,
    /// The vehicle of eqs 1-3 has no mass or no brakes.
    Body,
    /// A limit of the envelope is zero, or one is negative; or it brakes harder than what is published of the vehicle, or with less
    /// than 0.1 m/s² or 0.1 m/s³, which is hardly a step of a command; or its
    /// delay is beyond 0.5 s, its tolerance beyond the whole lag, or the longest lag beyond 1.998 s.
    Envelope,
    /// `transport` is CAN FD, which this build has no code for: it takes the feature `fd`.
    Transport,
}

impl core::fmt::Display for ConfigError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Identifiers(error) => return error.fmt(f),
            Self::Period => "period is outside 1 to 100 ms",
            Self::Step => "step is outside 1 ms to 1 s",
            Self::Horizon => "horizon is shorter than two steps, longer than 25.5 s, or needs more steps than there is room for",
            Self::Length => "length is outside 0 to 40.95 m",
            Self::Lag => "lag is outside 0 to 1.998 s",
            Self::Limits => "a limit is out of range (0 < braking <= 6 m/s² and <= emergency braking <= 20.46 m/s²; jerk <= 51.15 m/s³, and more than 2 mm/s² in a period, by which a command changes at least)",
            Self::TimeGap => "time_gap or silent_time_gap is outside 0.1 to 3.995 s",
            Self::Standstill => "standstill is outside 0 to 10.23 m",
            Self::Gain => "gain is outside 0.01 to 3.999 /s², or damping outside 0 to 3.999 s",
            Self::FeedForward => "feed_forward is neither 0 nor 0.5, or is 0.5 with a step or a period below 7.813 ms",
            Self::Unstable => "the prediction is unstable with this gain at this step; lower the gain or the step",
            Self::Speed => "a speed is outside 0 to 65.534 m/s",
            Self::CatchUp => "catch_up is outside 0 to 0.75, or no multiple of 0.05, in which it is published",
            Self::FreeRoad => "free_road_acceleration is below 0.1 m/s² or above the limit on acceleration",
            Self::Link => "a time of the link is out of range",
            Self::Body => "the vehicle's body is out of range (mass 300 to 40,000 kg, gear ratio above 0)",
            Self::Envelope => "a limit of the envelope is zero, its margin is negative, its braking is below 0.1 m/s² or its jerk below 0.1 m/s³, its braking is harder than emergency braking, its delay is beyond 0.5 s, or its lag_tolerance is beyond 1 or makes a lag beyond 1.998 s",
            Self::Transport => "transport is CAN FD, which this build has no code for; build with the feature `fd`",
        })
    }
}

impl core::error::Error for ConfigError {}

const LONGEST_LAG: FineSeconds = FineSeconds::from_millis(1_998);
/// With less the last gate could hardly brake: a command has steps of 2 mm/s².
const LEAST_BRAKING: Acceleration = Acceleration::from_mm_per_s2(100);
/// A command has steps of 2 mm/s². What changes less in a period never changes.
const LEAST_STEP: Acceleration = Acceleration::from_mm_per_s2(2);
const LEAST_JERK: Jerk = Jerk::from_mm_per_s3(100);
const WIRE_SPEED_MAX: Speed = Speed::from_mm_per_s(65_534);
const WIRE_ACCELERATION_MAX: Acceleration = Acceleration::from_mm_per_s2(20_460);

impl Config {
    /// Checks everything against its documented range.
    ///
    /// # Errors
    /// The first value that is out of its range, by name.
    pub fn check(&self, capacity: usize) -> Result<(), ConfigError> {
        let positive = |d: Duration| d > Duration::ZERO;
        let ensure = |holds: bool, error: ConfigError| if holds { Ok(()) } else { Err(error) };
        let millis = Duration::from_millis;
        self.identifiers.check(self.transport).map_err(ConfigError::Identifiers)?;
        ensure(cfg!(feature = "fd") || self.transport == Transport::Classic, ConfigError::Transport)?;
        ensure((millis(1)..=millis(100)).contains(&self.period), ConfigError::Period)?;
        let Prediction { step, horizon, .. } = self.prediction;
        ensure((millis(1)..=millis(1000)).contains(&step), ConfigError::Step)?;
        ensure(
            horizon >= step.times(2) && horizon <= millis(25_500) && self.steps() <= capacity,
            ConfigError::Horizon,
        )?;
        ensure((Distance::ZERO..=Distance::from_mm(40_950)).contains(&self.length), ConfigError::Length)?;
        ensure((FineSeconds::ZERO..=LONGEST_LAG).contains(&self.lag), ConfigError::Lag)?;
        self.check_limits()?;
        self.check_law()?;
        let link = &self.link;
        ensure(
            positive(link.period)
                && link.tolerance >= Duration::ZERO
                && positive(link.stale)
                && link.stale <= parameters::STALE_MAX
                && link.future >= Duration::ZERO
                && link.future < millis(1000)
                && (Duration::ZERO..=link.future).contains(&link.clock_error)
                && [link.slot_reuse, link.holdover, link.ego_timeout, link.request_timeout, link.sync_timeout]
                    .into_iter()
                    .all(positive)
                && link.assumed_delay >= Duration::ZERO
                && link.assumed_delay <= millis(2000),
            ConfigError::Link,
        )?;
        ensure(self.body.is_sane(), ConfigError::Body)?;
        ensure(
            self.envelope.is_none_or(|e| {
                e.acceleration > Acceleration::ZERO
                    && e.braking >= LEAST_BRAKING
                    && e.braking <= self.limits.emergency_braking
                    && e.jerk >= LEAST_JERK
                    && e.speed > Speed::ZERO
                    && e.margin >= Distance::ZERO
                    && (Duration::ZERO..=millis(500)).contains(&e.delay)
                    && (Fraction::ZERO..=Fraction::ONE).contains(&e.lag_tolerance)
                    && self.lag.plus(self.lag.fraction(e.lag_tolerance)) <= LONGEST_LAG
            }),
            ConfigError::Envelope,
        )
    }

    fn check_limits(&self) -> Result<(), ConfigError> {
        let Limits { acceleration, braking, jerk, emergency_braking } = self.limits;
        let holds = acceleration > Acceleration::ZERO
            && acceleration <= WIRE_ACCELERATION_MAX
            && braking > Acceleration::ZERO
            && braking <= parameters::BRAKING_MAX
            && braking <= emergency_braking
            && emergency_braking <= WIRE_ACCELERATION_MAX
            && jerk.over(self.period.fine_seconds()) > LEAST_STEP
            && jerk <= Jerk::from_mm_per_s3(51_150);
        if holds { Ok(()) } else { Err(ConfigError::Limits) }
    }

    fn check_law(&self) -> Result<(), ConfigError> {
        let law = &self.law;
        let ensure = |holds: bool, error: ConfigError| if holds { Ok(()) } else { Err(error) };
        let gaps = Seconds::from_millis(100)..=Seconds::from_millis(3995);
        ensure(gaps.contains(&law.time_gap) && gaps.contains(&law.silent_time_gap), ConfigError::TimeGap)?;
        ensure((Distance::ZERO..=Distance::from_mm(10_230)).contains(&law.standstill), ConfigError::Standstill)?;
        let gains = Gain::from_milli(10)..=Gain::from_milli(3999);
        let dampings = Seconds::ZERO..=Seconds::from_millis(3999);
        ensure(gains.contains(&law.gain) && dampings.contains(&law.damping), ConfigError::Gain)?;
        let shortest = self.prediction.step.min(self.period);
        let is_fed = law.feed_forward == parameters::FEED_FORWARD && shortest >= FEED_FORWARD_STEP;
        ensure(law.feed_forward == Fraction::ZERO || is_fed, ConfigError::FeedForward)?;
        let speeds = Speed::ZERO..=WIRE_SPEED_MAX;
        ensure(speeds.contains(&law.target_speed) && speeds.contains(&law.max_speed), ConfigError::Speed)?;
        let is_told_exactly = Fraction::from_steps(law.catch_up.to_steps(20), 20) == law.catch_up;
        let catch_ups = Fraction::ZERO..=Fraction::from_milli(750);
        ensure(catch_ups.contains(&law.catch_up) && is_told_exactly, ConfigError::CatchUp)?;
        let free = parameters::FREE_ROAD_ACCELERATION_MIN..=self.limits.acceleration;
        ensure(free.contains(&law.free_road_acceleration), ConfigError::FreeRoad)?;
        ensure(
            crate::model::follower::is_stable(law.gain, law.damping, law.time_gap, self.prediction.step),
            ConfigError::Unstable,
        )
    }
}
