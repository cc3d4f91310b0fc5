//! What a vehicle may do in its turn: one thing a step.

use holdover::passes::{Claim, Window, is_covered};
use holdover::time::{Duration, GnssTime};

use crate::broken::Broken;
use crate::world::{Phase, Plan, State, Vehicle};

/// One thing that a vehicle does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Act {
    /// Nothing, or it stays where it is.
    Wait,
    /// It claims this window, from this time on.
    Claim(Claim),
    /// It gives a window up.
    Drop(usize),
    /// It moves a window a step later, which no rule allows.
    Shift(usize),
    /// It goes in.
    Enter,
    /// It leaves.
    Leave,
}

fn steps(steps: u8) -> Duration {
    Duration::from_micros(steps.into())
}

/// Everything that a vehicle may do.
#[must_use]
pub fn all(state: &State, index: usize, plan: &Plan) -> Vec<Act> {
    let vehicle = &state.vehicles[index];
    match vehicle.phase {
        Phase::Beyond => vec![Act::Wait],
        // Its window ends when its longest stay does, so it is out by then.
        Phase::Inside(since) => {
            let stayed = state.now - since;
            let mut acts = Vec::new();
            if stayed < plan.stay {
                acts.push(Act::Wait);
            }
            if stayed > 0 {
                acts.push(Act::Leave);
            }
            acts
        }
        Phase::Before if !is_speaking(vehicle, state.now, plan) => vec![Act::Wait],
        Phase::Before => {
            let mut acts = vec![Act::Wait];
            acts.extend(claims(state, index, plan).into_iter().map(Act::Claim));
            for (piece, _) in vehicle.claims.iter().enumerate().filter(|(_, claim)| claim.is_some()) {
                acts.push(Act::Drop(piece));
                if plan.breaks(Broken::KeepsItsTime) && is_shift_free(state, index, piece, plan) {
                    acts.push(Act::Shift(piece));
                }
            }
            if may_enter(state, index, plan) {
                acts.push(Act::Enter);
            }
            acts
        }
    }
}

/// The one thing that gets a vehicle through, once all messages are received.
#[must_use]
pub fn best(state: &State, index: usize, plan: &Plan) -> Act {
    let possible = all(state, index, plan);
    let wanted = |act: &&Act| matches!(act, Act::Enter | Act::Leave);
    if let Some(act) = possible.iter().find(wanted) {
        return *act;
    }
    let vehicle = &state.vehicles[index];
    let now = vehicle.clock(state.now);
    // A window that it cannot use any more is given up, so that there is room for a claim.
    let is_over = |claim: &Claim| claim.window.exit < now.plus(steps(plan.stay)) || is_short(claim, plan);
    if vehicle.phase == Phase::Before {
        if let Some(piece) = vehicle.claims.iter().position(|claim| claim.is_some_and(|claim| is_over(&claim))) {
            return Act::Drop(piece);
        }
        if vehicle.claims.iter().all(Option::is_none) && is_speaking(vehicle, state.now, plan) {
            return Act::Claim(earliest(state, index, plan, claims_from(vehicle, now, plan).plus(steps(1))));
        }
    }
    Act::Wait
}

fn is_short(claim: &Claim, plan: &Plan) -> bool {
    claim.window.exit < claim.window.entry.plus(steps(plan.stay))
}

/// Whether it may go in with the window that it has claimed in this very step.
#[must_use]
pub fn may_enter_at_once(state: &State, index: usize, act: Act, plan: &Plan) -> bool {
    matches!(act, Act::Claim(_)) && may_enter(state, index, plan)
}

/// Does it.
pub fn carry_out(state: &mut State, index: usize, act: Act) {
    let now = state.now;
    let vehicle = &mut state.vehicles[index];
    match act {
        Act::Wait => {}
        Act::Claim(claim) => {
            if let Some(free) = vehicle.claims.iter_mut().find(|claim| claim.is_none()) {
                *free = Some(claim);
            }
        }
        Act::Drop(piece) => vehicle.claims[piece] = None,
        Act::Shift(piece) => {
            if let Some(claim) = &mut vehicle.claims[piece] {
                claim.window = shifted(&claim.window);
            }
        }
        Act::Enter => vehicle.phase = Phase::Inside(now),
        Act::Leave => {
            vehicle.phase = Phase::Beyond;
            vehicle.claims = Default::default();
        }
    }
    // What is over is nobody's any more.
    let clock = vehicle.clock(now);
    for claim in &mut vehicle.claims {
        if vehicle.phase == Phase::Before && claim.is_some_and(|claim| claim.window.exit <= clock) {
            *claim = None;
        }
    }
}

/// Whether it publishes. Out of range nobody hears that.
#[must_use]
pub fn is_speaking(vehicle: &Vehicle, now: u8, plan: &Plan) -> bool {
    let early = if plan.breaks(Broken::OutOfRange) { plan.silence } else { 0 };
    now + early >= vehicle.on_air
}

fn claims_from(vehicle: &Vehicle, now: GnssTime, plan: &Plan) -> GnssTime {
    let early = if plan.breaks(Broken::OutOfRange) { plan.silence } else { 0 };
    let early = early + if plan.breaks(Broken::WaitsNoClocks) { plan.clocks } else { 0 };
    let on_air = vehicle.clock(vehicle.on_air).plus(Duration::ZERO.minus(steps(early)));
    match vehicle.said {
        Some(said) if plan.breaks(Broken::SaidBefore) => said.max(on_air.plus(steps(plan.silence + plan.clocks))),
        said => plan.rules().claims_from(now, on_air, said),
    }
}

/// The claims that it may make now.
fn claims(state: &State, index: usize, plan: &Plan) -> Vec<Claim> {
    let vehicle = &state.vehicles[index];
    if vehicle.claims.iter().flatten().count() >= plan.pieces {
        return Vec::new();
    }
    let from = claims_from(vehicle, vehicle.clock(state.now), plan);
    let mut found: Vec<Claim> =
        (0..plan.entries).map(|later| earliest(state, index, plan, from.plus(steps(later)))).collect();
    found.dedup();
    found.retain(|claim| !vehicle.claims.iter().flatten().any(|own| own.window == claim.window));
    found
}

/// The claim of the earliest free window from this time on.
fn earliest(state: &State, index: usize, plan: &Plan, entry: GnssTime) -> Claim {
    let vehicle = &state.vehicles[index];
    let known = state.known(index, plan);
    let taken: Vec<Window> = known.iter().flat_map(|(_, claims)| claims).map(|claim| claim.window).collect();
    let wanted = Window { entry, exit: entry.plus(steps(plan.window)) };
    let window = plan.rules().earliest_free(&wanted, taken.iter().copied());
    let at = claims_from(vehicle, vehicle.clock(state.now), plan);
    Claim { at, window, station: station(index) }
}

/// Whether it may go in: its whole stay is in firm windows.
fn may_enter(state: &State, index: usize, plan: &Plan) -> bool {
    let entry = state.vehicles[index].clock(state.now);
    let stay = plan.stay - u8::from(plan.breaks(Broken::CoversLess));
    let stay = Window { entry, exit: entry.plus(steps(stay)) };
    is_covered(&stay, state.firm(index, plan).into_iter())
}

fn shifted(window: &Window) -> Window {
    Window { entry: window.entry.plus(steps(1)), exit: window.exit.plus(steps(1)) }
}

/// Whether a shifted window overlaps nothing that is known.
fn is_shift_free(state: &State, index: usize, piece: usize, plan: &Plan) -> bool {
    let Some(claim) = state.vehicles[index].claims[piece] else { return false };
    let (rules, window) = (plan.rules(), shifted(&claim.window));
    state.known(index, plan).iter().flat_map(|(_, claims)| claims).all(|other| !rules.conflict(&window, &other.window))
}

/// The number by which a station is told.
#[must_use]
pub fn station(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}
