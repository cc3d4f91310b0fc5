//! The safe distance. The ego and the vehicle that it has to stay behind enter; the speed to spare, and the largest acceleration that it
//! allows, leave. The theory and its names are at the top of [`crate::envelope`].
//!
//! All values are whole micrometres, micrometres per second and so on, rounded so that less is allowed. No product reaches 2⁶³: in these
//! units accelerations and jerks are below 2²⁶, speeds below 2²⁹, and ways below 2³².

use super::hardest;
use crate::config::Envelope;
use crate::fixed::quotient;
use crate::model::bound::{AccelerationRange, Bound};
use crate::time::Duration;
use crate::units::{Acceleration, Distance, FineSeconds, Position, Speed};

/// The ego as the gate sees it: each value at the end of its uncertainty that is less safe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ego {
    /// Front bumper, as far ahead as it may be.
    pub position: Position,
    /// Speed, as high as it may be.
    pub speed: Speed,
    /// Acceleration that is reached, as high as it may be.
    pub acceleration: Acceleration,
    /// The command in force.
    pub last: Acceleration,
    /// Time constant of the actuators, as configured.
    pub lag: FineSeconds,
}

/// What the ego has to stay behind, at now. For a vehicle ahead it is the rear at the near end of the bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Obstacle {
    /// Its rear.
    pub position: Position,
    /// Its speed, as low as it may be.
    pub speed: Speed,
    /// Its hardest braking, as a magnitude.
    pub braking: Acceleration,
}

impl Obstacle {
    /// An obstacle that does not move.
    #[must_use]
    pub const fn standing(position: Position) -> Self {
        Self { position, speed: Speed::ZERO, braking: Acceleration::MAX }
    }

    /// The rear of a vehicle of this length. The bound at now is that of its front bumper.
    #[must_use]
    pub fn rear(bound: &Bound, length: Distance, reach: &AccelerationRange) -> Self {
        let position = bound.lowest_position().ahead(length.negated());
        Self { position, speed: bound.lowest_speed().max(Speed::ZERO), braking: reach.braking }
    }
}

/// The speed to spare, `G` of the theory, in µm/s: by how much the ramp of emergency braking may still raise the closing speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Spare(i64);

impl Spare {
    /// No vehicle is ahead.
    pub const ENDLESS: Self = Self(i64::MAX);
    /// Not even emergency braking is known to be enough.
    pub const NONE: Self = Self(i64::MIN);
}

/// The speed to spare behind an obstacle.
#[must_use]
pub fn spare(envelope: &Envelope, ego: &Ego, obstacle: &Obstacle) -> Spare {
    spare_of_all_lags(envelope, ego, obstacle, false)
}

/// The speed to spare by the better of the two conditions, each taken at the worse end of the lag. What a condition leaves is least at an
/// end of the lag. But if one condition holds at one end only and the other at the other end only, then between the ends neither need
/// hold.
fn spare_of_all_lags(envelope: &Envelope, ego: &Ego, obstacle: &Obstacle, comes_to_rest: bool) -> Spare {
    let braking = hardest(envelope);
    let rest = rest(braking, obstacle);
    let at = |lag| spare_at(envelope, ego, obstacle, (braking, rest), lag, comes_to_rest);
    let [shortest, longest] = lags(envelope, ego.lag).map(at);
    shortest.0.min(longest.0).max(shortest.1.min(longest.1))
}

/// The way that the obstacle still makes to its point of rest with the harder of the two brakings, in µm.
fn rest(braking: Acceleration, obstacle: &Obstacle) -> i64 {
    let (v, harder) = (speed_down(obstacle.speed), micros_up(braking.max(obstacle.braking)));
    quotient(v.saturating_mul(v), harder.saturating_mul(2))
}

/// The shortest and the longest lag that the real lag may be.
fn lags(envelope: &Envelope, lag: FineSeconds) -> [FineSeconds; 2] {
    let more = lag.fraction(envelope.lag_tolerance);
    [lag.minus(more).max(FineSeconds::ZERO), lag.plus(more)]
}

/// The speed to spare at this lag, by the points of rest and by closing. The ego's hardest braking enters with the obstacle's way to rest.
/// While the ego is about to stand, `y` may move backwards; once the ego stands, it does not any more. So nothing is built on that, unless
/// the ego `comes_to_rest` for good.
fn spare_at(
    envelope: &Envelope,
    ego: &Ego,
    obstacle: &Obstacle,
    (braking, rest): (Acceleration, i64),
    lag: FineSeconds,
    comes_to_rest: bool,
) -> (Spare, Spare) {
    let z = speed_up(ego.speed).saturating_add(speed_up(ego.acceleration.over(lag)));
    let z = if comes_to_rest { z } else { z.max(0) };
    let gap = obstacle.position.ahead_of(ego.position).minus(envelope.margin);
    if gap == Distance::MIN {
        // Further behind than the format can hold.
        return (Spare::NONE, Spare::NONE);
    }
    let room = distance_down(gap).saturating_sub(distance_up(way(ego.speed, lag)));

    let braking = micros_down(braking.to_bits());
    let by_rest = spare_of(braking, room.saturating_add(rest), z);
    let less = braking.saturating_sub(micros_up(obstacle.braking));
    if less <= 0 {
        return (by_rest, Spare::NONE);
    }
    // `q - r` is larger by `T` times the speed ahead, and `q̇` is less by `T` times the braking.
    let room = room.saturating_add(distance_down(way(obstacle.speed, lag)).saturating_sub(2));
    let moves = speed_down(obstacle.speed).saturating_sub(speed_up(obstacle.braking.over(lag)));
    (by_rest, spare_of(less, room, z.saturating_sub(moves)))
}

/// `sqrt(2 b S) - z`.
fn spare_of(braking: i64, room: i64, z: i64) -> Spare {
    if room < 0 {
        return Spare::NONE;
    }
    Spare(root(2i64.saturating_mul(braking).saturating_mul(room)).saturating_sub(z))
}

/// The largest acceleration with which there is still something to spare after the next tick. It is below the hardest braking if there is
/// none.
#[must_use]
pub fn distance_cap(envelope: &Envelope, spare: Spare, period: Duration) -> Acceleration {
    if spare == Spare::ENDLESS {
        return Acceleration::MAX;
    }
    let jerk = micros_down(envelope.jerk.to_bits());
    // With nothing to spare the root is 0, and the result is below the hardest braking.
    let rise = root(2i64.saturating_mul(jerk).saturating_mul(spare.0.clamp(0, 1 << 30)));
    let reaction = period.plus(envelope.delay).fine_seconds();
    let reacting = micros_up(envelope.jerk.over(reaction)).saturating_add(1);
    from_micros(rise.saturating_sub(reacting).saturating_sub(micros_up(hardest(envelope))).saturating_sub(1))
}

/// The lowest command that the limits on jerk and braking allow: emergency braking.
#[must_use]
pub fn floor(envelope: &Envelope, last: Acceleration, period: Duration) -> Acceleration {
    let slew = envelope.jerk.over(period.fine_seconds());
    last.minus(slew).max(hardest(envelope).negated())
}

/// Whether emergency braking from now on never meets the obstacle: the predicate that the gate keeps.
///
/// Let `lag_tolerance` be 0 and `ego.lag` the real lag. Let the predicate hold, and let the next command be the gate's, whatever was
/// demanded, and be in force from now to the next tick. Then the predicate holds at the next tick too. This is for an ego whose
/// acceleration and command in force are not below `-braking`, and which moves exactly and never backwards. It is for every obstacle that
/// brakes no harder than this one, and whose position and speed at the next tick are no less than those of this one after a tick of its
/// hardest braking (speed not below 0). Rounding costs less than 50 µm of position (`tests/core/envelope_kept.rs`). And where the predicate
/// holds and the ego is not beyond the obstacle, emergency braking does not take the ego beyond it.
///
/// With a tolerance, the predicate holds for every lag within it. Only for a lag that is not the real one may it fail later, by an ego
/// that does not move as that lag says. A command that comes into force late by `δ`, up to `delay`, is like a `delay` that is less by `δ`
/// from then on.
#[must_use]
pub fn is_safe(envelope: &Envelope, ego: &Ego, obstacle: &Obstacle, period: Duration) -> bool {
    // An ego that stands and is told to brake keeps standing. An ego that is about to stand and is told to brake makes no more way in
    // `y`.
    let brakes = ego.last <= Acceleration::ZERO;
    let stands = ego.speed <= Speed::ZERO && ego.acceleration <= Acceleration::ZERO;
    let spare = spare_of_all_lags(envelope, ego, obstacle, brakes);
    (brakes && stands) || distance_cap(envelope, spare, period) >= floor(envelope, ego.last, period)
}

/// `v T`, to within two bits of the word.
fn way(speed: Speed, time: FineSeconds) -> Distance {
    // 23 + 30 - 32 = 21 bits, which is one more than the format has: halved.
    let product = crate::fixed::mul_hi(speed.to_bits(), time.to_bits());
    Distance::from_bits(product.saturating_add(1).wrapping_shr(1).saturating_add(1))
}

/// A word of an acceleration or a jerk, rounded down: a million per 2²⁵ is 5⁶ per 2¹⁹.
fn micros_down(word: i32) -> i64 {
    i64::from(word).saturating_mul(15_625).wrapping_shr(19)
}

fn micros_up(acceleration: Acceleration) -> i64 {
    micros_down(acceleration.negated().to_bits()).saturating_neg()
}

/// One more than the nearest whole value.
fn speed_up(speed: Speed) -> i64 {
    speed.to_multiple_of(1_000_000).saturating_add(1)
}

/// One less than the nearest whole value.
fn speed_down(speed: Speed) -> i64 {
    speed.to_multiple_of(1_000_000).saturating_sub(1)
}

fn distance_up(distance: Distance) -> i64 {
    distance.to_multiple_of(1_000_000).saturating_add(1)
}

fn distance_down(distance: Distance) -> i64 {
    distance.to_multiple_of(1_000_000).saturating_sub(1)
}

fn from_micros(micros: i64) -> Acceleration {
    Acceleration::from_ratio(micros, 1_000_000)
}

/// The square root, rounded down; 0 for a negative value.
fn root(x: i64) -> i64 {
    i64::try_from(x.max(0).unsigned_abs().isqrt()).unwrap_or(i64::MAX)
}
