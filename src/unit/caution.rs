//! What the unit is careful by: what is certain of its peers and what its range sensor sees enter; what is still known of the
//! vehicle ahead without its messages, and the command that the last gate lets through, leave.

use super::{OnboardUnit, RANGE_TIMEOUT};
use crate::config::Envelope;
use crate::controller::Facts;
use crate::envelope::{self, Obstacle, Reckoning, Spare};
use crate::estimator::bound::Bound;
use crate::estimator::{Reading, State};
use crate::parameters::{
    DEFAULT_LENGTH, POSITION_ROUNDING, REACH, SPEED_ROUNDING, UNPUBLISHED_POSITION_ACCURACY, UNPUBLISHED_SPEED_ACCURACY,
};
use crate::peers::Sample;
use crate::time::Instant;
use crate::units::{Acceleration, Distance, Position};

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
        let length = self.peers.get(index)?.intent().map_or(DEFAULT_LENGTH, |intent| intent.length);
        let position = bound.lowest_position().ahead(length.negated());
        // The law takes positions modulo 4096 m: what was left far behind must not turn up ahead.
        let ego = self.ego.as_ref()?.position;
        let gap = position.ahead_of(ego).limited(REACH.negated(), REACH);
        Some(Reading { position: ego.ahead(gap), speed: bound.lowest_speed() })
    }

    /// The last gate, with the ego at the less safe end of its accuracies: the command as it is encoded, and whether the
    /// gate changed the demand.
    #[allow(clippy::too_many_arguments)] // all of them are of one tick
    pub(super) fn gate(
        &mut self,
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
        let start = envelope::Start {
            at: sample.at,
            position: sample.position.ahead(off).ahead(late),
            speed: sample.speed.plus(faster),
            acceleration: sample.acceleration,
        };
        let reckoning = Reckoning::carry(&mut self.reckoning, &start, now, last, limits);
        let ego = reckoning.ego(limits, last, self.config.lag);
        // As far back as it may be: a vehicle that may be inside a conflict area already has to clear it.
        let rearmost = sample.position.ahead(moved).ahead(off.negated()).ahead(late.negated());
        let spare = |obstacle: Obstacle| envelope::spare(limits, &ego, &obstacle);
        let heard = match self.coordination.itinerary() {
            None => target.and_then(|index| self.obstacle(now, index)).map(spare),
            Some(_) => {
                let crossing = self.stop_at_crossing(now, rearmost).map(Obstacle::standing);
                self.stop_on_lane(now, &ego).chain(crossing).map(spare).min()
            }
        };
        let seen = self.obstacle_seen(now).map(spare);
        let spare = [heard, seen].into_iter().flatten().min().unwrap_or(Spare::ENDLESS);
        let situation = envelope::Situation { is_fresh: facts.ego.is_ok(), spare };
        let command = envelope::gate(limits, demand, &ego, &situation, self.config.period);
        (envelope::encodable(limits, command), command != demand)
    }

    /// On an itinerary: behind everyone ahead on the same leg. Who is estimated to be the nearest of them need not be: one that
    /// is silent may have braked where it is estimated to have driven on, past another one that is heard.
    fn stop_on_lane(&self, now: Instant, ego: &envelope::Ego) -> impl Iterator<Item = Obstacle> {
        let choice = self.coordination.choice();
        let leading = (0..PEERS)
            .filter(move |index| choice.leading.contains(*index))
            .filter(move |index| self.is_heeded(*index, now, ego.position, ego.speed));
        leading.chain(choice.lane.map(usize::from)).filter_map(move |index| self.obstacle(now, index))
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
        let area_begins = point.ahead(intersection.half.negated());
        if rearmost > area_begins || !intersection.conflict(crossing.leg, standing.leg) {
            return None;
        }
        let near_end = self.bound(index, now)?.lowest_position();
        let is_inside = near_end >= area_begins && self.coordination.is_here(standing);
        if !is_inside && !self.coordination.choice().ahead.contains(index) {
            return None;
        }
        let length = self.peers.get(index)?.intent().map_or(DEFAULT_LENGTH, |intent| intent.length);
        envelope::stop_before_conflict(area_begins, near_end, length, point.ahead(intersection.half))
    }

    /// The rear of a peer at its near end, behind which the ego has to stay.
    fn obstacle(&self, now: Instant, index: usize) -> Option<Obstacle> {
        let track = self.peers.get(index)?;
        let length = track.intent().map_or(DEFAULT_LENGTH, |intent| intent.length);
        Some(Obstacle::rear(&self.bound(index, now)?, length, &track.reach()))
    }

    /// The same of whatever the range sensor sees that is not known to be the target.
    fn obstacle_seen(&self, now: Instant) -> Option<Obstacle> {
        let (rear, reach) = self.ranging.stranger(now, RANGE_TIMEOUT)?;
        Some(Obstacle::rear(&rear.after(now, &reach), Distance::ZERO, &reach))
    }
}
