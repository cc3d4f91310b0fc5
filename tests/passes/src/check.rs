//! The model as the checker sees it: one turn after the other, and what has to hold in every state.

use stateright::{Model, Property};

use crate::act::{self, Act};
use crate::hear::{self, Comes};
use crate::world::{Phase, Plan, State, Turn, Vehicle};

/// One thing that happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Event {
    /// The vehicle whose turn it is does this.
    Act(Act),
    /// The message whose turn it is comes like this.
    Hear(Comes),
}

/// Never are two vehicles in the area at once.
pub const APART: &str = "two vehicles are never in the area at once";
/// Once all messages are received, everybody gets through by the end of time.
pub const SERVED: &str = "everybody gets through once all messages are received";

impl Model for Plan {
    type State = State;
    type Action = Event;

    fn init_states(&self) -> Vec<State> {
        let mut all = vec![Vec::new()];
        for _ in 0..self.vehicles {
            let with = |vehicles: &Vec<Vehicle>, on_air, ahead| {
                let next = Vehicle { on_air, ahead, phase: Phase::Before, claims: Default::default(), said: None };
                [&vehicles[..], &[next]].concat()
            };
            let choices = || {
                (self.first_comes()..=self.first_comes() + self.last_comes)
                    .flat_map(|on_air| (0..=self.clocks).map(move |ahead| (on_air, ahead)))
            };
            all = all
                .iter()
                .flat_map(|vehicles| choices().map(move |(on_air, ahead)| with(vehicles, on_air, ahead)))
                .collect();
        }
        // Only differences matter, of clocks and of when they come.
        let first = self.first_comes();
        all.retain(|vehicles| {
            vehicles.iter().any(|vehicle| vehicle.ahead == 0) && vehicles.iter().any(|vehicle| vehicle.on_air == first)
        });
        all.into_iter().map(State::new).collect()
    }

    fn actions(&self, state: &State, actions: &mut Vec<Event>) {
        if state.now >= self.until || are_through(state) {
            return;
        }
        let is_settled = self.settles.is_some_and(|settles| state.now >= settles);
        match state.turn {
            Turn::Act(index) | Turn::Use(index) if is_settled => {
                actions.push(Event::Act(act::best(state, index, self)))
            }
            Turn::Act(index) => actions.extend(act::all(state, index, self).into_iter().map(Event::Act)),
            Turn::Use(_) => actions.extend([Act::Wait, Act::Enter].map(Event::Act)),
            Turn::Hear(number) => actions.extend(hear::ways(state, number, self).into_iter().map(Event::Hear)),
        }
    }

    fn next_state(&self, state: &State, event: Event) -> Option<State> {
        let mut next = state.clone();
        match (state.turn, event) {
            (Turn::Act(index) | Turn::Use(index), Event::Act(act)) => {
                act::carry_out(&mut next, index, act);
                next.turn = Turn::Act(index + 1);
                if act::may_enter_at_once(&next, index, act, self) {
                    next.turn = Turn::Use(index);
                } else if index + 1 == self.vehicles {
                    hear::speak(&mut next, self);
                    next.turn = Turn::Hear(0);
                }
            }
            (Turn::Hear(number), Event::Hear(comes)) => {
                hear::receive(&mut next, number, comes, self);
                next.turn = Turn::Hear(number + 1);
                if number + 1 == self.vehicles * (self.vehicles - 1) {
                    next.turn = Turn::Act(0);
                    next.now += 1;
                    hear::forget_the_useless(&mut next);
                }
            }
            _ => return None,
        }
        Some(next)
    }

    fn properties(&self) -> Vec<Property<Self>> {
        let mut properties = vec![Property::always(APART, |_, state: &State| {
            // While the vehicles act one after the other, one may already be in that another one is about to leave.
            let is_inside = |vehicle: &&Vehicle| matches!(vehicle.phase, Phase::Inside(_));
            matches!(state.turn, Turn::Act(_) | Turn::Use(_)) || state.vehicles.iter().filter(is_inside).count() < 2
        })];
        if self.settles.is_some() {
            properties
                .push(Property::always(SERVED, |plan: &Self, state| state.now < plan.until || are_through(state)));
        }
        properties
    }
}

fn are_through(state: &State) -> bool {
    state.vehicles.iter().all(|vehicle| vehicle.phase == Phase::Beyond)
}
