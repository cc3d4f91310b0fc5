//! What the unit is careful by: what is certain of its peers and what its range sensor sees enter; what is still known of the
//! vehicle ahead without its messages, and the command that the last gate lets through, leave.

use super::OnboardUnit;
use crate::config::Envelope;
use crate::controller::Facts;
use crate::envelope::{self, Obstacle, Reckoning, Spare};
use crate::estimator::bound::{AccelerationRange, Bound};
use crate::estimator::{Reading, State};
use crate::parameters::{
    DEFAULT_LENGTH, POSITION_ROUNDING, REACH, SPEED_ROUNDING, UNPUBLISHED_POSITION_ACCURACY, UNPUBLISHED_SPEED_ACCURACY,
};
use crate::peers::Sample;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Position, Speed};
use crate::wire::Predecessor;

/// What is certain of a vehicle that has no slot any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Displaced {
    bound: Bound,
    reach: AccelerationRange,
    length: Distance,
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// What is certain of a peer at an instant, now or later.
    #[must_use]
    pub fn bound(&self, index: usize, at: Instant) -> Option<Bound> {
        let track = self.peers.get(index)?;
        Some(track.certainty().bound()?.after(at, &track.reach()))
    }

    /// Where a peer is estimated to be, inside what is certain of it then.
    pub(super) fn estimated(&self, index: usize, at: Instant) -> Option<Reading> {
        self.estimator.read_inside(index, at, &self.peers)
    }

    /// The rear bumper of the vehicle ahead as far as it is still known without its messages: as the range sensor sees it,
    /// or the near end of what it has seen standing, or the near end of what is certain of the target, unless the sensor sees
    /// that it is not there. Never a stale sample. A target that comes by another leg is not what the sensor sees: of the two,
    /// the one that is nearer.
    pub(super) fn still_known(&self, now: Instant, target: Option<usize>) -> Option<Reading> {
        let seen = self.ranging.ahead(now);
        if seen.is_some() && target == self.visible() {
            return seen;
        }
        let stood = self.ranging.standing(now).map(|sight| sight.bound().after(now, &AccelerationRange::WORST));
        let stood = stood.and_then(|bound| self.near(bound.lowest_position(), bound.lowest_speed()));
        let target = target.filter(|index| !self.is_seen_past(*index, now));
        let certain = target.and_then(|index| self.certain_rear(now, index));
        [seen.or(stood), certain].into_iter().flatten().min_by_key(|rear| rear.position)
    }

    /// The rear bumper at the near end of what is certain of a peer.
    fn certain_rear(&self, now: Instant, index: usize) -> Option<Reading> {
        let bound = self.bound(index, now)?;
        self.near(bound.lowest_position().ahead(self.length_of(index).negated()), bound.lowest_speed())
    }

    /// The law takes positions modulo 4096 m: what was left far behind must not turn up ahead.
    fn near(&self, position: Position, speed: Speed) -> Option<Reading> {
        let ego = self.ego.as_ref()?.position;
        let gap = position.ahead_of(ego).limited(REACH.negated(), REACH);
        Some(Reading { position: ego.ahead(gap), speed })
    }

    /// Takes note of whom the driver has put ahead. A name that nobody has been heard by says nothing of where that one is, so
    /// whoever was ahead before is minded until then, or until the driver says that nobody is.
    pub(super) fn note_named(&mut self, target: Option<usize>) {
        if target.is_some() {
            self.named = target.and_then(|index| u8::try_from(index).ok());
            self.displaced.clear();
        } else if self.predecessor() == Predecessor::None {
            self.named = None;
            self.displaced.clear();
        }
    }

    /// Keeps what is certain of whom the driver has put ahead, where it loses its slot to somebody else: it is still there.
    pub(super) fn displace(&mut self, index: usize) {
        if self.named.map(usize::from) != Some(index) {
            return;
        }
        self.named = None;
        if let Some(track) = self.peers.get(index)
            && let Some(bound) = track.certainty().bound()
        {
            self.displaced.set(Displaced { bound: *bound, reach: track.reach(), length: self.length_of(index) });
        }
    }

    /// The rear of whom the driver has put ahead, at its near end, unless the range sensor sees that it is not there.
    fn named_ahead(&self, now: Instant) -> Option<Obstacle> {
        if let Some(index) = self.named.map(usize::from) {
            return if self.is_seen_past(index, now) { None } else { self.obstacle(now, index) };
        }
        let Displaced { bound, reach, length } = self.displaced.get()?;
        Some(Obstacle::rear(&bound.after(now, &reach), length, &reach))
    }

    /// The last gate, with the ego at the less safe end of its accuracies: the command as it is encoded, and whether the
    /// gate changed the demand. The last command is from so long ago.
    #[allow(clippy::too_many_arguments)] // all of them are of one tick
    pub(super) fn gate(
        &mut self,
        limits: &Envelope,
        now: Instant,
        demand: Acceleration,
        last: Acceleration,
        ego: Option<&State>,
        facts: &Facts,
        since: Duration,
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
            None => self.named_ahead(now).map(spare),
            Some(_) => self.spare_on_way(now, rearmost, &spare),
        };
        let seen = self.obstacles_seen(now, rearmost).map(spare).min();
        let spare = [heard, seen].into_iter().flatten().min().unwrap_or(Spare::ENDLESS);
        let situation = envelope::Situation { is_fresh: facts.ego.is_ok(), spare };
        let command = envelope::gate_after(limits, demand, &ego, &situation, self.config.period, since);
        (envelope::encodable(limits, command), command != demand)
    }

    /// On an itinerary: what is to spare behind whoever is ahead for certain, as far as the ego may be back.
    pub(super) fn spare_on_way(
        &self,
        now: Instant,
        rearmost: Position,
        spare: &impl Fn(Obstacle) -> Spare,
    ) -> Option<Spare> {
        let stop =
            [self.stop_at_crossing(now, rearmost), self.stop_for_unknown(now, rearmost)].into_iter().flatten().min();
        let stop = stop.map(Obstacle::standing).map(spare);
        [self.spare_on_lane(now, spare), stop].into_iter().flatten().min()
    }

    /// On an itinerary: before the conflict area for every one whose way crosses the ego's and who is ahead in the order, or is
    /// in the area for certain: who gave way when it could not stop any more is there all the same. And before one at which it has
    /// not arrived, as it does not know the time: nobody minds it there.
    fn stop_at_crossing(&self, now: Instant, rearmost: Position) -> Option<Position> {
        let others = (0..PEERS).filter_map(|index| self.stop_before_area(now, index, rearmost));
        others.chain(self.stop_without_time(now, rearmost)).min()
    }

    fn stop_without_time(&self, now: Instant, rearmost: Position) -> Option<Position> {
        let next = self.coordination.next_of(self.coordination.next(), rearmost, self.config.length);
        let has_arrived = next == self.coordination.next() && self.coordination.registration().is_some();
        if has_arrived || self.is_synchronised(now) {
            return None;
        }
        let crossing = self.coordination.itinerary()?.crossings.get(next)?;
        let point = self.coordination.crossing_point(crossing)?;
        Some(point.ahead(crossing.intersection.half.negated())).filter(|begins| rearmost <= *begins)
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

    /// The rear of a peer at its near end, behind which the ego has to stay.
    pub(super) fn obstacle(&self, now: Instant, index: usize) -> Option<Obstacle> {
        let reach = self.peers.get(index)?.reach();
        Some(Obstacle::rear(&self.bound(index, now)?, self.length_of(index), &reach))
    }

    /// The same of everyone whom the range sensor has seen and who is not known to be the target. Past whom the ego has got by more
    /// than a vehicle's length is not on its path.
    fn obstacles_seen(&self, now: Instant, rearmost: Position) -> impl Iterator<Item = Obstacle> {
        let target = self.visible().and_then(|index| self.peers.get(index)?.station());
        let is_passed = move |rear: &Bound| rearmost.ahead_of(rear.lowest_position()) > DEFAULT_LENGTH;
        let ahead = self.ranging.strangers(now, target).filter(move |rear| !is_passed(rear));
        ahead.map(move |rear| {
            Obstacle::rear(&rear.after(now, &AccelerationRange::WORST), Distance::ZERO, &AccelerationRange::WORST)
        })
    }
}
