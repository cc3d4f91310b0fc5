//! The on-board range sensor: its view of the vehicle ahead enters; what is certain of the target is narrowed by it, the
//! estimate is corrected by it, and whether the two agree leaves.
//!
//! The sensor's and the estimate's positions are weighed by the squares of their uncertainties: the sensor's accuracy
//! against half the width of the target's bound, which grows with the age of what was heard over V2X. So fresh messages
//! are left alone, and in a long silence the sensor decides.

use super::OnboardUnit;
use crate::estimator::Reading;
use crate::estimator::bound::{Bound, Doubt};
use crate::health::Refusal;
use crate::held::Held;
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
    seen: RangeSample,
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

    /// Whether what the sensor sees and what is heard contradict one another beyond what is uncertain of both.
    pub(super) const fn disagrees(&self) -> bool {
        self.contradictions >= DISAGREEMENT
    }

    /// The vehicle ahead at now as the sensor saw it, at constant speed since; its rear bumper takes the place of the
    /// front one. `None` if it is older than `timeout`.
    pub(super) fn ahead(&self, now: Instant, timeout: Duration) -> Option<Reading> {
        let sight = self.sight.get()?;
        let age = now.since(sight.at);
        (age <= timeout)
            .then(|| Reading { position: sight.rear.ahead(sight.speed.over(age.seconds())), speed: sight.speed })
    }
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// Takes in a view of the vehicle ahead, received at `received`.
    pub(super) fn take_range(&mut self, received: Instant, seen: RangeSample) -> Result<(), Refusal> {
        let ego = self.ego.get().ok_or(Refusal::Torn)?;
        let at = received.minus(seen.age);
        let since = at.since(ego.at);
        if since > self.config.link.ego_timeout || since < Duration::ZERO.minus(self.config.link.ego_timeout) {
            return Err(Refusal::Stale);
        }
        let own = ego.position.ahead(ego.speed.over(since.seconds()));
        let rear = own.ahead(seen.distance);
        let speed = ego.speed.plus(seen.speed_difference).max(Speed::ZERO);
        let sight = Sight { at, rear, speed, seen };
        self.ranging.sight.set(sight);
        if let Some(index) = self.target() {
            self.compare(index, &sight, &ego);
        }
        Ok(())
    }

    fn compare(&mut self, index: usize, sight: &Sight, ego: &Sample) {
        let Some(track) = self.peers.get_index_mut(index) else { return };
        let Some(length) = track.intent().map(|intent| intent.length) else { return };
        let front = sight.rear.ahead(length);
        let own = ego.position_accuracy.unwrap_or(crate::parameters::UNPUBLISHED_POSITION_ACCURACY);
        let own_speed = ego.speed_accuracy.unwrap_or(crate::parameters::UNPUBLISHED_SPEED_ACCURACY);
        let doubt = Doubt {
            position: sight.seen.distance_accuracy.plus(own).plus(crate::parameters::POSITION_ROUNDING),
            speed: sight.seen.speed_accuracy.plus(own_speed).plus(crate::parameters::SPEED_ROUNDING),
            earlier: self.config.link.clock_error,
            later: self.config.link.clock_error,
        };
        let reach = track.reach();
        let before = track.certainty().bound().map(|bound| bound.after(sight.at, &reach));
        if !track.narrow(&Bound::around(sight.at, front, sight.speed, &doubt, &reach)) {
            self.ranging.contradictions = self.ranging.contradictions.saturating_add(1);
            return;
        }
        self.ranging.contradictions = 0;
        let Some(newest) = track.newest().copied() else { return };
        let Some(bound) = before else { return };
        if let Some(sample) = self.corrected(index, sight, front, &doubt, &bound, &newest) {
            self.estimator.note_correction(index, sample);
        }
    }

    /// The estimate and the sight, each by its weight, as a sample of the target.
    fn corrected(
        &self,
        index: usize,
        sight: &Sight,
        front: Position,
        doubt: &Doubt,
        bound: &Bound,
        newest: &Sample,
    ) -> Option<Sample> {
        let estimate = self.estimator.read(index, sight.at)?;
        let half = |high: Position, low: Position| Distance::from_bits(high.ahead_of(low).to_bits() / 2);
        let width = half(bound.highest_position(), bound.lowest_position());
        let (share, whole) = weight(i64::from(width.to_bits()), i64::from(doubt.position.to_bits()));
        let spread = bound.highest_speed().minus(bound.lowest_speed()).to_bits() / 2;
        let (speed_share, speed_whole) = weight(i64::from(spread), i64::from(doubt.speed.to_bits()));
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
