//! The fused track of the vehicle that the range sensor sees. A view that is of a station, or a message of that station, enters; a
//! sample of the station by all that was seen and heard leaves.

use super::Scene;
use super::sight::{Sight, Whose};
use crate::fusion::{Fusion, Measured, Motion};
use crate::held::Held;
use crate::model::bound::Uncertainty;
use crate::peers::Sample;
use crate::time::Instant;
use crate::units::{Acceleration, Distance, Position, Speed};

/// The track, and whose it is.
#[derive(Clone, Debug)]
pub(in crate::unit) struct Fused {
    track: Fusion,
    whose: Held<Whose>,
    /// Whether the horizon of the station is to start from the track at the next update.
    is_wanted: bool,
    /// So many views in a row were faster, and slower, than the estimate by more than a view errs usually.
    aside: [u8; 2],
}

/// So many views in a row on the same side of an estimate show that its speed is wrong: 40 ms at 50 views a second.
const ASIDE: u8 = 3;

impl Fused {
    /// Nobody is tracked.
    pub const NONE: Self = Self { track: Fusion::new(), whose: Held::Nothing, is_wanted: false, aside: [0; 2] };

    /// Takes in a view of a station, with its front bumper there, and the station's newest message.
    pub fn see(&mut self, whose: Whose, sight: &Sight, errors: &Uncertainty, front: Position, newest: &Sample) {
        if self.whose != Held::Value(whose) {
            self.whose.set(whose);
            self.track.clear();
            (self.is_wanted, self.aside) = (false, [0; 2]);
        }
        if !self.track.is_tracking(sight.at) {
            self.aside = [0; 2];
        }
        self.track.see(&Measured::within(sight.at, front, sight.speed, errors.position, errors.speed), newest);
    }

    /// Takes in the newest message of a station. Returns whether that station is tracked.
    pub fn hear(&mut self, whose: Whose, now: Instant, newest: &Sample) -> bool {
        let is_tracked = self.whose == Held::Value(whose);
        if is_tracked {
            self.track.hear(now, newest);
        }
        is_tracked
    }

    /// Takes in by how much a view was faster than the estimate, and by how much it errs usually. Returns whether the estimate is wrong. A
    /// row goes on over a message, which is older than the views, and ends with the track.
    pub fn is_beside(&mut self, faster: Speed, usual: Speed) -> bool {
        let [in_front, behind] = self.aside;
        let next = |row: u8, goes_on: bool| if goes_on { row.saturating_add(1) } else { 0 };
        self.aside = [next(in_front, faster > usual), next(behind, faster < usual.negated())];
        self.aside.iter().any(|row| *row >= ASIDE)
    }

    /// The horizon of the station is to start from the track.
    pub fn want(&mut self) {
        self.is_wanted = true;
    }

    /// The acceleration of a station by all that was seen and heard, if it is tracked.
    pub fn acceleration(&self, whose: Whose, now: Instant) -> Option<Acceleration> {
        let track = (self.whose == Held::Value(whose)).then_some(&self.track)?;
        track.motion(now).map(|motion| motion.acceleration)
    }

    /// Moves the track of a slot, because the axis of its station moved.
    pub fn shift(&mut self, index: usize, way: Distance) {
        if self.whose.as_ref().is_some_and(|(slot, _)| usize::from(slot.0) == index) {
            self.track.shift(way);
        }
    }

    /// Takes in what came since the last tick. Returns whose motion that is, if its horizon is to start from it.
    fn update(&mut self) -> Option<(Whose, Motion)> {
        let motion = self.track.update()?;
        core::mem::take(&mut self.is_wanted).then_some((self.whose.get()?, motion))
    }
}

impl<const PEERS: usize, const SAMPLES: usize, const STEPS: usize> Scene<PEERS, SAMPLES, STEPS> {
    /// The slot of the vehicle that is seen, and its sample by all that was seen and heard, if its horizon is to start from that.
    pub fn fuse(&mut self) -> Option<(usize, Sample)> {
        let ((slot, station), Motion { at, position, speed, acceleration }) = self.fused.update()?;
        let index = usize::from(slot.0);
        let newest = self.peers.get(index)?.newest().filter(|newest| newest.station == station)?;
        Some((index, Sample { at, position, speed, acceleration, demand: acceleration, ..*newest }))
    }
}
