//! Where the ego has to be able to stop by what is estimated: where it is, and how the one ahead on its leg gets on, enter; whether it
//! is held before the next conflict area, and how much it may accelerate, leave.
//!
//! Whoever stands in a conflict area blocks those who cross. So nobody enters who could not leave it again, because the one ahead
//! has come to a stand beyond it, or is about to. And while it waits for that it lets everyone else go first: they may be those for
//! whom the one ahead waits, round a whole block.

use super::OnboardUnit;
use crate::config::Envelope;
use crate::envelope::{self, Obstacle};
use crate::estimator::State;
use crate::fixed::{quotient, saturate_i32};
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Fraction, Position, Speed};

/// From when the ego enters until it has left a conflict area, about; as far as every unit looks ahead.
const LEAVES: Duration = Duration::from_millis(3_900);

/// Slower than this a vehicle waits.
const WAITING: Speed = Speed::from_mm_per_s(500);

/// Slower than this a vehicle is in a queue.
const SLOW: Speed = Speed::from_mm_per_s(3_000);

/// Slower than this a vehicle may be about to stop in one.
const QUEUED: Speed = Speed::from_mm_per_s(5_000);

/// How far before the conflict area the ego stops, and at least behind the one ahead.
const LINE: Distance = Distance::from_mm(1_000);

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// Where the next conflict area begins.
    pub(super) fn area_begins(&self) -> Option<Position> {
        let crossing = self.coordination.crossing()?;
        Some(self.coordination.crossing_point(crossing)?.ahead(crossing.intersection.half.negated()))
    }

    /// Whether the ego, with its front bumper there, at this speed, could not stop before the next conflict area as it brakes in
    /// normal driving: it gives way to nobody any more, as it would stand in the area and wait for one who cannot get past it.
    pub(super) fn is_committed(&self, front: Position, speed: Speed) -> bool {
        let Some(area_begins) = self.area_begins() else { return false };
        area_begins.ahead_of(front) <= self.stops_within(speed)
    }

    /// The way that the ego takes to stop as it brakes in normal driving, from when the law asks for it.
    fn stops_within(&self, speed: Speed) -> Distance {
        let limits = &self.config.limits;
        let mm_per_s2 = i64::from(limits.braking.to_mm_per_s2()).max(1);
        // Until the brakes are on: half of the ramp, and the lag.
        let ramp = quotient(mm_per_s2.saturating_mul(500), i64::from(limits.jerk.to_mm_per_s3()).max(1));
        let reaction_ms = ramp.saturating_add(i64::from(self.config.lag.to_millis()));
        let mm_per_s = i64::from(speed.to_mm_per_s());
        let reacting = quotient(mm_per_s.saturating_mul(reaction_ms), 1_000);
        Distance::from_mm(saturate_i32(reacting.saturating_add(braked(mm_per_s, mm_per_s2))))
    }

    /// Whether there will be room beyond the next conflict area behind that one, the nearest ahead on the ego's leg. Who stands is
    /// there still: that it wants to move off is not that it can.
    pub(super) fn has_room(&self, ahead: Option<usize>, now: Instant) -> bool {
        let (Some(index), Some(end)) = (ahead, self.coordination.end_of(self.coordination.next())) else { return true };
        let Some((reading, rear)) = self.rear(index, now) else { return true };
        let later = self.rear(index, now.plus(LEAVES)).filter(|_| reading.speed > WAITING);
        let rear = later.map_or(rear, |(_, rear)| rear);
        rear >= end.ahead(self.config.length).ahead(self.standstill_at(self.coordination.next(), index))
    }

    /// Whether the ego, at this speed, stands before the next conflict area for want of room, and is the first to do so on its leg.
    pub(super) fn waits_for_room(&self, ahead: Option<usize>, now: Instant, speed: Speed) -> bool {
        let is_first = |index| self.rear(index, now).is_some_and(|(_, rear)| Some(rear) >= self.area_begins());
        speed <= WAITING && ahead.is_none_or(is_first)
    }

    /// The largest acceleration with which the ego can still come to a stand, braking as it does in normal driving, behind the one
    /// ahead on its leg, where that is estimated to do the same now; and, where it is held, before the next conflict area. The law asks
    /// for gaps, and closing in fast it may ask for too much too late.
    pub(super) fn careful(&self, now: Instant, ego: &State) -> Acceleration {
        let Some(sample) = self.ego.as_ref().filter(|_| self.coordination.itinerary().is_some()) else {
            return Acceleration::MAX;
        };
        let choice = self.coordination.choice();
        let behind = choice.lane.and_then(|index| self.stops_at(index.into(), now));
        let line = self.area_begins().filter(|_| choice.is_held).map(|begins| begins.ahead(LINE.negated()));
        let limits = &self.config.limits;
        let normal = Envelope {
            acceleration: limits.acceleration,
            braking: limits.braking,
            jerk: limits.jerk,
            speed: self.config.law.max_speed,
            margin: Distance::ZERO,
            delay: Duration::ZERO,
            lag_tolerance: Fraction::ZERO,
        };
        let ego = envelope::Ego {
            position: sample.position.ahead(ego.position.ahead_of(sample.position.ring())),
            speed: ego.speed,
            acceleration: ego.acceleration,
            last: self.controller.last_demand(),
            lag: self.config.lag,
        };
        let spare = |obstacle| envelope::spare(&normal, &ego, &obstacle);
        let passes = self.passes_first(now, ego.position, ego.speed);
        let unknown = self.unknown_ahead(now).map(|rear| rear.ahead(LINE.negated()));
        let stop = [behind, line, passes, unknown].into_iter().flatten().min().map(Obstacle::standing).map(spare);
        let Some(spare) = stop else { return Acceleration::MAX };
        envelope::distance_cap(&normal, spare, self.config.period).max(limits.braking.negated())
    }

    /// Where the ego, with its front bumper there, at this speed, waits as long as somebody who crosses its way, and is ahead in the order or in the
    /// next conflict area already, is estimated not to have left it by the time that the ego would be there: before that area. The law looks at the
    /// last one ahead alone, and once that one has been announced; it starts early, too, and from a stand the ego is there at once.
    fn passes_first(&self, now: Instant, front: Position, speed: Speed) -> Option<Position> {
        let (crossing, line) = (self.coordination.crossing()?, self.area_begins()?);
        let end = self.coordination.end_of(self.coordination.next())?;
        if front > line {
            return None;
        }
        let micros = quotient(
            i64::from(line.ahead_of(front).to_mm()).saturating_mul(1_000_000),
            i64::from(speed.to_mm_per_s()).max(1),
        );
        let then = if speed <= SLOW { now } else { now.plus(Duration::from_micros(micros).min(LEAVES)) };
        let is_due = |index: &usize| {
            let Some(standing) = self.coordination.standing(*index) else { return false };
            let is_inside = || {
                self.coordination.is_here(standing)
                    && self.rear(*index, now).is_some_and(|(reading, _)| reading.position > line)
            };
            crossing.intersection.conflict(crossing.leg, standing.leg)
                && (self.coordination.choice().ahead.contains(*index) || is_inside())
                && self.rear(*index, then).is_some_and(|(_, rear)| rear < end)
        };
        (0..PEERS).any(|index| is_due(&index)).then(|| line.ahead(LINE.negated()))
    }

    /// Where the rear bumper of a peer is estimated to come to a stand if it brakes now as the ego does, less the margin. That one which
    /// was hardly moving when it was heard last has moved on since is not believed for as long as a holdover lasts: whom it waits
    /// for may have changed.
    fn stops_at(&self, index: usize, now: Instant) -> Option<Position> {
        let braking = i64::from(self.config.limits.braking.to_mm_per_s2()).max(1);
        let way = |speed: Speed| Distance::from_mm(saturate_i32(braked(i64::from(speed.to_mm_per_s()), braking)));
        let track = self.peers.get(index)?;
        let is_silent = !track.link().is_on(now, &self.config.link) && self.is_in_reach(index, now);
        let length = self.length_of(index);
        if let Some(newest) = track.newest().filter(|newest| is_silent && newest.speed <= QUEUED) {
            let certain = self.bound(index, now)?.lowest_position();
            let at_rest = if newest.speed <= SLOW { certain } else { newest.position.ahead(way(newest.speed)) };
            return Some(at_rest.ahead(length.negated()).ahead(LINE.negated()));
        }
        let (reading, rear) = self.rear(index, now)?;
        Some(rear.ahead(way(reading.speed)).ahead(LINE.negated()))
    }
}

/// The way of a braking to a stand, rounded.
fn braked(mm_per_s: i64, mm_per_s2: i64) -> i64 {
    quotient(mm_per_s.saturating_mul(mm_per_s), mm_per_s2.saturating_mul(2))
}
