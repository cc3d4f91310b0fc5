//! The vehicles that are certainly ahead on the ego's own leg. Bounds enter at every review; what is to spare behind these vehicles
//! leaves.
//!
//! No vehicle passes another there. So a vehicle that was ahead for certain stays ahead, however long it is silent, and wherever it is
//! estimated to be. It may have braked to a stand at once, and the gate keeps the ego behind that place. What ends this is certain too.
//! Either the vehicle is heard farther on, or on another way. Or a vehicle that was behind it for certain is heard farther on, and then
//! so is it.

use heapless::Vec;

use super::scene::Scene;
use crate::coordination::Slots;
use crate::envelope::{Obstacle, Spare};
use crate::time::Instant;
use crate::units::{Distance, Position};

/// Where a peer on the ego's leg is, for certain.
struct Certain {
    index: usize,
    near: Position,
    far: Position,
    /// The near end of its rear bumper.
    rear: Position,
    /// How far it has come at least on the ego's way.
    come: Position,
}

/// A silent vehicle that could not stand nearer than this is out of the radio's reach, even if it has braked at its hardest since it was
/// heard last. It is not minded until it is heard again; at that distance no more is known of any other vehicle either. This is an
/// assumption of use: a vehicle that comes nearer is heard.
const RADIO_RANGE: Distance = Distance::from_mm(300_000);

/// Notes which vehicles on the ego's own leg are ahead of its front bumper for certain, which of them are behind which, and how far they
/// have come at least.
pub(super) fn note<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &mut Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    front: Position,
) {
    let lane = certain(scene, now);
    let (mut leading, mut beyond) = (Slots::NONE, Slots::NONE);
    for one in &lane {
        // A vehicle that may be on either side of the ego stays on the side that it was on.
        let was_ahead = scene.coordination.choice().leading.contains(one.index);
        leading.set(one.index, one.near > front || one.far > front && was_ahead);
        beyond.set(one.index, is_beyond(scene, one.index, now, front));
        for other in lane.iter().filter(|other| other.rear >= one.far) {
            scene.coordination.note_behind(other.index, one.index);
        }
    }
    for one in &lane {
        scene.coordination.note_passed(one.index, one.come);
    }
    scene.coordination.note_leading(leading, beyond);
}

/// Where the peers on the ego's leg are, for certain.
fn certain<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
) -> Vec<Certain, PEERS> {
    let certain = |index: usize| {
        let approach = scene.coordination.approach(index)?;
        let (rear, bound) = scene.near_rear(index, now)?;
        let near = bound.lowest_position();
        scene.coordination.is_on_lane(approach, scene.coordination.has_left(approach, rear)).then_some(())?;
        // Where a vehicle that turns off has come in the conflict area says nothing of a vehicle ahead of it that does not.
        let come = scene.coordination.turns_off_at(approach).map_or(near, |begins| near.min(begins));
        Some(Certain { index, near, far: bound.highest_position(), rear, come })
    };
    let mut lane = Vec::new();
    for one in (0..PEERS).filter_map(certain) {
        // There is room for all, because there are no more than slots.
        let _ = lane.push(one);
    }
    lane
}

fn is_beyond<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    index: usize,
    now: Instant,
    front: Position,
) -> bool {
    let is_silent = scene.peers.get(index).is_some_and(|track| !track.link().is_on(now, &scene.config.link));
    let is_far = || stop_behind(scene, index).is_some_and(|stop| stop >= front.ahead(RADIO_RANGE));
    is_silent && (scene.coordination.choice().beyond.contains(index) || is_far())
}

/// Where a peer's rear comes to rest if it has braked at its hardest since it was heard last.
fn stop_behind<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    index: usize,
) -> Option<Position> {
    let track = scene.peers.get(index)?;
    let stop = track.certainty().bound()?.nearest_stop(&track.reach());
    Some(stop.ahead(track.length().negated()))
}

/// What is to spare behind the vehicles ahead on the same leg. The vehicle that is estimated to be nearest need not be the nearest one. A
/// silent vehicle may have braked where it is estimated to have driven on, past another vehicle that is heard.
pub(super) fn spare<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    spare: &impl Fn(Obstacle) -> Spare,
) -> Option<Spare> {
    let ahead = ahead(scene, now);
    // The rear of a vehicle is not behind its own near end, nor behind the place that it is known to have passed. So the better of both
    // holds. Of a vehicle that stands farther back than another one drives, less is to spare, and it need not be computed.
    let behind = |index: usize| {
        let near = scene.obstacle(now, index);
        let is_farther = |passed: &Position| near.is_none_or(|near| *passed > near.position);
        let passed = scene.coordination.passed(index).filter(is_farther).map(Obstacle::standing);
        [near, passed].into_iter().flatten().map(spare).max()
    };
    ahead.filter_map(behind).min()
}

/// The vehicles ahead on the same leg that are minded.
fn ahead<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
) -> impl Iterator<Item = usize> + use<'_, PEERS, SAMPLES, STEPS> {
    let choice = scene.coordination.choice();
    let leading = (0..PEERS).filter(|index| choice.leading.contains(*index) && !choice.beyond.contains(*index));
    // A vehicle that joins, and is only estimated to have left the conflict area, is minded before that area.
    let estimated = choice.lane.map(usize::from).filter(|index| !scene.joins(*index));
    leading.chain(estimated).filter(move |index| !scene.is_seen_past(*index, now))
}

/// The vehicles that may have gone ahead to the ego's exit by another leg, but not for certain.
fn joining<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
) -> impl Iterator<Item = usize> + use<'_, PEERS, SAMPLES, STEPS> {
    let choice = scene.coordination.choice();
    let goes_ahead = |index: &usize| choice.ahead.contains(*index) || choice.lane.map(usize::from) == Some(*index);
    let joining =
        (0..PEERS).filter(move |index| goes_ahead(index) && !choice.leading.contains(*index) && scene.joins(*index));
    joining.filter(move |index| !scene.is_seen_past(*index, now))
}

/// Whether no silent vehicle ahead on the same lane may have come to rest before a place, or may yet.
pub(super) fn is_certain_to_leave<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    place: Position,
) -> bool {
    let is_silent =
        |index: &usize| !scene.peers.get(*index).is_some_and(|track| track.link().is_on(now, &scene.config.link));
    let rests = |index: usize| stop_behind(scene, index).max(scene.coordination.passed(index));
    ahead(scene, now)
        .chain(joining(scene, now))
        .filter(is_silent)
        .all(|index| rests(index).is_some_and(|rests| rests >= place))
}
