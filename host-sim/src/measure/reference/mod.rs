//! The discrete equations of the core in float64, as the reference for the fixed-point core: a state and the parameters
//! of a law enter; the state one step later leaves. [`horizon`] strings steps to horizons and chains.
//!
//! It is written from the equations, not from the core. One step of length `h`, from `t+k-1` to `t+k`:
//!
//! 1. the demand `u` of the law: [`demand_lead`] (Algorithm 2), [`demand_follow`] (Algorithm 4), or 0 for a vehicle
//!    that published no driving parameters;
//! 2. [`limited`]: the controller's limits on acceleration and jerk;
//! 3. [`actuated`]: the actuator lag solved exactly, the speed not below 0, the position (Algorithm 3).

pub mod horizon;

use crate::measure::heard::{Heard, HeardParameters};

/// `a_max` of Algorithm 2, m/s².
pub const LEADER_ACCELERATION_MPS2: f64 = 0.73;
/// `σ` of Algorithm 2.
pub const FREE_EXPONENT: i32 = 4;
/// Below this `v_∞`, in m/s, a leader stops, because Algorithm 2 divides by `v_∞`.
pub const STOPPING_TARGET_SPEED_MPS: f64 = 0.1;
/// Time constant with which the acceleration of a vehicle without a law fades.
pub const FADING_S: f64 = 2.0;

/// The format of `φ/h` ends here. A shorter step passes on less of the predecessor's acceleration.
pub const LARGEST_FEED_PER_S: f64 = 64.0;

/// A vehicle's state on the lane at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Front bumper.
    pub position_m: f64,
    /// Speed, not below 0.
    pub speed_mps: f64,
    /// Acceleration of the vehicle.
    pub acceleration_mps2: f64,
    /// Acceleration last demanded of its actuators.
    pub demand_mps2: f64,
}

/// The vehicle ahead as a follower's law sees it, at `t+k`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ahead {
    /// Its front bumper, `r_{n-1}`.
    pub position_m: f64,
    /// Its speed, `v_{n-1}`.
    pub speed_mps: f64,
    /// By how much its speed grew over the step.
    pub gained_mps: f64,
    /// Its length, `l_{n-1}`.
    pub length_m: f64,
}

/// The law that a vehicle drives by; limits are magnitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Length, bumper to bumper, `l`.
    pub length_m: f64,
    /// Standstill distance, `s_0`.
    pub standstill_m: f64,
    /// Target speed on a free road, `v_∞`.
    pub target_speed_mps: f64,
    /// Largest speed while catching up, `v_c`; infinite: limited by the law only.
    pub catch_up_mps: f64,
    /// Desired time gap, `t_g`.
    pub time_gap_s: f64,
    /// Gain `α k` in 1/s².
    pub gain: f64,
    /// Damping `γ`.
    pub damping_s: f64,
    /// Share of the predecessor's acceleration that is added, `φ`.
    pub feed_forward: f64,
    /// Time constant of the actuators, `T`; 0: no lag.
    pub lag_s: f64,
    /// Largest acceleration demanded.
    pub acceleration_mps2: f64,
    /// Hardest braking demanded.
    pub braking_mps2: f64,
    /// Fastest change of the demand.
    pub jerk_mps3: f64,
}

/// How a step moves the position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PositionRule {
    /// `r + (v(t+k-1) + v(t+k)) h/2`: this project's reading of Algorithm 3.
    Trapezoid,
    /// `r + v(t+k-1) h`: eq. 9 as printed.
    Euler,
}

impl From<&Heard> for State {
    fn from(heard: &Heard) -> Self {
        Self {
            position_m: heard.position_m,
            speed_mps: heard.speed_mps,
            acceleration_mps2: heard.acceleration_mps2,
            demand_mps2: heard.demand_mps2,
        }
    }
}

impl From<&HeardParameters> for Parameters {
    fn from(parameters: &HeardParameters) -> Self {
        Self {
            length_m: parameters.length_m,
            standstill_m: parameters.standstill_m,
            target_speed_mps: parameters.target_speed_mps,
            catch_up_mps: (1.0 + parameters.catch_up) * parameters.target_speed_mps,
            time_gap_s: parameters.time_gap_s,
            gain: parameters.gain,
            damping_s: parameters.damping_s,
            feed_forward: parameters.feed_forward,
            lag_s: parameters.lag_s,
            acceleration_mps2: parameters.acceleration_mps2,
            braking_mps2: parameters.braking_mps2,
            jerk_mps3: parameters.jerk_mps3,
        }
    }
}

impl Parameters {
    /// The same law as in the paper: no standstill distance, no lag, no limits. The limits are finite but never
    /// reached: they have to be finite because a leader that is told to stop demands its braking limit.
    #[must_use]
    pub fn as_printed(self) -> Self {
        let unlimited = 1e9;
        Self {
            standstill_m: 0.0,
            catch_up_mps: f64::INFINITY,
            lag_s: 0.0,
            acceleration_mps2: unlimited,
            braking_mps2: unlimited,
            jerk_mps3: unlimited,
            ..self
        }
    }
}

/// Eq. 8, as a demand: `a_max [1 - (v/v_∞)^σ]`, limited to the law's hardest braking.
#[must_use]
pub fn demand_lead(state: &State, law: &Parameters) -> f64 {
    if law.target_speed_mps < STOPPING_TARGET_SPEED_MPS {
        return -law.braking_mps2;
    }
    let share = (state.speed_mps / law.target_speed_mps).powi(FREE_EXPONENT);
    (LEADER_ACCELERATION_MPS2 * (1.0 - share)).max(-law.braking_mps2)
}

/// Eq. 13 as the semi-implicit step that it is, as a demand: with `κ = α k h` and `r_n(t+k) = r_n + v_n h`,
///
/// ```text
/// v* = [v_n - κ (r_n(t+k) - r_{n-1}(t+k) + l_{n-1} + s_0 - γ v_{n-1}(t+k))] / [1 + κ (t_g + γ)]
/// u = (v* - v_n)/h + φ (v_{n-1}(t+k) - v_{n-1}(t+k-1))/h
/// ```
///
/// `φ/h` is at most [`LARGEST_FEED_PER_S`].
#[must_use]
pub fn demand_follow(state: &State, ahead: &Ahead, law: &Parameters, step_s: f64) -> f64 {
    let kappa = law.gain * step_s;
    let position_m = state.position_m + state.speed_mps * step_s;
    let spacing_m = position_m - ahead.position_m + ahead.length_m + law.standstill_m;
    let wanted_mps = (state.speed_mps - kappa * (spacing_m - law.damping_s * ahead.speed_mps))
        / (1.0 + kappa * (law.time_gap_s + law.damping_s));
    let free = law.gain * (law.time_gap_s + step_s) / (1.0 + kappa * (law.time_gap_s + law.damping_s));
    let by_gap = ((wanted_mps - state.speed_mps) / step_s).min(free * (law.catch_up_mps - state.speed_mps));
    by_gap + (law.feed_forward / step_s).min(LARGEST_FEED_PER_S) * ahead.gained_mps
}

/// The demand within the law's limits on acceleration and, from the last demand on, on jerk. Where the two ranges do
/// not meet, the higher of their lower ends counts. So a demand below the braking limit returns to it at once, and a
/// demand above the acceleration limit decreases at the jerk limit.
#[must_use]
pub fn limited(demand_mps2: f64, last_demand_mps2: f64, law: &Parameters, step_s: f64) -> f64 {
    let change = law.jerk_mps3 * step_s;
    let lowest = (-law.braking_mps2).max(last_demand_mps2 - change);
    let highest = law.acceleration_mps2.min(last_demand_mps2 + change);
    demand_mps2.min(highest).max(lowest)
}

/// The state after a step at a constant demand `u`: with `φ = e^(-h/T)`, acceleration `u + (a - u) φ` and speed
/// `v + u h + (a - u) T (1 - φ)`. A speed below 0 becomes 0, and the acceleration is then not below 0 either.
#[must_use]
pub fn actuated(state: &State, demand_mps2: f64, lag_s: f64, step_s: f64, rule: PositionRule) -> State {
    let share = if lag_s > 0.0 { (-step_s / lag_s).exp() } else { 0.0 };
    let excess = state.acceleration_mps2 - demand_mps2;
    let mut acceleration_mps2 = demand_mps2 + excess * share;
    let mut speed_mps = state.speed_mps + demand_mps2 * step_s + excess * lag_s * (1.0 - share);
    if speed_mps < 0.0 {
        speed_mps = 0.0;
        acceleration_mps2 = acceleration_mps2.max(0.0);
    }
    let way_m = match rule {
        PositionRule::Trapezoid => 0.5 * (state.speed_mps + speed_mps) * step_s,
        PositionRule::Euler => state.speed_mps * step_s,
    };
    State { position_m: state.position_m + way_m, speed_mps, acceleration_mps2, demand_mps2 }
}

/// The state after a step of a vehicle without driving parameters: its acceleration fades as `e^(-t/2 s)`, which is a
/// lag of 2 s towards a demand of 0.
#[must_use]
pub fn faded(state: &State, step_s: f64, rule: PositionRule) -> State {
    actuated(state, 0.0, FADING_S, step_s, rule)
}

#[cfg(test)]
mod tests;
