//! Where the ego is at the latest between two of its own samples. A sample at the less safe end of its accuracies, and the commands since
//! then, enter; the ego as the gate sees it leaves.
//!
//! `y = r + T v` and `z = v + T a` move as a double integrator under the commands alone (see [`crate::envelope`]). So both are known
//! without the lag. Let `v'` be the integral of the commands, starting from the sample's speed, and `r'` the integral of `v'`, starting
//! from the sample's position. Then at an age `A`
//!
//! ```text
//! z = v' + T a,    y = r' + T (v + A a)
//! ```
//!
//! with the speed `v` and the acceleration `a` of the sample. The result stays right without a new sample: what the vehicle does besides,
//! such as on a slope, is covered by a speed that grows with the age at [`UNPUBLISHED_ACCELERATION_ACCURACY`].

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
    /// Speed, as high as it may be.
    pub speed: Speed,
    /// Acceleration as it was measured.
    pub acceleration: Acceleration,
}

/// The ego as it is carried on by the commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reckoning {
    start: Start,
    at: Instant,
    /// `r'` and `v'` at that instant.
    position: Position,
    speed: Speed,
}

impl Reckoning {
    /// Carries the ego on to `now`: from the sample, or from where it was carried to before if the sample is the same. `last` is the
    /// command that was in force since then, or since the last tick.
    pub fn carry(held: &mut Held<Self>, start: &Start, now: Instant, last: Acceleration, envelope: &Envelope) -> Self {
        let before = held.get().filter(|held| held.start == *start);
        let from = before.unwrap_or(Self { start: *start, at: start.at, position: start.position, speed: start.speed });
        let since = now.since(from.at).max(Duration::ZERO);
        // A command may come into force late, and a sample may be from before the last command. Until the last command the one in force
        // was higher, by the jerk for each moment of that.
        let before_last = if before.is_some() { Duration::ZERO } else { since };
        let higher = envelope.jerk.over(envelope.delay.plus(before_last).fine_seconds());
        let reckoning = from.on(since, last.plus(higher).plus(UNPUBLISHED_ACCELERATION_ACCURACY));
        held.set(reckoning);
        reckoning
    }

    fn on(self, since: Duration, command: Acceleration) -> Self {
        // No longer than the formats hold. The rest of a longer time is taken up tick by tick.
        let since = since.min(Duration::from_millis(1_900));
        let speed = self.speed.plus(command.over(since.fine_seconds())).max(Speed::ZERO);
        // The higher speed of both ends, which is on the safe side by half a tick.
        let way = self.speed.max(speed).over(since.seconds());
        Self { at: self.at.plus(since), position: self.position.ahead(way), speed, ..self }
    }

    /// The ego as the gate sees it, with the longest lag that the envelope tolerates.
    #[must_use]
    pub fn ego(&self, envelope: &Envelope, last: Acceleration, lag: FineSeconds) -> Ego {
        let acceleration = self.start.acceleration.plus(UNPUBLISHED_ACCELERATION_ACCURACY);
        let age = self.at.since(self.start.at).fine_seconds();
        // `y` needs `v'` in the place of `v + A a`.
        let short = self.start.speed.plus(acceleration.over(age)).minus(self.speed).max(Speed::ZERO);
        let longest = lag.plus(lag.fraction(envelope.lag_tolerance));
        // 23 + 30 - 32 = 21 bits, which is one more than the format has: halved.
        let product = crate::fixed::mul_hi(short.to_bits(), longest.to_bits());
        let way = Distance::from_bits(product.saturating_add(1).wrapping_shr(1).saturating_add(1));
        Ego { position: self.position.ahead(way), speed: self.speed, acceleration, last, lag }
    }
}
