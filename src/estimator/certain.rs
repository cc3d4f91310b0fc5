//! Keeps estimates inside what is certain. A sample, a received horizon or a reading enters with the bound of its vehicle; the part of it
//! that can be true leaves.
//!
//! The true state is inside the bound. So whatever is moved to the nearer end of the bound comes nearer to the true state, and never gets
//! farther from it. What is exact is inside already, and stays as it is.
//!
//! * A *sample* is moved at its stamp, before the model starts from it, so that the model starts right. So a poor sample counts for no
//!   more than it adds to the good samples before it.
//! * A *horizon* that was sent is used as it is or not at all. If its sender cannot reach it at one of its knots, it predicts nothing
//!   anywhere.
//! * A *reading* is limited at its instant, whatever it comes from.

use crate::model::Reading;
use crate::model::bound::{AccelerationRange, Bound};
use crate::peers::Sample;
use crate::time::Duration;
use crate::units::{Distance, Speed};
use crate::wire::horizon::{KNOTS_PER_MILLE, Knots};

/// If the bound is later than a sample by more than this, because another sensor narrowed it since, it says too little of the sample's
/// own instant. Then only the reading is limited.
const CARRIED: Duration = Duration::from_millis(100);

/// The largest error with which a horizon is rebuilt from its knots, in metres and in metres per second.
const REBUILT: Distance = Distance::from_mm(10);
const REBUILT_SPEED: Speed = Speed::from_mm_per_s(10);

/// A reading at the bound's instant, moved to the nearer end of the bound where it is outside.
#[must_use]
pub fn limited(reading: Reading, bound: &Bound) -> Reading {
    Reading {
        position: reading.position.min(bound.highest_position()).max(bound.lowest_position()),
        speed: reading.speed.min(bound.highest_speed()).max(bound.lowest_speed()),
    }
}

/// A sample that was outside the bound, moved into it; `None` if it is inside.
pub(super) fn moved(sample: &Sample, bound: &Bound, reach: &AccelerationRange) -> Option<Sample> {
    let bound = bound.after(sample.at, reach);
    let later = bound.at().since(sample.at);
    if later > CARRIED {
        return None;
    }
    // Carried on to the bound's instant, which is later by the clock's error or a little more, at the sample's own acceleration.
    let gained = sample.acceleration.over(later.fine_seconds());
    let mean = sample.speed.plus(Speed::from_bits(gained.to_bits() / 2)).max(Speed::ZERO);
    let carried = Reading {
        position: sample.position.ahead(mean.over(later.seconds())),
        speed: sample.speed.plus(gained).max(Speed::ZERO),
    };
    let inside = limited(carried, &bound);
    (inside != carried).then(|| Sample {
        position: sample.position.ahead(inside.position.ahead_of(carried.position)),
        speed: sample.speed.plus(inside.speed.minus(carried.speed)).max(Speed::ZERO),
        ..*sample
    })
}

/// Whether its sender can take the path of a horizon of `tenths` tenths of a second that begins with the sample. It is checked at the
/// knots, to within the error with which they are rebuilt.
pub(super) fn is_reachable(
    knots: &Knots,
    tenths: u8,
    sample: &Sample,
    bound: &Bound,
    reach: &AccelerationRange,
) -> bool {
    knots.knots.iter().zip(KNOTS_PER_MILLE).all(|(knot, share)| {
        let after = i64::from(tenths).saturating_mul(i64::from(share)).saturating_mul(100);
        let at = sample.at.plus(Duration::from_micros(after));
        if at < bound.at() {
            return true; // the bound says nothing of what was before it
        }
        let position = sample.position.ahead(knot.displacement);
        bound.after(at, reach).comes_near(position, REBUILT, knot.speed, REBUILT_SPEED)
    })
}
