//! Messages: what each says, and what it does to the vehicle that hears it.

use crate::act::is_speaking;
use crate::broken::Broken;
use crate::world::{Message, Phase, Plan, Said, State};

/// How a message comes from one vehicle to another in this step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comes {
    /// Not at all.
    Lost,
    /// At once.
    Now,
    /// The one of the step before, which nothing newer has overtaken.
    Late,
}

/// The sender and the receiver of a pair.
#[must_use]
pub fn pair(number: usize, vehicles: usize) -> (usize, usize) {
    let (from, to) = (number / (vehicles - 1), number % (vehicles - 1));
    (from, if to >= from { to + 1 } else { to })
}

/// All vehicles speak: every message takes the place of the last one.
pub fn speak(state: &mut State, plan: &Plan) {
    let now = state.now;
    for index in 0..state.vehicles.len() {
        let is_on_air = is_speaking(&state.vehicles[index], now, plan);
        let message = (is_on_air || plan.queue).then(|| message(state, index, plan));
        let vehicle = &mut state.vehicles[index];
        vehicle.said = is_on_air.then(|| vehicle.clock(now));
        let last = state.air[index][0].take();
        state.air[index] = [message, if plan.delays { last } else { None }];
    }
}

fn message(state: &State, index: usize, plan: &Plan) -> Message {
    let vehicle = &state.vehicles[index];
    let own = Said {
        stamp: vehicle.clock(state.now),
        claims: vehicle.claims,
        has_left: vehicle.phase == Phase::Beyond,
        is_before_zone: !is_speaking(vehicle, state.now, plan),
    };
    let about = |(other, heard): (usize, &Option<Said>)| match other == index {
        true => Some(own),
        false => heard.filter(|_| plan.relay),
    };
    state.heard[index].iter().enumerate().map(about).collect()
}

/// The ways in which a message may come now.
#[must_use]
pub fn ways(state: &State, number: usize, plan: &Plan) -> Vec<Comes> {
    let (from, to) = pair(number, state.vehicles.len());
    let both_since = state.vehicles[from].on_air.max(state.vehicles[to].on_air);
    // Who is in the area or beyond it does not heed messages any more.
    let are_within_range = plan.queue || state.now >= both_since;
    if !are_within_range || state.vehicles[to].phase != Phase::Before {
        return vec![Comes::Lost];
    }
    if plan.settles.is_some_and(|settles| state.now >= settles) {
        return vec![Comes::Now];
    }
    let mut ways = vec![Comes::Now];
    // Two that are on air hear one another within the longest silence for the first time. From then on everything may be lost.
    let is_first_due = state.heard[to][from].is_none() && state.now + 1 >= both_since + plan.silence;
    if !is_first_due {
        ways.push(Comes::Lost);
    }
    let was_within_range = plan.queue && state.now > 0 || state.now > both_since;
    if was_within_range && is_news(state, from, to, 1) {
        ways.push(Comes::Late);
    }
    ways
}

/// Whether the message of this step (0) or of the step before (1) would say anything new.
fn is_news(state: &State, from: usize, to: usize, age: usize) -> bool {
    let Some(message) = &state.air[from][age] else { return false };
    message.iter().zip(&state.heard[to]).enumerate().any(|(about, (said, held))| {
        about != to && said.is_some_and(|said| held.is_none_or(|held| held.stamp < said.stamp))
    })
}

/// Empties what makes no difference any more, so that states that differ in nothing else are one.
pub fn forget_the_useless(state: &mut State) {
    for index in 0..state.vehicles.len() {
        if state.vehicles[index].phase != Phase::Before {
            state.heard[index].fill(None);
        }
    }
    for from in 0..state.vehicles.len() {
        let heeds = |to: usize| state.vehicles[to].phase == Phase::Before;
        if !(0..state.vehicles.len()).any(|to| to != from && heeds(to) && is_news(state, from, to, 0)) {
            state.air[from][0] = None;
        }
        state.air[from][1] = None;
    }
}

/// The message comes.
pub fn receive(state: &mut State, number: usize, comes: Comes, plan: &Plan) {
    let (from, to) = pair(number, state.vehicles.len());
    let message = match comes {
        Comes::Lost => None,
        Comes::Now => state.air[from][0].clone(),
        Comes::Late => state.air[from][1].clone(),
    };
    for (about, said) in message.into_iter().flatten().enumerate() {
        let Some(said) = said.filter(|_| about != to) else { continue };
        let held = &mut state.heard[to][about];
        if held.is_none_or(|held| held.stamp < said.stamp) {
            *held = Some(said);
        }
    }
    give_way(state, to, plan);
}

/// The claims of a vehicle that is before the area give way to those with priority.
fn give_way(state: &mut State, index: usize, plan: &Plan) {
    if state.vehicles[index].phase != Phase::Before || plan.breaks(Broken::KeepsAll) {
        return;
    }
    let (rules, known) = (plan.rules(), state.known(index, plan));
    for claim in &mut state.vehicles[index].claims {
        let Some(own) = claim else { continue };
        for other in known.iter().flat_map(|(_, claims)| claims) {
            if rules.gives_way(own, other) {
                own.window = rules.trimmed(&own.window, &other.window);
            }
        }
        if own.window.is_empty() {
            *claim = None;
        }
    }
}
