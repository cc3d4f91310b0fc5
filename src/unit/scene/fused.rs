//! The fused track of the vehicle that the range sensor sees. A view that is of a station, or a message of that station, enters; a
//! sample of the station by all that was seen and heard leaves.

use super::sight::{Sight, Whose};
use crate::fusion::{Fusion, Measured, Motion};
use crate::held::Held;
use crate::peers::Sample;
use crate::time::Instant;
use crate::units::{Distance, Position};

/// The track, and whose it is.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Fused {
    track: Fusion,
    whose: Held<Whose>,
}

impl Fused {
    /// Nobody is tracked.
    pub const NONE: Self = Self { track: Fusion::new(), whose: Held::Nothing };

    /// Takes in a view of a station, with its front bumper there, and the station's newest message.
    pub fn see(&mut self, whose: Whose, sight: &Sight, front: Position, newest: &Sample) -> Sample {
        if self.whose != Held::Value(whose) {
            self.whose.set(whose);
            self.track.clear();
        }
        let errors = &sight.uncertainty;
        let view = Measured::within(sight.at, front, sight.speed, errors.position, errors.speed);
        sample(self.track.see(&view, newest), newest)
    }

    /// Takes in the newest message of a station, if that is the one that is tracked.
    pub fn hear(&mut self, whose: Whose, now: Instant, newest: &Sample) -> Option<Sample> {
        if self.whose != Held::Value(whose) {
            return None;
        }
        self.track.hear(now, newest).map(|motion| sample(motion, newest))
    }

    /// Moves the track of a slot, because the axis of its station moved.
    pub fn shift(&mut self, index: usize, way: Distance) {
        if self.whose.as_ref().is_some_and(|(slot, _)| usize::from(slot.0) == index) {
            self.track.shift(way);
        }
    }
}

/// The station's sample at the instant of a motion.
fn sample(motion: Motion, newest: &Sample) -> Sample {
    let Motion { at, position, speed, acceleration } = motion;
    Sample { at, position, speed, acceleration, demand: acceleration, ..*newest }
}
