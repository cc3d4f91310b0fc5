//! The largest acceleration with which the ego can still come to a stand, braking as in normal driving. What it may have to stop behind
//! enters; a cap on the law's demand leaves.
//!
//! The law answers gap and speed, so it asks for less than it may until both have changed. That is too late behind a vehicle that brakes
//! as hard as the ego can, or harder. The cap is the law's own, and is there without the envelope too: with normal limits, and by what is
//! estimated, not by what is certain.

use super::room::{self, LINE, WAITING};
use super::scene::Scene;
use crate::config::{Config, Envelope};
use crate::envelope::{self, Obstacle};
use crate::model::State;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, Fraction, Position};

/// A vehicle that brakes harder than this may be about to stop. In everyday traffic most vehicles brake less.
const HARD: Acceleration = Acceleration::from_mm_per_s2(1_000);

/// The cap. On a way through intersections the ego stops where [`room`] says, elsewhere behind a vehicle that brakes hard or stands.
pub(super) fn careful<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
    ego: &State,
) -> Acceleration {
    let obstacle = match scene.coordination.itinerary() {
        Some(_) => room::stop(scene, now, ego).map(Obstacle::standing),
        None => stopping_ahead(scene, now),
    };
    obstacle.map_or(Acceleration::MAX, |obstacle| cap(&scene.config, scene.front(ego), ego, &obstacle))
}

/// The target, while the range sensor sees it brake hard or stand. It is taken to go on as hard as it is seen to brake, and at least as
/// hard as it has published that its law may, or as the ego's law may: braking is still growing while it is seen.
fn stopping_ahead<const PEERS: usize, const SAMPLES: usize, const STEPS: usize>(
    scene: &Scene<PEERS, SAMPLES, STEPS>,
    now: Instant,
) -> Option<Obstacle> {
    let index = scene.target()?;
    let seen = scene.fused.acceleration(index, now)?.negated();
    let (reading, rear) = scene.rear(index, now)?;
    if seen <= HARD && reading.speed > WAITING {
        return None;
    }
    let published = scene.peers.get(index)?.parameters().map(|parameters| parameters.limits.braking);
    let braking = seen.max(scene.config.limits.braking).max(published.unwrap_or(Acceleration::ZERO));
    Some(Obstacle { position: rear.ahead(LINE.negated()), speed: reading.speed, braking })
}

/// No more than this leaves the ego able to stop behind the obstacle. No less than normal braking is asked for.
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
