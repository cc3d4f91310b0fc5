//! Inside what is certain: a sample, a received horizon or a reading enters with the bound of its vehicle; what of it can be
//! true leaves.
//!
//! The truth is inside the bound, so whatever is moved to the bound's nearer end comes nearer to the truth and never gets
//! farther from it. What is exact is inside already and stays as it is.
//!
//! * A *sample* is moved at its stamp, before the model starts from it: then the model starts right. So a poor sample counts for
//!   no more than it adds to the good ones before it.
//! * A *horizon* that was sent is used as it is or not at all: a path that its sender cannot take at one of its knots is no
//!   forecast of it anywhere.
//! * A *reading* is limited at its instant, whatever it comes from.

use crate::model::Reading;
use crate::model::bound::{AccelerationRange, Bound};
use crate::peers::Sample;
use crate::time::Duration;
use crate::units::{Distance, Speed};
use crate::wire::horizon::{Knots, SHARES_PER_MILLE};

/// A bound that is later than a sample by more than this, because another sensor narrowed it since, says too little of the
/// sample's own instant; the reading alone is limited then.
const CARRIED: Duration = Duration::from_millis(100);

/// A horizon is rebuilt from its knots to within this, in metres and in metres per second.
const REBUILT: Distance = Distance::from_mm(10);
const REBUILT_SPEED: Speed = Speed::from_mm_per_s(10);

/// A reading at the bound's instant, at the nearer end of the bound where it is outside.
#[must_use]
pub fn limited(reading: Reading, bound: &Bound) -> Reading {
    Reading {
        position: reading.position.min(bound.highest_position()).max(bound.lowest_position()),
        speed: reading.speed.min(bound.highest_speed()).max(bound.lowest_speed()),
    }
}

/// A sample that was outside the bound, moved into it; `None` where nothing is to be moved.
pub(super) fn moved(sample: &Sample, bound: &Bound, reach: &AccelerationRange) -> Option<Sample> {
    let bound = bound.after(sample.at, reach);
    let later = bound.at().since(sample.at);
    if later > CARRIED {
        return None;
    }
    // On to the bound's instant, which is later by the clock's error or a little more, at the sample's own acceleration.
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

/// Whether its sender can take the path of a horizon of so many tenths of a second that begins with the sample, as far as its
/// knots are rebuilt.
pub(super) fn is_reachable(
    knots: &Knots,
    tenths: u8,
    sample: &Sample,
    bound: &Bound,
    reach: &AccelerationRange,
) -> bool {
    knots.knots.iter().zip(SHARES_PER_MILLE).all(|(knot, share)| {
        let after = i64::from(tenths).saturating_mul(i64::from(share)).saturating_mul(100);
        let at = sample.at.plus(Duration::from_micros(after));
        if at < bound.at() {
            return true; // the bound says nothing of what was before it
        }
        let (then, position) = (bound.after(at, reach), sample.position.ahead(knot.displacement));
        position.ahead(REBUILT) >= then.lowest_position()
            && position.ahead(REBUILT.negated()) <= then.highest_position()
            && knot.speed.plus(REBUILT_SPEED) >= then.lowest_speed()
            && knot.speed.minus(REBUILT_SPEED) <= then.highest_speed()
    })
}
