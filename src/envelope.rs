//! The last gate before the actuators. A demand enters; a command leaves that is inside absolute limits, and with which the vehicle stays
//! able to stop behind what is certain of the vehicle ahead.
//!
//! The gate is independent of the controller, and disengaged unless configured. It only ever makes a command more careful: each check is
//! a cap on the acceleration, and the smallest cap wins. Only the limits on jerk and on braking bound from below, because slamming the
//! brake is not careful.
//!
//! # Safe distance
//!
//! What is certain of a vehicle ahead is its near end: an imagined vehicle whose rear is at `p`, whose speed is `w`, and which brakes at
//! its hardest, `c` ([`crate::model::bound`]). The real vehicle is never behind it. The gate keeps this true: *emergency braking from now
//! on never meets the near end*. Where a sufficient condition for that allows a command, the command keeps it true. Where none does, the
//! command is emergency braking, and what was true stays true.
//!
//! With actuators that lag by `T`, `y = r + T v` and `z = v + T a` move exactly as a double integrator, `ẏ = z`, `ż = u`. For the near
//! end likewise, with `q = p + T w`, `q̇ = w - T c`. If `y` is behind `q`, then `r` is behind `p`: since
//! `T d(p - r)/dt + (p - r) = q - y`, a `p - r` that was not negative stays so while `q - y` is not negative. At the beginning it is not
//! negative: there was no collision yet, and if a near end is behind the ego, its vehicle is at least where the ego is.
//!
//! Emergency braking takes the demand `u` down to `-b` at jerk `j`, which takes `τ = (u + b)/j`. Before it begins, the demand may hold
//! for the reaction time `h`. This is a tick, and the time by which a command may come into force late ([`Envelope::delay`]). Then, with
//! `X = z + ½ j (τ + h)²`,
//!
//! ```text
//! V = X² / 2b
//! ```
//!
//! is more than all of the way that `y` still makes: along that manoeuvre `Ẋ <= -b`, so that `V` falls by at least `X`, which is at least
//! `z`. For the same reason, if `c < b`, with `Z = z - q̇` and `X = Z + ½ j (τ + h)²`,
//!
//! ```text
//! V = X² / 2(b - c),   0 for X < 0
//! ```
//!
//! is more than all of the way by which `y` still closes in on `q`, as long as `q` goes on braking. On the real `q` it closes in by less:
//! where the real one comes to rest, its parabola goes on backwards. So each of two conditions suffices:
//!
//! - **by the points of rest**: `V <= S` with the way `S` from `y` to where the near end would come to rest *if it braked with the harder
//!   of `b` and `c`*. A vehicle that brakes like this is never ahead of the near end. While both move, the gap to it is concave, since no
//!   ego brakes harder than `b`. Once that vehicle stands, the gap only shrinks. Once the ego stands, it only grows. So the gap is
//!   smallest at the beginning or at the points of rest. With `c` alone instead of the harder one, the gap is not concave if `c < b`: the
//!   paths cross on the way.
//! - **by closing**, if `c < b`: `V <= S` with the way `S` from `y` to `q`.
//!
//! Both conditions are kept from tick to tick by braking at the latest when they would be broken. Both grow weaker if the near end is
//! further ahead or faster than it was said to be. Solved for the demand, with the *speed to spare* `G = sqrt(2 b S) - z`, or
//! `sqrt(2 (b - c) S) - Z`, both are
//!
//! ```text
//! u = sqrt( 2 j G ) - j h - b
//! ```
//!
//! so that one root serves for the larger `G` of the two conditions, and for the least over all vehicles ahead. The cap falls steadily as
//! the way shrinks: there is no cliff.
//!
//! *Coming to rest.* Where `z` is negative, `y` runs back. At a standstill the acceleration is lost, and `z` springs up to 0. So the cap
//! takes a negative `z` as 0, because the ego might be told to drive on. If the ego is told to brake, it stands for good. Then what is
//! known of the way until that moment is enough ([`is_safe`]).
//!
//! *The lag* is known to within [`Envelope::lag_tolerance`]. `V - S` is a convex function of `T` (the square of a linear term, less a
//! linear term). So it is largest at one of the two ends of the tolerance, and both ends are computed.
//!
//! In steady following behind a vehicle that brakes no less hard than the ego, the gate does nothing under two conditions. The newest
//! sample is younger than `t_g - ρ`, with `ρ = T (1 + α/b) + (b + j h)²/(2 j b)`, `T` at its longest and `α` the uncertainty of the
//! ego's acceleration. And the standstill distance covers the margin, the accuracies and `(b + j h)⁴/(8 j² b)`.
//!
//! # What it tolerates
//!
//! The gate tolerates all of these at once. `tests/core/envelope_margins.rs` drives at each limit, and at all limits together, without a
//! collision. What happens beyond was counted with the drives of that test: 600 drives of the gate alone with full acceleration demanded
//! throughout, and 72 of whole units that follow. The two counts of collisions are in this order.
//!
//! | assumption | tolerated | beyond |
//! |---|---|---|
//! | the lag is as configured | ±25 % ([`Envelope::lag_tolerance`]) | +50 %: 0 and 0 collide, +100 %: 416 and 4; shorter: none |
//! | a command is in force within its period, and no tick is missed | 30 ms, or three ticks in a row ([`Envelope::delay`]) | 100 ms late: 0 and 0; twelve ticks missed: 0 and 0 |
//! | the ego's acceleration is as measured | 1 m/s² too low ([`UNPUBLISHED_ACCELERATION_ACCURACY`](crate::parameters::UNPUBLISHED_ACCELERATION_ACCURACY)) | 2 m/s²: 51 and 0, 3 m/s²: 330 and 3 |
//! | its position and speed are | as accurate as it says | |
//! | `EgoMotion` comes | no limit: it is carried on by its commands ([`Reckoning`]) | 2 s: 0 and 0 |
//! | the vehicle brakes with [`Envelope::braking`] on any road that it is on | none but margin and slack | 5 % less: 42 and 0, 10 %: 240 and 3, 20 %: 444 and 6 |
//!
//! # What is given away
//!
//! Compared with the least way from which emergency braking does not collide, found by simulation with nothing tolerated
//! (`tests/core/envelope_lorry.rs`; 8 m/s², lag 0.3 s), the gate gives away at most 0.7 m behind a vehicle that brakes at least as hard.
//! That is `½ b T²` of the lag's end and `j (τ + h)³/6` of the ramp. Behind a vehicle that brakes less hard it gives away at most 1.7 m at
//! the same speed. It gives away up to 15 m where the ego closes in on a much slower vehicle and would stop a little before that vehicle
//! does. There the points of rest with `c` itself would suffice. But whether they suffice depends on which vehicle stops first, and a
//! condition that a faster vehicle ahead can break is a cliff.

mod distance;
mod reckoning;

pub use distance::{Ego, Obstacle, Spare, distance_cap, floor, is_safe, spare};
pub use reckoning::{Reckoning, Start};

use crate::config::Envelope;
use crate::time::Duration;
use crate::units::{Acceleration, Distance, Position, Speed};
use crate::wire::command::{ACCELERATION_MOST, ACCELERATION_STEPS};
use crate::wire::quantity::Quantity;

/// The cap by the absolute limit on acceleration.
#[must_use]
pub fn absolute_cap(envelope: &Envelope) -> Acceleration {
    envelope.acceleration
}

/// No acceleration at the speed limit or beyond it.
#[must_use]
pub fn speed_cap(envelope: &Envelope, speed: Speed) -> Acceleration {
    if speed >= envelope.speed { Acceleration::ZERO } else { Acceleration::MAX }
}

/// No acceleration while the ego's own motion is not fresh.
#[must_use]
pub fn freshness_cap(is_fresh: bool) -> Acceleration {
    if is_fresh { Acceleration::MAX } else { Acceleration::ZERO }
}

/// The highest command that the limit on jerk allows.
#[must_use]
pub fn ceiling(envelope: &Envelope, last: Acceleration, period: Duration) -> Acceleration {
    last.plus(envelope.jerk.over(period.fine_seconds()))
}

/// What the gate knows besides the ego.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Situation {
    /// Whether the ego's own motion is fresh.
    pub is_fresh: bool,
    /// The least that is to spare behind any vehicle ahead.
    pub spare: Spare,
}

/// The gate: the command that the demand becomes. `since` is the age of the last command; it is more than a period where ticks were
/// missed. Downward, the command changes by no more than the limit on jerk allows in that time, of which no more than a period and the
/// envelope's delay count. If a period alone counted, ticks that are missed again and again would slow down the ramp of emergency braking
/// each time.
#[must_use]
pub fn gate(
    envelope: &Envelope,
    demand: Acceleration,
    ego: &Ego,
    situation: &Situation,
    period: Duration,
    since: Duration,
) -> Acceleration {
    let cap = absolute_cap(envelope)
        .min(speed_cap(envelope, ego.speed))
        .min(freshness_cap(situation.is_fresh))
        .min(distance_cap(envelope, situation.spare, period))
        .min(ceiling(envelope, ego.last, period));
    demand.min(cap).max(floor(envelope, ego.last, since.min(period.plus(envelope.delay)).max(period)))
}

/// The command as it will be encoded. It is rounded down to the next step, so that no rounding undoes a cap. It is rounded up where the
/// step below would brake harder than the limit.
#[must_use]
pub fn encodable(envelope: &Envelope, command: Acceleration) -> Acceleration {
    let nearest = command.to_steps(ACCELERATION_STEPS);
    let step = |steps| Acceleration::from_steps(steps, ACCELERATION_STEPS);
    let down = if step(nearest) > command { nearest.saturating_sub(1) } else { nearest };
    if step(down) < envelope.braking.negated() { step(down.saturating_add(1)) } else { step(down) }
}

/// The hardest braking that is ever commanded, as a magnitude: the configured limit, on a step of the command and within its range.
#[must_use]
pub fn hardest(envelope: &Envelope) -> Acceleration {
    let most = Acceleration::from_steps(ACCELERATION_MOST, ACCELERATION_STEPS);
    encodable(envelope, envelope.braking.min(most).negated()).negated()
}

/// Where the ego has to be able to stop for a vehicle on a path that crosses its own: before the conflict area, until the rear of that
/// vehicle's near end has left the area.
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

#[cfg(test)]
mod proof;
#[cfg(test)]
mod tests;
