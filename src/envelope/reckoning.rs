//! Where the ego is at the latest between two of its own samples: a sample at the less safe end of its accuracies and the
//! commands since enter, the ego of the gate leaves.
//!
//! `y = r + T v` and `z = v + T a` move as a double integrator under the commands alone (see [`crate::envelope`]), so that both
//! are known without the lag: with `v'` the integral of the commands from the sample's speed on and `r'` that of `v'` from its
//! position on, at an age `A`
//!
//! ```text
//! z = v' + T a,    y = r' + T (v + A a)
//! ```
//!
//! with the speed `v` and the acceleration `a` of the sample. It needs no new sample to stay right: what the vehicle does
//! besides, on a slope, grows with the age at [`UNPUBLISHED_ACCELERATION_ACCURACY`].

use super::Ego;
use crate::config::Envelope;
use crate::held::Held;
use crate::parameters::UNPUBLISHED_ACCELERATION_ACCURACY;
use crate::time::{Duration, Instant};
use crate::units::{Acceleration, Distance, FineSeconds, Position, Speed};

/// A sample of the ego at the less safe end of its accuracies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Start {
    /// When it was true.
    pub at: Instant,
    /// Front bumper, as far ahead as it may be.
    pub position: Position,
    /// As high as it may be.
    pub speed: Speed,
    /// As it was measured.
    pub acceleration: Acceleration,
}

/// The ego as it is carried on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reckoning {
    start: Start,
    at: Instant,
    /// `r'` and `v'` at that instant.
    position: Position,
    speed: Speed,
}

impl Reckoning {
    /// From a sample on, or on from the one before if it is the same one, to now; the command in force since then or since the
    /// last tick.
    pub fn carry(held: &mut Held<Self>, start: &Start, now: Instant, last: Acceleration, envelope: &Envelope) -> Self {
        let before = held.get().filter(|held| held.start == *start);
        let from = before.unwrap_or(Self { start: *start, at: start.at, position: start.position, speed: start.speed });
        let since = now.since(from.at).max(Duration::ZERO);
        // A command may be late, and a sample from before the last one: the one in force was a jerk higher for each moment of that.
        let before_last = if before.is_some() { Duration::ZERO } else { since };
        let higher = envelope.jerk.over(envelope.delay.plus(before_last).fine_seconds());
        let reckoning = from.on(since, last.plus(higher).plus(UNPUBLISHED_ACCELERATION_ACCURACY));
        held.set(reckoning);
        reckoning
    }

    fn on(self, since: Duration, command: Acceleration) -> Self {
        // As long as the formats hold; what is left of a longer time is taken up tick by tick.
        let since = since.min(Duration::from_millis(1_900));
        let speed = self.speed.plus(command.over(since.fine_seconds())).max(Speed::ZERO);
        // The higher one of both ends: on the safe side by half a tick.
        let way = self.speed.max(speed).over(since.seconds());
        Self { at: self.at.plus(since), position: self.position.ahead(way), speed, ..self }
    }

    /// The ego of the gate, with the longest lag that the envelope tolerates.
    #[must_use]
    pub fn ego(&self, envelope: &Envelope, last: Acceleration, lag: FineSeconds) -> Ego {
        let acceleration = self.start.acceleration.plus(UNPUBLISHED_ACCELERATION_ACCURACY);
        let age = self.at.since(self.start.at).fine_seconds();
        // `y` is to be made of `v'`, but is of `v + A a`.
        let short = self.start.speed.plus(acceleration.over(age)).minus(self.speed).max(Speed::ZERO);
        let longest = lag.plus(lag.share(envelope.lag_tolerance));
        // 23 + 30 - 32 = 21 bits, and one more than half of that.
        let product = crate::fixed::mul_hi(short.to_bits(), longest.to_bits());
        let way = Distance::from_bits(product.saturating_add(1).wrapping_shr(1).saturating_add(1));
        Ego { position: self.position.ahead(way), speed: self.speed, acceleration, last, lag }
    }
}
