//! Horizons and chains of them: a state, a role and a law enter, the states of every step leave.

use super::{Ahead, Parameters, PositionRule, State, actuated, demand_follow, demand_lead, faded, limited};

/// The role of a vehicle.
#[derive(Clone, Copy, Debug)]
pub enum Role<'a> {
    /// The vehicle has no predecessor: Algorithm 2.
    Leader,
    /// The vehicle follows a predecessor whose horizon is on the same time grid: Algorithm 4.
    Follower {
        /// The horizon of the predecessor: its states as [`horizon`] returns them.
        ahead: &'a [State],
        /// `l_{n-1}`.
        length_m: f64,
    },
    /// The vehicle published no driving parameters: its acceleration fades.
    Silent,
}

/// The states at `t, t+1, …, t+steps`; the first is the initial one.
///
/// # Panics
/// If the horizon of the predecessor is shorter.
#[must_use]
pub fn horizon(
    initial: State,
    role: Role<'_>,
    law: &Parameters,
    step_s: f64,
    steps: usize,
    rule: PositionRule,
) -> Vec<State> {
    let mut states = Vec::with_capacity(steps + 1);
    let mut state = initial;
    states.push(state);
    for k in 1..=steps {
        let demand = match role {
            Role::Leader => Some(demand_lead(&state, law)),
            Role::Follower { ahead, length_m } => {
                let State { position_m, speed_mps, .. } = ahead[k];
                let gained_mps = speed_mps - ahead[k - 1].speed_mps;
                Some(demand_follow(&state, &Ahead { position_m, speed_mps, gained_mps, length_m }, law, step_s))
            }
            Role::Silent => None,
        };
        state = match demand {
            Some(demand) => actuated(&state, limited(demand, state.demand_mps2, law, step_s), law.lag_s, step_s, rule),
            None => faded(&state, step_s, rule),
        };
        states.push(state);
    }
    states
}

/// The horizons of a whole string, leader first. Each follower uses the horizon of the vehicle ahead.
#[must_use]
pub fn chain(vehicles: &[(State, Parameters)], step_s: f64, steps: usize, rule: PositionRule) -> Vec<Vec<State>> {
    let mut horizons: Vec<Vec<State>> = Vec::with_capacity(vehicles.len());
    for (n, (initial, law)) in vehicles.iter().enumerate() {
        let role = match horizons.last() {
            None => Role::Leader,
            Some(ahead) => Role::Follower { ahead, length_m: vehicles[n - 1].1.length_m },
        };
        let states = horizon(*initial, role, law, step_s, steps, rule);
        horizons.push(states);
    }
    horizons
}
