//! The last gate before the actuators: a demand enters, a command that is inside absolute limits leaves.
//!
//! It is independent of the controller, disengaged unless configured, and only ever makes a command more careful: each
//! check is a cap on the acceleration, and the smallest one wins. Only the limit on jerk also bounds from below, because
//! slamming the brake is not careful.

use crate::config::Envelope;
use crate::time::Duration;
use crate::units::{Acceleration, Speed};

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

/// No faster change than the limit on jerk over one period, and no harder braking than the limit on braking.
#[must_use]
pub fn rate_limited(envelope: &Envelope, wish: Acceleration, last: Acceleration, period: Duration) -> Acceleration {
    let slew = envelope.jerk.over(period.fine_seconds());
    let floor = last.minus(slew).max(envelope.braking.negated());
    wish.min(last.plus(slew)).max(floor)
}

/// The gate: the command that the demand becomes.
#[must_use]
pub fn gate(
    envelope: &Envelope,
    demand: Acceleration,
    last: Acceleration,
    speed: Speed,
    is_fresh: bool,
    period: Duration,
) -> Acceleration {
    let cap = absolute_cap(envelope).min(speed_cap(envelope, speed)).min(freshness_cap(is_fresh));
    rate_limited(envelope, demand.min(cap), last, period)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Jerk;

    const LIMITS: Envelope = Envelope {
        acceleration: Acceleration::from_mm_per_s2(2000),
        braking: Acceleration::from_mm_per_s2(6000),
        jerk: Jerk::from_mm_per_s3(10_000),
        speed: Speed::from_mm_per_s(30_000),
    };
    const PERIOD: Duration = Duration::from_millis(10);

    fn around(mm: i32) -> impl Iterator<Item = i32> {
        (mm - 5..=mm + 5).chain([-60_000, -1, 0, 1, 60_000])
    }

    #[test]
    fn nothing_beyond_the_absolute_limits_gets_out() {
        for wish in around(2000).chain(around(-6000)).map(Acceleration::from_mm_per_s2) {
            for last in around(2000).chain(around(-6000)).map(Acceleration::from_mm_per_s2) {
                let out = gate(&LIMITS, wish, last, Speed::ZERO, true, PERIOD);
                let last_inside = last >= LIMITS.braking.negated() && last <= LIMITS.acceleration;
                assert!(
                    !last_inside || out <= LIMITS.acceleration && out >= LIMITS.braking.negated(),
                    "{wish:?} {last:?}"
                );
            }
        }
    }

    #[test]
    fn no_change_is_faster_than_the_limit_on_jerk() {
        for wish in around(100).chain(around(-100)).map(Acceleration::from_mm_per_s2) {
            let out = rate_limited(&LIMITS, wish, Acceleration::ZERO, PERIOD).to_mm_per_s2();
            assert_eq!(out, wish.to_mm_per_s2().clamp(-100, 100));
        }
    }

    #[test]
    fn at_the_speed_limit_nothing_accelerates() {
        for speed in around(30_000) {
            let cap = speed_cap(&LIMITS, Speed::from_mm_per_s(speed));
            assert_eq!(cap == Acceleration::ZERO, speed >= 30_000, "{speed}");
        }
    }

    #[test]
    fn a_stale_ego_does_not_accelerate() {
        let last = Acceleration::from_mm_per_s2(0);
        assert_eq!(gate(&LIMITS, Acceleration::MAX, last, Speed::ZERO, false, PERIOD), Acceleration::ZERO);
    }
}
