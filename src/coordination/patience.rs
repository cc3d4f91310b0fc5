//! How long the ego bears with one that does not heed it: how another station regards the ego enters, at every review; whether
//! that has lasted too long leaves.

use super::Regard;
use crate::held::Held;
use crate::time::{Duration, Instant};

/// A later arrival has to overlook the ego for this long to be given way: five of the messages that tell it, so that what is
/// only on its way, or lost once or twice, costs nothing.
pub(crate) const OVERLOOKED: Duration = Duration::from_millis(1_000);

/// And one whose claim is unclear to the ego for this long: by then whoever is claimed has not only been silent, but is out of
/// the ego's hearing.
pub(crate) const UNCLEAR: Duration = Duration::from_millis(6_000);

/// With one station.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Patience {
    /// Since when it has regarded the ego in the one same way that does not heed it.
    since: Held<(Instant, Regard)>,
}

impl Patience {
    /// Nothing to bear with.
    pub(crate) const FULL: Self = Self { since: Held::Nothing };

    /// Whether a station has regarded the ego so for too long, by when it said so: what a silent one said last may be out of date.
    pub(crate) fn is_over(&mut self, heard: Instant, regard: Regard) -> bool {
        let lasts = match regard {
            Regard::Heeds => {
                self.since.clear();
                return false;
            }
            Regard::Unclear => UNCLEAR,
            Regard::Overlooks => OVERLOOKED,
        };
        match self.since.get() {
            Some((since, before)) if before == regard => heard.since(since) >= lasts,
            _ => {
                self.since.set((heard, regard));
                false
            }
        }
    }
}
