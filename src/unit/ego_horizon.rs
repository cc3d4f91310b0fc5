//! The ego's own horizon. The ego's state and the vehicle that it follows enter; where the ego will be leaves, past the changes of target
//! that it can foresee.
//!
//! A vehicle that falls silent drives on by what it knows, and so do the vehicles ahead of it. When its target leaves the conflict area,
//! or when it comes to the next intersection itself, it follows another vehicle from then on. It already knows that order, and holds
//! those horizons. So its own horizon includes the change. Every vehicle that hears it then knows of the change, and so do the vehicles
//! behind.

use super::scene::Scene;
use super::vantage::Vantage;
use crate::controller::Gains;
use crate::coordination::{Entry, REVIEW, Slots};
use crate::model::Reading;
use crate::peers::Sample;
use crate::time::Instant;
use crate::units::Position;

/// Computes the ego's own horizon from its own state, behind the target with the gains of the association.
pub(super) fn foresee<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &mut Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    sample: &Sample,
    target: Option<usize>,
    gains: Option<Gains>,
) {
    let mut manner = scene.estimator.manner(scene.ego_model_now(gains), target, &scene.peers);
    let review = scene.coordination.next_review().filter(|_| scene.is_decided_by_order());
    scene.estimator.foresee_own(now, review, sample, &manner);
    let Some(mut review) = review.map(|review| review.max(now)) else { return };
    let (mut crossing, mut comfort) = (scene.coordination.next(), scene.coordination.choice().comfort);
    let mut gains = gains;
    let minded = minded(scene, now, crossing);
    while scene.estimator.is_own_short(now) {
        let Some(own) = scene.estimator.read_own(review) else { return };
        crossing = scene.coordination.next_of(crossing, own.position, scene.config.length);
        let view = Vantage { scene, at: review, next: crossing, front: own.position, speed: own.speed };
        let target = outlook(&view, minded, manner.target);
        let is_new = target != manner.target;
        let may = view.comfort(target);
        if is_new || may < comfort {
            comfort = may;
            if is_new {
                gains = target.and_then(|index| gains_behind(scene, index, &own, review));
            }
            let behind = gains.zip(target).map(|(gains, index)| (gains, scene.standstill_at(crossing, index)));
            manner = scene.estimator.manner(scene.ego_model(behind, comfort), target, &scene.peers);
        }
        review = review.plus(REVIEW);
        scene.estimator.carry_own_on(now, review, &manner);
    }
}

/// The gains of an association that begins at `at`.
fn gains_behind<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    index: usize,
    own: &Reading,
    at: Instant,
) -> Option<Gains> {
    let ahead = scene.estimated(index, at)?;
    let headway = ahead.position.ahead_of(own.position);
    Some(Gains::look_up(&scene.config.law, own.speed, ahead.speed, headway))
}

/// The vehicles that the ego may follow at some time, with `next` as its next crossing: a vehicle that is ahead on its leg now, because
/// no vehicle passes another there; a vehicle that is ahead in the order; and a vehicle that has come to a later crossing.
fn minded<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    next: usize,
) -> Slots {
    let mut minded = Slots::NONE;
    let Some(own) = scene.estimator.read_own(now) else { return minded };
    for index in 0..PEERS {
        let is_minded = scene.coordination.approach(index).is_some_and(|approach| {
            if scene.coordination.is_on_lane(approach) {
                scene.estimated(index, now).is_some_and(|reading| reading.position > own.position)
            } else {
                let is_ahead = || scene.entry(index, approach).is_some_and(|entry| is_ahead(scene, index, &entry));
                approach.crossing > next || approach.crossing == next && is_ahead()
            }
        });
        minded.set(index, is_minded);
    }
    minded
}

/// The vehicle that the ego will follow, by the order and the horizons as they are known now. A vehicle that registers in between is not
/// known.
fn outlook<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    view: &Vantage<'_, PEERS, SAMPLES, STEPS>,
    minded: Slots,
    followed: Option<usize>,
) -> Option<usize> {
    let (scene, coordination) = (view.scene, &view.scene.coordination);
    let end = coordination.end_of(view.next);
    let is_later = view.next != coordination.next();
    let (mut order, mut lane) = (None::<(usize, Entry)>, None::<(usize, Position)>);
    for index in (0..PEERS).filter(|index| minded.contains(*index)) {
        let Some(approach) = coordination.approach(index) else { continue };
        let is_on_lane = coordination.is_on_lane(approach);
        // The entry is asked for first, because it needs no horizon.
        let entry = scene.entry(index, approach).filter(|entry| {
            let is_ahead = is_later || is_ahead(scene, index, entry);
            is_ahead && approach.crossing == view.next && order.is_none_or(|(_, last)| last.is_before(entry))
        });
        if !is_on_lane && entry.is_none() {
            continue;
        }
        let Some((reading, rear)) = scene.rear(index, view.at) else { continue };
        if is_on_lane && reading.position > view.front && lane.is_none_or(|(_, nearest)| reading.position < nearest) {
            lane = Some((index, reading.position));
        }
        let Some(entry) = entry.filter(|_| end.is_some_and(|end| rear < end)) else { continue };
        if followed == Some(index) || view.is_announced(approach) {
            order = Some((index, entry));
        }
    }
    // A vehicle that is ahead on the same leg, and not yet at the later crossing, comes there before the ego, and after all that are
    // there now.
    let comes_last = |index| coordination.approach(index).is_some_and(|approach| approach.crossing != view.next);
    let order = order.filter(|_| !(is_later && lane.is_some_and(|(index, _)| comes_last(index))));
    let is_heeded = |index: &usize| view.is_heeded(*index);
    let (order, lane) = (order.map(|(index, _)| index), lane.map(|(index, _)| index));
    let target = view.more_careful(order.filter(is_heeded), lane.filter(is_heeded))?;
    view.is_in_the_way(target, followed).then_some(target)
}

/// Whether a station was ahead at the last review, and still is by what it has said since then.
fn is_ahead<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    index: usize,
    entry: &Entry,
) -> bool {
    let arrival = scene.coordination.registration().map(|registration| registration.arrival);
    let (claim, leg) = (scene.coordination.claim(), scene.coordination.leg());
    let own = Entry { station: scene.config.station, arrival, claim, leg };
    scene.coordination.choice().ahead.contains(index) && entry.is_before(&own)
}
