//! `PeerHorizon`, `OwnHorizon`: a vehicle's own horizon in a few knots, one multiplexed frame each; [`super::curve`] tells what
//! lies between them.

use super::bits::Payload;
use super::field::{Field, TAG};
use super::meaning::meaning;
use super::motion;
use crate::units::{Acceleration, Distance, Speed};

/// Knots of a horizon on the wire.
pub const KNOTS: usize = 5;

/// One knot: the predicted state at a fixed share ([`KNOTS_PER_MILLE`]) of the horizon's length after the motion's
/// stamp.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Knot {
    #[doc = meaning!(displacement)]
    ///
    /// 0 to 262.143 m by 1 mm.
    pub displacement: Distance,
    #[doc = meaning!(knot_speed)]
    ///
    /// 0 to 65.534 m/s by 2 mm/s.
    pub speed: Speed,
    #[doc = meaning!(knot_acceleration)]
    ///
    /// ±20.46 m/s² by 0.02 m/s²; not positive at standstill.
    pub acceleration: Acceleration,
    #[doc = meaning!(bow)]
    ///
    /// -20 to 15 mm by 5 mm.
    pub bow: Distance,
}

/// The knots of one horizon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Knots {
    /// The tag of the motion message that it starts from.
    pub tag: u8,
    /// In the order of time.
    pub knots: [Knot; KNOTS],
}

/// When the knots are, in thousandths of the horizon's length.
pub const KNOTS_PER_MILLE: [u16; KNOTS] = [175, 375, 600, 800, 1000];

#[allow(clippy::cast_possible_wrap)] // 5
const PART: Field = Field::selector("Part", 14, 3, KNOTS as i64);
const DISPLACEMENT: Field = Field::unsigned("Displacement", 17, 18).steps(1000, "m");
const SPEED: Field = motion::speed("Speed", 35);
const ACCELERATION: Field = motion::acceleration("Acceleration", 50);
const BOW: Field = Field::signed("Bow", 61, 3).limits(-4, 3).steps(200, "m");

/// Every part has the same fields: one knot.
pub const FIELDS: &[Field] = &[TAG, PART, DISPLACEMENT, SPEED, ACCELERATION, BOW];

impl Knot {
    fn encode(&self, payload: Payload) -> Payload {
        let a = DISPLACEMENT.with(payload, self.displacement);
        let a = SPEED.with(a, self.speed);
        let a = ACCELERATION.with(a, self.acceleration);
        BOW.with(a, self.bow)
    }

    fn decode(a: Payload) -> Self {
        Self {
            displacement: DISPLACEMENT.get(a),
            speed: SPEED.get(a),
            acceleration: ACCELERATION.get(a),
            bow: BOW.get(a),
        }
    }

    /// The start of a horizon, from the motion that it begins with.
    #[must_use]
    pub const fn start(speed: Speed, acceleration: Acceleration) -> Self {
        Self { displacement: Distance::ZERO, speed, acceleration, bow: Distance::ZERO }
    }

    /// As the receiver will read it.
    #[must_use]
    pub fn rounded(&self) -> Self {
        Self::decode(self.encode(Payload::EMPTY))
    }
}

impl Knots {
    /// The parts' payloads; what does not fit is limited to its field's range.
    #[must_use]
    pub fn encode(&self) -> [Payload; KNOTS] {
        let mut part = 0i64;
        self.knots.map(|knot| {
            let a = PART.with_raw(TAG.with_raw(Payload::EMPTY, i64::from(self.tag & 3)), part);
            part = part.saturating_add(1);
            knot.encode(a)
        })
    }

    /// From the parts' payloads; every payload within the fields' limits is a knot.
    #[must_use]
    pub fn decode(parts @ [first, ..]: &[Payload; KNOTS]) -> Self {
        Self { tag: TAG.byte(*first), knots: parts.map(Knot::decode) }
    }
}
