//! What can be looked at from outside: the parts of the unit, and whether it knows the time.

use super::OnboardUnit;
use crate::config::Config;
use crate::controller::Mode;
use crate::coordination::Coordination;
use crate::estimator::Estimator;
use crate::health::Health;
use crate::model::bound::Bound;
use crate::peers::Peers;
use crate::time::Instant;

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> OnboardUnit<PEERS, SAMPLES, STEPS> {
    /// The counts, by cause.
    #[must_use]
    pub const fn health(&self) -> &Health {
        &self.health
    }

    /// The mode of the last tick.
    #[must_use]
    pub const fn mode(&self) -> Mode {
        self.mode
    }

    /// The peers.
    #[must_use]
    pub const fn peers(&self) -> &Peers<PEERS, SAMPLES> {
        &self.scene.peers
    }

    /// The coordination at intersections.
    #[must_use]
    pub const fn coordination(&self) -> &Coordination<PEERS> {
        &self.scene.coordination
    }

    /// The horizons.
    #[must_use]
    pub const fn estimator(&self) -> &Estimator<PEERS, STEPS> {
        &self.scene.estimator
    }

    /// The checked configuration.
    #[must_use]
    pub const fn config(&self) -> &Config {
        &self.scene.config
    }

    /// Whether GNSS time is known.
    #[must_use]
    pub fn is_synchronised(&self, now: Instant) -> bool {
        self.scene.is_synchronised(now)
    }

    /// What is certain of a peer at an instant, now or later.
    #[must_use]
    pub fn bound(&self, index: usize, at: Instant) -> Option<Bound> {
        self.scene.bound(index, at)
    }
}
