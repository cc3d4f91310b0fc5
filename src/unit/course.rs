//! The basis of the mode and of the controller. The scene enters; the facts that decide the mode, and the course to be driven in it,
//! leave.

use super::scene::Scene;
use super::stopping;
use crate::controller::{Course, Facts, FallbackCause, FaultCause, Gains, Mode, Target, TargetFact, slowing};
use crate::model::bound::AccelerationRange;
use crate::model::{Reading, State};
use crate::parameters::FARTHEST_PEER;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Position, Speed};
use crate::wire::Predecessor;

/// The facts by which the mode is decided. `is_readable` says whether the target has an estimate.
pub(super) fn facts<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    target: Option<usize>,
    is_readable: bool,
) -> Facts {
    let ego = match (scene.ego.as_ref(), scene.fresh_ego(now)) {
        (None, _) => Err(FaultCause::EgoMissing),
        (Some(_), None) => Err(FaultCause::EgoStale),
        (Some(_), Some(_)) => Ok(()),
    };
    let track = target.and_then(|index| scene.peers.get(index));
    let target = match (scene.predecessor(), track) {
        (Predecessor::None, _) => TargetFact::NotNeeded,
        (Predecessor::Unknown, _) => TargetFact::Lost(FallbackCause::NotAssociated),
        (Predecessor::Station(_), Some(track)) if is_readable => {
            let silence = track.link().silence(now).unwrap_or(Duration::MAX);
            if track.link().is_on(now, &scene.config.link) {
                TargetFact::On
            } else if silence <= scene.config.link.holdover {
                TargetFact::Off
            } else {
                TargetFact::Lost(FallbackCause::Silent)
            }
        }
        (Predecessor::Station(_), _) => TargetFact::Lost(FallbackCause::NeverHeard),
    };
    // The ego then drives by what its sensor sees ahead, and not by what it hears.
    let is_contradicted = scene.visible().is_some_and(|index| scene.is_contradicted(index, now));
    let target = match target {
        _ if scene.is_request_lost(now) => TargetFact::Lost(FallbackCause::RequestLost),
        TargetFact::Lost(_) => target,
        _ if is_contradicted => TargetFact::Lost(FallbackCause::RangeDisagrees),
        _ => target,
    };
    Facts { engaged: scene.is_engaged(), ego, target }
}

/// The course of a mode. `gains` are those of the association with the target.
pub(super) fn course<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    mode: Mode,
    target: Option<usize>,
    gains: Option<Gains>,
    ego: Option<&State>,
) -> Course {
    match mode {
        Mode::Standby => Course::Yield { demand: scene.ego.as_ref().map_or(Acceleration::ZERO, |ego| ego.demand) },
        Mode::Cooperative | Mode::Holdover { .. } => by_law(scene, now, target, gains, ego, Acceleration::MAX),
        Mode::Fallback { cause: FallbackCause::RequestLost, since, .. } => {
            hand_back(scene, now, since, target, gains, ego)
        }
        Mode::Fallback { .. } => match still_known(scene, now, target) {
            Some(ahead) => Course::Cruise { ahead, target_speed: scene.target_speed() },
            None => Course::GrowingBraking { ahead: None, since: None },
        },
        Mode::Fault { .. } => Course::Brake,
    }
}

/// The law, with no more acceleration than the cap allows, or than leaves the ego able to stop.
fn by_law<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    target: Option<usize>,
    gains: Option<Gains>,
    ego: Option<&State>,
    cap: Acceleration,
) -> Course {
    let next = now.plus(scene.config.period);
    let target = target.and_then(|index| {
        let (before, mut reading) = (scene.estimated(index, now)?, scene.estimated(index, next)?);
        // An opened time gap is a target that much nearer: the constants of the law stay.
        if let Some((opened, ego)) = scene.opening.in_force(next).zip(ego) {
            reading.position = reading.position.ahead(ego.speed.over(opened).negated());
        }
        Some(Target { reading, gained: reading.speed.minus(before.speed), length: scene.peers.length_of(index) })
    });
    let cap = ego.map_or(cap, |ego| stopping::careful(scene, now, ego).min(cap));
    Course::Law { vehicle: scene.ego_model_now(gains), target, cap }
}

/// Slowing down since the request was lost. Behind a target that can still be driven by, by the law, which keeps the distance; else
/// behind what is still known.
fn hand_back<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    since: Instant,
    target: Option<usize>,
    gains: Option<Gains>,
    ego: Option<&State>,
) -> Course {
    let is_driven_by = |index: &usize| scene.is_in_reach(*index, now) && !scene.is_contradicted(*index, now);
    match target.filter(is_driven_by) {
        Some(index) => by_law(scene, now, Some(index), gains, ego, slowing(&scene.config, now.since(since))),
        None => Course::GrowingBraking { ahead: still_known(scene, now, target), since: Some(since) },
    }
}

/// The rear bumper of the vehicle ahead as far as it is still known without its messages: as the range sensor sees it, or the near
/// end of what it has seen standing, or the near end of what is certain of the target, unless the sensor sees that it is not there, or the
/// end of what it sees to be free. Never a stale sample. A target that comes by another leg is not what the sensor sees: of the two, the
/// one that is nearer.
fn still_known<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    target: Option<usize>,
) -> Option<Reading> {
    let seen = scene.ranging.ahead(now);
    if seen.is_some() && target == scene.visible() {
        return seen;
    }
    let stood = scene.ranging.standing(now).map(|sight| sight.bound.after(now, &AccelerationRange::WORST));
    let stood = stood.filter_map(|bound| near(scene, bound.lowest_position(), bound.lowest_speed()));
    let stood = stood.min_by_key(|rear| rear.position);
    let target = target.filter(|index| !scene.is_seen_past(*index, now));
    let certain = target.and_then(|index| {
        let (rear, bound) = scene.near_rear(index, now)?;
        near(scene, rear, bound.lowest_speed())
    });
    let known = [seen.or(stood), certain].into_iter().flatten().min_by_key(|rear| rear.position);
    // Beyond what is seen to be free a vehicle may stand.
    known.or_else(|| near(scene, scene.ranging.free(now)?, Speed::ZERO))
}

/// `None` if it is too far away. The law takes positions modulo 4096 m, so that a vehicle left far behind must not turn up ahead.
fn near<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    position: Position,
    speed: Speed,
) -> Option<Reading> {
    let ego = scene.ego.as_ref()?.position;
    let gap = position.ahead_of(ego).limited(FARTHEST_PEER.negated(), FARTHEST_PEER);
    Some(Reading { position: ego.ahead(gap), speed })
}
