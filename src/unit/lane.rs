//! Who is ahead on the ego's own leg, by what is certain: bounds enter at every review; what is to spare behind them leaves.
//!
//! No vehicle passes another there. So a vehicle that was ahead for certain stays ahead, however long it is silent and wherever it is
//! estimated to be: it may have braked to a stand at once, and the gate keeps behind that. What ends this is certain too: the vehicle
//! is heard farther on, or on another way; or one that was behind it for certain is heard farther on, and then so is it.

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
}

/// A vehicle that would stand farther ahead than this by when it was heard last is out of the radio's reach, and not minded until it
/// is heard again: no more is known there of any other vehicle either. An assumption of use: a vehicle that comes nearer is heard.
const RADIO_REACH: Distance = Distance::from_mm(300_000);

/// Takes note of who is ahead of the ego's front bumper on its own leg for certain, who of them is behind whom, and how far they have
/// come by that.
pub(super) fn note<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &mut Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    front: Position,
) {
    let lane = certain(scene, now);
    let (mut leading, mut beyond) = (Slots::NONE, Slots::NONE);
    for one in &lane {
        // A vehicle that may be on either side is where it was.
        let was_ahead = scene.coordination.choice().leading.contains(one.index);
        leading.set(one.index, one.near > front || one.far > front && was_ahead);
        beyond.set(one.index, is_beyond(scene, one.index, now, front));
        for other in lane.iter().filter(|other| other.rear >= one.far) {
            scene.coordination.note_behind(other.index, one.index);
        }
    }
    for one in &lane {
        scene.coordination.note_passed(one.index, one.near);
    }
    scene.coordination.note_leading(leading, beyond);
}

/// Where everyone on the ego's leg is, for certain.
fn certain<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
) -> Vec<Certain, PEERS> {
    let certain = |index: usize| {
        scene.coordination.standing(index).filter(|standing| scene.coordination.is_on_lane(standing))?;
        let (rear, bound) = scene.near_rear(index, now)?;
        Some(Certain { index, near: bound.lowest_position(), far: bound.highest_position(), rear })
    };
    let mut lane = Vec::new();
    for one in (0..PEERS).filter_map(certain) {
        // There is room for all: no more than there are slots.
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
    let is_far = || stop_behind(scene, index).is_some_and(|stop| stop >= front.ahead(RADIO_REACH));
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

/// What is to spare behind everyone ahead on the same leg. The one that is estimated to be the nearest of them need not be: one that
/// is silent may have braked where it is estimated to have driven on, past another one that is heard.
pub(super) fn spare<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    spare: &impl Fn(Obstacle) -> Spare,
) -> Option<Spare> {
    let choice = scene.coordination.choice();
    let leading = (0..PEERS).filter(|index| choice.leading.contains(*index) && !choice.beyond.contains(*index));
    let ahead = leading.chain(choice.lane.map(usize::from)).filter(|index| !scene.is_seen_past(*index, now));
    // Its rear is not behind its own near end, nor behind the place that it is known to have passed: so the better of both holds.
    let behind = |index: usize| {
        let passed = scene.coordination.passed(index).map(Obstacle::standing);
        [scene.obstacle(now, index), passed].into_iter().flatten().map(spare).max()
    };
    ahead.filter_map(behind).min()
}
