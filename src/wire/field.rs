//! One field of a frame, as the catalogue names it: bits of a payload enter, a raw number or a quantity leaves, and back.
//!
//! The decoders and encoders read and write through these, and the DBC is printed from them, so the catalogue is the
//! code. Raw values outside the limits are reserved: a frame with one is refused. The offset of every field is 0.

use super::bits::{FIRST_BIT, Payload};
use super::quantity::Quantity;
use crate::time::Stamp;

/// In which frames of its identifier a field stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In every frame.
    Always,
    /// In every frame, and it says which part of the message this frame is.
    Selector,
    /// Only in this part.
    Part(u8),
}

/// A named bit field.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Its name, as in the DBC.
    pub name: &'static str,
    /// Lowest bit; byte 0 bit 0 is bit 0.
    pub start: u32,
    /// Bits.
    pub length: u32,
    /// Whether in two's complement.
    pub signed: bool,
    /// Steps per unit: the factor is `1/per_unit`.
    pub per_unit: i64,
    /// Unit of the physical value; empty for numbers.
    pub unit: &'static str,
    /// Smallest raw value that is a value.
    pub min: i64,
    /// Largest raw value that is a value.
    pub max: i64,
    /// The raw value that says that there is none.
    pub none: Option<i64>,
    /// The raw value that a sender has before it knows better, if it is not the one that is nearest to 0.
    pub initial: Option<i64>,
    /// Names of raw values.
    pub values: &'static [(i64, &'static str)],
    /// Where it stands.
    pub place: Place,
}

impl Field {
    /// A plain number of so many bits, every value allowed.
    #[must_use]
    pub const fn unsigned(name: &'static str, start: u32, length: u32) -> Self {
        Self {
            name,
            start,
            length,
            signed: false,
            per_unit: 1,
            unit: "",
            min: 0,
            max: ones(length),
            none: None,
            initial: None,
            values: &[],
            place: Place::Always,
        }
    }

    /// The same in two's complement. The most negative value is reserved, which keeps the range symmetric.
    #[must_use]
    pub const fn signed(name: &'static str, start: u32, length: u32) -> Self {
        let max = ones(length.saturating_sub(1));
        Self { signed: true, min: max.wrapping_neg(), max, ..Self::unsigned(name, start, length) }
    }

    /// In steps of `1/per_unit` of this unit.
    #[must_use]
    pub const fn steps(self, per_unit: i64, unit: &'static str) -> Self {
        Self { per_unit, unit, ..self }
    }

    /// Only these raw values are values.
    #[must_use]
    pub const fn limits(self, min: i64, max: i64) -> Self {
        Self { min, max, ..self }
    }

    /// Before a sender knows better it says the largest value, from which a receiver concludes the least.
    #[must_use]
    pub const fn initially_largest(self) -> Self {
        Self { initial: Some(self.max), ..self }
    }

    /// The largest raw value says that there is none.
    #[must_use]
    pub const fn or_none(self, values: &'static [(i64, &'static str)]) -> Self {
        Self { max: self.max.wrapping_sub(1), none: Some(self.max), values, ..self }
    }

    /// Only the named raw values are values; they count from 0.
    #[must_use]
    #[allow(clippy::cast_possible_wrap)] // a field has at most 2⁸ names
    pub const fn named(self, values: &'static [(i64, &'static str)]) -> Self {
        Self { max: (values.len() as i64).wrapping_sub(1), values, ..self }
    }

    /// Only in this part of the message.
    #[must_use]
    pub const fn part(self, part: u8) -> Self {
        Self { place: Place::Part(part), ..self }
    }

    /// The field that says which part a frame is; there are so many.
    #[must_use]
    pub const fn selector(name: &'static str, start: u32, length: u32, parts: i64) -> Self {
        Self { place: Place::Selector, max: parts.wrapping_sub(1), ..Self::unsigned(name, start, length) }
    }

    /// The raw value.
    #[inline(always)]
    #[must_use]
    #[allow(clippy::cast_possible_wrap)] // a field has at most 52 bits
    pub const fn raw(&self, payload: Payload) -> i64 {
        if self.signed {
            payload.signed(self.start, self.length)
        } else {
            payload.unsigned(self.start, self.length) as i64
        }
    }

    /// With the raw value, limited to what is a value; the code for none passes too.
    #[inline(always)]
    #[must_use]
    #[allow(clippy::cast_sign_loss)] // two's complement is what stands on the wire
    pub const fn with_raw(&self, payload: Payload, raw: i64) -> Payload {
        let limited = if self.is_none(raw) {
            raw
        } else if raw > self.max {
            self.max
        } else if raw < self.min {
            self.min
        } else {
            raw
        };
        payload.with(self.start, self.length, limited as u64)
    }

    /// The raw value of a field of at most 8 bits.
    #[inline(always)]
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // of at most 8 bits
    pub const fn byte(&self, payload: Payload) -> u8 {
        self.raw(payload) as u8
    }

    /// The raw value of a field of at most 32 bits, unsigned.
    #[inline(always)]
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // of at most 32 bits
    pub const fn word(&self, payload: Payload) -> u32 {
        self.raw(payload) as u32
    }

    /// Whether this raw value may stand in the field.
    #[must_use]
    pub const fn accepts(&self, raw: i64) -> bool {
        (self.min <= raw && raw <= self.max) || self.is_none(raw)
    }

    const fn is_none(&self, raw: i64) -> bool {
        matches!(self.none, Some(none) if none == raw)
    }

    /// The quantity.
    #[inline(always)]
    #[must_use]
    pub fn get<Q: Quantity>(&self, payload: Payload) -> Q {
        Q::from_steps(self.raw(payload), self.per_unit)
    }

    /// With the quantity, to the nearest step, limited to the field's range.
    #[inline(always)]
    #[must_use]
    pub fn with<Q: Quantity>(&self, payload: Payload, quantity: Q) -> Payload {
        self.with_raw(payload, quantity.to_steps(self.per_unit).min(self.max).max(self.min))
    }

    /// With the quantity, rounded up, limited to the field's range.
    #[inline(always)]
    #[must_use]
    pub fn with_up<Q: Quantity>(&self, payload: Payload, quantity: Q) -> Payload {
        self.with_raw(payload, quantity.to_steps_up(self.per_unit).min(self.max).max(self.min))
    }

    /// The quantity, if there is one.
    #[inline(always)] // the whole field would be passed, with its names
    #[must_use]
    pub fn get_known<Q: Quantity>(&self, payload: Payload) -> Option<Q> {
        let raw = self.raw(payload);
        if self.is_none(raw) { None } else { Some(Q::from_steps(raw, self.per_unit)) }
    }

    /// With the quantity, rounded to the nearest step, or the code for none.
    #[inline(always)]
    #[must_use]
    pub fn with_known<Q: Quantity>(&self, payload: Payload, quantity: Option<Q>) -> Payload {
        match quantity {
            Some(quantity) => self.with(payload, quantity),
            None => self.with_raw(payload, self.none.unwrap_or(self.min)),
        }
    }

    /// With the bound, rounded up. A bound that is not known, or is wider than the field can say, becomes the code for
    /// none: a bound on the wire is never tighter than the one that was meant.
    #[inline(always)]
    #[must_use]
    pub fn with_bound<Q: Quantity>(&self, payload: Payload, bound: Option<Q>) -> Payload {
        self.with_steps(payload, bound.and_then(|bound| self.bound_steps(bound)))
    }

    /// The bound in steps, rounded up, if the field can say that.
    #[inline(always)]
    #[must_use]
    pub fn bound_steps<Q: Quantity>(&self, bound: Q) -> Option<i64> {
        Some(bound.to_steps_up(self.per_unit)).filter(|steps| *steps <= self.max)
    }

    /// With so many steps, or the code for none.
    #[inline(always)]
    #[must_use]
    pub fn with_steps(&self, payload: Payload, steps: Option<i64>) -> Payload {
        self.with_raw(payload, steps.or(self.none).unwrap_or(self.max))
    }
}

/// Ties the frames of one message: the first bits of every frame of a message that needs more than one.
pub const TAG: Field = Field::unsigned("Tag", FIRST_BIT, 2);

/// A stamp, shared by every message that has one.
pub(super) const fn stamp(start: u32) -> Field {
    Field::unsigned("Stamp", start, Stamp::BITS).steps(10_000, "s")
}

pub(super) fn stamp_of(payload: Payload, field: &Field) -> Stamp {
    Stamp::from_raw(field.word(payload))
}

const fn ones(length: u32) -> i64 {
    match 1i64.checked_shl(length) {
        Some(power) => power.wrapping_sub(1),
        None => i64::MAX,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Distance;

    const ACCURACY: Field = Field::unsigned("Accuracy", 20, 7).steps(20, "m").or_none(&[(127, "none")]);

    #[test]
    fn a_bound_is_rounded_up_or_not_told() {
        let told =
            |mm| ACCURACY.get_known::<Distance>(ACCURACY.with_bound(Payload::EMPTY, Some(Distance::from_mm(mm))));
        assert_eq!(told(0), Some(Distance::ZERO));
        assert_eq!(told(51), Some(Distance::from_mm(100)));
        assert_eq!(told(6300), Some(Distance::from_mm(6300)));
        assert_eq!(told(6301), None);
        assert_eq!(ACCURACY.get_known::<Distance>(ACCURACY.with_bound::<Distance>(Payload::EMPTY, None)), None);
    }

    #[test]
    fn values_beyond_the_range_are_limited_to_it() {
        let demand = Field::signed("Demand", 12, 11);
        assert_eq!(demand.raw(demand.with_raw(Payload::EMPTY, 5000)), 1023);
        assert_eq!(demand.raw(demand.with_raw(Payload::EMPTY, -5000)), -1023);
        assert!(!demand.accepts(-1024));
    }
}
