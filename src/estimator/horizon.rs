//! The horizon of one vehicle: a ring buffer of positions and speeds on the unit's time grid. Steps enter at the far end and leave at the
//! near end as time passes; a reading at any instant leaves.
//!
//! A horizon starts from an anchor, the vehicle's state at the stamp of a sample. Between the anchor and the first step, and between
//! steps, a reading is on the cubic that meets both positions and both speeds.

use super::interpolation::{Approach, Cubic};
use crate::fixed::quotient;
use crate::model::{Reading, Remainders, State, Step};
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Position, RingPosition, Speed};

/// The time grid that all horizons of one unit share: step `n` is at `origin + n·δt`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Grid {
    /// The instant of step 0.
    pub origin: Instant,
    /// `δt`.
    pub step: Duration,
}

impl Grid {
    /// The last step at or before an instant.
    #[must_use]
    pub fn at_or_before(&self, at: Instant) -> i64 {
        self.split(at).0
    }

    /// The last step at or before an instant, and how much later the instant is.
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    #[must_use]
    pub fn split(&self, at: Instant) -> (i64, Duration) {
        let (since, step) = (at.since(self.origin).as_micros(), self.step.as_micros());
        let towards_zero = quotient(since, step);
        let after = since.wrapping_sub(towards_zero.wrapping_mul(step));
        // Rounded towards -∞: a step before the origin has a negative index.
        if after < 0 {
            (towards_zero.saturating_sub(1), Duration::from_micros(after.saturating_add(step)))
        } else {
            (towards_zero, Duration::from_micros(after))
        }
    }

    /// The first step at or after an instant.
    #[must_use]
    pub fn at_or_after(&self, at: Instant) -> i64 {
        let before = self.at_or_before(at);
        if self.time_of(before) == at { before } else { before.saturating_add(1) }
    }

    /// The step nearest to an instant.
    #[must_use]
    pub fn nearest(&self, at: Instant) -> i64 {
        self.at_or_before(at.plus(Duration::from_micros(self.step.as_micros() / 2)))
    }

    /// How much later a step is than an instant.
    #[inline(always)]
    #[must_use]
    pub fn since(&self, index: i64, at: Instant) -> Duration {
        let way = self.step.as_micros().wrapping_mul(index); // of steps of a millisecond or more: no overflow
        Duration::from_micros(self.origin.since(at).as_micros().wrapping_add(way))
    }

    /// The instant of a step.
    #[must_use]
    pub fn time_of(&self, index: i64) -> Instant {
        self.origin.plus(self.step.times(index))
    }
}

/// The state that a horizon starts from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Anchor {
    /// Its stamp.
    pub at: Instant,
    /// Front bumper.
    pub position: Position,
    /// Speed.
    pub speed: Speed,
    /// Acceleration.
    pub acceleration: Acceleration,
}

/// Where a horizon ends.
#[derive(Clone, Copy, Debug)]
pub struct End {
    len: usize,
    tip: State,
}

/// A ring of up to `STEPS` steps.
#[derive(Clone, Debug)]
pub struct Horizon<const STEPS: usize> {
    steps: [Step; STEPS],
    /// Index in the ring of the first step.
    head: usize,
    len: usize,
    /// Grid index of the first step.
    first: i64,
    /// Absolute position of the first step.
    base: Position,
    /// State at the last step, from which the next one is computed.
    tip: State,
    anchor: Anchor,
}

impl<const STEPS: usize> Horizon<STEPS> {
    /// No steps.
    #[must_use]
    pub const fn empty() -> Self {
        Self {
            steps: [Step { position: Position::ZERO.ring(), speed: Speed::ZERO }; STEPS],
            head: 0,
            len: 0,
            first: 0,
            base: Position::ZERO,
            tip: State {
                position: Position::ZERO.ring(),
                speed: Speed::ZERO,
                acceleration: Acceleration::ZERO,
                demand: Acceleration::ZERO,
                remainders: Remainders::UNSET,
            },
            anchor: Anchor {
                at: Instant::ZERO,
                position: Position::ZERO,
                speed: Speed::ZERO,
                acceleration: Acceleration::ZERO,
            },
        }
    }

    /// Whether it has no steps.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// How many steps it holds.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.len
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// The state that it started from.
    #[must_use]
    pub const fn anchor(&self) -> &Anchor {
        &self.anchor
    }

    /// The state at the last step.
    #[must_use]
    pub const fn tip(&self) -> State {
        self.tip
    }

    /// Grid index of the first step; without meaning while the horizon is empty.
    #[must_use]
    pub const fn first(&self) -> i64 {
        self.first
    }

    /// Grid index of the last step; one before the first while the horizon is empty.
    #[must_use]
    pub fn last(&self) -> i64 {
        self.first.saturating_add(i64::try_from(self.len).unwrap_or(0)).saturating_sub(1)
    }

    /// Starts anew from an anchor. The first step has this grid index and this state; `position` is the state's position, unwrapped.
    pub fn start(&mut self, anchor: Anchor, index: i64, position: Position, state: State) {
        self.anchor = anchor;
        self.head = 0;
        self.len = 0;
        self.first = index;
        self.base = position;
        self.push(state);
    }

    /// Adds the next step at the far end; a full ring drops its first step.
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub fn push(&mut self, state: State) {
        if self.len == STEPS {
            self.drop_first();
        }
        let place = self.place(self.len);
        if let Some(step) = self.steps.get_mut(place) {
            *step = Step { position: state.position, speed: state.speed };
            self.len = self.len.wrapping_add(1); // below STEPS
        }
        self.tip = state;
    }

    /// Drops the first step and adds one at the far end. The horizon has at least two steps.
    pub(super) fn turn(&mut self, state: State) {
        let (far, second) = (self.place(self.len), self.place(1));
        if let (Some(old), Some(new)) = (self.steps.get(self.head), self.steps.get(second)) {
            self.base = self.base.ahead(new.position.ahead_of(old.position));
        }
        if let Some(step) = self.steps.get_mut(far) {
            *step = Step { position: state.position, speed: state.speed };
        }
        self.head = second;
        self.first = self.first.wrapping_add(1); // of 2⁶³ steps of a millisecond or more
        self.tip = state;
    }

    /// Lets `take` add steps after the last one: at most `most`, no more than the ring has room for, and not across the end of the array.
    /// `take` gets the state at the last step and the room for new steps. It returns the state at its own last step, and how many steps
    /// it took. Returns that number; 0 for an empty horizon.
    pub(super) fn run(&mut self, most: usize, take: impl FnOnce(State, &mut [Step]) -> (State, usize)) -> usize {
        if self.is_empty() {
            return 0;
        }
        let from = self.place(self.len);
        let room = most.min(STEPS.saturating_sub(self.len)).min(STEPS.saturating_sub(from));
        let Some(out) = self.steps.get_mut(from..from.saturating_add(room)) else { return 0 };
        let (tip, done) = take(self.tip, out);
        self.tip = tip;
        self.len = self.len.saturating_add(done);
        done
    }

    /// The steps from this index on, in two runs; `None` if the horizon does not hold the step of this index.
    pub(super) fn from(&self, index: i64) -> Option<(&[Step], &[Step])> {
        let offset = usize::try_from(index.wrapping_sub(self.first)).ok().filter(|offset| *offset < self.len)?;
        let (turned, straight) = self.steps.split_at_checked(self.head)?;
        let straight = straight.get(..self.len.min(straight.len()))?;
        let turned = turned.get(..self.len.saturating_sub(straight.len()))?;
        Some(match straight.get(offset..) {
            Some(near) => (near, turned),
            None => (turned.get(offset.saturating_sub(straight.len())..)?, &[]),
        })
    }

    /// Drops the first step, unless it is the only one.
    pub fn drop_first(&mut self) {
        let (Some(old), Some(new)) = (self.nth(0), self.nth(1)) else { return };
        self.base = self.base.ahead(new.position.ahead_of(old.position));
        self.head = self.place(1);
        self.len = self.len.saturating_sub(1);
        self.first = self.first.saturating_add(1);
    }

    /// Where it ends now.
    #[must_use]
    pub const fn mark(&self) -> End {
        End { len: self.len, tip: self.tip }
    }

    /// Takes back the steps that were added since it ended there. None was dropped at the near end since.
    pub fn cut(&mut self, end: &End) {
        self.len = self.len.min(end.len);
        self.tip = end.tip;
    }

    /// Moves every step ahead by this way.
    pub fn shift(&mut self, way: Distance) {
        self.steps.iter_mut().for_each(|step| step.position = step.position.ahead(way));
        self.base = self.base.ahead(way);
        self.tip.position = self.tip.position.ahead(way);
        self.anchor.position = self.anchor.position.ahead(way);
    }

    /// The step with this grid index.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, index: i64) -> Option<Step> {
        let offset = usize::try_from(index.wrapping_sub(self.first)).ok()?;
        self.nth(offset)
    }

    /// The absolute position of a position that is near this horizon's first step.
    #[must_use]
    pub fn absolute(&self, position: RingPosition) -> Position {
        self.base.ahead(position.ahead_of(self.base.ring()))
    }

    /// Where the vehicle is at an instant. Before the anchor it moves at the anchor's speed. Beyond the last step the last position and
    /// speed are held; this happens only in a horizon that is not endless.
    #[must_use]
    pub fn read(&self, at: Instant, grid: &Grid, interpolate: bool) -> Option<Reading> {
        if !interpolate {
            return self.held(grid.nearest(at));
        }
        let (index, since) = grid.split(at);
        match (self.at(index), self.at(index.saturating_add(1))) {
            (Some(step), _) if since == Duration::ZERO => Some(self.reading(step)),
            (Some(before), Some(after)) => {
                let from = self.reading(before);
                let way = after.position.ahead_of(before.position);
                Some(Cubic::new(from, way, after.speed, grid.step).at(since))
            }
            (None, _) if index < self.first => Some(self.approach(grid)?.at(at)),
            _ => self.held(index),
        }
    }

    /// The curve before the first step.
    pub(super) fn approach(&self, grid: &Grid) -> Option<Approach> {
        let first = self.nth(0)?;
        let Anchor { at: start, position, speed, .. } = self.anchor;
        let way = self.base.ahead_of(position);
        Some(Approach::new(start, Reading { position, speed }, way, first.speed, grid.time_of(self.first).since(start)))
    }

    /// The vehicle at its last step.
    #[must_use]
    pub fn end(&self) -> Option<Reading> {
        self.held(self.last())
    }

    /// The step of an index, or the first or last one if the index is outside.
    pub(super) fn held(&self, index: i64) -> Option<Reading> {
        let last = self.len.checked_sub(1)?;
        let beyond = index.wrapping_sub(self.first); // of steps of a millisecond or more: no overflow
        let n = if beyond <= 0 { 0 } else { usize::try_from(beyond).map_or(last, |n| n.min(last)) };
        self.steps.get(self.place(n)).map(|step| self.reading(*step))
    }

    fn reading(&self, step: Step) -> Reading {
        Reading { position: self.absolute(step.position), speed: step.speed }
    }

    #[inline(always)]
    fn nth(&self, n: usize) -> Option<Step> {
        if n < self.len { self.steps.get(self.place(n)).copied() } else { None }
    }

    /// Index in the ring of the n-th step, for n up to the capacity.
    #[inline(always)]
    fn place(&self, n: usize) -> usize {
        let place = self.head.wrapping_add(n); // head < STEPS and n <= STEPS: no overflow
        if place >= STEPS { place.wrapping_sub(STEPS) } else { place }
    }
}

impl<const STEPS: usize> Default for Horizon<STEPS> {
    fn default() -> Self {
        Self::empty()
    }
}

#[cfg(test)]
mod tests;
