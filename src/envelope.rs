//! The last gate before the actuators: a demand enters, a command that is inside absolute limits, and with which the
//! vehicle stays able to stop behind what is certain of the one ahead, leaves.
//!
//! It is independent of the controller, disengaged unless configured, and only ever makes a command more careful: each
//! check is a cap on the acceleration, and the smallest one wins. Only the limits on jerk and on braking bound from
//! below, because slamming the brake is not careful.
//!
//! # Safe distance
//!
//! What is certain of a vehicle ahead is its near end: a vehicle of its own, whose rear is at `p`, whose speed is `w`, and
//! which brakes with `c`, its hardest ([`crate::model::bound`]). No truth gets behind it. What the gate keeps is this:
//! *emergency braking from now on never meets the near end*. A command that is allowed by a condition that suffices for it
//! keeps it; and where none does, the command is emergency braking, and what was true stays true.
//!
//! With actuators that lag by `T`, `y = r + T v` and `z = v + T a` move as a double integrator, `ẏ = z`, `ż = u`, exactly.
//! Of the near end likewise `q = p + T w`, `q̇ = w - T c`. Behind `q` in `y` is behind `p` in `r`: since
//! `T d(p - r)/dt + (p - r) = q - y`, a `p - r` that was not negative stays so while `q - y` is not. It is not to begin with:
//! there was no collision yet, and a near end that is behind the ego is that of a vehicle that is at least where the ego is.
//!
//! Emergency braking takes the demand `u` down to `-b` at jerk `j`, which takes `τ = (u + b)/j`. Before it begins the
//! demand may hold for the reaction time `h`: a tick, and how late a command may come into force
//! ([`Envelope::delay`]). Then, with `X = z + ½ j (τ + h)²`,
//!
//! ```text
//! V = X² / 2b
//! ```
//!
//! is more than all of the way that `y` still makes: along that manoeuvre `Ẋ <= -b`, so that `V` falls by at least `X`, which
//! is at least `z`. For the same reason, if `c < b`, with `Z = z - q̇` and `X = Z + ½ j (τ + h)²`,
//!
//! ```text
//! V = X² / 2(b - c),   0 for X < 0
//! ```
//!
//! is more than all by which `y` still closes on `q` as long as that goes on braking, and on the real `q` the less: where that
//! comes to rest, its parabola goes on backwards. So either of two conditions suffices:
//!
//! - **by the points of rest**: `V <= S` with the way `S` from `y` to where the near end would come to rest *if it braked with
//!   the harder of `b` and `c`*. A vehicle that brakes so is never ahead of the near end. Both on the move, the gap to it is
//!   concave, since no ego brakes harder than `b`; once it stands the gap only shrinks, once the ego does it only grows. So
//!   its least value is at the beginning or at the points of rest. With `c` alone in the place of the harder one the gap is
//!   not concave if `c < b`: the paths cross on the way.
//! - **by closing**, if `c < b`: `V <= S` with the way `S` from `y` to `q`.
//!
//! Both are kept from tick to tick by braking at the latest when they would be broken, and both grow weaker if the near end is
//! further ahead or faster than it was said to be. Solved for the demand, with the *speed to spare*
//! `G = sqrt(2 b S) - z`, or `sqrt(2 (b - c) S) - Z`, both are
//!
//! ```text
//! u = sqrt( 2 j G ) - j h - b
//! ```
//!
//! so that one root serves for the larger `G` of the two conditions, the least of all vehicles ahead. It falls steadily as the
//! way shrinks: there is no cliff.
//!
//! *Coming to rest.* Where `z` is negative, `y` runs back. At a standstill the acceleration is lost, and `z` springs up to 0. So
//! the cap takes no `z` for less than 0, as the ego might be told to drive on. If it is told to brake it stands for good, and
//! what is known of the way until then is enough ([`is_safe`]).
//!
//! *The lag* is known to within [`Envelope::lag_tolerance`]. `V - S` is a convex function of `T` (a square of what is linear,
//! less what is linear), so it is largest at one of the two ends of that; both are computed.
//!
//! In steady following behind a vehicle that brakes no less hard than the ego it does nothing as long as the newest sample is
//! younger than `t_g - ρ`, with `ρ = T (1 + α/b) + (b + j h)²/(2 j b)`, `T` at its longest and `α` what is uncertain of the
//! ego's acceleration, if the standstill distance covers margin, accuracies and `(b + j h)⁴/(8 j² b)`.
//!
//! # What it tolerates
//!
//! All of these at once; `tests/envelope_margins.rs` drives at each edge and at all of them together without a collision. What
//! happens beyond was counted with its drives: 600 of the gate alone with full acceleration demanded throughout, and 72 of
//! whole units that follow.
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
//! Against the least way from which emergency braking does not collide, found by simulation with nothing tolerated
//! (`tests/envelope_lorry.rs`; 8 m/s², lag 0.3 s): at most 0.7 m behind a vehicle that brakes at least as hard, which is
//! `½ b T²` of the lag's end and `j (τ + h)³/6` of the ramp. Behind one that brakes less hard, at the same speed at most
//! 1.7 m; and up to 15 m where the ego closes in on one that is much slower and would stop a little before it does. There the
//! points of rest with `c` itself would do; but whether they do turns on who stops first, and a condition that a faster vehicle
//! ahead can break is a cliff.

mod distance;
mod reckoning;

pub use distance::{Ego, Obstacle, Spare, distance_cap, floor, is_safe, spare};
pub use reckoning::{Reckoning, Start};

use crate::config::Envelope;
use crate::time::Duration;
use crate::units::{Acceleration, Distance, Position, Speed};
use crate::wire::command::{ACCELERATION_MOST, ACCELERATION_STEPS};
use crate::wire::quantity::Quantity;

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

/// The highest command that the limit on jerk allows.
#[must_use]
pub fn ceiling(envelope: &Envelope, last: Acceleration, period: Duration) -> Acceleration {
    last.plus(envelope.jerk.over(period.fine_seconds()))
}

/// What the gate has to go by besides the ego.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Situation {
    /// Whether the ego's own motion is fresh.
    pub is_fresh: bool,
    /// The least that is to spare behind anyone ahead.
    pub spare: Spare,
}

/// The gate: the command that the demand becomes. `since` is the age of the last command: it is more than a period where ticks were
/// missed. Downward the command changes by no more than the limit on jerk allows in that time, of which a period and the envelope's
/// delay count. With a period alone, ticks that are missed again and again would slow down the ramp of emergency braking each time.
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

/// The command as it will be encoded: the next step down, so that no rounding undoes a cap; up from where that is
/// braking beyond the limit.
#[must_use]
pub fn encodable(envelope: &Envelope, command: Acceleration) -> Acceleration {
    let nearest = command.to_steps(ACCELERATION_STEPS);
    let step = |steps| Acceleration::from_steps(steps, ACCELERATION_STEPS);
    let down = if step(nearest) > command { nearest.saturating_sub(1) } else { nearest };
    if step(down) < envelope.braking.negated() { step(down.saturating_add(1)) } else { step(down) }
}

/// The hardest braking that is ever commanded, as a magnitude: the limit, on a step of the command and within what it can say.
#[must_use]
pub fn hardest(envelope: &Envelope) -> Acceleration {
    let most = Acceleration::from_steps(ACCELERATION_MOST, ACCELERATION_STEPS);
    encodable(envelope, envelope.braking.min(most).negated()).negated()
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

#[cfg(test)]
mod proof;
#[cfg(test)]
mod tests;
