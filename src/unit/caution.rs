//! What the unit is careful by: what is certain of its peers and what its range sensor sees enter; what is still known of the
//! vehicle ahead without its messages, and the command that the last gate lets through, leave.

use super::{OnboardUnit, RANGE_TIMEOUT};
use crate::config::Envelope;
use crate::controller::Facts;
use crate::envelope;
use crate::estimator::bound::Bound;
use crate::estimator::{Reading, State};
use crate::parameters::{
    ACCELERATION_ROUNDING, POSITION_ROUNDING, REACH, SPEED_ROUNDING, UNPUBLISHED_POSITION_ACCURACY,
    UNPUBLISHED_SPEED_ACCURACY,
};
use crate::peers::Sample;
use crate::time::Instant;
use crate::units::{Acceleration, Position};

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// What is certain of a peer at an instant, now or later.
    #[must_use]
    pub fn bound(&self, index: usize, at: Instant) -> Option<Bound> {
        let track = self.peers.get(index)?;
        Some(track.certainty().bound()?.after(at, &track.reach()))
    }

    /// The rear bumper of the vehicle ahead as far as it is still known without its messages: as the range sensor sees it,
    /// or the near end of what is certain. Never a stale sample. A target that comes by another leg is not what the sensor
    /// sees: of the two, the one that is nearer.
    pub(super) fn still_known(&self, now: Instant, target: Option<usize>) -> Option<Reading> {
        let seen = self.ranging.ahead(now, RANGE_TIMEOUT);
        if seen.is_some() && target == self.visible() {
            return seen;
        }
        let certain = target.and_then(|index| self.certain_rear(now, index));
        [seen, certain].into_iter().flatten().min_by_key(|rear| rear.position)
    }

    /// The rear bumper at the near end of what is certain of a peer.
    fn certain_rear(&self, now: Instant, index: usize) -> Option<Reading> {
        let bound = self.bound(index, now)?;
        let position = bound.lowest_position().ahead(self.length_of(index).negated());
        // The law takes positions modulo 4096 m: what was left far behind must not turn up ahead.
        let ego = self.ego.as_ref()?.position;
        let gap = position.ahead_of(ego).limited(REACH.negated(), REACH);
        Some(Reading { position: ego.ahead(gap), speed: bound.lowest_speed() })
    }

    /// The last gate, with the ego at the less safe end of its accuracies: the command as it is encoded, and whether the
    /// gate changed the demand.
    #[allow(clippy::too_many_arguments)] // all of them are of one tick
    pub(super) fn gate(
        &self,
        limits: &Envelope,
        now: Instant,
        demand: Acceleration,
        last: Acceleration,
        ego: Option<&State>,
        facts: &Facts,
        target: Option<usize>,
    ) -> (Acceleration, bool) {
        let sample = self.ego.get().unwrap_or(Sample::UNKNOWN);
        let state = ego.copied().unwrap_or_default();
        let moved = state.position.ahead_of(sample.position.ring());
        let off = sample.position_accuracy.unwrap_or(UNPUBLISHED_POSITION_ACCURACY).plus(POSITION_ROUNDING);
        let faster = sample.speed_accuracy.unwrap_or(UNPUBLISHED_SPEED_ACCURACY).plus(SPEED_ROUNDING);
        let late = sample.speed.plus(faster).over(self.config.link.clock_error.seconds());
        let ego = envelope::Ego {
            position: sample.position.ahead(moved).ahead(off).ahead(late),
            speed: state.speed.plus(faster),
            acceleration: state.acceleration.plus(ACCELERATION_ROUNDING),
            last,
            lag: self.config.lag,
        };
        // As far back as it may be: a vehicle that may be inside a conflict area already has to clear it.
        let rearmost = sample.position.ahead(moved).ahead(off.negated()).ahead(late.negated());
        let heard = match self.coordination.itinerary() {
            None => target.and_then(|index| self.stop_behind(index)),
            Some(_) => [self.stop_on_lane(), self.stop_at_crossing(now, rearmost)].into_iter().flatten().min(),
        };
        let stop_before = [heard, self.stop_behind_seen(now)].into_iter().flatten().min();
        let situation = envelope::Situation { is_fresh: facts.ego.is_ok(), stop_before };
        let command = envelope::gate(limits, demand, &ego, &situation, self.config.period);
        (envelope::encodable(limits, command), command != demand)
    }

    /// On an itinerary: before the conflict area for every one whose way crosses the ego's and who is ahead in the order, or is
    /// in the area for certain: who gave way when it could not stop any more is there all the same.
    fn stop_at_crossing(&self, now: Instant, rearmost: Position) -> Option<Position> {
        (0..PEERS).filter_map(|index| self.stop_before_area(now, index, rearmost)).min()
    }

    fn stop_before_area(&self, now: Instant, index: usize, rearmost: Position) -> Option<Position> {
        let (standing, crossing) = (self.coordination.standing(index)?, self.coordination.crossing()?);
        let intersection = crossing.intersection;
        let point = self.coordination.crossing_point(crossing)?;
        let area_begins = self.area_begins()?;
        if rearmost > area_begins || !intersection.conflict(crossing.leg, standing.leg) {
            return None;
        }
        let near_end = self.bound(index, now)?.lowest_position();
        let is_inside = near_end >= area_begins && self.coordination.is_here(standing);
        if !is_inside && !self.coordination.choice().ahead.contains(index) {
            return None;
        }
        envelope::stop_before_conflict(area_begins, near_end, self.length_of(index), point.ahead(intersection.half))
    }

    /// The point behind a peer before which the ego has to be able to stop.
    pub(super) fn stop_behind(&self, index: usize) -> Option<Position> {
        let track = self.peers.get(index)?;
        let stop = track.certainty().bound()?.nearest_stop(&track.reach());
        Some(envelope::stop_behind(stop, self.length_of(index)))
    }

    /// The same behind whatever the range sensor sees that is not known to be the target.
    fn stop_behind_seen(&self, now: Instant) -> Option<Position> {
        let (rear, reach) = self.ranging.stranger(now, RANGE_TIMEOUT)?;
        Some(rear.nearest_stop(&reach))
    }
}
