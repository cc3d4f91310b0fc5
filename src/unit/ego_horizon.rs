//! The ego's own horizon. The ego's state and the vehicle that it follows enter; where the ego will be leaves, past the changes of target
//! that it can foresee.
//!
//! A vehicle that falls silent drives on by what it knows, and so do the vehicles ahead of it. When its target leaves the conflict area,
//! or when it comes to the next intersection itself, it follows another vehicle from then on. It already knows that order, and holds
//! those horizons. So its own horizon includes the change. Every vehicle that hears it then knows of the change, and so do the vehicles
//! behind.

use heapless::Vec;

use super::opening::Opening;
use super::scene::Scene;
use super::vantage::{Candidate, Vantage};
use crate::controller::Gains;
use crate::coordination::{Entry, REVIEW, standstill_on_way};
use crate::estimator::{End, Manner};
use crate::model::Reading;
use crate::peers::Sample;
use crate::time::{Duration, Instant};
use crate::units::{Distance, Position};

/// The order is reviewed in the horizon once in so many reviews: for a second, for four, and after that. Where the ego follows another
/// vehicle at one of these than at the one before, the review at which that begins is looked for between them, by halves; beyond four
/// seconds to within `FINEST_FAR` reviews. In the first second that is also done where the ego has to brake harder for the same vehicle.
const NEAR: Duration = Duration::from_millis(1_000);
const REVIEWS_NEAR: i64 = 4;
const FAR: Duration = Duration::from_millis(4_000);
const REVIEWS: i64 = 8;
const REVIEWS_FAR: i64 = 16;
const FINEST_FAR: i64 = 4;
/// Off a map the own horizon takes an opened time gap as the same for so long. On a map it does from one review of its own to the next,
/// which is up to 1.6 s.
const PIECE: Duration = Duration::from_millis(1_000);
/// So many changes of target, or of how gently to brake for it, are foreseen. Each takes the constants of another prediction step, and
/// three more reviews.
const CHANGES: u8 = 8;

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
    let mut opening = scene.opening.clone();
    if opening.is_opened() {
        if review.is_none() {
            return foresee_opened(scene, now, sample, manner, &opening);
        }
        widen(scene, &mut manner, &opening, now);
    }
    scene.estimator.foresee_own(now, review, sample, &manner);
    let Some(mut review) = review.map(|review| review.max(now)) else { return };
    let (mut crossing, mut comfort) = (scene.coordination.next(), scene.coordination.choice().comfort);
    let (mut gains, mut changes) = (gains, CHANGES);
    let minded = minded(scene, now, crossing);
    // The last review, with the end of the horizon then; how many reviews later this one is; and the width of the interval in which a
    // change is looked for, or 0.
    let (mut before, mut passed, mut left) = (None::<(Instant, End)>, 1i64, 0i64);
    let last = scene.estimator.own_end_of(now);
    while scene.estimator.is_own_short(last) {
        let Some((step, own)) = scene.estimator.own_end() else { return };
        let next = scene.coordination.next_of(crossing, own.position, scene.config.length);
        let view = Vantage { scene, at: review, next, front: own.position, speed: own.speed };
        let ahead = outlook(&view, step, &minded, manner.target);
        let target = ahead.map(|(peer, _)| peer.index);
        let is_new = target != manner.target;
        let may = view.comfort(target);
        let changes_now = (is_new || may < comfort) && changes > 0;
        let (widest, finest) = match review.since(now) {
            until if until < NEAR => (REVIEWS_NEAR, 1),
            until if until < FAR => (REVIEWS, 1),
            _ => (REVIEWS_FAR, FINEST_FAR),
        };
        let is_sought = |earlier: Instant| is_new || earlier.since(now) < NEAR;
        if let Some((earlier, end)) =
            before.filter(|(earlier, _)| changes_now && passed > finest && is_sought(*earlier))
        {
            scene.estimator.cut_own(&end);
            (left, passed) = (passed, passed / 2);
            review = earlier.plus(REVIEW.times(passed));
        } else {
            if changes_now {
                changes = changes.saturating_sub(1);
                comfort = may;
                if is_new {
                    if opening.is_opened() {
                        // By what is known of its silence now.
                        let on_lane = ahead.filter(|(_, is_on_lane)| *is_on_lane).map(|(peer, _)| peer.index);
                        opening.turn(review, scene.opens_behind(now, on_lane));
                    }
                    gains = ahead.map(|(peer, _)| gains_behind(scene, &peer.reading, &own));
                }
                let behind = gains.zip(target).map(|(gains, index)| (gains, scene.standstill_at(next, index)));
                manner = scene.estimator.manner(scene.ego_model(behind, comfort), target, &scene.peers);
            }
            crossing = next;
            before = Some((review, scene.estimator.own_mark()));
            left = if changes_now { 0 } else { left.saturating_sub(passed).max(0) };
            passed = if left > 0 { (left / 2).max(finest) } else { widest };
            review = review.plus(REVIEW.times(passed));
        }
        if opening.is_opened() {
            widen(scene, &mut manner, &opening, review.minus(REVIEW.times(passed).halved()));
        }
        scene.estimator.carry_own_on(review, last, &manner);
    }
}

/// The same where the ego follows one vehicle throughout and its time gap is opened: piece by piece.
#[cold]
#[inline(never)]
fn foresee_opened<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &mut Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    sample: &Sample,
    mut manner: Manner,
    opening: &Opening,
) {
    let mut ends = now.plus(PIECE);
    widen(scene, &mut manner, opening, ends.minus(PIECE.halved()));
    scene.estimator.foresee_own(now, Some(ends), sample, &manner);
    let last = scene.estimator.own_end_of(now);
    while scene.estimator.is_own_short(last) {
        ends = ends.plus(PIECE);
        widen(scene, &mut manner, opening, ends.minus(PIECE.halved()));
        scene.estimator.carry_own_on(ends, last, &manner);
    }
}

/// Gives the manner the time gap as it will be opened at an instant: the middle of the piece that comes, or now for the first one.
#[cold]
#[inline(never)]
fn widen<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    manner: &mut Manner,
    opening: &Opening,
    at: Instant,
) {
    scene.estimator.keep_time_gap(manner, scene.time_gap().plus(opening.later(at)));
}

/// The gains of an association that begins there.
fn gains_behind<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    ahead: &Reading,
    own: &Reading,
) -> Gains {
    let headway = ahead.position.ahead_of(own.position);
    Gains::look_up(&scene.config.law, own.speed, ahead.speed, headway)
}

/// A vehicle that the ego may follow at some time.
struct Minded {
    index: usize,
    /// Its crossing.
    crossing: usize,
    /// Whether it is on the ego's lane until it has left the conflict area there, and from then on.
    is_on_lane: [bool; 2],
    /// Where it has left that area.
    left_at: Option<Position>,
    /// Whether its place in the order is known and its way conflicts with the ego's there, and whether that place is ahead of the ego's
    /// at the next crossing.
    conflicts: bool,
    is_ahead: bool,
    /// The way from its front to its rear, and the standstill distance behind it if its crossing is the ego's next one.
    to_rear: Distance,
    standstill: Distance,
}

/// The vehicles that the ego may follow at some time, with `next` as its next crossing: a vehicle that is ahead on its leg now, because
/// no vehicle passes another there; a vehicle that is ahead in the order; and a vehicle that has come to a later crossing.
fn minded<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    next: usize,
) -> Vec<Minded, PEERS> {
    let mut minded = Vec::new();
    let Some(own) = scene.estimator.read_own(now) else { return minded };
    let step = scene.estimator.grid().at_or_before(now);
    for index in 0..PEERS {
        let Some(approach) = scene.coordination.approach(index) else { continue };
        let is_on_lane = [false, true].map(|has_left| scene.coordination.is_on_lane(approach, has_left));
        let entry = scene.entry(index, approach);
        let is_ahead = entry.as_ref().is_some_and(|entry| is_ahead(scene, index, entry));
        let is_named = !scene.coordination.choice().namesakes.contains(index);
        let conflicts = entry.is_some() && is_named && scene.coordination.conflicts(approach);
        let comes = approach.crossing > next || approach.crossing == next && is_ahead && conflicts;
        let leads = || scene.estimator.read_step(index, step).is_some_and(|reading| reading.position > own.position);
        let is_minded = match is_on_lane {
            [true, _] => leads(),
            [false, true] => comes || leads(),
            [false, false] => comes,
        };
        if is_minded {
            let (crossing, to_rear) = (approach.crossing, scene.peers.length_of(index).negated());
            let left_at = scene.coordination.end_of(crossing).map(|end| end.ahead(approach.shift));
            let standstill = scene.standstill_at(crossing, index);
            let one = Minded { index, crossing, is_on_lane, left_at, conflicts, is_ahead, to_rear, standstill };
            let _ = minded.push(one); // no more than slots
        }
    }
    minded
}

/// The vehicle that the ego will follow, at a step of the grid, and whether that is the one ahead on the ego's lane. Order and horizons are
/// taken as they are known now; a vehicle that registers in between is not known. The horizons are read at the step itself, where they take
/// no interpolation; and beyond what is certain of a vehicle its horizon does not go, because the horizon keeps to the limits that this
/// rests on.
fn outlook<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    view: &Vantage<'_, PEERS, SAMPLES, STEPS>,
    step: i64,
    minded: &[Minded],
    followed: Option<usize>,
) -> Option<(Candidate, bool)> {
    let (scene, coordination) = (view.scene, &view.scene.coordination);
    let is_later = view.next != coordination.next();
    let elsewhere = standstill_on_way(scene.config.law.standstill, None, scene.config.range_sensor);
    let (mut order, mut lane) = (None::<(Candidate, Position)>, None::<(Candidate, usize)>);
    for Minded { index, crossing, is_on_lane, left_at, conflicts, is_ahead, to_rear, standstill } in minded {
        // This is asked for first, because it needs no horizon.
        let goes_first = *conflicts && (is_later || *is_ahead) && *crossing == view.next;
        if *is_on_lane == [false; 2] && !goes_first {
            continue;
        }
        let Some(reading) = scene.estimator.read_step(*index, step) else { continue };
        let standstill = if *crossing == view.next { *standstill } else { elsewhere };
        let peer = Candidate { index: *index, reading, rear: reading.position.ahead(*to_rear), standstill };
        let has_left = left_at.is_some_and(|end| peer.rear >= end);
        let [before, after] = *is_on_lane;
        let is_on_lane = if has_left { after } else { before };
        let is_nearest = lane.is_none_or(|(nearest, _)| reading.position < nearest.reading.position);
        if is_on_lane && reading.position > view.front && is_nearest {
            lane = Some((peer, *crossing));
        }
        if !goes_first || left_at.is_none_or(|end| peer.rear >= end) {
            continue;
        }
        let is_announced = || coordination.approach(*index).is_some_and(|approach| view.is_announced(approach));
        if followed == Some(*index) || is_announced() {
            order = view.nearest(order, peer);
        }
    }
    // A vehicle that is ahead on the same leg, and not yet at the later crossing, comes there before the ego, and after all that are
    // there now.
    let order = order.filter(|_| !(is_later && lane.is_some_and(|(_, crossing)| crossing != view.next)));
    let lane = lane.map(|(peer, _)| peer).filter(|peer| view.is_heeded(peer));
    let target = view.choose(order, lane, followed)?;
    let is_on_lane = |lane: Candidate| lane.index == target.index && coordination.choice().leading.contains(lane.index);
    Some((target, lane.is_some_and(is_on_lane)))
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
