//! One CAN identifier, standard or extended: a number of a checked range enters, and bits that can be compared leave.

use core::fmt::{Display, Formatter, Result};

use embedded_can::{ExtendedId, Id, StandardId};

/// A CAN identifier. Two are the same only if both are standard or both are extended.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Identifier(u32);

impl Identifier {
    /// That of a line that is not placed; no frame has it.
    pub(super) const NONE: Self = Self(0);
    /// In front of a standard identifier's number, so that all bits 0 are no identifier.
    const STANDARD: u32 = 1 << 30;
    /// In front of an extended identifier's number, as in a DBC.
    const EXTENDED: u32 = 1 << 31;
    const STANDARD_MAX: u32 = 0x7FF;
    const EXTENDED_MAX: u32 = 0x1FFF_FFFF;

    /// With 11 bits: `None` above 0x7FF.
    #[must_use]
    pub const fn standard(number: u16) -> Option<Self> {
        if number as u32 <= Self::STANDARD_MAX { Some(Self(Self::STANDARD | number as u32)) } else { None }
    }

    /// With 29 bits: `None` above 0x1FFF_FFFF.
    #[must_use]
    pub const fn extended(number: u32) -> Option<Self> {
        if number <= Self::EXTENDED_MAX { Some(Self(Self::EXTENDED | number)) } else { None }
    }

    /// Its number; 0 to 0x7FF, or to 0x1FFF_FFFF if it is extended.
    #[must_use]
    pub const fn number(self) -> u32 {
        self.0 & Self::EXTENDED_MAX
    }

    /// Whether it has 29 bits.
    #[must_use]
    pub const fn is_extended(self) -> bool {
        self.0 & Self::EXTENDED != 0
    }

    /// Its number as it stands in a DBC: bit 31 set if it is extended.
    #[must_use]
    pub const fn in_dbc(self) -> u32 {
        self.0 & !Self::STANDARD
    }

    /// The one that is so many further; of the same kind as long as [`Self::has_room_for`] says so.
    pub(super) const fn plus(self, further: u32) -> Self {
        Self(self.0.wrapping_add(further))
    }

    /// How much further than `first` it is; far more than any identifier reaches if they are not of one kind.
    pub(super) const fn since(self, first: Self) -> u32 {
        self.0.wrapping_sub(first.0)
    }

    /// Whether the identifier that is so many further still has as many bits.
    pub(super) const fn has_room_for(self, further: u32) -> bool {
        let last = if self.is_extended() { Self::EXTENDED_MAX } else { Self::STANDARD_MAX };
        further <= last.saturating_sub(self.number())
    }
}

impl From<Id> for Identifier {
    fn from(id: Id) -> Self {
        match id {
            Id::Standard(id) => Self(Self::STANDARD | u32::from(id.as_raw())),
            Id::Extended(id) => Self(Self::EXTENDED | id.as_raw()),
        }
    }
}

impl From<Identifier> for Id {
    fn from(id: Identifier) -> Self {
        if id.is_extended() {
            return Self::Extended(ExtendedId::new(id.number()).unwrap_or(ExtendedId::MAX));
        }
        #[allow(clippy::cast_possible_truncation)] // 11 bits
        Self::Standard(StandardId::new(id.number() as u16).unwrap_or(StandardId::MAX))
    }
}

impl Display for Identifier {
    /// `0x482`, and `0x18FF0201x` if it is extended.
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        if self.is_extended() { write!(f, "{:#010X}x", self.number()) } else { write!(f, "{:#05X}", self.number()) }
    }
}

impl core::fmt::Debug for Identifier {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_number_is_two_identifiers() {
        let (standard, extended) = (Identifier::standard(0x482).unwrap(), Identifier::extended(0x482).unwrap());
        assert_ne!(standard, extended);
        assert_eq!((standard.number(), extended.number()), (0x482, 0x482));
        assert_eq!((standard.in_dbc(), extended.in_dbc()), (0x482, 0x8000_0482));
        assert_eq!((standard.to_string(), extended.to_string()), ("0x482".into(), "0x00000482x".into()));
    }

    #[test]
    fn an_identifier_is_that_of_a_frame_and_back() {
        let ends = [
            Identifier::standard(0),
            Identifier::standard(0x7FF),
            Identifier::extended(0),
            Identifier::extended(0x1FFF_FFFF),
        ];
        for id in ends.map(Option::unwrap) {
            assert_eq!(Identifier::from(Id::from(id)), id);
            assert_ne!(id, Identifier::NONE);
        }
        assert_eq!((Identifier::standard(0x800), Identifier::extended(0x2000_0000)), (None, None));
    }

    #[test]
    fn room_ends_with_the_bits() {
        let (standard, extended) = (Identifier::standard(0x7F0).unwrap(), Identifier::extended(0x1FFF_FFF0).unwrap());
        assert!(standard.has_room_for(15) && extended.has_room_for(15));
        assert!(!standard.has_room_for(16) && !extended.has_room_for(16));
        assert!(extended.since(standard) > 1 << 29 && standard.since(extended) > 1 << 29);
    }
}
