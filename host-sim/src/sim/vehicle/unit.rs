//! The simulated unit: the same core as on the ECU, with room for more peers and longer horizons. A configuration
//! enters, a started unit leaves.
//!
//! Its 170 kB lie on the heap from the beginning, and its owner holds a pointer, because a worker thread has only 2 MiB
//! of stack.

use std::ops::{Deref, DerefMut};

use holdover::{Config, ConfigError, OnboardUnit};

use super::{SAMPLES, STEPS};
use crate::sim::modem::PEERS;

type Core = OnboardUnit<PEERS, SAMPLES, STEPS>;

/// A unit.
#[derive(Debug)]
pub struct Unit(Box<Core>);

impl Unit {
    /// A started unit.
    ///
    /// # Errors
    /// The first value of the configuration that is out of its documented range.
    pub fn new(config: &Config) -> Result<Self, ConfigError> {
        let mut unit = Self::idle();
        unit.start(config)?;
        Ok(unit)
    }

    /// An idle unit. Its room on the heap is allocated first, and a constant is copied into it, so that the value need
    /// not lie on the stack.
    #[inline(never)] // if the value lies on the stack after all, it is not in the caller's frame
    fn idle() -> Self {
        Self(Box::write(Box::new_uninit(), const { Core::idle() }))
    }
}

impl Clone for Unit {
    #[inline(never)] // as above
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl Deref for Unit {
    type Target = Core;

    fn deref(&self) -> &Core {
        &self.0
    }
}

impl DerefMut for Unit {
    fn deref_mut(&mut self) -> &mut Core {
        &mut self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whoever_owns_a_unit_or_a_vehicle_holds_little_on_the_stack() {
        assert!(size_of::<Core>() > 100_000, "{}", size_of::<Core>());
        assert_eq!(size_of::<Unit>(), size_of::<usize>());
        let vehicle = size_of::<crate::sim::vehicle::Vehicle>();
        assert!(vehicle <= 8 << 10, "{vehicle}");
    }
}
