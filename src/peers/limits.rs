//! How hard a station can change its speed, over time. The limits that it publishes enter; the limits that hold now, and those that held
//! before, leave.
//!
//! * *Harder* limits hold at once, and for the past too. The assumption of use is: a station publishes harder limits at least `stale` (10
//!   s as shipped) before it uses them, and a station that has not been heard for longer keeps to the limits that it published last.
//! * *Softer* limits never hold for the past. They hold from a message that publishes them, once nothing harder has been published for
//!   `stale`. Until then two things may still come: an overtaken message, which no stamp would reveal, and a sample from before. From
//!   then on, what is certain is carried on by the softer limits. What is from before is carried on to that instant by the harder ones.
//! * Until a station has published limits, the worst limits hold.

use crate::model::bound::{AccelerationRange, Bound, Uncertainty};
use crate::time::{Duration, Instant};
use crate::units::{Position, Speed};

/// The limits of one station.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits {
    now: AccelerationRange,
    /// The limits that held before `since`; nowhere softer than `now`.
    before: AccelerationRange,
    /// Since when `now` holds.
    since: Instant,
    /// The hardest limits published after `held`, while all of them were softer than `now` in one way or another.
    softer: AccelerationRange,
    /// When limits as hard as `now` were published last.
    held: Instant,
}

impl Limits {
    /// The limits of a station that publishes for the first time.
    #[must_use]
    pub fn first(at: Instant, published: AccelerationRange) -> Self {
        Self {
            now: published,
            before: AccelerationRange::WORST.or(published),
            since: at,
            softer: AccelerationRange::NONE,
            held: at,
        }
    }

    /// The limits after the station published these, received at `at`.
    #[must_use]
    pub fn publish(self, at: Instant, published: AccelerationRange, stale: Duration) -> Self {
        let now = self.now.or(published);
        let harder = Self { now, before: self.before.or(published), ..self };
        if published == now {
            return Self { softer: AccelerationRange::NONE, held: at, ..harder };
        }
        let softer = self.softer.or(published);
        if at.since(self.held) < stale {
            return Self { softer, ..harder };
        }
        Self { now: softer, before: now, since: at, softer: AccelerationRange::NONE, held: at }
    }

    /// The limits that hold from [`since`](Self::since) on.
    #[must_use]
    pub const fn now(&self) -> AccelerationRange {
        self.now
    }

    /// A bound from before `since`, carried on to `since`; any other bound unchanged.
    #[must_use]
    pub fn settled(&self, bound: &Bound) -> Bound {
        bound.after(self.since, &self.before)
    }

    /// What is certain by a sample or by a view of the range sensor, carried on to `since` if it is from before.
    #[must_use]
    pub fn around(&self, at: Instant, position: Position, speed: Speed, uncertainty: &Uncertainty) -> Bound {
        let reach = self.from(at.minus(uncertainty.earlier));
        self.settled(&Bound::around(at, position, speed, uncertainty, &reach))
    }

    /// The hardest limits that hold from an instant on.
    #[must_use]
    pub fn from(&self, at: Instant) -> AccelerationRange {
        if at < self.since { self.before } else { self.now }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Acceleration;

    const STALE: Duration = Duration::from_millis(10_000);

    fn reach(acceleration: i32, braking: i32) -> AccelerationRange {
        let of = |mps2| Acceleration::from_mm_per_s2(1_000 * mps2);
        AccelerationRange { acceleration: of(acceleration), braking: of(braking) }
    }

    fn at(millis: u64) -> Instant {
        Instant::from_micros(millis * 1_000)
    }

    /// Publishes one after the other. Each message is followed by the limits that hold then.
    fn publish(messages: &[(u64, AccelerationRange, AccelerationRange)]) -> Limits {
        let mut limits = Limits::first(at(messages[0].0), messages[0].1);
        for (millis, published, expected) in messages {
            limits = limits.publish(at(*millis), *published, STALE);
            assert_eq!(limits.now(), *expected, "{millis}");
        }
        limits
    }

    #[test]
    fn harder_limits_hold_at_once_and_softer_ones_when_nothing_harder_was_published_for_long() {
        let (hard, soft) = (reach(2, 8), reach(2, 2));
        let limits = publish(&[
            (0, soft, soft),
            (100, hard, hard),
            (600, soft, hard),
            (10_099, soft, hard),
            (10_100, soft, soft),
        ]);
        assert_eq!((limits.before, limits.since), (hard, at(10_100)));
        // An overtaken message starts the time anew, and so does a silence in which nothing is published.
        publish(&[(0, hard, hard), (500, soft, hard), (9_999, hard, hard), (10_500, soft, hard), (19_999, soft, soft)]);
    }

    #[test]
    fn each_way_is_as_hard_as_the_hardest_and_what_lies_between_is_taken_in_turn() {
        let (one, other) = (reach(1, 8), reach(4, 3));
        publish(&[(0, one, one), (500, other, reach(4, 8)), (9_999, other, reach(4, 8)), (10_000, other, other)]);
        let steps =
            [(0, reach(2, 8), reach(2, 8)), (9_000, reach(2, 6), reach(2, 8)), (10_000, reach(2, 2), reach(2, 6))];
        publish(&[&steps[..], &[(19_999, reach(2, 2), reach(2, 6)), (20_000, reach(2, 2), reach(2, 2))]].concat());
    }

    #[test]
    fn before_anything_was_published_the_worst_held() {
        assert_eq!(Limits::first(at(7), reach(2, 8)).before, AccelerationRange::WORST);
        assert_eq!(
            Limits::first(at(7), reach(2, 14)).before,
            AccelerationRange { braking: reach(2, 14).braking, ..AccelerationRange::WORST }
        );
    }
}
