//! The unit's configuration: plain typed values enter, and are checked once at start with a named error.
//!
//! It is immutable afterwards, `Copy`, holds no pointer, and can therefore lie in a calibration section.

mod check;

pub use crate::model::Model;
pub use check::ConfigError;

use crate::model::{Aim, Body, Consensus, VehicleModel};
use crate::parameters;
use crate::time::Duration;
use crate::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};
use crate::wire::driving_parameters::Limits;
use crate::wire::{Identifiers, StationHash, Transport};

/// The prediction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Prediction {
    /// Prediction step, `δt`; 1 ms to 1 s.
    pub step: Duration,
    /// How far ahead; at least two steps, and two steps less than the capacity.
    pub horizon: Duration,
    /// What is in the model.
    pub model: Model,
}

/// The law of eqs 5 and 7.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Law {
    /// Desired time gap, `t_g`; 0.1 to 3.995 s.
    pub time_gap: Seconds,
    /// Time gap to which that opens, slowly, while the vehicle ahead is neither heard nor seen; 0.1 to 3.995 s. It closes again with news.
    /// If it is no larger than the gap in force, the gap does not open. See [`parameters::OPENS_AFTER`] and [`parameters::OPENS_BY`].
    pub silent_time_gap: Seconds,
    /// Distance kept at standstill, `s_0`; 0 to 10.23 m.
    pub standstill: Distance,
    /// Whether the gains come from the tables of eq. 6, which are proved with lags up to 0.5 s and time gaps up to 2 s: without
    /// feed-forward from 1 s on, and with it from 0.7 s on. Otherwise they are the following two. Where there is no association the two are
    /// what is published.
    pub table: bool,
    /// Gain `k`; 0.01 to 3.999 /s².
    pub gain: Gain,
    /// Damping `γ`; 0 to 3.999 s.
    pub damping: Seconds,
    /// Share of the predecessor's acceleration that is passed on, `φ`: 0 or 0.5. The latter needs a step and a period of at least
    /// 7.813 ms ([`FEED_FORWARD_STEP`]).
    ///
    /// [`FEED_FORWARD_STEP`]: crate::model::follower::FEED_FORWARD_STEP
    pub feed_forward: Fraction,
    /// Largest acceleration on a free road, `a_max` of eq. 8.
    pub free_road_acceleration: Acceleration,
    /// Speed wanted on a free road until `DriverRequest` says otherwise, `v_∞`.
    pub target_speed: Speed,
    /// Share by which the ego may exceed that speed to catch up with the vehicle that it follows; 0 to 0.75 by 0.05, as it is
    /// published. At 0 the speed is a cap.
    pub catch_up: Fraction,
    /// Speed never demanded beyond.
    pub max_speed: Speed,
}

impl Law {
    /// The law of eq. 5 with the two gains that are configured.
    #[must_use]
    pub const fn consensus(&self) -> Consensus {
        let Self { gain, damping, time_gap, feed_forward, .. } = *self;
        Consensus { gain, damping, time_gap, feed_forward }
    }
}

/// What counts as a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Link {
    /// Period with which the unit's own messages are sent, and a peer's until its own is measured.
    pub period: Duration,
    /// The link is off when no valid message came for a period and this.
    pub tolerance: Duration,
    /// Older stamps are refused; at most 10 s.
    pub stale: Duration,
    /// Stamps further in the future are refused; at least `clock_error`, below 1 s.
    pub future: Duration,
    /// Between a sender's stamp and the unit's own clock there is no more error than this while the unit is synchronised:
    /// both clocks' errors and the stamp's rounding.
    pub clock_error: Duration,
    /// A slot may be taken over by another station after this much silence.
    pub slot_reuse: Duration,
    /// Age up to which a target's estimate is driven by.
    pub holdover: Duration,
    /// Age up to which the ego's own motion is usable.
    pub ego_timeout: Duration,
    /// Age up to which the driver's request holds.
    pub request_timeout: Duration,
    /// Age up to which a synchronisation holds.
    pub sync_timeout: Duration,
    /// Delay assumed while there is no synchronisation.
    pub assumed_delay: Duration,
}

/// The limits of the last gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Envelope {
    /// Largest acceleration ever commanded.
    pub acceleration: Acceleration,
    /// Hardest braking ever commanded, as a magnitude: what the vehicle is sure to be capable of.
    pub braking: Acceleration,
    /// Fastest change ever commanded, that of emergency braking.
    pub jerk: Jerk,
    /// No acceleration at or beyond this speed.
    pub speed: Speed,
    /// What is left between the bumpers when both have come to rest.
    pub margin: Distance,
    /// How long a command may stay in force beyond its period: the next one's way to the actuators, and ticks that were missed
    /// in a row; 0 to 0.5 s.
    pub delay: Duration,
    /// Share of the configured lag by which the real one may be longer or shorter; 0 to 1.
    pub lag_tolerance: Fraction,
}

impl Envelope {
    /// A car's: 3 m/s², emergency braking of 8 m/s² built up at 25 m/s³, 50 m/s, half a metre; three ticks of 10 ms, a quarter
    /// of the lag.
    pub const CAR: Self = Self {
        acceleration: Acceleration::from_mm_per_s2(3_000),
        braking: Acceleration::from_mm_per_s2(8_000),
        jerk: Jerk::from_mm_per_s3(25_000),
        speed: Speed::from_mm_per_s(50_000),
        margin: Distance::from_mm(500),
        delay: Duration::from_millis(30),
        lag_tolerance: Fraction::from_milli(250),
    };
}

/// Everything that the unit has to be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Config {
    /// The ego's own station.
    pub station: StationHash,
    /// The whole identity of the ego's station, of which `station` is the low 8 bits. At intersections no two vehicles have the same.
    pub station_id: u32,
    /// Where each message of the catalogue lies on the bus.
    pub identifiers: Identifiers,
    /// Which frames the bus carries.
    pub transport: Transport,
    /// Period of the task that calls `tick`; 1 to 100 ms.
    pub period: Duration,
    /// Bumper to bumper.
    pub length: Distance,
    /// Time constant of the actuators, `T`; 0 to 1.998 s.
    pub lag: FineSeconds,
    /// Limits of the controller, and of the vehicle.
    pub limits: Limits,
    /// The vehicle of eqs 1-3.
    pub body: Body,
    /// Whether what eq. 1 does not know of, such as a grade, is measured and made up for.
    pub correction: bool,
    /// The law.
    pub law: Law,
    /// The prediction.
    pub prediction: Prediction,
    /// The link.
    pub link: Link,
    /// The last gate. `None` disengages it: for studies only, because nothing certain stands behind a command then.
    pub envelope: Option<Envelope>,
    /// Whether a range sensor is fitted. With one, the gate trusts other vehicles' passes: the sensor sees a vehicle that stays in the
    /// conflict area all the same.
    pub range_sensor: bool,
    /// Whether the unit keeps passes at intersections while its envelope is engaged. Without, it claims none, takes in none, and waits for
    /// the near end of every vehicle that is ahead in the order and crosses its way: for studies, and for an integrator whose modem does
    /// not relay passes.
    pub passes: bool,
}

impl Config {
    /// Of a unit that is not started: all zero, and refused by every check.
    pub(crate) const NONE: Self = Self {
        station: StationHash(0),
        station_id: 0,
        identifiers: Identifiers::NONE,
        transport: Transport::Classic,
        period: Duration::ZERO,
        length: Distance::ZERO,
        lag: FineSeconds::ZERO,
        limits: Limits {
            acceleration: Acceleration::ZERO,
            braking: Acceleration::ZERO,
            jerk: Jerk::ZERO,
            emergency_braking: Acceleration::ZERO,
        },
        body: Body { mass_kg: 0, ratio_milli: 0, drag_milli: 0, friction_milli: 0, mechanical_n: 0 },
        correction: false,
        law: Law {
            time_gap: Seconds::ZERO,
            silent_time_gap: Seconds::ZERO,
            standstill: Distance::ZERO,
            table: false,
            gain: Gain::ZERO,
            damping: Seconds::ZERO,
            feed_forward: Fraction::ZERO,
            free_road_acceleration: Acceleration::ZERO,
            target_speed: Speed::ZERO,
            catch_up: Fraction::ZERO,
            max_speed: Speed::ZERO,
        },
        prediction: Prediction { step: Duration::ZERO, horizon: Duration::ZERO, model: Model::PAPER },
        link: Link {
            period: Duration::ZERO,
            tolerance: Duration::ZERO,
            stale: Duration::ZERO,
            future: Duration::ZERO,
            clock_error: Duration::ZERO,
            slot_reuse: Duration::ZERO,
            holdover: Duration::ZERO,
            ego_timeout: Duration::ZERO,
            request_timeout: Duration::ZERO,
            sync_timeout: Duration::ZERO,
            assumed_delay: Duration::ZERO,
        },
        envelope: None,
        range_sensor: false,
        passes: false,
    };

    /// A car: 1,500 kg, 4.8 m, lag 0.3 s, time gap 1.6 s, 100 Hz, the envelope engaged, passes kept, no range sensor. `δt` is 30 ms, and
    /// the horizon of 10.71 s is as long as a message can say, two silences of 4 s in a row, and more. With the two that interpolation
    /// needs these are 359 steps.
    #[must_use]
    pub const fn car(station: StationHash) -> Self {
        Self {
            station,
            station_id: station.0 as u32,
            identifiers: Identifiers::DEFAULT,
            transport: Transport::Classic,
            period: Duration::from_millis(10),
            length: parameters::DEFAULT_LENGTH,
            lag: FineSeconds::from_millis(300),
            limits: Limits {
                acceleration: Acceleration::from_mm_per_s2(2500),
                braking: Acceleration::from_mm_per_s2(4000),
                jerk: Jerk::from_mm_per_s3(5000),
                emergency_braking: Acceleration::from_mm_per_s2(8000),
            },
            body: Body::CAR,
            correction: true,
            law: Law {
                time_gap: parameters::TIME_GAP,
                silent_time_gap: parameters::SILENT_TIME_GAP,
                standstill: Distance::from_mm(2000),
                table: true,
                gain: parameters::GAIN,
                damping: parameters::DAMPING,
                feed_forward: Fraction::ZERO,
                free_road_acceleration: parameters::FREE_ROAD_ACCELERATION,
                target_speed: Speed::from_mm_per_s(13_400),
                catch_up: Fraction::ZERO,
                max_speed: Speed::from_mm_per_s(50_000),
            },
            prediction: Prediction {
                step: Duration::from_millis(30),
                horizon: Duration::from_millis(10_710),
                model: Model::HOLDOVER,
            },
            link: Link {
                period: Duration::from_millis(100),
                tolerance: Duration::from_millis(150),
                stale: parameters::STALE_MAX,
                future: Duration::from_millis(5),
                clock_error: Duration::from_micros(500),
                slot_reuse: Duration::from_millis(2000),
                holdover: Duration::from_millis(15_000),
                ego_timeout: Duration::from_millis(50),
                request_timeout: Duration::from_millis(300),
                sync_timeout: Duration::from_millis(5000),
                assumed_delay: Duration::from_millis(40),
            },
            envelope: Some(Envelope::CAR),
            range_sensor: false,
            passes: true,
        }
    }

    /// The same vehicle with a range sensor, at the time gap that a sensor allows: [`parameters::TIME_GAP_WITH_SENSOR`], with
    /// [`parameters::FEED_FORWARD`]. That gap is a car's. A van of 4 m/s³ needs 1 s, and a bus of 2.5 m/s³ 1.4 s and no feed-forward.
    #[must_use]
    pub const fn with_range_sensor(mut self) -> Self {
        self.range_sensor = true;
        self.law.time_gap = parameters::TIME_GAP_WITH_SENSOR;
        self.law.feed_forward = parameters::FEED_FORWARD;
        self
    }

    /// How the ego drives when this is what it is after.
    #[must_use]
    pub const fn vehicle_model(&self, aim: Aim) -> VehicleModel {
        VehicleModel { aim, lag: Duration::of_fine_seconds(self.lag), limits: self.limits }
    }

    /// Steps that a horizon of this configuration holds: two more than it is long, for the interpolation at both ends.
    #[must_use]
    pub const fn steps(&self) -> usize {
        let step = self.prediction.step.as_micros();
        if step <= 0 {
            return 0;
        }
        #[allow(clippy::arithmetic_side_effects, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        // the divisor is positive, and a quotient beyond the capacity is refused by `check`
        {
            (self.prediction.horizon.as_micros() / step) as usize + 2
        }
    }
}
