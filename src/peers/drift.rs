//! Drift. The samples of a station, one after the other, enter; whether its positions fit its speeds over all of them leaves.
//!
//! The place of a vehicle follows from its place before and from the speeds between. The way over a gap is the mean of the speeds at both
//! ends. To either side there are the errors of both speeds, and the bulge: how far the fastest change from one speed to the other within
//! the limits departs from the mean. So the place is known within an interval. The interval is carried on from sample to sample, and cut
//! by the interval of each sample alone. A sample that leaves nothing of it does not fit. To cut it each time is as much as to compare
//! every sample with every sample before it.
//!
//! With accelerations between `-b` and `a`, the bulge over a gap of `T`, between speeds of the slope `s`, is
//! `(a - s) (b + s) / (a + b) · T²/2`. The errors of both speeds count fully and not twice: if the error at one end were less, the bulge
//! would grow, but by less than the mean falls, as long as `-b <= s <= a`.
//!
//! So a drift is found if it is faster than the sum of the published accuracy of the speed and `a b / (a + b) · T/2`. The latter is 0.1
//! m/s for a car of 2.5 and 8 m/s² that is heard at 10 Hz. It is found when its excess of speed has made up twice the accuracy of the
//! position. A slower drift is inside what the station says of itself.

use super::Sample;
use crate::fixed::{quotient, saturate_i32};
use crate::health::Cause;
use crate::model::bound::{AccelerationRange, Uncertainty};
use crate::parameters::{SPEED_ROUNDING, UNPUBLISHED_SPEED_ACCURACY};
use crate::time::Duration;
use crate::units::{Acceleration, Distance, Position, Seconds, Speed};

/// Over a longer gap the bulge says nothing any more. The course begins anew.
const LONGEST_GAP: Duration = Duration::from_millis(500);
/// If the instant of a sample is less certain than this, as without synchronisation, there is no course.
const LEAST_CERTAIN: Duration = Duration::from_millis(20);
/// One error of a speed in twenty is larger than the accuracy. By such errors in a row of normal ones, the way by the speeds is wrong by
/// more than the accuracy allows, but hardly ever by more than the accuracy's way in this time: with messages at 10 Hz 6 standard
/// deviations make 0.23 s of it.
const SELDOM: Seconds = Seconds::from_millis(300);
/// What fixed-point arithmetic loses over a gap, and much more.
const ROUNDING: Distance = Distance::from_bits(16);

/// The interval in which a station is, at the stamp of its newest sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Course {
    low: Position,
    high: Position,
}

impl Course {
    /// The course by a single sample.
    fn of(sample: &Sample, uncertainty: &Uncertainty, off: Speed) -> Self {
        let moved = sample.speed.plus(off).over(uncertain(uncertainty).seconds());
        let seldom = sample.speed_accuracy.map_or(Distance::ZERO, |accuracy| accuracy.over(SELDOM));
        let off = uncertainty.position.plus(moved).plus(seldom).plus(ROUNDING);
        Self { low: sample.position.ahead(off.negated()), high: sample.position.ahead(off) }
    }

    /// The same course, moved ahead by this way.
    #[must_use]
    pub fn shifted(&self, way: Distance) -> Self {
        Self { low: self.low.ahead(way), high: self.high.ahead(way) }
    }

    /// The course after a sample, from the course at the sample before it; `None` if the course begins anew with the next sample.
    ///
    /// # Errors
    /// [`Cause::Implausible`]: nothing is left of the interval, because the positions do not fit the speeds.
    pub fn after(
        held: Option<&Self>,
        last: Option<&Sample>,
        sample: &Sample,
        uncertainty: &Uncertainty,
        reach: &AccelerationRange,
    ) -> Result<Option<Self>, Cause> {
        if uncertain(uncertainty) > LEAST_CERTAIN {
            return Ok(None);
        }
        let faster = reach.acceleration.max(reach.braking).over(uncertain(uncertainty).fine_seconds());
        let off = off(sample, faster);
        let own = Self::of(sample, uncertainty, off);
        let (Some(held), Some(last)) = (held, last) else { return Ok(Some(own)) };
        let gap = sample.at.since(last.at);
        if gap <= Duration::ZERO || gap > LONGEST_GAP {
            return Ok(Some(own));
        }
        let off_before = self::off(last, faster);
        let mean =
            |one: Speed, other: Speed| Speed::from_bits(one.to_bits() / 2).plus(Speed::from_bits(other.to_bits() / 2));
        let way = mean(last.speed, sample.speed).over(gap.seconds());
        let slope = (off == off_before).then(|| slope(last.speed, sample.speed, gap));
        let either = mean(off_before, off).over(gap.seconds()).plus(bulge(reach, slope, gap)).plus(ROUNDING);
        let low = held.low.ahead(way).ahead(either.negated()).max(own.low);
        let high = held.high.ahead(way).ahead(either).min(own.high);
        if low <= high { Ok(Some(Self { low, high })) } else { Err(Cause::Implausible) }
    }
}

/// By how much the sample may be earlier or later than its stamp.
fn uncertain(uncertainty: &Uncertainty) -> Duration {
    uncertainty.earlier.max(uncertainty.later)
}

/// How far off the speed at the stamp may be, if it may have changed by `faster` in the time that is uncertain.
fn off(sample: &Sample, faster: Speed) -> Speed {
    sample.speed_accuracy.unwrap_or(UNPUBLISHED_SPEED_ACCURACY).plus(SPEED_ROUNDING).plus(faster)
}

/// The acceleration with 15 fraction bits, rounded up. Sums and products of a few such values stay below 2⁶³.
fn coarse(acceleration: Acceleration) -> i64 {
    i64::from(acceleration.to_bits()).saturating_add(1023) >> 10
}

/// The slope from one speed to another, in m/s² with 15 fraction bits.
fn slope(from: Speed, to: Speed, gap: Duration) -> i64 {
    let gained = i64::from(to.to_bits()).saturating_sub(from.to_bits().into());
    quotient(gained.saturating_mul(1_000_000), gap.as_micros().max(1)) >> 8
}

/// How much farther, or less far, a vehicle may get in a gap than by the mean of its speeds. If the slope is not known, the most for any
/// slope.
fn bulge(reach: &AccelerationRange, slope: Option<i64>, gap: Duration) -> Distance {
    let (a, b) = (coarse(reach.acceleration), coarse(reach.braking));
    let steepest = a.saturating_sub(b) / 2;
    let s = slope.unwrap_or(steepest).min(a).max(b.saturating_neg());
    let product = a.saturating_sub(s).saturating_mul(b.saturating_add(s));
    let height = quotient(product, a.saturating_add(b).max(1)).saturating_add(2);
    let gained = Acceleration::from_bits(saturate_i32(height.saturating_mul(1 << 10))).over(gap.fine_seconds());
    Speed::from_bits(gained.to_bits() / 2).over(gap.seconds()).plus(ROUNDING)
}
