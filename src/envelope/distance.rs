//! The safe distance: the ego and whom it has to stay behind enter; the speed to spare, and the largest acceleration that it
//! allows, leave. The theory stands at the top of [`crate::envelope`]; the names here are those there.
//!
//! Everything is computed in whole micrometres, micrometres per second and their like, and rounded so that less is allowed.
//! No product reaches 2⁶³: accelerations and jerks are below 2²⁶, speeds below 2²⁹, ways below 2³² of these.

use super::hardest;
use crate::config::Envelope;
use crate::fixed::quotient;
use crate::model::bound::{AccelerationRange, Bound};
use crate::time::Duration;
use crate::units::{Acceleration, Distance, FineSeconds, Position, Speed};

/// The ego as the gate sees it: its own motion at the uncertain end that is the less safe one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ego {
    /// Front bumper, as far ahead as it may be.
    pub position: Position,
    /// Speed, as high as it may be.
    pub speed: Speed,
    /// Acceleration reached, as high as it may be.
    pub acceleration: Acceleration,
    /// The command in force.
    pub last: Acceleration,
    /// Time constant of its actuators, as configured.
    pub lag: FineSeconds,
}

/// What the ego has to stay behind, at now: of a vehicle ahead the rear at the near end of what is certain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Obstacle {
    /// Its rear.
    pub position: Position,
    /// Its speed, as low as it may be.
    pub speed: Speed,
    /// The hardest that it brakes, as a magnitude.
    pub braking: Acceleration,
}

impl Obstacle {
    /// What does not move.
    #[must_use]
    pub const fn standing(position: Position) -> Self {
        Self { position, speed: Speed::ZERO, braking: Acceleration::MAX }
    }

    /// The rear of a vehicle of that length, of whose front this is certain at now.
    #[must_use]
    pub fn rear(bound: &Bound, length: Distance, reach: &AccelerationRange) -> Self {
        let position = bound.lowest_position().ahead(length.negated());
        Self { position, speed: bound.lowest_speed().max(Speed::ZERO), braking: reach.braking }
    }
}

/// The speed to spare, `G` of the theory, in µm/s: what the ramp of emergency braking may still add to the closing speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Spare(i64);

impl Spare {
    /// Nobody is ahead.
    pub const ENDLESS: Self = Self(i64::MAX);
    /// Not even emergency braking is known to help.
    pub const NONE: Self = Self(i64::MIN);
}

/// How much there is to spare behind an obstacle.
#[must_use]
pub fn spare(envelope: &Envelope, ego: &Ego, obstacle: &Obstacle) -> Spare {
    spare_of_all_lags(envelope, ego, obstacle, false)
}

/// By the better condition, and by each what there is at the worse end of the lag. What a condition leaves is at its least at an
/// end; but where one holds at one end and the other at the other, between them neither need do.
fn spare_of_all_lags(envelope: &Envelope, ego: &Ego, obstacle: &Obstacle, comes_to_rest: bool) -> Spare {
    let rest = rest(envelope, obstacle);
    let at = |lag| spare_at(envelope, ego, obstacle, rest, lag, comes_to_rest);
    let [shortest, longest] = lags(envelope, ego.lag).map(at);
    shortest.0.min(longest.0).max(shortest.1.min(longest.1))
}

/// The way that the obstacle still makes to its point of rest, with the harder of the two brakings, in µm.
fn rest(envelope: &Envelope, obstacle: &Obstacle) -> i64 {
    let (v, harder) = (speed_down(obstacle.speed), micros_up(hardest(envelope).max(obstacle.braking)));
    quotient(v.saturating_mul(v), harder.saturating_mul(2))
}

/// The least and the largest lag that the real one may be.
fn lags(envelope: &Envelope, lag: FineSeconds) -> [FineSeconds; 2] {
    let more = lag.share(envelope.lag_tolerance);
    [lag.minus(more).max(FineSeconds::ZERO), lag.plus(more)]
}

/// How much there is to spare with this lag, by the points of rest and by closing. An ego that is about to stand may make way
/// backwards in `y`; once it stands, it does not any more, so that nothing is built on that, unless it `comes_to_rest` for good.
fn spare_at(
    envelope: &Envelope,
    ego: &Ego,
    obstacle: &Obstacle,
    rest: i64,
    lag: FineSeconds,
    comes_to_rest: bool,
) -> (Spare, Spare) {
    let z = speed_up(ego.speed).saturating_add(speed_up(ego.acceleration.over(lag)));
    let z = if comes_to_rest { z } else { z.max(0) };
    let gap = obstacle.position.ahead_of(ego.position).minus(envelope.margin);
    if gap == Distance::MIN {
        // Further behind than the format can say.
        return (Spare::NONE, Spare::NONE);
    }
    let room = distance_down(gap).saturating_sub(distance_up(way(ego.speed, lag)));

    let braking = micros_down(hardest(envelope).to_bits());
    let by_rest = spare_of(braking, room.saturating_add(rest), z);
    let less = braking.saturating_sub(micros_up(obstacle.braking));
    if less <= 0 {
        return (by_rest, Spare::NONE);
    }
    // `q - r` is `T` times the speed ahead more, and `q` moves by `T` times the braking less fast than that.
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

/// The largest acceleration with which there is still something to spare after the next tick; below the hardest braking if
/// there is none.
#[must_use]
pub fn distance_cap(envelope: &Envelope, spare: Spare, period: Duration) -> Acceleration {
    if spare == Spare::ENDLESS {
        return Acceleration::MAX;
    }
    let jerk = micros_down(envelope.jerk.to_bits());
    // With nothing to spare the root is 0, and what comes out is below the hardest braking.
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
/// Let `lag_tolerance` be 0 and `ego.lag` the real lag. If it holds, and the next command is the gate's, whatever was demanded,
/// and is in force from now to the next tick, then it holds at the next tick too: for an ego whose acceleration and command in
/// force are from `-braking` on, that moves exactly and never backwards, and for every obstacle whose position and speed are
/// then no less than those of this one after a tick of its hardest braking (not below 0), and that brakes no harder. Rounding
/// costs less than 50 µm of position (`tests/envelope_kept.rs`). And where it holds and the ego is not beyond the obstacle,
/// emergency braking does not take it there.
///
/// With a tolerance it says so of every lag within; only those that are not the real one may be broken later, by an ego
/// that does not move as they say. A delay of `δ` up to `delay` is as good as a `delay` that is less by `δ` from then on.
#[must_use]
pub fn is_safe(envelope: &Envelope, ego: &Ego, obstacle: &Obstacle, period: Duration) -> bool {
    // What stands and is told to brake goes on standing. What is about to stand and is told to brake makes no more way in `y`.
    let brakes = ego.last <= Acceleration::ZERO;
    let stands = ego.speed <= Speed::ZERO && ego.acceleration <= Acceleration::ZERO;
    let spare = spare_of_all_lags(envelope, ego, obstacle, brakes);
    (brakes && stands) || distance_cap(envelope, spare, period) >= floor(envelope, ego.last, period)
}

/// `v T`, to within two words.
fn way(speed: Speed, time: FineSeconds) -> Distance {
    // 23 + 30 - 32 = 21 bits, and one more than half of that.
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

/// One more than the nearest.
fn speed_up(speed: Speed) -> i64 {
    speed.to_multiple_of(1_000_000).saturating_add(1)
}

/// One less than the nearest.
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

/// The square root, rounded down; 0 of what is negative.
fn root(x: i64) -> i64 {
    i64::try_from(x.max(0).unsigned_abs().isqrt()).unwrap_or(i64::MAX)
}
