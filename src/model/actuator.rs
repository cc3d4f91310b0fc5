//! What the controller and the actuators of a vehicle make of a desired acceleration. The desired acceleration enters; it is limited in
//! size and jerk, and delayed by the lag of the actuators. The state one step later leaves. The prediction and the controller share this,
//! because the model must be the controller.

use super::exponential::Decay;
use super::position::Path;
use super::state::{Remainders, State, Step};
use super::switches::Model;
use crate::fixed::{Rest, mul_hi, product, sum};
use crate::time::Duration;
use crate::units::{Acceleration, FineSeconds, Jerk, Speed};
use crate::wire::driving_parameters::Limits;

/// The constants of one step of a given length for one vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Actuator {
    path: Path,
    step: FineSeconds,
    /// `e^(-δt/T)` with 31 fraction bits, so that its product needs only a doubling.
    keep: i32,
    slip: FineSeconds,
    /// How much room the format has above the largest acceleration, and below the hardest braking. What is added and taken away again
    /// saturates just there, which takes fewer registers than a comparison.
    above: Acceleration,
    below: Acceleration,
    slew: Acceleration,
}

impl Actuator {
    /// For steps of length `step`, of a vehicle with this lag and these limits.
    #[must_use]
    pub fn over(step: Duration, lag: Duration, limits: &Limits, model: &Model) -> Self {
        let lag = if model.lag { lag } else { Duration::ZERO };
        let unlimited = !model.limits;
        let Decay { keep, slip } = Decay::over(step, lag);
        Self {
            path: Path::over(step, model.trapezoid),
            step: step.fine_seconds(),
            keep: keep.to_bits().saturating_mul(2).max(0),
            slip,
            above: if unlimited { Acceleration::ZERO } else { Acceleration::MAX.minus(limits.acceleration) },
            below: if unlimited { Acceleration::ZERO } else { limits.braking.negated().minus(Acceleration::MIN) },
            slew: if unlimited { Acceleration::MAX } else { slew(limits.jerk, step) },
        }
    }

    /// The demand for a desired acceleration. It differs from the last demand by the jerk limit at most. It is within the limits on
    /// acceleration, as far as the jerk limit lets it get there.
    #[inline(always)]
    #[must_use]
    pub fn limit(&self, desired: Acceleration, last: Acceleration) -> Acceleration {
        let (low, high) = (last.minus(self.slew), last.plus(self.slew));
        let below_ceiling = desired.plus(self.above).minus(self.above);
        below_ceiling.min(high).max(low).minus(self.below).plus(self.below)
    }

    /// The gain in speed over the step at this acceleration.
    #[must_use]
    pub const fn gained(&self, acceleration: Acceleration) -> Speed {
        acceleration.over(self.step)
    }

    /// The state after one step under a demand that holds for the whole step. The lag `ȧ = (u - a)/T` is solved exactly, the speed never
    /// becomes negative, and the position follows Algorithm 3.
    #[inline(always)]
    #[must_use]
    pub fn drive(&self, state: State, demand: Acceleration) -> State {
        if self.path.is_trapezoid() { self.go::<true>(state, demand) } else { self.go::<false>(state, demand) }
    }

    #[inline(always)]
    fn go<const TRAPEZOID: bool>(&self, state: State, demand: Acceleration) -> State {
        let behind = state.acceleration.minus(demand);
        // The result is between the demand and the acceleration, so that the sum cannot overflow.
        let left = mul_hi(behind.to_bits(), self.keep).wrapping_mul(2);
        let mut acceleration = Acceleration::from_bits(demand.to_bits().wrapping_add(left));
        // Each is less than 2⁶¹: 64 m/s² with 25 bits, for 1 s with 30 bits.
        let gained =
            product(demand.to_bits(), self.step.to_bits()).wrapping_add(product(behind.to_bits(), self.slip.to_bits()));
        let (word, mut rest) = sum(state.speed.to_bits(), state.remainders.speed, gained);
        let mut speed = Speed::from_bits(word);
        if word < 0 {
            (speed, rest, acceleration) = (Speed::ZERO, Rest::NONE, at_rest(acceleration));
        }
        let (position, rest_of_position) =
            self.path.follow::<TRAPEZOID>(state.position, state.remainders.position, state.speed, speed);
        State {
            position,
            speed,
            acceleration,
            demand,
            remainders: Remainders { position: rest_of_position, speed: rest },
        }
    }
}

impl Actuator {
    /// Whether [`run`](Self::run) and [`coast`](Self::coast) do what [`drive`](Self::drive) does.
    pub(super) const fn can_run(&self) -> bool {
        self.path.is_trapezoid()
    }

    /// Steps by a law. The law gets what is in its element of `steps`, and the end of the step is written there. Returns the state at
    /// the last step.
    #[inline(always)]
    pub(super) fn run(
        &self,
        mut state: State,
        steps: &mut [Step],
        mut desired: impl FnMut(&State, &Step) -> Acceleration,
    ) -> State {
        for out in steps {
            state = self.go::<true>(state, self.limit(desired(&state, out), state.demand));
            *out = Step { position: state.position, speed: state.speed };
        }
        state
    }

    /// Steps without any demand.
    #[inline(always)]
    pub(super) fn coast(&self, mut state: State, steps: &mut [Step]) -> State {
        for out in steps {
            state = self.go::<true>(state, Acceleration::ZERO);
            *out = Step { position: state.position, speed: state.speed };
        }
        state
    }
}

/// The acceleration of a vehicle that comes to rest. It is a function of its own because it is rare: the step then has a branch that is
/// not taken, and does not compute this in vain.
#[cold]
#[inline(never)]
fn at_rest(acceleration: Acceleration) -> Acceleration {
    acceleration.max(Acceleration::ZERO)
}

/// By how much the jerk limit lets the demand change in a step of up to 1 s.
fn slew(jerk: Jerk, step: Duration) -> Acceleration {
    jerk.over(step.fine_seconds())
}
