//! The horizon of one vehicle from one source. A sample, a horizon that the vehicle sent, or no news enters; the horizon brought up to
//! now leaves.

use super::delay::adjusted;
use super::horizon::{Anchor, Grid, Horizon};
use super::interpolation::Approach;
use crate::fixed::quotient;
use crate::model::{Model, Remainders, State, Step, Stride, TargetStep, VehicleModel};
use crate::peers::Sample;
use crate::time::{Duration, Instant};
use crate::units::{Distance, Position, Speed};
use crate::wire::curve::Curve;
use crate::wire::driving_parameters::DrivingParameters;
use crate::wire::horizon::{Knot, Knots};

/// A sample that is older than so many steps of the grid is brought up to now in fewer.
pub(super) const LATE: usize = 200;

/// Whose horizon is ahead: a follower's horizon is computed from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ahead {
    /// The horizon of the peer in this slot.
    Peer(usize),
    /// The ego's own.
    Own,
}

/// What the horizon of one vehicle is computed with.
pub struct Forecast<'a, const STEPS: usize> {
    /// The unit's grid.
    pub grid: &'a Grid,
    /// Number of steps that a horizon keeps.
    pub length: usize,
    /// The parts of the model that are used.
    pub model: &'a Model,
    /// How the vehicle drives, over a whole step.
    pub stride: &'a Stride,
    /// Its predecessor's horizon.
    pub ahead: Option<&'a Horizon<STEPS>>,
    /// The delay of eqs 10-12, in paper mode.
    pub delay: Option<Duration>,
}

/// What a horizon starts anew from.
pub struct News<'a> {
    /// The vehicle's state.
    pub sample: &'a Sample,
    /// The horizon that the vehicle sent, with its driving parameters.
    pub received: Option<(&'a Knots, &'a DrivingParameters)>,
    /// How the vehicle drives.
    pub vehicle: VehicleModel,
    /// Length of its predecessor; not used without a predecessor.
    pub length_ahead: Distance,
}

impl<const STEPS: usize> Forecast<'_, STEPS> {
    /// Starts the horizon anew: from the vehicle's own horizon, if it sent that and its driving parameters, or else from the sample.
    pub fn anchor(&self, horizon: &mut Horizon<STEPS>, present: i64, news: &News<'_>) {
        let sample = news.sample;
        let anchor =
            Anchor { at: sample.at, position: sample.position, speed: sample.speed, acceleration: sample.acceleration };
        horizon.clear();
        // A horizon that ends is kept from its sample on, because eqs 10-12 look back into it by the delay.
        let from = if self.model.endless { present } else { i64::MIN };
        let mut filling = Filling { horizon, present: from, anchor };
        let next = news
            .received
            .and_then(|(knots, parameters)| self.resample(&mut filling, knots, parameters))
            .or_else(|| self.depart(&mut filling, news));
        if let Some((index, state)) = next {
            self.carry_on(&mut filling, index, state, self.end(present, sample));
        }
    }

    /// Drops the steps that have passed. In an endless horizon, computes as many at the far end.
    pub fn extend(&self, horizon: &mut Horizon<STEPS>, present: i64) {
        if horizon.is_empty() || !self.model.endless {
            return;
        }
        if horizon.len() == self.length && self.length > 1 && present.wrapping_sub(horizon.first()) == 1 {
            // The usual case of a tick without news.
            let last = horizon.last();
            let ahead = between(self.ahead_at(last), self.ahead_at(last.wrapping_add(1)));
            return horizon.turn(self.stride.take(horizon.tip(), ahead));
        }
        let (last, state) = (horizon.last(), horizon.tip());
        let end = present.saturating_add(steps(self.length)).saturating_sub(1);
        if end.saturating_sub(last) > steps(STEPS) {
            // The pause was longer than the horizon, so that the steps to compute from are gone.
            horizon.clear();
            return;
        }
        while horizon.first() < present && horizon.len() > 1 {
            horizon.drop_first();
        }
        let anchor = *horizon.anchor();
        self.carry_on(&mut Filling { horizon, present, anchor }, last, state, end);
    }

    /// Carries a horizon on from its last step to the step `end`.
    #[inline(always)]
    pub fn carry(&self, horizon: &mut Horizon<STEPS>, end: i64) {
        if !horizon.is_empty() {
            let (from, state, anchor) = (horizon.last(), horizon.tip(), *horizon.anchor());
            self.carry_on(&mut Filling { horizon, present: i64::MIN, anchor }, from, state, end);
        }
    }

    /// The last index to compute. An endless horizon counts its length from now, a horizon that ends from its sample.
    fn end(&self, present: i64, sample: &Sample) -> i64 {
        let from = if self.model.endless { present } else { self.grid.nearest(sample.at) };
        from.saturating_add(steps(self.length)).saturating_sub(1)
    }

    /// Source (b): from the sample to the first step on the grid. Without stamps the sample is taken unchanged at the nearest step.
    fn depart(&self, filling: &mut Filling<'_, STEPS>, news: &News<'_>) -> Option<(i64, State)> {
        let sample = news.sample;
        let mut state = State {
            position: sample.position.ring(),
            speed: sample.speed.max(Speed::ZERO),
            acceleration: sample.acceleration,
            demand: if self.model.last_demand { sample.demand } else { sample.acceleration },
            remainders: Remainders::NONE,
        };
        let index;
        if self.model.stamped {
            index = self.grid.at_or_after(sample.at);
            let part = self.grid.time_of(index).since(sample.at);
            if part > Duration::ZERO {
                let stride = news.vehicle.over(part, news.length_ahead, self.model);
                let ahead = between(self.ahead_when(sample.at), self.ahead_at(index));
                state = stride.take(state, ahead);
            }
        } else {
            index = self.grid.nearest(sample.at);
        }
        let (index, state) = self.catch_up(filling.present, news, index, state);
        filling.put(index, state);
        Some((index, state))
    }

    /// Brings the state of an old sample nearly up to now, in steps that are several of the grid's, so that it takes as long as a younger
    /// one. They are no longer than a [`LATE`]th of its age: an error that they make is small against that of the age.
    fn catch_up(&self, present: i64, news: &News<'_>, index: i64, state: State) -> (i64, State) {
        let late = present.saturating_sub(index);
        if late <= steps(LATE) {
            return (index, state);
        }
        let (mut index, mut state) = (index, state);
        let each = quotient(late, steps(LATE)).saturating_add(1);
        let stride = news.vehicle.over(self.grid.step.times(each), news.length_ahead, self.model);
        let approach = self.approach(index);
        let mut ahead = self.ahead_before(approach.as_ref(), index);
        while index.saturating_add(each) <= present {
            index = index.saturating_add(each);
            let before = core::mem::replace(&mut ahead, self.ahead_before(approach.as_ref(), index));
            state = stride.take(state, between(before, ahead));
        }
        (index, state)
    }

    /// Source (a): the sent horizon on the grid, from now to its end. A sent horizon that ended before now is not used.
    fn resample(
        &self,
        filling: &mut Filling<'_, STEPS>,
        knots: &Knots,
        parameters: &DrivingParameters,
    ) -> Option<(i64, State)> {
        let anchor = filling.anchor;
        let length = Duration::from_millis(100).times(i64::from(parameters.horizon_tenths));
        let first = self.grid.at_or_after(anchor.at).max(filling.present);
        let after = self.grid.time_of(first).since(anchor.at);
        if after > length {
            return None;
        }
        let curve = Curve::new(Knot::start(anchor.speed, anchor.acceleration), knots, length);
        let origin = anchor.position.ring();
        let acceleration = knots.knots.last()?.acceleration;
        let at = |(way, speed)| {
            let position = origin.ahead(way);
            State { position, speed, acceleration, demand: acceleration, remainders: Remainders::NONE }
        };
        let mut runs = curve.runs(after, self.grid.step);
        if !runs.turn() {
            return None;
        }
        filling.put(first, at(runs.run().next()?));
        // These are all of the steps, unless the sent horizon is longer than the ring.
        filling.horizon.run(STEPS, |mut tip, mut out| {
            let mut done = 0usize;
            loop {
                let run = runs.run();
                let Some((now, later)) = out.split_at_mut_checked(run.len().min(out.len())) else { break };
                for (step, reading) in now.iter_mut().zip(run) {
                    tip = at(reading);
                    *step = Step { position: tip.position, speed: tip.speed };
                }
                (done, out) = (done.saturating_add(now.len()), later);
                if out.is_empty() || !runs.turn() {
                    break;
                }
            }
            (tip, done)
        });
        Some((filling.horizon.last(), filling.horizon.tip()))
    }

    /// Computes the steps from an index to the end of the horizon. They are computed one by one until both this horizon and its
    /// predecessor's have begun, and from there on all in one go.
    fn carry_on(&self, filling: &mut Filling<'_, STEPS>, from: i64, mut state: State, end: i64) {
        let mut index = from;
        let approach = self.approach(from);
        let mut step_ahead = self.ahead_before(approach.as_ref(), index);
        while index < end {
            let next = index.saturating_add(1);
            let left = usize::try_from(end.saturating_sub(index)).unwrap_or(0);
            let run = match (self.ahead, self.delay) {
                (None, _) => Some(filling.horizon.run(left, |tip, out| self.stride.run_alone(tip, out))),
                (Some(ahead), None) => ahead.from(next).map(|(near, far)| {
                    filling.horizon.run(left, |tip, out| {
                        let before = step_ahead.map_or(Speed::ZERO, |step| step.speed);
                        let (tip, done) = self.stride.run(tip, before, near, out);
                        let before = near.last().map_or(before, |step| step.speed);
                        let (tip, more) = self.stride.run(tip, before, far, out.get_mut(done..).unwrap_or_default());
                        (tip, done.saturating_add(more))
                    })
                }),
                (Some(_), Some(_)) => None,
            };
            match run {
                Some(done) if done > 0 => {
                    index = index.saturating_add(steps(done));
                    state = filling.horizon.tip();
                    step_ahead = self.ahead_at(index);
                }
                _ => {
                    index = next;
                    let before = core::mem::replace(&mut step_ahead, self.ahead_before(approach.as_ref(), index));
                    state = self.stride.take(state, between(before, step_ahead));
                    filling.put(index, state);
                }
            }
        }
    }

    /// The curve before the predecessor's first step, if the steps after this one begin there. It is made once for all of them.
    fn approach(&self, from: i64) -> Option<Approach> {
        let ahead = self.ahead.filter(|_| self.delay.is_none())?;
        if from.saturating_add(1) < ahead.first() { ahead.approach(self.grid) } else { None }
    }

    /// The predecessor at a step, by that curve up to its end.
    fn ahead_before(&self, approach: Option<&Approach>, index: i64) -> Option<Step> {
        match approach.zip(self.ahead) {
            Some((approach, ahead)) if index < ahead.first() => Some(approach.at_step(index, self.grid)),
            _ => self.ahead_at(index),
        }
    }

    /// The predecessor at a step; `None` if its horizon does not reach it.
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    fn ahead_at(&self, index: i64) -> Option<Step> {
        let ahead = self.ahead?;
        if let Some(delay) = self.delay {
            return self.ahead_delayed(ahead, index, delay);
        }
        // Beyond its end the last step is held, as where it is read.
        if let Some(step) = ahead.at(index.min(ahead.last())) {
            return Some(step);
        }
        self.ahead_when(self.grid.time_of(index))
    }

    /// The predecessor at an instant between steps, or before its first step.
    fn ahead_when(&self, at: Instant) -> Option<Step> {
        let reading = self.ahead?.read(at, self.grid, true)?;
        Some(Step { position: reading.position.ring(), speed: reading.speed })
    }

    fn ahead_delayed(&self, ahead: &Horizon<STEPS>, index: i64, delay: Duration) -> Option<Step> {
        // Before its first step the first one is held, and after its last step the last one.
        let behind = self.grid.nearest(self.grid.time_of(index).minus(delay)).min(ahead.last()).max(ahead.first());
        let after = behind.saturating_add(1).min(ahead.last());
        Some(adjusted(ahead.at(behind)?, ahead.at(after)?, delay, self.grid.step))
    }
}

/// The predecessor over a step, from where it is before and after. Where it is not known before, it keeps its speed.
fn between(before: Option<Step>, after: Option<Step>) -> Option<TargetStep> {
    let after = after?;
    Some(TargetStep::between(before.unwrap_or(after).speed, &after))
}

/// A horizon that is being filled. Steps before the present are only passed through.
struct Filling<'a, const STEPS: usize> {
    horizon: &'a mut Horizon<STEPS>,
    present: i64,
    anchor: Anchor,
}

impl<const STEPS: usize> Filling<'_, STEPS> {
    fn put(&mut self, index: i64, state: State) {
        if !self.horizon.is_empty() {
            self.horizon.push(state);
        } else if index >= self.present {
            self.horizon.start(self.anchor, index, self.absolute(&state), state);
        }
    }

    /// The absolute position of a state within 2048 m of the anchor.
    fn absolute(&self, state: &State) -> Position {
        self.anchor.position.ahead(state.position.ahead_of(self.anchor.position.ring()))
    }
}

/// A number of steps as a difference of indices.
pub(super) fn steps(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}
