//! The controller: the ego's state and the estimate of its target at now enter, the demanded acceleration leaves.
//!
//! Eqs 5 and 7 with the *estimate at now*, never the stale sample. The law is taken over the unit's own period as the same
//! semi-implicit step that the prediction takes over `δt` (see [`crate::model::Follower`]): at 10 ms it differs from
//! eq. 7 by less than 1 % in gain, and the model that others predict this vehicle with is the controller it drives by.

mod blend;
mod gain_table;
mod gains;
mod mode;

pub use blend::{BLEND, Blend, keep_over};
pub use gains::Gains;
pub use mode::{Facts, FallbackCause, FaultCause, Mode, TargetFact};

use crate::config::Config;
use crate::held::Held;
use crate::model::{Consensus, Follower, Leader, Reading, State, Stride, TargetStep, VehicleModel};
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};

/// What the controller drives by in one tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// The ego's own law: free road, or behind a target whose reading is of one period from now.
    Law {
        /// How the ego drives.
        vehicle: VehicleModel,
        /// The target.
        target: Option<Target>,
        /// No more acceleration than this, whatever the law asks for.
        cap: Acceleration,
    },
    /// Adaptive cruise control: behind what is still known, seen from the rear bumper of the vehicle ahead, and no faster than
    /// the free road would be driven.
    Cruise {
        /// Rear bumper and speed of the vehicle ahead.
        ahead: Reading,
        /// `v_∞`.
        target_speed: Speed,
    },
    /// Braking that grows slowly while nothing is known, or while nobody says what is wanted; more of it if what is still
    /// known ahead asks for that.
    GrowingBraking {
        /// As in `Cruise`.
        ahead: Option<Reading>,
        /// Since when the braking has grown, if that was before this course.
        since: Option<Instant>,
    },
    /// Braking as hard as is normal.
    Brake,
    /// Someone else drives; the unit keeps up with what is demanded.
    Yield {
        /// The demand in force.
        demand: Acceleration,
    },
}

/// The target as the law sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// Where it is one period from now.
    pub reading: Reading,
    /// By how much its speed grows until then.
    pub gained: Speed,
    /// Its length.
    pub length: Distance,
}

/// The controller's memory: the last demand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Controller {
    demand: Acceleration,
    blend: Blend,
    keep: Fraction,
    period: FineSeconds,
    /// Since when the braking grows.
    grows_since: Option<Instant>,
    /// The step of the law that was driven by last, which is made of a vehicle model and a length.
    stride: Held<(VehicleModel, Distance, Stride)>,
}

/// Growth of the braking while nothing is known: 0.5 m/s² more every second, so that a target that is heard at once costs nothing and
/// one that is not costs comfort first.
const BRAKING_GROWTH: Jerk = Jerk::from_mm_per_s3(500);

/// The cruise control. Softer than the cooperative law and with a longer time gap, because nothing is known of what the vehicle ahead
/// intends: overdamped (poles at -0.23 and -0.65 /s).
const CRUISE: Consensus = Consensus {
    gain: Gain::from_milli(150),
    damping: Seconds::from_millis(3_999),
    time_gap: crate::parameters::SILENT_TIME_GAP,
    feed_forward: Fraction::ZERO,
};

/// Within this time a vehicle at its speed limit closes on it.
const SPEED_LIMIT_TIME: i64 = 2;

impl Controller {
    /// Not started: all zero.
    pub(crate) const fn idle() -> Self {
        Self {
            demand: Acceleration::ZERO,
            blend: Blend::NONE,
            keep: Fraction::ZERO,
            period: FineSeconds::ZERO,
            grows_since: None,
            stride: Held::Nothing,
        }
    }

    /// At rest.
    #[must_use]
    pub fn new(period: Duration) -> Self {
        Self { keep: keep_over(period), period: period.fine_seconds(), ..Self::idle() }
    }

    /// The demand in force.
    #[must_use]
    pub const fn last_demand(&self) -> Acceleration {
        self.demand
    }

    /// What was really commanded, if something after the controller changed its demand.
    pub fn correct(&mut self, commanded: Acceleration) {
        self.demand = commanded;
    }

    /// Leads the controller from what it would have seen to what news after a silence says of the same instant.
    pub fn blend_from(&mut self, estimate_before: Reading, estimate_after: Reading) {
        self.blend = Blend::from(self.blend.apply(estimate_before), estimate_after);
    }

    /// The demand of this tick.
    pub fn drive(&mut self, config: &Config, now: Instant, ego: Option<&State>, course: &Course) -> Acceleration {
        self.blend = self.blend.faded(self.keep);
        if !matches!(course, Course::GrowingBraking { .. }) {
            self.grows_since = None;
        }
        self.demand = match (course, ego) {
            (Course::Yield { demand }, _) => {
                self.blend = Blend::NONE;
                *demand
            }
            (Course::Law { vehicle, target, cap }, Some(ego)) => self.by_law(config, vehicle, ego, *target, *cap),
            (Course::Cruise { ahead, target_speed }, Some(ego)) => self.cruise(config, ego, ahead, *target_speed),
            (Course::GrowingBraking { ahead, since }, ego) => {
                let since = *self.grows_since.get_or_insert(since.unwrap_or(now));
                let slowing = slowing(config, now.since(since));
                let behind = ego.zip(*ahead).map(|(ego, ahead)| behind(config, ego, &ahead));
                self.slewed(config, behind.map_or(slowing, |behind| behind.min(slowing)))
            }
            (Course::Brake | Course::Law { .. } | Course::Cruise { .. }, _) => {
                self.slewed(config, config.limits.braking.negated())
            }
        };
        self.demand
    }

    fn by_law(
        &mut self,
        config: &Config,
        vehicle: &VehicleModel,
        ego: &State,
        target: Option<Target>,
        cap: Acceleration,
    ) -> Acceleration {
        let length = target.map_or(Distance::ZERO, |target| target.length);
        let is_same = |(same, same_length, _): &(_, _, _)| same == vehicle && *same_length == length;
        if !self.stride.as_ref().is_some_and(is_same) {
            self.stride.set((*vehicle, length, vehicle.over(config.period, length, &config.prediction.model)));
        }
        let Held::Value((_, _, stride)) = &self.stride else { return Acceleration::ZERO };
        let ahead = target.map(|Target { reading, gained, .. }| {
            let seen = self.blend.apply(reading);
            TargetStep { position: seen.position.ring(), speed: seen.speed, gained }
        });
        let demand = stride.demand(ego, ahead, speed_cap(config.law.max_speed, ego.speed)).min(cap);
        if !config.prediction.model.limits {
            return demand;
        }
        // The law's own limit on jerk does not hold where the last demand was outside the law's limits: emergency braking is
        // let off as fast as it is built up, what the driver left is led over as comfort wants it.
        let jerk = config.envelope.map_or(config.limits.jerk, |envelope| envelope.jerk.max(config.limits.jerk));
        self.slewed_by(jerk, demand)
    }

    /// A plain ACC law: constant time gap on what a sensor sees, or on the worst that is certain, without any prediction. Where
    /// that asks for more than Algorithm 2 does at the speed that the driver wants, Algorithm 2 is driven by.
    fn cruise(&self, config: &Config, ego: &State, ahead: &Reading, target_speed: Speed) -> Acceleration {
        let desired = behind(config, ego, ahead);
        let limits = config.limits;
        let free = Leader::new(config.law.free_road_acceleration, target_speed).desired(ego.speed);
        let capped = desired.min(free).min(speed_cap(config.law.max_speed, ego.speed));
        self.slewed(config, capped.limited(limits.braking.negated(), limits.acceleration))
    }

    fn slewed(&self, config: &Config, desired: Acceleration) -> Acceleration {
        self.slewed_by(config.limits.jerk, desired)
    }

    fn slewed_by(&self, jerk: Jerk, desired: Acceleration) -> Acceleration {
        let slew = jerk.over(self.period);
        desired.limited(self.demand.minus(slew), self.demand.plus(slew))
    }
}

/// What the law of the cruise control asks for behind this rear bumper, within the limits of normal driving.
fn behind(config: &Config, ego: &State, ahead: &Reading) -> Acceleration {
    let consensus = Consensus { time_gap: CRUISE.time_gap.max(config.law.time_gap), ..CRUISE };
    let law = Follower::over(config.period, &consensus, config.law.standstill, None);
    let ahead = TargetStep { position: ahead.position.ring(), speed: ahead.speed, gained: Speed::ZERO };
    let desired = law.desired(ego, &ahead);
    desired.limited(config.limits.braking.negated(), config.limits.acceleration)
}

/// The demand after it has grown for so long, no harder than normal braking.
#[must_use]
pub fn slowing(config: &Config, since: Duration) -> Acceleration {
    growth(since).min(config.limits.braking).negated()
}

/// Braking after it has grown for so long, saturating after 2 s steps.
fn growth(since: Duration) -> Acceleration {
    let tenths = since.as_micros().max(0) / 100_000;
    let tenth = BRAKING_GROWTH.over(FineSeconds::from_millis(100));
    Acceleration::from_bits(crate::fixed::saturate_i32(i64::from(tenth.to_bits()).saturating_mul(tenths)))
}

/// The largest acceleration that keeps within a speed limit, approached in [`SPEED_LIMIT_TIME`]⁻¹ s.
fn speed_cap(limit: Speed, speed: Speed) -> Acceleration {
    // 23 to 25 fraction bits is a factor of 4; over half a second one of 2.
    let left = i64::from(limit.minus(speed).to_bits());
    Acceleration::from_bits(crate::fixed::saturate_i32(left.saturating_mul(4).saturating_mul(SPEED_LIMIT_TIME)))
}

#[cfg(test)]
mod tests;
