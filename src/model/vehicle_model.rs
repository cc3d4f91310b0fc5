//! How a vehicle drives, as far as it is known. Its published driving parameters, or the lack of them, enter; the constants of its
//! prediction step leave.

use super::actuator::Actuator;
use super::follower::Follower;
use super::leader::Leader;
use super::state::{State, Step};
use super::switches::Model;
use crate::parameters::{FADE, FREE_ROAD_ACCELERATION};
use crate::time::Duration;
use crate::units::{Acceleration, Distance, Fraction, Gain, Jerk, RingPosition, Seconds, Speed};
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
        /// `k`.
        gain: Gain,
        /// `γ`.
        damping: Seconds,
        /// `t_g`.
        time_gap: Seconds,
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
                gain: parameters.gain,
                damping: parameters.damping,
                time_gap: parameters.time_gap,
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
        let course = match self.aim {
            Aim::Fade => Course::Fade,
            Aim::Lead { largest, target_speed } => Course::Lead(Leader::new(largest, target_speed)),
            Aim::Follow { gain, damping, time_gap, standstill, catch_up } => {
                let spacing = length_ahead.plus(standstill);
                let catch_up = model.limits.then_some(catch_up);
                Course::Follow(Follower::over(step, gain, damping, time_gap, spacing, catch_up))
            }
        };
        let lag = if matches!(course, Course::Fade) { FADE } else { self.lag };
        let fading = Model { lag: true, ..*model };
        let model = if matches!(course, Course::Fade) { &fading } else { model };
        Stride { course, actuator: Actuator::over(step, lag, &self.limits, model) }
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
    /// The demand of this step: the desired acceleration, but no more than the cap, and within the vehicle's limits. The acceleration of
    /// a follower without a predecessor fades out.
    #[inline(always)]
    #[must_use]
    pub fn demand(&self, state: &State, ahead: Option<(RingPosition, Speed)>, cap: Acceleration) -> Acceleration {
        let desired = match (&self.course, ahead) {
            (Course::Lead(leader), _) => leader.desired(state.speed),
            (Course::Follow(follower), Some((position, speed))) => follower.desired(state, position, speed),
            (Course::Follow(_), None) | (Course::Fade, _) => return Acceleration::ZERO,
        };
        self.actuator.limit(desired.min(cap), state.demand)
    }

    /// Takes as many steps as `out` has room for, behind a predecessor with these steps. Returns the state at the last step, and how many
    /// steps were taken. The kind of law is asked for once for all steps, not in each.
    ///
    /// No step is taken if positions are not by the trapezoid. That is for reproducing the paper, and need not be fast on an ECU.
    pub fn run(&self, state: State, ahead: &[Step], out: &mut [Step]) -> (State, usize) {
        if !self.actuator.can_run() {
            return (state, 0);
        }
        match &self.course {
            Course::Follow(follower) => {
                let steps = out.iter_mut().zip(ahead);
                let done = steps.len();
                let desired = |state: &State, ahead: &Step| follower.desired(state, ahead.position, ahead.speed);
                (self.actuator.run(state, steps, desired), done)
            }
            Course::Lead(_) | Course::Fade => {
                let done = out.len().min(ahead.len());
                self.run_alone(state, out.get_mut(..done).unwrap_or_default())
            }
        }
    }

    /// Takes as many steps as `out` has room for, without a predecessor. No step is taken in the same case.
    pub fn run_alone(&self, state: State, out: &mut [Step]) -> (State, usize) {
        if !self.actuator.can_run() {
            return (state, 0);
        }
        let done = out.len();
        let steps = out.iter_mut().map(|out| (out, ()));
        let state = match &self.course {
            Course::Lead(leader) => self.actuator.run(state, steps, |state, ()| leader.desired(state.speed)),
            Course::Follow(_) | Course::Fade => self.actuator.coast(state, steps.map(|(out, ())| out)),
        };
        (state, done)
    }

    /// The state at the end of the step.
    #[inline(never)] // where there are many steps, `run` takes them
    #[must_use]
    pub fn take(&self, state: State, ahead: Option<(RingPosition, Speed)>) -> State {
        self.actuator.drive(state, self.demand(&state, ahead, Acceleration::MAX))
    }
}
