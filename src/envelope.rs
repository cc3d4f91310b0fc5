//! The last gate before the actuators: a demand enters, a command that is inside absolute limits, and with which the
//! vehicle stays able to stop behind what is certain of the one ahead, leaves.
//!
//! It is independent of the controller, disengaged unless configured, and only ever makes a command more careful: each
//! check is a cap on the acceleration, and the smallest one wins. Only the limits on jerk and on braking bound from
//! below, because slamming the brake is not careful.
//!
//! # Safe distance
//!
//! The vehicle ahead cannot stop before the near end of its bound does if that brakes at its hardest
//! ([`crate::estimator::bound::Bound::nearest_stop`]); through a silence that point does not move. The ego has to be
//! able to stop before it: RSS' longitudinal rule with the ego's own reaction in full.
//!
//! With actuators that lag by `T`, `y = r + T v` and `z = v + T a` move as a double integrator, `ẏ = z`, `ż = u`, exactly.
//! Emergency braking takes the demand `u` down to `-b` at jerk `j`, which takes `τ = (u + b)/j`. Then
//!
//! ```text
//! V(z, u) = ( z + ½ j (τ + h)² )² / 2b
//! ```
//!
//! is more than all of the way that `y` still makes if the demand `u` holds for one more tick `h` and emergency braking
//! follows: along that manoeuvre `V` falls by at least the way made, and it is never negative. So `V <= S`, with `S` the
//! way from `y` to the point, is kept from tick to tick by braking at the latest when it would be broken, and solved for
//! the demand it is the largest acceleration that keeps the next tick safe:
//!
//! ```text
//! u = sqrt( 2 j ( sqrt(2 b S) - z ) ) - j h - b
//! ```
//!
//! It falls steadily as the way shrinks: there is no cliff. In steady following behind a vehicle that brakes no harder
//! than the ego it does nothing as long as the newest sample is younger than `t_g - ρ`, with
//! `ρ = T + 2h + (b + j h)²/(2 j b)`, if the standstill distance covers margin, accuracies and `(b + j h)⁴/(8 j² b)`.

use crate::config::Envelope;
use crate::time::Duration;
use crate::units::{Acceleration, Distance, FineSeconds, Position, Speed};
use crate::wire::command::ACCELERATION_STEPS;
use crate::wire::quantity::Quantity;

/// The ego as the gate sees it: its own motion at the uncertain end that is the less safe one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ego {
    /// Front bumper, as far ahead as it may be.
    pub position: Position,
    /// Speed, as high as it may be.
    pub speed: Speed,
    /// Acceleration reached.
    pub acceleration: Acceleration,
    /// The command in force.
    pub last: Acceleration,
    /// Time constant of its actuators.
    pub lag: FineSeconds,
}

/// No more acceleration than the absolute limit.
#[must_use]
pub fn absolute_cap(envelope: &Envelope) -> Acceleration {
    envelope.acceleration
}

/// No acceleration at or beyond the speed limit.
#[must_use]
pub fn speed_cap(envelope: &Envelope, speed: Speed) -> Acceleration {
    if speed >= envelope.speed { Acceleration::ZERO } else { Acceleration::MAX }
}

/// No acceleration while the ego's own motion is not fresh.
#[must_use]
pub fn freshness_cap(is_fresh: bool) -> Acceleration {
    if is_fresh { Acceleration::MAX } else { Acceleration::ZERO }
}

/// The way to a point before which the ego has to be able to stop, less the margin, the lag's part and one tick of delay:
/// `S` of the module's theory.
#[must_use]
pub fn room(envelope: &Envelope, ego: &Ego, stop_before: Position, period: Duration) -> Distance {
    let ahead = stop_before.ahead_of(ego.position).minus(envelope.margin);
    ahead.minus(way(ego.speed, ego.lag)).minus(ego.speed.over(period.seconds()))
}

/// The largest acceleration that keeps the next tick safe; below the hardest braking if none does.
#[must_use]
pub fn distance_cap(envelope: &Envelope, ego: &Ego, room: Distance, period: Duration) -> Acceleration {
    let braking = micros(envelope.braking);
    let jerk = i64::from(envelope.jerk.to_mm_per_s3()).saturating_mul(1000);
    // At a standstill the acceleration is lost and `z` springs up to 0, so that nothing may be built on its being less.
    let z = speed_micros(ego.speed).saturating_add(speed_micros(ego.acceleration.over(ego.lag))).max(0);
    let fastest = root(2i64.saturating_mul(braking).saturating_mul(distance_micros(room)));
    // Without room or without anything to spare the roots are 0, and what comes out is below the hardest braking.
    let rise = root(2i64.saturating_mul(jerk).saturating_mul(fastest.saturating_sub(z)));
    let tick = micros(envelope.jerk.over(period.fine_seconds()));
    from_micros(rise.saturating_sub(tick).saturating_sub(braking))
}

/// The lowest command that the limits on jerk and braking allow: emergency braking.
#[must_use]
pub fn floor(envelope: &Envelope, last: Acceleration, period: Duration) -> Acceleration {
    let slew = envelope.jerk.over(period.fine_seconds());
    last.minus(slew).max(envelope.braking.negated())
}

/// The highest command that the limit on jerk allows.
#[must_use]
pub fn ceiling(envelope: &Envelope, last: Acceleration, period: Duration) -> Acceleration {
    last.plus(envelope.jerk.over(period.fine_seconds()))
}

/// Whether emergency braking from now on stops the ego in time: the predicate that the gate keeps.
#[must_use]
pub fn is_safe(envelope: &Envelope, ego: &Ego, room: Distance, period: Duration) -> bool {
    distance_cap(envelope, ego, room, period) >= floor(envelope, ego.last, period)
}

/// What the gate has to go by besides the ego.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Situation {
    /// Whether the ego's own motion is fresh.
    pub is_fresh: bool,
    /// The nearest point before which the ego has to be able to stop, if there is one.
    pub stop_before: Option<Position>,
}

/// The gate: the command that the demand becomes.
#[must_use]
pub fn gate(
    envelope: &Envelope,
    demand: Acceleration,
    ego: &Ego,
    situation: &Situation,
    period: Duration,
) -> Acceleration {
    let distance = situation
        .stop_before
        .map_or(Acceleration::MAX, |point| distance_cap(envelope, ego, room(envelope, ego, point, period), period));
    let cap = absolute_cap(envelope)
        .min(speed_cap(envelope, ego.speed))
        .min(freshness_cap(situation.is_fresh))
        .min(distance)
        .min(ceiling(envelope, ego.last, period));
    demand.min(cap).max(floor(envelope, ego.last, period))
}

/// The command as it will be encoded: the next step down, so that no rounding undoes a cap; up from where that is
/// braking beyond the limit.
#[must_use]
pub fn encodable(envelope: &Envelope, command: Acceleration) -> Acceleration {
    let nearest = command.to_steps(ACCELERATION_STEPS);
    let step = |steps| Acceleration::from_steps(steps, ACCELERATION_STEPS);
    let down = if step(nearest) > command { nearest.saturating_sub(1) } else { nearest };
    if step(down) < envelope.braking.negated() { step(down.saturating_add(1)) } else { step(down) }
}

/// Where the ego has to be able to stop behind a vehicle on its own path: behind that one's rear, where its near end would
/// come to rest.
#[must_use]
pub fn stop_behind(nearest_stop: Position, length: Distance) -> Position {
    nearest_stop.ahead(length.negated())
}

/// Where the ego has to be able to stop for a vehicle on a path that crosses its own: before the conflict area, until the
/// rear of that one's near end has left it.
#[must_use]
pub fn stop_before_conflict(
    area_begins: Position,
    other_near_end: Position,
    other_length: Distance,
    other_area_ends: Position,
) -> Option<Position> {
    let has_left = other_near_end.ahead(other_length.negated()) >= other_area_ends;
    if has_left { None } else { Some(area_begins) }
}

/// `v T`, rounded up by at most a micrometre.
fn way(speed: Speed, time: FineSeconds) -> Distance {
    // 23 + 30 - 32 = 21 bits, and one more than half of that.
    let product = crate::fixed::mul_hi(speed.to_bits(), time.to_bits());
    Distance::from_bits(product.saturating_add(1).wrapping_shr(1).saturating_add(1))
}

fn micros(acceleration: Acceleration) -> i64 {
    acceleration.to_multiple_of(1_000_000)
}

fn speed_micros(speed: Speed) -> i64 {
    speed.to_multiple_of(1_000_000)
}

fn distance_micros(distance: Distance) -> i64 {
    distance.to_multiple_of(1_000_000)
}

fn from_micros(micros: i64) -> Acceleration {
    Acceleration::from_ratio(micros, 1_000_000)
}

/// The square root, rounded down; 0 of what is negative.
fn root(x: i64) -> i64 {
    i64::try_from(x.max(0).unsigned_abs().isqrt()).unwrap_or(i64::MAX)
}

#[cfg(test)]
mod tests;
