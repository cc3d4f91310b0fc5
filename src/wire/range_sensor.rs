//! `RangeSensor`: an on-board sensor's view of the own path, in one frame: the vehicle ahead, or that none is there.

use super::bits::Payload;
use super::field::Field;
use super::meaning::meaning;
use crate::time::Duration;
use crate::units::{Distance, Speed};

/// One measurement of the vehicle ahead on the own path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RangeSample {
    #[doc = meaning!(range_distance)]
    ///
    /// 0 to 262.143 m by 1 mm.
    pub distance: Distance,
    #[doc = meaning!(speed_difference)]
    ///
    /// ±65.534 m/s by 2 mm/s.
    pub speed_difference: Speed,
    #[doc = meaning!(distance_accuracy)]
    ///
    /// 0 to 1.55 m by 0.05 m, rounded up.
    pub distance_accuracy: Distance,
    #[doc = meaning!(range_speed_accuracy)]
    ///
    /// 0 to 1.5 m/s by 0.1 m/s, rounded up.
    pub speed_accuracy: Speed,
    #[doc = meaning!(range_age)]
    ///
    /// 0 to 63 ms by 1 ms, rounded up.
    pub age: Duration,
    #[doc = meaning!(range_nobody)]
    ///
    /// Then [`speed_difference`](Self::speed_difference) says nothing.
    pub nobody: bool,
}

const DISTANCE: Field = Field::unsigned("Distance", 12, 18).steps(1000, "m");
const SPEED_DIFFERENCE: Field = Field::signed("SpeedDifference", 30, 16).steps(500, "m/s");
const DISTANCE_ACCURACY: Field = Field::unsigned("DistanceAccuracy", 46, 5).steps(20, "m");
const SPEED_ACCURACY: Field = Field::unsigned("SpeedAccuracy", 51, 4).steps(10, "m/s");
const NOBODY: Field =
    Field::unsigned("Nobody", 61, 1).named(&[(0, "vehicle at Distance"), (1, "no vehicle nearer than Distance")]);
const AGE: Field = Field::unsigned("Age", 55, 6).steps(1000, "s");

/// The frame.
pub const FIELDS: &[Field] = &[DISTANCE, SPEED_DIFFERENCE, DISTANCE_ACCURACY, SPEED_ACCURACY, AGE, NOBODY];

const AGE_STEP_MICROS: i64 = 1000;

impl RangeSample {
    /// The oldest that a measurement can be said to be.
    pub const OLDEST: Duration = Duration::from_millis(63);

    /// The frame's payload; what does not fit is limited to its field's range.
    #[must_use]
    pub fn encode(&self) -> [Payload; 1] {
        let a = DISTANCE.with(Payload::EMPTY, self.distance);
        let a = SPEED_DIFFERENCE.with(a, self.speed_difference);
        let a = DISTANCE_ACCURACY.with_up(a, self.distance_accuracy);
        let a = SPEED_ACCURACY.with_up(a, self.speed_accuracy);
        let steps = self.age.as_micros().saturating_add(AGE_STEP_MICROS.saturating_sub(1)).div_euclid(AGE_STEP_MICROS);
        [NOBODY.with_raw(AGE.with_raw(a, steps), self.nobody.into())]
    }

    /// From the frame's payload; every payload within the fields' limits is a measurement.
    #[must_use]
    pub fn decode([a]: &[Payload; 1]) -> Self {
        Self {
            distance: DISTANCE.get(*a),
            speed_difference: SPEED_DIFFERENCE.get(*a),
            distance_accuracy: DISTANCE_ACCURACY.get(*a),
            speed_accuracy: SPEED_ACCURACY.get(*a),
            age: Duration::from_micros(AGE.raw(*a).saturating_mul(AGE_STEP_MICROS)),
            nobody: NOBODY.raw(*a) != 0,
        }
    }
}
