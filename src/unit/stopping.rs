//! The largest acceleration with which the ego can still come to a stand, braking as in normal driving. What it may have to stop behind
//! enters; a cap on the law's demand leaves.
//!
//! The law answers gap and speed, so it brakes by less than its limit until both have changed. That is too late behind a vehicle that
//! brakes as hard as the ego can, or harder. The cap goes by what is estimated, with the limits of normal driving. On a way through
//! intersections it is always there. Elsewhere it is there only without the envelope, which keeps the ego able to stop by what is certain,
//! and only while the range sensor tracks the vehicle ahead.

use super::room::{self, LINE, WAITING};
use super::scene::Scene;
use crate::config::{Config, Envelope};
use crate::envelope::{self, Obstacle};
use crate::model::State;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Fraction, Position, Speed};

/// The cap. On a way through intersections the ego stops where [`room`] says, elsewhere behind a vehicle that brakes or stands.
pub(super) fn careful<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    ego: &State,
) -> Acceleration {
    let obstacle = match scene.coordination.itinerary() {
        Some(_) => room::stop(scene, now, ego).map(Obstacle::standing),
        None if scene.config.envelope.is_none() => stopping_ahead(scene, now),
        None => None,
    };
    obstacle.map_or(Acceleration::MAX, |obstacle| cap(&scene.config, scene.front(ego), ego, &obstacle))
}

/// The target, while the range sensor tracks it and it is estimated to brake or to stand. Braking is seen late, and grows meanwhile. So it
/// is taken to brake four times as hard from now on, but by no more than the larger of two limits: that of the ego's law, and the one that
/// it has published for its own. Harder braking is not believed.
fn stopping_ahead<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
) -> Option<Obstacle> {
    let index = scene.target().filter(|index| !scene.is_seen_past(*index, now))?;
    let braking = scene.fused.acceleration(scene.whose(index)?, now)?.negated();
    let (reading, rear) = scene.rear(index, now)?;
    if braking <= Acceleration::ZERO && reading.speed > WAITING {
        return None;
    }
    let published = scene.peers.get(index)?.parameters().map(|parameters| parameters.limits.braking);
    let normal = scene.config.limits.braking.max(published.unwrap_or(Acceleration::ZERO));
    let twice = braking.plus(braking);
    let braking = twice.plus(twice).min(normal).max(Acceleration::ZERO);
    let speed = reading.speed.max(Speed::ZERO);
    Some(Obstacle { position: rear.ahead(LINE.negated()), speed, braking })
}

/// The largest acceleration that leaves the ego able to stop behind the obstacle. It never asks for more than normal braking.
fn cap(config: &Config, front: Position, ego: &State, obstacle: &Obstacle) -> Acceleration {
    let limits = &config.limits;
    let normal = Envelope {
        acceleration: limits.acceleration,
        braking: limits.braking,
        jerk: limits.jerk,
        speed: config.law.max_speed,
        margin: Distance::ZERO,
        delay: Duration::ZERO,
        lag_tolerance: Fraction::ZERO,
    };
    let ego = envelope::Ego {
        position: front,
        speed: ego.speed,
        acceleration: ego.acceleration,
        last: ego.demand,
        lag: config.lag,
    };
    let spare = envelope::spare(&normal, &ego, obstacle);
    envelope::distance_cap(&normal, spare, config.period).max(limits.braking.negated())
}
