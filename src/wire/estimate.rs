//! `TargetEstimate`: where the unit believes its target is now, in two frames every period.

use super::bits::Payload;
use super::field::{Field, TAG};
use super::meaning::meaning;
use super::motion::{self, WirePosition, position_of};
use crate::fixed::quotient;
use crate::health::Cause;
use crate::time::Duration;
use crate::units::{Distance, Speed};

/// The ends of the bound around an estimate, as distances from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ends {
    #[doc = meaning!(behind)]
    ///
    /// 0 to 327.64 m by 0.02 m, rounded up.
    pub behind: Distance,
    #[doc = meaning!(ahead)]
    ///
    /// Likewise.
    pub ahead: Distance,
    #[doc = meaning!(slower)]
    ///
    /// 0 to 102 m/s by 0.2 m/s, rounded up.
    pub slower: Speed,
    #[doc = meaning!(faster)]
    ///
    /// Likewise.
    pub faster: Speed,
}

/// The estimate of one period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TargetEstimate {
    /// Ties the two frames; modulo 4.
    pub tag: u8,
    #[doc = meaning!(estimate_position)]
    ///
    /// 1 mm.
    pub position: WirePosition,
    #[doc = meaning!(estimate_speed)]
    ///
    /// 0 to 65.534 m/s by 2 mm/s.
    pub speed: Speed,
    #[doc = meaning!(age)]
    ///
    /// 0 to 16.38 s by 2 ms, rounded up, saturating.
    pub age: Duration,
    /// The bound; `None`: not known, or wider than the fields can say.
    pub ends: Option<Ends>,
}

const POSITION: Field = motion::position(14);
const SPEED: Field = motion::speed("Speed", 39);
const FASTER: Field = Field::unsigned("Faster", 54, 9).steps(5, "m/s").or_none(&[(511, "no bound")]);
const AGE: Field = Field::unsigned("Age", 14, 13).limits(0, 8190).steps(500, "s");
const BEHIND: Field = Field::unsigned("Behind", 27, 14).steps(50, "m").or_none(&[(16_383, "no bound")]);
const AHEAD: Field = Field::unsigned("Ahead", 41, 14).steps(50, "m").or_none(&[(16_383, "no bound")]);
const SLOWER: Field = Field::unsigned("Slower", 55, 9).steps(5, "m/s").or_none(&[(511, "no bound")]);

/// The first frame.
pub const FIELDS_A: &[Field] = &[TAG, POSITION, SPEED, FASTER];
/// The second frame.
pub const FIELDS_B: &[Field] = &[TAG, AGE, BEHIND, AHEAD, SLOWER];

const AGE_STEP_MICROS: i64 = 2000;

impl TargetEstimate {
    /// The two frames' payloads; what does not fit is limited to its field's range, except that a bound of which one
    /// end does not fit is not told at all.
    #[must_use]
    pub fn encode(&self) -> [Payload; 2] {
        let ends = self.ends.and_then(|ends| {
            let slow_and_fast = (SLOWER.bound_steps(ends.slower)?, FASTER.bound_steps(ends.faster)?);
            Some((BEHIND.bound_steps(ends.behind)?, AHEAD.bound_steps(ends.ahead)?, slow_and_fast))
        });
        let a = TAG.with_raw(Payload::EMPTY, i64::from(self.tag & 3));
        let a = POSITION.with_raw(a, i64::from(self.position.mm()));
        let a = SPEED.with(a, self.speed);
        let a = FASTER.with_steps(a, ends.map(|(_, _, (_, faster))| faster));
        let b = TAG.with_raw(Payload::EMPTY, i64::from(self.tag & 3));
        let steps = quotient(self.age.as_micros().saturating_add(AGE_STEP_MICROS.saturating_sub(1)), AGE_STEP_MICROS);
        let b = AGE.with_raw(b, steps);
        let b = BEHIND.with_steps(b, ends.map(|(behind, _, _)| behind));
        let b = AHEAD.with_steps(b, ends.map(|(_, ahead, _)| ahead));
        let b = SLOWER.with_steps(b, ends.map(|(_, _, (slower, _))| slower));
        [a, b]
    }

    /// From the two frames' payloads.
    ///
    /// # Errors
    /// `Range` if the bound has some ends but not all.
    pub fn decode([a, b]: &[Payload; 2]) -> Result<Self, Cause> {
        let told = (BEHIND.get_known(*b), AHEAD.get_known(*b), SLOWER.get_known(*b), FASTER.get_known(*a));
        let ends = match told {
            (Some(behind), Some(ahead), Some(slower), Some(faster)) => Some(Ends { behind, ahead, slower, faster }),
            (None, None, None, None) => None,
            _ => return Err(Cause::Range),
        };
        Ok(Self {
            tag: TAG.byte(*a),
            position: position_of(*a, &POSITION),
            speed: SPEED.get(*a),
            age: Duration::from_micros(AGE.raw(*b).saturating_mul(AGE_STEP_MICROS)),
            ends,
        })
    }
}
