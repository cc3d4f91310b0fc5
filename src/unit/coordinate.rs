//! The review of the order at the intersections, ten times a second. The scene enters; the vehicle that the ego follows, the vehicles
//! that it waits for, and the vehicles that are ahead of it for certain are known from then on. The rules are those of
//! [`crate::coordination`].
//!
//! In a tick the review comes before the estimator, because the target has to be known before the horizons change. Where news ends a
//! silence, the target is read by the old horizon and by the new one, and the controller is led from the one to the other. So the review
//! reads the horizons of the last tick. They reach beyond now, so that only the messages since the last tick are missing from them. Those
//! count from the next review on.

use heapless::Vec;

use super::lane;
use super::scene::Scene;
use super::vantage::Vantage;
use crate::coordination::{Arrival, Present, Side, Slots};
use crate::health::{Cause, Health};
use crate::time::Instant;
use crate::units::{Acceleration, Distance, Position, Speed};

/// A silent vehicle that is estimated to drive on this far ahead is not heard because it is too far away.
const FAR_AHEAD: Distance = Distance::from_mm(250_000);

/// Reviews which vehicles are ahead.
pub(super) fn review<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &mut Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    last_demand: Acceleration,
    health: &mut Health,
) {
    scene.estimator.read_all(now, &scene.peers);
    let Some(ego) = scene.ego_at(now, last_demand) else { return };
    let (front, speed) = (scene.front(&ego), ego.speed);
    // Without GNSS time the ego cannot tell when it arrives. It minds the others all the same, but arrives at no crossing.
    let gnss = scene.clock.gnss(now).filter(|_| scene.is_synchronised(now));
    let arrival = gnss.map(|gnss| Arrival::of_micros(gnss.as_micros()));
    if let Some(arrival) = arrival {
        scene.coordination.advance(front, scene.config.length, now, arrival);
    }

    let view = scene.vantage(now, front, speed);
    let is_committed = view.is_committed();
    let is_inside = scene.area_begins().is_some_and(|begins| front > begins);
    let (present, nearest) = around(&view, is_committed, is_inside);
    // A vehicle that stops at the line is only just before the point from which it could not stop any more.
    let can_wait = if scene.coordination.choice().is_held { !is_inside } else { !is_committed };
    let has_room = view.has_room(nearest);
    let gives_way = can_wait && !has_room && view.waits_for_room(nearest);
    let is_held = can_wait && (!has_room || scene.is_crossed_by_unknown(now));
    if let Some(arrival) = arrival.filter(|_| gives_way) {
        scene.coordination.give_way(arrival);
    }
    scene.coordination.hold(is_held);
    if scene.coordination.review(now, scene.config.station, &present, scene.has_slot_for_all(now)) {
        health.count(Cause::Overlooked);
    }
    scene.coordination.note_lost(lost(scene, now, front), missed(scene, now, front));
    choose(scene, now, front, speed, nearest);
    lane::note(scene, now, front);
}

/// All stations at the next crossing, and the vehicle that is estimated to be nearest ahead on the ego's leg.
fn around<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    view: &Vantage<'_, PEERS, SAMPLES, STEPS>,
    is_committed: bool,
    is_inside: bool,
) -> (Vec<Present, PEERS>, Option<usize>) {
    let coordination = &view.scene.coordination;
    let followed = coordination.choice().target.map(usize::from);
    let (mut present, mut nearest) = (Vec::new(), None::<(usize, Position)>);
    for index in 0..PEERS {
        let Some(approach) = coordination.approach(index) else { continue };
        let Some((reading, rear)) = view.scene.rear(index, view.at) else { continue };
        let Some(entry) = view.scene.entry(index, approach) else { continue };
        let has_left = coordination.has_left(approach, rear);
        let is_on_lane = coordination.is_on_lane(approach, has_left);
        let side = if reading.position > view.front { Side::Ahead } else { Side::Behind };
        if coordination.is_here(approach) {
            let takes_along = side == Side::Behind || !is_committed;
            // A vehicle in the area does not wait there for a vehicle that comes after it.
            let is_passed = is_inside && side == Side::Behind;
            let _ = present.push(Present {
                index,
                entry,
                heard: approach.heard,
                has_left,
                conflicts: coordination.conflicts(approach),
                way: reading.position.ahead_of(view.front),
                is_far_behind: is_committed || view.is_far_behind(&reading),
                is_announced: !is_passed && (followed == Some(index) || view.is_announced(approach)),
                lane: (is_on_lane && takes_along).then_some(side),
            }); // no more than slots
        }
        // A vehicle that drove on out of reach, or that the range sensor sees past, is not where it is estimated to be.
        let is_elsewhere = coordination.choice().lost.contains(index) || view.scene.is_seen_past(index, view.at);
        let is_ahead = side == Side::Ahead && is_on_lane && !is_elsewhere;
        if is_ahead && nearest.is_none_or(|(_, position)| reading.position < position) {
            nearest = Some((index, reading.position));
        }
    }
    (present, nearest.map(|(index, _)| index))
}

/// The peers that are out of reach, and drive on far ahead or are behind. One ahead that stood when it was heard last still stands there.
fn lost<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    front: Position,
) -> Slots {
    let mut lost = scene.coordination.choice().lost;
    for index in 0..PEERS {
        let drives_off = || {
            let estimate = scene.rear(index, now);
            estimate.is_some_and(|(reading, rear)| rear > front.ahead(FAR_AHEAD) && reading.speed > Speed::ZERO)
        };
        let is_elsewhere = || lost.contains(index) || drives_off() || is_behind(scene, index, now);
        lost.set(index, !scene.is_in_reach(index, now) && is_elsewhere());
    }
    lost
}

/// Whether a peer on the ego's lane was never ahead for certain. It is behind, wherever it is estimated to be: nobody passes there.
#[cold] // only where a peer has been silent for longer than a holdover
fn is_behind<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    index: usize,
    now: Instant,
) -> bool {
    let coordination = &scene.coordination;
    let place = coordination.approach(index).zip(scene.near_rear(index, now));
    let is_on_lane = place
        .is_some_and(|(approach, (rear, _))| coordination.is_on_lane(approach, coordination.has_left(approach, rear)));
    is_on_lane && !coordination.choice().leading.contains(index)
}

/// The peers that have been silent for longer than a holdover and are estimated to be in the next conflict area, where the ego's sensor sees
/// nobody. They have left it, or have not come. Once in the area itself, the ego goes by what it saw from before it.
#[inline(never)] // hardly ever, and the review is larger with it
fn missed<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    front: Position,
) -> Slots {
    let (before, mut missed) = (scene.coordination.choice().missed, Slots::NONE);
    let is_in_area = scene.area_begins().is_some_and(|begins| front > begins);
    let is_empty = !is_in_area && scene.sees_empty_area(now);
    for index in (0..PEERS).filter(|index| if is_in_area { before.contains(*index) } else { is_empty }) {
        missed.set(index, !scene.is_in_reach(index, now) && scene.is_estimated_in_area(index, now));
    }
    missed
}

/// Chooses the vehicle that the ego follows from now on: of those that it lets pass first, and the vehicle just ahead on the leg, the one
/// that asks for the most caution.
fn choose<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &mut Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    front: Position,
    speed: Speed,
    nearest: Option<usize>,
) {
    let view = scene.vantage(now, front, speed);
    let before = scene.coordination.choice();
    let first = (0..PEERS).filter(|index| before.first.contains(*index)).filter_map(|index| view.candidate(index));
    let order = first.fold(None, |best, peer| view.nearest(best, peer));
    let lane = nearest.and_then(|index| view.candidate(index)).filter(|peer| view.is_heeded(peer));
    let followed = before.target.map(usize::from);
    let target = view.choose(order, lane, followed);
    let [target, order, lane] = [target, order.map(|(peer, _)| peer), lane].map(|peer| peer.map(|peer| peer.index));
    let may = view.comfort(target);
    // For the same target the ego does not brake more gently than it already had to.
    let comfort = if followed == target { may.min(before.comfort) } else { may };
    scene.coordination.choose(target, comfort, order, lane);
}
