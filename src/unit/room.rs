//! Where the ego has to be able to stop at intersections, by what is estimated. The ego's state and the vehicle ahead on its leg enter;
//! whether the ego is held before the next conflict area, and where it has to be able to stop, leave.
//!
//! A vehicle that stands in a conflict area blocks those that cross. So a vehicle does not enter the area if it could not leave it again,
//! because the vehicle ahead has come to a stand beyond the area, or is about to. While it waits for room, it yields to every other
//! vehicle: the vehicle ahead may be waiting for these, round a whole block.

use super::scene::Scene;
use super::vantage::Vantage;
use crate::fixed::{quotient, saturate_i32};
use crate::model::{State, catch_up};
use crate::time::{Duration, Instant};
use crate::units::{Distance, Position, Speed};

/// About the time from when the ego enters a conflict area until it has left it; as far as every unit looks ahead.
const LEAVES: Duration = Duration::from_millis(3_900);

/// Slower than this a vehicle waits.
pub(super) const WAITING: Speed = Speed::from_mm_per_s(500);

/// Slower than this a vehicle is in a queue.
const SLOW: Speed = Speed::from_mm_per_s(3_000);

/// How far before the conflict area the ego stops, and at least behind the vehicle ahead.
pub(super) const LINE: Distance = Distance::from_mm(1_000);

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Vantage<'_, PEERS, SAMPLES, STEPS> {
    /// Whether the ego cannot stop before the next conflict area any more, braking as in normal driving. It does not yield to any vehicle
    /// then: it would stand in the area, and wait for a vehicle that cannot get past it.
    pub fn is_committed(&self) -> bool {
        let Some(area_begins) = self.scene.area_begins() else { return false };
        area_begins.ahead_of(self.front) <= self.stops_within()
    }

    /// The way that the ego needs to stop, braking as in normal driving, from when the law asks for it.
    fn stops_within(&self) -> Distance {
        let config = &self.scene.config;
        let mm_per_s2 = i64::from(config.limits.braking.to_mm_per_s2()).max(1);
        // The time until the brakes are on: half of the ramp, and the lag.
        let ramp = quotient(mm_per_s2.saturating_mul(500), i64::from(config.limits.jerk.to_mm_per_s3()).max(1));
        let reaction_ms = ramp.saturating_add(i64::from(config.lag.to_millis()));
        let mm_per_s = i64::from(self.speed.to_mm_per_s());
        let reacting = quotient(mm_per_s.saturating_mul(reaction_ms), 1_000);
        Distance::from_mm(saturate_i32(reacting.saturating_add(braked(mm_per_s, mm_per_s2))))
    }

    /// Whether there will be room beyond the next conflict area behind the vehicle `ahead`, the nearest on the ego's leg. A vehicle that
    /// stands is taken to stay: it may want to move off without being able to.
    pub fn has_room(&self, ahead: Option<usize>) -> bool {
        let scene = self.scene;
        let (Some(index), Some(end)) = (ahead, scene.coordination.end_of(self.next)) else { return true };
        let Some((reading, rear)) = scene.rear(index, self.at) else { return true };
        let later = scene.rear(index, self.at.plus(LEAVES)).filter(|_| reading.speed > WAITING);
        let rear = later.map_or(rear, |(_, rear)| rear);
        rear >= end.ahead(scene.config.length).ahead(scene.standstill_at(self.next, index))
    }

    /// Whether the ego stands before the next conflict area because there is no room beyond it, and is the first to do so on its leg.
    pub fn waits_for_room(&self, ahead: Option<usize>) -> bool {
        let area_begins = self.scene.area_begins();
        let is_first = |index| self.scene.rear(index, self.at).is_some_and(|(_, rear)| Some(rear) >= area_begins);
        self.speed <= WAITING && ahead.is_none_or(is_first)
    }

    /// Where the ego waits for a vehicle that crosses its way: before the area. The vehicle is ahead in the order or already in the next
    /// conflict area, and is estimated not to have left the area by the time that the ego would be there. The law alone is not enough. It
    /// looks at one vehicle only, and only once that vehicle has been announced. It also starts early, and from a stand the
    /// ego is in the area at once. The ego does not wait for a vehicle that it sees not to be where it is estimated to be.
    fn passes_first(&self) -> Option<Position> {
        let coordination = &self.scene.coordination;
        let (crossing, line) = (coordination.crossing()?, self.scene.area_begins()?);
        let end = coordination.end_of(self.next)?;
        if self.front > line {
            return None;
        }
        let then = if self.speed <= SLOW { self.at } else { self.at.plus(self.time_to(line).min(LEAVES)) };
        let is_due = |index: usize| {
            let Some(approach) = coordination.approach(index) else { return false };
            let is_inside = || {
                coordination.is_here(approach)
                    && self
                        .scene
                        .rear(index, self.at)
                        .is_some_and(|(reading, _)| reading.position > line.ahead(approach.shift))
            };
            crossing.intersection.conflict(crossing.movement, approach.movement)
                && (coordination.choice().ahead.contains(index) || is_inside())
                && !self.scene.is_missed(index, self.at)
                && self.scene.rear(index, then).is_some_and(|(_, rear)| rear < end.ahead(approach.shift))
        };
        (0..PEERS).any(is_due).then(|| line.ahead(LINE.negated()))
    }

    /// The shortest time in which the ego gets to a place ahead, rounded: it accelerates as it may in normal driving, up to the speed at
    /// which it catches up. By its present speed alone it would be there later than it will be, and find out too late to stop.
    fn time_to(&self, place: Position) -> Duration {
        let (config, speed) = (&self.scene.config, i64::from(self.speed.to_mm_per_s()));
        let mm = i64::from(place.ahead_of(self.front).to_mm()).max(0);
        let acceleration = i64::from(config.limits.acceleration.to_mm_per_s2()).max(1);
        let top = i64::from(catch_up(self.scene.target_speed(), config.law.catch_up).to_mm_per_s()).max(speed).max(1);
        let squared = |speed: i64| speed.saturating_mul(speed);
        let gained = acceleration.saturating_mul(2).saturating_mul(mm);
        let faster = squared(speed).saturating_add(gained);
        let micros = if faster <= squared(top) {
            let then = i64::try_from(faster.unsigned_abs().isqrt()).unwrap_or(top);
            quotient(mm.saturating_mul(2_000_000), speed.saturating_add(then).max(1))
        } else {
            let reached = quotient(squared(top).saturating_sub(squared(speed)), acceleration.saturating_mul(2));
            quotient(top.saturating_sub(speed).saturating_mul(1_000_000), acceleration)
                .saturating_add(quotient(mm.saturating_sub(reached).saturating_mul(1_000_000), top))
        };
        Duration::from_micros(micros)
    }

    /// Where the rear bumper of a peer is estimated to come to a stand if it brakes now as the ego does, less the margin.
    fn stops_at(&self, index: usize) -> Option<Position> {
        let braking = i64::from(self.scene.config.limits.braking.to_mm_per_s2()).max(1);
        let (reading, rear) = self.scene.rear(index, self.at)?;
        let way = braked(i64::from(reading.speed.to_mm_per_s()), braking);
        Some(rear.ahead(Distance::from_mm(saturate_i32(way))).ahead(LINE.negated()))
    }
}

/// The nearest place where the ego has to be able to stop, if any: behind the vehicle ahead on its leg, which is estimated to brake now as
/// the ego may; before the next conflict area, if the ego is held or a crossing vehicle passes first; and behind a vehicle that is seen and
/// not known. The law alone keeps gaps: when the ego closes in fast, it brakes too late.
pub(super) fn stop<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    ego: &State,
) -> Option<Position> {
    let view = scene.vantage(now, scene.front(ego), ego.speed);
    let choice = scene.coordination.choice();
    let behind = choice.lane.and_then(|index| view.stops_at(index.into()));
    let line = scene.area_begins().filter(|_| choice.is_held).map(|begins| begins.ahead(LINE.negated()));
    let unknown = scene.unknown_ahead(now).map(|rear| rear.ahead(LINE.negated()));
    [behind, line, view.passes_first(), unknown].into_iter().flatten().min()
}

/// The way of braking to a stand, rounded.
fn braked(mm_per_s: i64, mm_per_s2: i64) -> i64 {
    quotient(mm_per_s.saturating_mul(mm_per_s), mm_per_s2.saturating_mul(2))
}
