//! The on-board range sensor. Its view of the vehicle ahead enters. What is certain of the target is narrowed by it, and the estimate is
//! corrected by it; whether the two agree leaves.
//!
//! The view shows the nearest vehicle on the ego's path. So no vehicle whose place is on that path is nearer, and the near ends of these
//! vehicles are raised to it. A sensor that says that nobody is near raises them likewise, as far as it sees. A view from before the
//! driver named the target is not of the target. While view and messages contradict one another, neither changes the other, and the unit
//! drives by what it sees.
//!
//! A frame with a view is only kept; the next tick looks at the view ([`Scene::look`]), so that a frame costs little.
//!
//! A view errs more than a message, and is newer. So both are fused to one track (`fusion`), from which the horizon of a vehicle starts
//! that does not say how it will drive: its braking is seen before it is heard, and also in a silence. The horizon of a vehicle that said
//! how it will drive stays as it said, as long as the estimated speed may be right: by the largest error of a view, and by the usual one, a
//! third of it, of three views in a row. Then a view moves that horizon by a part of what is beyond a view's usual error. So fresh
//! messages, and horizons that are right, are hardly corrected.

use super::Scene;
use super::sight::{Sight, Verdict, Whose};
use crate::fixed::quotient;
use crate::health::{Cause, Health};
use crate::model::bound::{Bound, Uncertainty};
use crate::parameters::{DEFAULT_LENGTH, LENGTH_ROUNDING, POSITION_ROUNDING, SHORTEST, SPEED_ROUNDING};
use crate::peers::{Sample, Track, excess, largest_error, largest_speed_error};
use crate::time::{Duration, Instant};
use crate::units::{Distance, Position, Speed};
use crate::wire::Slot;
use crate::wire::range_sensor::RangeSample;

/// From when the sensor sends a view to when the view has been on the bus, at most: it waits for a frame that is on the bus, and
/// for those of a tick that win over it.
const ON_BUS: Duration = Duration::from_millis(3);

/// By how much the length of a vehicle may differ from the default one: a lorry with a trailer is 18.75 m long.
const LENGTHS: Distance = Distance::from_mm(13_950);

/// A view that the estimate may be right about corrects it by at most this fraction, one in so many: a view errs by more than an
/// estimate.
const MOST_SHARE: i64 = 10;

/// A correction by less than this fraction, one in so many, is not made.
const LEAST_SHARE: i64 = 16;

/// A view while it is looked at.
#[derive(Clone, Copy)]
struct View {
    sight: Sight,
    uncertainty: Uncertainty,
    /// How much of the uncertainty of the place is beyond the accuracies that were told.
    excess: Distance,
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// Keeps a view of the vehicle ahead, received at `received`, for the next tick.
    ///
    /// # Errors
    /// [`Cause::Torn`] without an own motion, and [`Cause::Stale`] if that is too old or too new for the view.
    pub(super) fn take_range(
        &mut self,
        received: Instant,
        seen: RangeSample,
        health: &mut Health,
    ) -> Result<(), Cause> {
        let ego = self.ego.as_ref().ok_or(Cause::Torn)?;
        let since = received.minus(seen.age).since(ego.at);
        let earliest = Duration::ZERO.minus(RangeSample::OLDEST).minus(self.config.link.ego_timeout);
        if since > self.config.link.ego_timeout || since < earliest {
            return Err(Cause::Stale);
        }
        // A sensor with a shorter cycle than the unit's period costs more.
        if let Some((received, seen)) = self.ranging.wait(received, seen) {
            self.look_at(received, &seen, health);
        }
        Ok(())
    }

    /// Takes in the view that came since the last tick.
    pub fn look(&mut self, health: &mut Health) {
        if let Some((received, seen)) = self.ranging.take_waiting() {
            self.look_at(received, &seen, health);
        }
    }

    #[inline(never)] // keeps its stack apart from that of the doors
    fn look_at(&mut self, received: Instant, seen: &RangeSample, health: &mut Health) {
        let Some(ego) = self.ego.as_ref() else { return };
        let at = received.minus(seen.age);
        let since = at.since(ego.at);
        // The ego's own motion, moved to the instant of the view.
        let gained = ego.acceleration.over(since.fine_seconds());
        let mean = ego.speed.plus(Speed::from_bits(gained.to_bits() / 2));
        let front = ego.position.ahead(mean.over(since.seconds()));
        let rear = front.ahead(seen.distance);
        let speed = ego.speed.plus(gained).plus(seen.speed_difference).max(Speed::ZERO);
        let uncertainty = self.uncertainty_of_sight(ego, since, seen);
        let excess = excess(Some(seen.distance_accuracy)).plus(excess(ego.position_accuracy));
        let mut view = View { sight: Sight::new(at, rear, speed, &uncertainty), uncertainty, excess };
        if seen.nobody {
            return self.take_nobody(received, &view.sight, health);
        }
        self.ranging.note_seen(at);
        let visible = self.visible();
        self.raise_others(visible, &view.sight);
        view.sight.is_on_leg = self.is_on_leg(&view.sight);
        let is_on_leg = view.sight.is_on_leg;
        if self.is_of_one_that_crosses(&view.sight, front) {
            // The vehicle ahead holds the ego only where it stands. It is in the area, whoever else was heard in there.
            let holds = if is_on_leg { view.sight.stands() } else { !self.is_crossing_heard(at) };
            if holds {
                self.ranging.see_crossing(view.sight);
            }
            if !is_on_leg {
                return;
            }
        }
        if let Some(index) = visible.filter(|_| self.ranging.is_of_named(at.minus(ON_BUS))) {
            view.sight.whose = self.compare(received, index, &view, health);
        }
        self.ranging.see(view.sight);
    }

    /// Raises the near ends of the vehicles that are ahead for certain, without this one.
    fn raise_others(&mut self, visible: Option<usize>, sight: &Sight) {
        let leading = self.coordination.choice().leading;
        for index in (0..PEERS).filter(|index| Some(*index) != visible && leading.contains(*index)) {
            self.raise(index, sight);
        }
    }

    /// Takes in that no vehicle is nearer than a place.
    fn take_nobody(&mut self, now: Instant, free: &Sight, health: &mut Health) {
        let visible = self.visible();
        self.raise_others(visible, free);
        // What was free before the driver named a vehicle may have been so because that one was not on the path yet.
        let named = visible.filter(|_| self.ranging.is_of_named(free.at.minus(ON_BUS)));
        if let Some((index, whose)) = named.and_then(|index| Some((index, self.whose(index)?))) {
            let heard = self.heard_of(index).and_then(|(_, heard)| heard);
            let verdict = if self.raise(index, free) { Verdict::Agrees } else { Verdict::SeesPast };
            if self.ranging.judge(whose, now, verdict, heard) {
                health.count(Cause::RangeDisagrees);
            }
        }
        self.ranging.see_nobody(free);
    }

    /// Raises the near end of a peer: no vehicle on the ego's path is nearer than what is seen. Returns whether the peer may be farther
    /// than that.
    fn raise(&mut self, index: usize, sight: &Sight) -> bool {
        let Some(track) = self.peers.get_index_mut(index) else { return true };
        // However long the peer is, its front is not behind its rear.
        let length = track.published_length().unwrap_or(Distance::ZERO);
        let place = sight.bound.lowest_position().ahead(length);
        // A near end never moves back.
        track.certainty().bound().is_some_and(|bound| bound.lowest_position() >= place)
            || track.narrow(&Bound::not_behind(sight.bound.at(), place))
    }

    /// What is uncertain of a view: the accuracies of the sensor and of the ego, and what the ego may have done between its own sample
    /// and the view.
    fn uncertainty_of_sight(&self, ego: &Sample, since: Duration, seen: &RangeSample) -> Uncertainty {
        // The age of the view is rounded up to a whole millisecond, in which the ego moved on.
        let unsaid = Duration::from_millis(1).min(seen.age);
        let clock_error = self.config.link.clock_error;
        let apart =
            Duration::from_micros(since.as_micros().saturating_abs()).plus(unsaid).plus(ON_BUS).plus(clock_error);
        let swing = self.config.limits.emergency_braking.plus(ego.acceleration.magnitude());
        let faster = swing.over(apart.fine_seconds());
        let (own, own_speed) = (ego.position_error(), ego.speed_error());
        let late = ego.speed.plus(own_speed).over(self.own_clock_error(ego).plus(ON_BUS).plus(unsaid).seconds());
        let roundings = POSITION_ROUNDING.plus(LENGTH_ROUNDING);
        let moved = own_speed.plus(faster).over(apart.seconds());
        Uncertainty {
            position: largest_error(seen.distance_accuracy).plus(own).plus(moved).plus(late).plus(roundings),
            speed: largest_speed_error(seen.speed_accuracy)
                .plus(own_speed)
                .plus(faster)
                .plus(SPEED_ROUNDING)
                .plus(SPEED_ROUNDING),
            earlier: clock_error.plus(ON_BUS),
            later: unsaid,
        }
    }

    /// Returns the station of the peer if the view is certainly of that peer; then the view narrows what is certain of the peer. It is
    /// certain if the view agrees with what is certain of the peer, and if this leaves no room for another vehicle. A view that may be of
    /// the peer or of another vehicle only corrects the estimate.
    fn compare(&mut self, now: Instant, index: usize, view: &View, health: &mut Health) -> Option<Whose> {
        let sight = &view.sight;
        let is_disputed = self.is_contradicted(index, now);
        let whose = self.whose(index)?;
        let track = self.peers.get_index_mut(index)?;
        let heard = track.newest().map(|newest| newest.received);
        let Some(length) = track.published_length() else {
            self.raise(index, sight);
            self.correct_without_length(index, view);
            return None;
        };
        let front = sight.rear.ahead(length);
        let reach = track.reach();
        let seen = track.around(sight.at, front, sight.speed, &view.uncertainty);
        let before = track.certainty().bound().map(|bound| bound.after(sight.at, &reach));
        let verdict = if track.certainty().bound().is_none_or(|bound| bound.and(&seen, &reach).is_some()) {
            Verdict::Agrees
        } else if before.is_some_and(|bound| bound.highest_position() < seen.lowest_position()) {
            Verdict::SeesPast
        } else {
            Verdict::Contradicts
        };
        if self.ranging.judge(whose, now, verdict, heard) {
            health.count(Cause::RangeDisagrees);
        }
        if is_disputed {
            return None;
        }
        if verdict != Verdict::Agrees {
            self.raise(index, sight);
            return None;
        }
        let bound = before?;
        // Another vehicle would have to be between: its rear not before what is seen, its front not past the peer's rear. What the peer's
        // own accuracy leaves open is room: one vehicle told its place that wrongly is enough.
        let newest = track.newest().copied();
        let room = bound.highest_position().ahead_of(seen.lowest_position()).minus(view.excess);
        let is_certain = room < SHORTEST;
        let track = self.peers.get_index_mut(index)?;
        if is_certain {
            track.narrow(&seen);
        } else {
            self.raise(index, sight);
        }
        if let Some(newest) = newest {
            self.correct(index, view, front, &bound, &newest);
        }
        is_certain.then_some(whose)
    }

    /// Corrects the estimate of a peer whose length is not known by a view that may be of that peer. It says little of where the front
    /// is, and as much as any of the speed.
    fn correct_without_length(&mut self, index: usize, view: &View) {
        let mut wide = *view;
        wide.uncertainty.position = wide.uncertainty.position.plus(LENGTHS);
        let View { sight, uncertainty, .. } = &wide;
        let front = sight.rear.ahead(DEFAULT_LENGTH);
        let Some(track) = self.peers.get(index) else { return };
        let reach = track.reach();
        let seen = track.around(sight.at, front, sight.speed, uncertainty);
        let held = track.certainty().bound().filter(|bound| bound.and(&seen, &reach).is_some());
        let before = held.map(|bound| bound.after(sight.at, &reach));
        if let Some((bound, newest)) = before.zip(track.newest().copied()) {
            self.correct(index, &wide, front, &bound, &newest);
        }
    }

    /// Whether what is seen and what is heard of a peer contradict one another.
    pub fn is_contradicted(&self, index: usize, now: Instant) -> bool {
        self.heard_of(index).is_some_and(|(whose, heard)| self.ranging.disagrees(whose, now, heard))
    }

    /// Whether the sensor sees that a peer is not where it is held to be.
    pub fn is_seen_past(&self, index: usize, now: Instant) -> bool {
        self.heard_of(index).is_some_and(|(whose, heard)| self.ranging.sees_past(whose, now, heard))
    }

    /// Whose place is in a slot.
    pub fn whose(&self, index: usize) -> Option<Whose> {
        Some((Slot(u8::try_from(index).ok()?), self.peers.get(index)?.station()?))
    }

    fn heard_of(&self, index: usize) -> Option<(Whose, Option<Instant>)> {
        let track = self.peers.get(index)?;
        Some((self.whose(index)?, track.newest().map(|newest| newest.received)))
    }

    /// Corrects the estimate by the view. The horizon of a vehicle that does not say how it will drive starts from the fused track. Where
    /// the vehicle did say so, and the estimated speed may be right, its horizon is moved. Where that speed is wrong, certainly or by
    /// several views in a row, it starts from the fused track too.
    fn correct(&mut self, index: usize, view: &View, front: Position, bound: &Bound, newest: &Sample) {
        let Some(whose) = self.whose(index) else { return };
        let View { sight, uncertainty, .. } = view;
        self.fused.see(whose, sight, uncertainty, front, newest);
        let Some(estimate) = self.estimator.read(index, sight.at) else { return };
        let faster = sight.speed.minus(estimate.speed);
        let usual_speed = Speed::from_bits(uncertainty.speed.to_bits() / 3);
        let is_wrong = self.fused.is_beside(faster, usual_speed) || faster.magnitude() > uncertainty.speed;
        if is_wrong || !self.estimator.is_foreseen(index, &self.peers) {
            self.fused.want();
            return;
        }
        let half = |high: Position, low: Position| Distance::from_bits(high.ahead_of(low).to_bits() / 2);
        let width = half(bound.highest_position(), bound.lowest_position());
        let (share, whole) = weight(i64::from(width.to_bits()), i64::from(uncertainty.position.to_bits()));
        let share = share.min(quotient(whole, MOST_SHARE));
        if share.saturating_mul(LEAST_SHARE) >= whole {
            let off = mixed(beyond(front.ahead_of(estimate.position), usual(uncertainty)).to_bits(), share, whole);
            self.estimator.move_horizon(index, Distance::from_bits(off));
        }
    }

    /// Takes the newest message of a peer into the fused track, if the peer is the one that is seen.
    pub(super) fn fuse_message(&mut self, index: usize, now: Instant) {
        let (Some(whose), Some(message)) = (self.whose(index), self.peers.get(index).and_then(Track::newest)) else {
            return;
        };
        if self.fused.hear(whose, now, message) && !self.estimator.is_foreseen(index, &self.peers) {
            self.fused.want();
        }
    }
}

/// By how much the place in a view errs usually: a third of its largest error.
fn usual(uncertainty: &Uncertainty) -> Distance {
    Distance::from_bits(uncertainty.position.to_bits() / 3)
}

/// What of a distance is beyond this magnitude.
fn beyond(distance: Distance, magnitude: Distance) -> Distance {
    distance.minus(distance.limited(magnitude.negated(), magnitude))
}

/// The weight of the sensor: `width² / (width² + accuracy²)`, as a fraction of small numbers.
fn weight(width: i64, accuracy: i64) -> (i64, i64) {
    let square = |word: i64| (word.clamp(0, 1 << 30) >> 8).saturating_mul(word.clamp(0, 1 << 30) >> 8);
    (square(width), square(width).saturating_add(square(accuracy)).max(1))
}

fn mixed(word: i32, share: i64, whole: i64) -> i32 {
    // Weights are up to 2⁴⁴ and words up to 2³¹. So the product needs a shift first.
    let (share, whole) = (share >> 14, (whole >> 14).max(1));
    crate::fixed::saturate_i32(i64::from(word).saturating_mul(share).checked_div(whole).unwrap_or(0))
}
