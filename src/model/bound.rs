//! The bound: what is certain of the position and the speed of a vehicle. A sample with its accuracies, and the published limits of the
//! vehicle, enter; the lowest and the highest position and speed at any later instant leave. The true state is between them as long as
//! the sample was within its accuracies and the vehicle keeps to its limits.
//!
//! The two ends are two imagined vehicles. The *near* end was as far back and as slow as the sample allows. It has braked at the
//! vehicle's hardest since then, and stands once it has come to rest. The *far* end was as far ahead and as fast as the sample allows. It
//! has accelerated at the vehicle's hardest since then, up to the top speed. The true vehicle is never behind the near end or ahead of
//! the far end, in position or in speed, because both are monotone in acceleration and in time. The ends are not symmetric: a car brakes
//! harder than it accelerates.
//!
//! Everything is computed in whole micrometres, micrometres per second and microseconds, and rounded away from the true state. Products and
//! sums of speeds stay below 2⁶³ and need not saturate. Speeds are at most 65.534e6; a single word makes at most 2.6e8 of them, and two
//! words 5.2e8. Accelerations are at most 6.4e7. The times for which they last are cut at an hour, 3.6e9. Positions are exact within
//! ±560,000 km. All of this is proved over the whole range in `proof` below this module.

use crate::fixed::{per_15_625, per_million, quotient};
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Position, Speed};
use crate::wire::driving_parameters::Limits;

/// The top speed: the highest that the wire can say, in µm/s.
const TOP_SPEED: i64 = 65_534_000;
/// After an hour the far end says nothing any more.
const LONGEST: i64 = 3_600_000_000;
const MICRO: i64 = 1_000_000;

/// How fast a vehicle can change its speed, as magnitudes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AccelerationRange {
    /// Hardest acceleration.
    pub acceleration: Acceleration,
    /// Hardest braking.
    pub braking: Acceleration,
}

impl AccelerationRange {
    /// The worst limits: what is physically possible for any road vehicle on a dry road. They hold where nothing was published.
    pub const WORST: Self =
        Self { acceleration: Acceleration::from_mm_per_s2(6_000), braking: Acceleration::from_mm_per_s2(12_000) };

    /// No change of speed at all.
    pub const NONE: Self = Self { acceleration: Acceleration::ZERO, braking: Acceleration::ZERO };

    /// The harder of two ranges, in each direction.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        Self { acceleration: self.acceleration.max(other.acceleration), braking: self.braking.max(other.braking) }
    }

    /// As published, braking by the harder of the two that are. It is not less than 0.1 m/s² each, so that coming to rest takes finite
    /// time. A vehicle that accelerates as hard as it has published may have a little more than that, because the effort is commanded in
    /// steps.
    #[must_use]
    pub fn published(limits: &Limits) -> Self {
        const LEAST: Acceleration = Acceleration::from_mm_per_s2(100);
        const EFFORT_STEP: Acceleration = Acceleration::from_mm_per_s2(10);
        let braking = limits.emergency_braking.max(limits.braking);
        let acceleration = limits.acceleration.plus(EFFORT_STEP);
        Self { acceleration: acceleration.max(LEAST), braking: braking.max(LEAST) }
    }
}

/// What is uncertain about a sample at its stamp.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Uncertainty {
    /// Position, to either side.
    pub position: Distance,
    /// Speed, to either side.
    pub speed: Speed,
    /// By how much the sample may really be earlier than the instant taken for it.
    pub earlier: Duration,
    /// By how much it may be later; negative if it is certainly earlier.
    pub later: Duration,
}

/// One end of the bound: a position in µm and a speed in µm/s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct End {
    position: i64,
    speed: i64,
}

impl End {
    /// The end after braking for `micros`, rounded down. Whether it has come to rest by then, `micros >= ⌈v/a⌉`, is found without a
    /// division.
    fn braked(self, micros: i64, braking: Acceleration) -> Self {
        let braking = micro_up(braking.to_bits(), 25).max(1);
        let could_lose = braking.wrapping_mul(micros);
        if could_lose >= self.speed.wrapping_mul(MICRO) {
            // v²/2a: speeds below 2²⁶ squared stay below 2⁵².
            let way = floor(self.speed.wrapping_mul(self.speed), braking.wrapping_mul(2));
            return Self { position: self.position.saturating_add(way), speed: 0 };
        }
        let lost = millionths_up(could_lose).min(self.speed);
        let way = millionths(self.speed.wrapping_mul(2).wrapping_sub(lost).wrapping_mul(micros)) / 2;
        Self { position: self.position.saturating_add(way), speed: self.speed.wrapping_sub(lost) }
    }

    /// The end after accelerating for `micros` up to the top speed, rounded up.
    fn accelerated(self, micros: i64, acceleration: Acceleration) -> Self {
        let acceleration = micro_up(acceleration.to_bits(), 25).max(1);
        let to_gain = TOP_SPEED.wrapping_sub(self.speed).max(0).wrapping_mul(MICRO);
        // The top speed is reached after ⌈gain/a⌉. This is divided out only if it is before the end.
        let rises_on = acceleration.wrapping_mul(micros.wrapping_sub(1)) < to_gain;
        let rising = if rises_on { micros } else { micros.min(ceil(to_gain, acceleration)) };
        let gained = millionths_up(acceleration.wrapping_mul(rising));
        let twice = self.speed.wrapping_mul(2).wrapping_add(gained).wrapping_mul(rising);
        let way = half_up(millionths_up(twice));
        let speed = self.speed.wrapping_add(gained).min(TOP_SPEED.max(self.speed));
        let rest = millionths_up(speed.wrapping_mul(micros.wrapping_sub(rising)));
        Self { position: self.position.saturating_add(way).saturating_add(rest), speed }
    }
}

/// The bound at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Bound {
    at: Instant,
    near: End,
    far: End,
}

impl Bound {
    /// At the origin of time and place: all zero.
    pub const ZERO: Self =
        Self { at: Instant::ZERO, near: End { position: 0, speed: 0 }, far: End { position: 0, speed: 0 } };

    /// The bound around a sample that is taken to be of `at`. The bound is at `at`, or at the latest instant that the sample may really
    /// be from.
    #[must_use]
    pub fn around(
        at: Instant,
        position: Position,
        speed: Speed,
        uncertainty: &Uncertainty,
        reach: &AccelerationRange,
    ) -> Self {
        let position = micro_position(position);
        let off = micro_up(uncertainty.position.to_bits(), 20);
        let faster = micro_up(uncertainty.speed.to_bits(), 23);
        let slow = micro_down(speed.to_bits(), 23).saturating_sub(faster).max(0);
        let fast = micro_up(speed.to_bits(), 23).saturating_add(faster).max(0);
        let near = End { position: position.0.saturating_sub(off), speed: slow };
        let far = End { position: position.1.saturating_add(off), speed: fast };
        // At the earliest instant the far end is farthest ahead. At the latest instant the near end is farthest back. The speeds may have
        // changed during all of the time in doubt, in either direction.
        let whole = uncertainty.earlier.plus(uncertainty.later).as_micros().clamp(0, LONGEST);
        let slower = near.braked(whole, reach.braking);
        Self {
            at: at.plus(uncertainty.later),
            near: End { position: near.position, speed: slower.speed },
            far: far.accelerated(whole, reach.acceleration),
        }
    }

    /// The bound of a vehicle of which nothing is known but that it is not behind this position.
    #[must_use]
    pub fn not_behind(at: Instant, position: Position) -> Self {
        let near = End { position: micro_position(position).0, speed: 0 };
        Self { at, near, far: End { position: i64::MAX, speed: TOP_SPEED } }
    }

    /// The instant that the bound is at.
    #[must_use]
    pub const fn at(&self) -> Instant {
        self.at
    }

    /// The bound moved ahead by this way, rounded outward.
    #[must_use]
    pub fn shifted(&self, way: Distance) -> Self {
        let shift = |end: End, micros: i64| End { position: end.position.saturating_add(micros), ..end };
        let (near, far) = (micro_down(way.to_bits(), 20), micro_up(way.to_bits(), 20));
        Self { near: shift(self.near, near), far: shift(self.far, far), ..*self }
    }

    /// The bound at a later instant. At an earlier instant it is unchanged.
    #[must_use]
    pub fn after(&self, now: Instant, reach: &AccelerationRange) -> Self {
        let micros = now.since(self.at).as_micros();
        if micros <= 0 {
            return *self;
        }
        let far = if micros > LONGEST {
            End { position: i64::MAX, speed: TOP_SPEED }
        } else {
            self.far.accelerated(micros, reach.acceleration)
        };
        Self { at: now, near: self.near.braked(micros.min(LONGEST), reach.braking), far }
    }

    /// The intersection of both bounds, at the later instant; `None` if they contradict one another.
    #[must_use]
    pub fn and(&self, other: &Self, reach: &AccelerationRange) -> Option<Self> {
        let at = self.at.max(other.at);
        let (a, b) = (self.after(at, reach), other.after(at, reach));
        let near = End { position: a.near.position.max(b.near.position), speed: a.near.speed.max(b.near.speed) };
        let far = End { position: a.far.position.min(b.far.position), speed: a.far.speed.min(b.far.speed) };
        (near.position <= far.position && near.speed <= far.speed).then_some(Self { at, near, far })
    }

    /// Whether no vehicle can be in both bounds, by its position at the later instant.
    #[must_use]
    pub fn is_apart_from(&self, other: &Self, reach: &AccelerationRange) -> bool {
        let at = self.at.max(other.at);
        let (a, b) = (self.after(at, reach), other.after(at, reach));
        a.near.position.max(b.near.position) > a.far.position.min(b.far.position)
    }

    /// Whether a vehicle in the bound can be so near to this position, and its speed to this one. Both are compared in the bound's own
    /// units, to the outer side, which takes no division.
    #[must_use]
    pub fn comes_near(&self, position: Position, within: Distance, speed: Speed, within_speed: Speed) -> bool {
        let (behind, ahead) = micro_position(position);
        let (slower, faster) = (micro_down(speed.to_bits(), 23), micro_up(speed.to_bits(), 23));
        let (way, change) = (micro_up(within.to_bits(), 20), micro_up(within_speed.to_bits(), 23));
        ahead.saturating_add(way) >= self.near.position
            && behind.saturating_sub(way) <= self.far.position
            && faster.saturating_add(change) >= self.near.speed
            && slower.saturating_sub(change) <= self.far.speed
    }

    /// The lowest position, rounded down.
    #[must_use]
    pub const fn lowest_position(&self) -> Position {
        Position::from_bits(floor_shifted(self.near.position, 20))
    }

    /// The highest position, rounded up.
    #[must_use]
    pub const fn highest_position(&self) -> Position {
        Position::from_bits(floor_shifted(self.far.position.saturating_neg(), 20).saturating_neg())
    }

    /// The lowest speed, rounded down.
    #[must_use]
    pub const fn lowest_speed(&self) -> Speed {
        Speed::from_bits(crate::fixed::saturate_i32(floor_shifted(self.near.speed, 23)))
    }

    /// The highest speed, rounded up.
    #[must_use]
    pub const fn highest_speed(&self) -> Speed {
        Speed::from_bits(crate::fixed::saturate_i32(
            floor_shifted(self.far.speed.saturating_neg(), 23).saturating_neg(),
        ))
    }

    /// Where the near end comes to rest if it goes on braking, rounded down. The vehicle cannot stop behind this, however long it is
    /// silent. This never moves back.
    #[must_use]
    pub fn nearest_stop(&self, reach: &AccelerationRange) -> Position {
        let stopped = self.near.braked(LONGEST, reach.braking);
        Position::from_bits(floor_shifted(stopped.position, 20))
    }
}

/// A word with `fraction` bits, at least 6, in millionths, rounded down.
#[inline(always)]
fn micro_down(word: i32, fraction: u32) -> i64 {
    i64::from(word).wrapping_mul(15_625).wrapping_shr(fraction.wrapping_sub(6)) // below 2⁴⁵
}

/// The same, rounded up.
#[inline(always)]
fn micro_up(word: i32, fraction: u32) -> i64 {
    let negated = i64::from(word).wrapping_mul(-15_625); // below 2⁴⁵
    negated.wrapping_shr(fraction.wrapping_sub(6)).wrapping_neg()
}

#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
fn micro_up_64(word: i64, fraction: u32) -> i64 {
    micro_down_64(word.saturating_neg(), fraction).saturating_neg()
}

/// For words with at least 6 fraction bits. A million and 2^fraction share the factor 2⁶; cancelled, it lets 64 bits reach 64 times as
/// far.
fn micro_down_64(word: i64, fraction: u32) -> i64 {
    word.saturating_mul(15_625).wrapping_shr(fraction.wrapping_sub(6))
}

/// A position in µm, rounded down and up; exact up to ±5.6e8 m, beyond which it saturates.
fn micro_position(position: Position) -> (i64, i64) {
    (micro_down_64(position.to_bits(), 20), micro_up_64(position.to_bits(), 20))
}

/// Millionths as a word with `fraction` bits, at least 6, rounded down; exact within the range of [`micro_position`].
#[cfg_attr(not(target_pointer_width = "64"), inline(never))]
const fn floor_shifted(micros: i64, fraction: u32) -> i64 {
    let x = micros.saturating_mul(1i64.wrapping_shl(fraction.wrapping_sub(6)));
    let sign = x >> 63;
    per_15_625((x ^ sign).cast_unsigned()).cast_signed() ^ sign
}

/// A millionth, rounded down.
const fn millionths(x: i64) -> i64 {
    // For a negative value it divides the magnitude less one, because ⌊-x/n⌋ = -⌊(x-1)/n⌋ - 1. The complement of the value is that
    // magnitude.
    let sign = x >> 63;
    per_million((x ^ sign).cast_unsigned()).cast_signed() ^ sign
}

/// A millionth, rounded up.
const fn millionths_up(x: i64) -> i64 {
    millionths(x.wrapping_neg()).wrapping_neg()
}

/// Half, rounded up.
const fn half_up(x: i64) -> i64 {
    x.wrapping_add(1) >> 1
}

/// Quotient rounded down, for a positive divisor.
const fn floor(dividend: i64, divisor: i64) -> i64 {
    let towards_zero = quotient(dividend, divisor);
    if dividend < 0 && towards_zero.saturating_mul(divisor) != dividend {
        towards_zero.saturating_sub(1)
    } else {
        towards_zero
    }
}

/// Quotient rounded up, for a positive divisor.
const fn ceil(dividend: i64, divisor: i64) -> i64 {
    floor(dividend.saturating_neg(), divisor).saturating_neg()
}

#[cfg(test)]
mod proof;
#[cfg(test)]
mod tests;
