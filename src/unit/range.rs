//! The on-board range sensor: its view of the vehicle ahead enters; what is certain of the target is narrowed by it, the
//! estimate is corrected by it, and whether the two agree leaves.
//!
//! The sensor's and the estimate's positions are weighed by the squares of their uncertainties: the sensor's accuracy
//! against half the width of the target's bound, which grows with the age of what was heard over V2X. So fresh messages
//! are left alone, and in a long silence the sensor decides.

use super::OnboardUnit;
use crate::estimator::Reading;
use crate::estimator::bound::{Bound, Doubt, Reach};
use crate::health::Refusal;
use crate::held::Held;
use crate::parameters::{
    LENGTH_ROUNDING, POSITION_ROUNDING, SPEED_ROUNDING, UNPUBLISHED_POSITION_ACCURACY, UNPUBLISHED_SPEED_ACCURACY,
};
use crate::peers::Sample;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Position, Speed};
use crate::wire::range_sensor::RangeSample;

/// The sensor's newest view, at an instant of the unit's clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Sight {
    at: Instant,
    /// Rear bumper of the vehicle ahead.
    rear: Position,
    speed: Speed,
    doubt: Doubt,
    /// Whether it went into what is certain of the target.
    is_target: bool,
}

/// So many views in a row that contradict what is certain of the target are a disagreement.
const DISAGREEMENT: u8 = 3;

/// A correction of less than this share is not worth computing the horizon anew.
const LEAST_SHARE: i64 = 16;

/// The range sensor's part of the unit.
#[derive(Clone, Debug, Default)]
pub(super) struct Ranging {
    sight: Held<Sight>,
    contradictions: u8,
}

impl Ranging {
    pub(super) const fn new() -> Self {
        Self { sight: Held::Nothing, contradictions: 0 }
    }

    /// Whether what the sensor sees and what is heard contradict one another beyond what is uncertain of both. What is no
    /// longer seen contradicts nothing.
    pub(super) fn disagrees(&self, now: Instant, timeout: Duration) -> bool {
        self.contradictions >= DISAGREEMENT && self.newest(now, timeout).is_some()
    }

    /// What is certain of the rear of a vehicle that the sensor sees, and how fast it can change its speed, as long as it is
    /// not known to be the target.
    pub(super) fn stranger(&self, now: Instant, timeout: Duration) -> Option<(Bound, Reach)> {
        let sight = self.newest(now, timeout).filter(|sight| !sight.is_target)?;
        Some((Bound::around(sight.at, sight.rear, sight.speed, &sight.doubt, &Reach::WORST), Reach::WORST))
    }

    fn newest(&self, now: Instant, timeout: Duration) -> Option<Sight> {
        self.sight.get().filter(|sight| now.since(sight.at) <= timeout)
    }

    /// The vehicle ahead at now as the sensor saw it, at constant speed since; its rear bumper takes the place of the
    /// front one. `None` if it is older than `timeout`.
    pub(super) fn ahead(&self, now: Instant, timeout: Duration) -> Option<Reading> {
        let sight = self.newest(now, timeout)?;
        let age = now.since(sight.at).seconds();
        Some(Reading { position: sight.rear.ahead(sight.speed.over(age)), speed: sight.speed })
    }
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// Takes in a view of the vehicle ahead, received at `received`.
    pub(super) fn take_range(&mut self, received: Instant, seen: RangeSample) -> Result<(), Refusal> {
        let ego = self.ego.as_ref().ok_or(Refusal::Torn)?;
        let at = received.minus(seen.age);
        let since = at.since(ego.at);
        if since > self.config.link.ego_timeout || since < Duration::ZERO.minus(self.config.link.ego_timeout) {
            return Err(Refusal::Stale);
        }
        // The ego's own motion, brought to the sight's instant.
        let gained = ego.acceleration.over(since.fine_seconds());
        let mean = ego.speed.plus(Speed::from_bits(gained.to_bits() / 2));
        let rear = ego.position.ahead(mean.over(since.seconds())).ahead(seen.distance);
        let speed = ego.speed.plus(gained).plus(seen.speed_difference).max(Speed::ZERO);
        let doubt = self.doubt_of_sight(ego, since, &seen);
        let mut sight = Sight { at, rear, speed, doubt, is_target: false };
        if let Some(index) = self.visible() {
            sight.is_target = self.compare(index, &sight);
        }
        self.ranging.sight.set(sight);
        Ok(())
    }

    /// What is uncertain of a sight: the sensor's accuracies, the ego's own, and what the ego may have done between its
    /// own sample and the sight.
    fn doubt_of_sight(&self, ego: &Sample, since: Duration, seen: &RangeSample) -> Doubt {
        let apart = Duration::from_micros(since.as_micros().saturating_abs());
        let swing = self.config.limits.emergency_braking.plus(ego.acceleration.magnitude());
        let faster = swing.over(apart.fine_seconds());
        let own = ego.position_accuracy.unwrap_or(UNPUBLISHED_POSITION_ACCURACY);
        let own_speed = ego.speed_accuracy.unwrap_or(UNPUBLISHED_SPEED_ACCURACY);
        let clock_error = self.config.link.clock_error;
        let late = ego.speed.plus(own_speed).over(clock_error.seconds());
        let roundings = POSITION_ROUNDING.plus(LENGTH_ROUNDING);
        Doubt {
            position: seen.distance_accuracy.plus(own).plus(faster.over(apart.seconds())).plus(late).plus(roundings),
            speed: seen.speed_accuracy.plus(own_speed).plus(faster).plus(SPEED_ROUNDING).plus(SPEED_ROUNDING),
            earlier: clock_error,
            // Its age is rounded up to a whole millisecond.
            later: Duration::from_millis(1).min(seen.age),
        }
    }

    /// Whether the sight is the target's, by all that is certain of that; then it narrows it.
    fn compare(&mut self, index: usize, sight: &Sight) -> bool {
        let Some(track) = self.peers.get_index_mut(index) else { return false };
        let Some(length) = track.intent().map(|intent| intent.length) else { return false };
        let front = sight.rear.ahead(length);
        let reach = track.reach();
        let before = track.certainty().bound().map(|bound| bound.after(sight.at, &reach));
        let around = track.around(sight.at, front, sight.speed, &sight.doubt);
        if !track.narrow(&around) {
            self.ranging.contradictions = self.ranging.contradictions.saturating_add(1);
            return false;
        }
        self.ranging.contradictions = 0;
        let (Some(newest), Some(bound)) = (track.newest().copied(), before) else { return true };
        if let Some(sample) = self.corrected(index, sight, front, &bound, &newest) {
            self.estimator.note_correction(index, sample);
        }
        true
    }

    /// The estimate and the sight, each by its weight, as a sample of the target.
    fn corrected(
        &self,
        index: usize,
        sight: &Sight,
        front: Position,
        bound: &Bound,
        newest: &Sample,
    ) -> Option<Sample> {
        let estimate = self.estimator.read(index, sight.at)?;
        let half = |high: Position, low: Position| Distance::from_bits(high.ahead_of(low).to_bits() / 2);
        let width = half(bound.highest_position(), bound.lowest_position());
        let (share, whole) = weight(i64::from(width.to_bits()), i64::from(sight.doubt.position.to_bits()));
        let spread = bound.highest_speed().minus(bound.lowest_speed()).to_bits() / 2;
        let (speed_share, speed_whole) = weight(i64::from(spread), i64::from(sight.doubt.speed.to_bits()));
        if share.saturating_mul(LEAST_SHARE) < whole && speed_share.saturating_mul(LEAST_SHARE) < speed_whole {
            return None;
        }
        let off = mixed(front.ahead_of(estimate.position).to_bits(), share, whole);
        let off_speed = mixed(sight.speed.minus(estimate.speed).to_bits(), speed_share, speed_whole);
        Some(Sample {
            at: sight.at,
            position: estimate.position.ahead(Distance::from_bits(off)),
            speed: estimate.speed.plus(Speed::from_bits(off_speed)).max(Speed::ZERO),
            acceleration: self.slope(index, sight.at),
            demand: self.slope(index, sight.at),
            ..*newest
        })
    }

    /// The acceleration on the target's horizon.
    fn slope(&self, index: usize, at: Instant) -> Acceleration {
        let half = Duration::from_millis(20);
        let speed = |at| self.estimator.read(index, at).map_or(Speed::ZERO, |reading| reading.speed);
        super::outbox::slope(speed(at.plus(half)).minus(speed(at.minus(half))), half.times(2))
    }
}

/// The share of the sensor's word: `width² / (width² + accuracy²)`, as a fraction of small numbers.
fn weight(width: i64, accuracy: i64) -> (i64, i64) {
    let square = |word: i64| (word.clamp(0, 1 << 30) >> 8).saturating_mul(word.clamp(0, 1 << 30) >> 8);
    (square(width), square(width).saturating_add(square(accuracy)).max(1))
}

fn mixed(word: i32, share: i64, whole: i64) -> i32 {
    // Shares of up to 2⁴⁴ and words of 2³¹: the product needs a shift first.
    let (share, whole) = (share >> 14, (whole >> 14).max(1));
    crate::fixed::saturate_i32(i64::from(word).saturating_mul(share).checked_div(whole).unwrap_or(0))
}
