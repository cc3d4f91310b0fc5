//! A vehicle's state at an instant of the unit's own clock: a motion message with its stamp and position unwrapped.

use crate::health::Cause;
use crate::parameters::{ACCURACY_FACTOR, UNPUBLISHED_POSITION_ACCURACY, UNPUBLISHED_SPEED_ACCURACY};
use crate::time::{Duration, Instant, Stamp};
use crate::units::{Acceleration, Distance, Position, Speed};
use crate::wire::StationHash;
use crate::wire::motion::Motion;

/// Checks that a state at `at`, received at `received`, is neither older than `stale` nor further in the future than `future`.
///
/// # Errors
/// [`Cause::Stale`] and [`Cause::Future`].
pub fn timely(at: Instant, received: Instant, stale: Duration, future: Duration) -> Result<(), Cause> {
    let age = received.since(at);
    if age > stale {
        return Err(Cause::Stale);
    }
    if age < Duration::ZERO.minus(future) {
        return Err(Cause::Future);
    }
    Ok(())
}

/// One sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sample {
    /// The instant at which it was true.
    pub at: Instant,
    /// When it was received.
    pub received: Instant,
    /// Its raw stamp, by which duplicates are recognised.
    pub stamp: Stamp,
    /// Front bumper.
    pub position: Position,
    /// Speed, not negative.
    pub speed: Speed,
    /// Acceleration.
    pub acceleration: Acceleration,
    /// Acceleration demanded up to then.
    pub demand: Acceleration,
    /// 95 % accuracy of the position, if published.
    pub position_accuracy: Option<Distance>,
    /// 95 % accuracy of the speed, if published.
    pub speed_accuracy: Option<Speed>,
    /// Whether `at` is by its stamp. Without GNSS time it is only by the time of reception.
    pub is_timed: bool,
    /// The station that it is of.
    pub station: StationHash,
    /// The tag, which ties the sample to the horizon that was computed from it.
    pub tag: u8,
}

impl Sample {
    /// At rest at the origin, of no station: for an ego of which nothing has been heard.
    pub const UNKNOWN: Self = Self {
        at: Instant::ZERO,
        received: Instant::ZERO,
        stamp: Stamp::from_raw(0),
        position: Position::ZERO,
        speed: Speed::ZERO,
        acceleration: Acceleration::ZERO,
        demand: Acceleration::ZERO,
        position_accuracy: None,
        speed_accuracy: None,
        is_timed: false,
        station: StationHash(0),
        tag: 0,
    };

    /// The largest error of its position: [`ACCURACY_FACTOR`] times what 95 % of the errors are below.
    #[must_use]
    pub fn position_error(&self) -> Distance {
        self.position_accuracy.map_or(UNPUBLISHED_POSITION_ACCURACY, largest_error)
    }

    /// The largest error of its speed, likewise.
    #[must_use]
    pub fn speed_error(&self) -> Speed {
        self.speed_accuracy.map_or(UNPUBLISHED_SPEED_ACCURACY, largest_speed_error)
    }

    /// Of a motion message whose stamp was at `at`, near a position known otherwise.
    #[must_use]
    pub fn of(motion: &Motion, at: Instant, received: Instant, near: Option<Position>) -> Self {
        let position = match near {
            Some(reference) => motion.position.nearest_to(reference),
            None => motion.position.face_value(),
        };
        Self {
            at,
            received,
            stamp: motion.stamp,
            position,
            speed: motion.speed,
            acceleration: motion.acceleration,
            demand: motion.demand,
            position_accuracy: motion.position_accuracy,
            speed_accuracy: motion.speed_accuracy,
            is_timed: true,
            station: motion.station,
            tag: motion.tag,
        }
    }
}

/// Of a sample, what tells it apart from others: by this a duplicate is known, and the sample to which a horizon belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Heard {
    /// The instant at which it was true.
    pub at: Instant,
    /// When it was received.
    pub received: Instant,
    /// Its raw stamp.
    pub stamp: Stamp,
    /// Its tag.
    pub tag: u8,
}

impl Heard {
    /// Of a sample.
    #[must_use]
    pub const fn of(sample: &Sample) -> Self {
        Self { at: sample.at, received: sample.received, stamp: sample.stamp, tag: sample.tag }
    }

    /// Whether another sample has the same stamp in the same turn of the stamp, which repeats every 13.1 s.
    #[must_use]
    pub fn is_again(&self, sample: &Sample) -> bool {
        let is_same_turn = || {
            let apart = self.at.since(sample.at);
            apart < Duration::from_millis(6_000) && apart > Duration::from_millis(-6_000)
        };
        self.stamp == sample.stamp && is_same_turn()
    }
}

/// By how much the largest error of a distance with this accuracy exceeds the accuracy. Whether there is room for another vehicle is
/// asked without it: several accuracies would have to be exceeded at once, all in one direction.
#[must_use]
pub const fn excess(accuracy: Option<Distance>) -> Distance {
    match accuracy {
        Some(accuracy) => largest_error(accuracy).minus(accuracy),
        None => Distance::ZERO,
    }
}

/// The largest error of a distance with this accuracy.
#[must_use]
pub const fn largest_error(accuracy: Distance) -> Distance {
    Distance::from_bits(accuracy.to_bits().saturating_mul(ACCURACY_FACTOR as i32))
}

/// The largest error of a speed with this accuracy.
#[must_use]
pub const fn largest_speed_error(accuracy: Speed) -> Speed {
    Speed::from_bits(accuracy.to_bits().saturating_mul(ACCURACY_FACTOR as i32))
}
