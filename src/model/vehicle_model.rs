//! How a vehicle drives, as far as it is known. Its published driving parameters, or the lack of them, enter; the constants of its
//! prediction step leave.

use super::actuator::Actuator;
use super::follower::{Consensus, Follower};
use super::leader::Leader;
use super::state::{State, Step, TargetStep};
use super::switches::Model;
use crate::parameters::{FADE, FREE_ROAD_ACCELERATION};
use crate::time::Duration;
use crate::units::{Acceleration, Distance, Fraction, Jerk, Seconds, Speed};
use crate::wire::Predecessor;
use crate::wire::driving_parameters::{DrivingParameters, Limits};

/// The aim of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Aim {
    /// Nothing is known: its acceleration fades out.
    Fade,
    /// It keeps a speed (Algorithm 2).
    Lead {
        /// `a_max`.
        largest: Acceleration,
        /// `v_∞`.
        target_speed: Speed,
    },
    /// It follows its predecessor (Algorithm 4).
    Follow {
        /// The law of eq. 5.
        law: Consensus,
        /// `s_0`.
        standstill: Distance,
        /// Never faster than this, `v_c` ([`catch_up`]).
        catch_up: Speed,
    },
}

/// A vehicle's parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct VehicleModel {
    /// Its aim.
    pub aim: Aim,
    /// `T`.
    pub lag: Duration,
    /// Its limits.
    pub limits: Limits,
}

impl VehicleModel {
    /// A vehicle of which nothing is known: its acceleration fades out.
    pub const UNKNOWN: Self = Self {
        aim: Aim::Fade,
        lag: Duration::ZERO,
        limits: Limits {
            acceleration: Acceleration::MAX,
            braking: Acceleration::MAX,
            jerk: Jerk::MAX,
            emergency_braking: Acceleration::MAX,
        },
    };

    /// A peer, by the driving parameters that it published.
    #[must_use]
    pub fn of_parameters(parameters: &DrivingParameters, model: &Model) -> Self {
        let aim = match parameters.predecessor {
            Predecessor::Unknown => Aim::Fade,
            Predecessor::None => Aim::Lead { largest: FREE_ROAD_ACCELERATION, target_speed: parameters.target_speed },
            Predecessor::Station(_) => Aim::Follow {
                law: Consensus {
                    gain: parameters.gain,
                    damping: parameters.damping,
                    time_gap: parameters.time_gap,
                    feed_forward: parameters.feed_forward,
                },
                standstill: if model.standstill { parameters.standstill } else { Distance::ZERO },
                catch_up: catch_up(parameters.target_speed, parameters.catch_up),
            },
        };
        Self { aim, lag: Duration::of_fine_seconds(parameters.lag), limits: parameters.limits }
    }

    /// The state after this time under the demand in force.
    #[must_use]
    pub fn coast(&self, state: State, time: Duration, model: &Model) -> State {
        Actuator::over(time, self.lag, &self.limits, model).drive(state, state.demand)
    }

    /// The constants of a step of this length, behind a predecessor of this length. The latter is not used without a predecessor.
    #[must_use]
    pub fn over(&self, step: Duration, length_ahead: Distance, model: &Model) -> Stride {
        let course = self.course(step, length_ahead, model);
        let lag = if matches!(course, Course::Fade) { FADE } else { self.lag };
        let fading = Model { lag: true, ..*model };
        let model = if matches!(course, Course::Fade) { &fading } else { model };
        Stride { course, actuator: Actuator::over(step, lag, &self.limits, model) }
    }

    fn course(&self, step: Duration, length_ahead: Distance, model: &Model) -> Course {
        match self.aim {
            Aim::Fade => Course::Fade,
            Aim::Lead { largest, target_speed } => Course::Lead(Leader::new(largest, target_speed)),
            Aim::Follow { law, standstill, catch_up } => {
                let spacing = length_ahead.plus(standstill);
                let catch_up = model.limits.then_some(catch_up);
                Course::Follow(Follower::over(step, &law, spacing, catch_up))
            }
        }
    }

    /// Gives the vehicle this time gap, if it follows.
    pub fn keep_time_gap(&mut self, time_gap: Seconds) {
        if let Aim::Follow { law, .. } = &mut self.aim {
            law.time_gap = time_gap;
        }
    }
}

/// The speed with which a follower catches up, `v_c`: the speed that it wants on a free road, and that share more.
#[must_use]
pub const fn catch_up(target_speed: Speed, share: Fraction) -> Speed {
    target_speed.plus(target_speed.fraction(share))
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Course {
    Fade,
    Lead(Leader),
    Follow(Follower),
}

/// One prediction step of one vehicle, ready to be taken many times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stride {
    course: Course,
    actuator: Actuator,
}

impl Stride {
    /// Gives the follower another time gap, if it is one; its other constants stay. Of the vehicle its speed for catching up is used.
    pub fn keep_time_gap(&mut self, vehicle: &VehicleModel, step: Duration, time_gap: Seconds, model: &Model) {
        if let (Course::Follow(follower), Aim::Follow { catch_up, .. }) = (&mut self.course, vehicle.aim) {
            follower.keep_time_gap(step, time_gap, model.limits.then_some(catch_up));
        }
    }

    /// The demand of this step: the desired acceleration, but no more than the cap, and within the vehicle's limits. The acceleration of
    /// a follower without a predecessor fades out.
    #[inline(always)]
    #[must_use]
    pub fn demand(&self, state: &State, ahead: Option<TargetStep>, cap: Acceleration) -> Acceleration {
        let desired = match (&self.course, ahead) {
            (Course::Lead(leader), _) => leader.desired(state.speed),
            (Course::Follow(follower), Some(ahead)) => follower.desired(state, &ahead),
            (Course::Follow(_), None) | (Course::Fade, _) => return Acceleration::ZERO,
        };
        self.actuator.limit(desired.min(cap), state.demand)
    }

    /// Takes as many steps as `out` has room for, behind a predecessor with these steps, and with this speed at the step before. Returns
    /// the state at the last step, and how many steps were taken. The kind of law is asked for once for all steps, not in each.
    ///
    /// No step is taken if positions are not by the trapezoid. That is for reproducing the paper, and need not be fast on an ECU.
    pub fn run(&self, state: State, before: Speed, ahead: &[Step], out: &mut [Step]) -> (State, usize) {
        let done = out.len().min(ahead.len());
        let (Some(ahead), Some(steps)) = (ahead.get(..done), out.get_mut(..done)) else { return (state, 0) };
        match &self.course {
            Course::Follow(follower) if self.actuator.can_run() => {
                // Where each step is written, the predecessor's is read: one place to keep in the loop, not two.
                steps.copy_from_slice(ahead);
                let mut before = before;
                let desired = |state: &State, ahead: &Step| {
                    let ahead = TargetStep::between(core::mem::replace(&mut before, ahead.speed), ahead);
                    follower.desired(state, &ahead)
                };
                (self.actuator.run(state, steps, desired), done)
            }
            Course::Follow(_) => (state, 0),
            Course::Lead(_) | Course::Fade => self.run_alone(state, steps),
        }
    }

    /// Takes as many steps as `out` has room for, without a predecessor. No step is taken in the same case.
    pub fn run_alone(&self, state: State, out: &mut [Step]) -> (State, usize) {
        if !self.actuator.can_run() {
            return (state, 0);
        }
        let done = out.len();
        let state = match &self.course {
            Course::Lead(leader) => self.actuator.run(state, out, |state, _| leader.desired(state.speed)),
            Course::Follow(_) | Course::Fade => self.actuator.coast(state, out),
        };
        (state, done)
    }

    /// The state at the end of the step.
    #[inline(never)] // where there are many steps, `run` takes them
    #[must_use]
    pub fn take(&self, state: State, ahead: Option<TargetStep>) -> State {
        self.actuator.drive(state, self.demand(&state, ahead, Acceleration::MAX))
    }
}
