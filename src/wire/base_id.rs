//! The first identifier of the unit's block: an identifier of the bus enters and its offset in the catalogue leaves, and back.

use super::catalogue::BLOCK;

/// The first identifier of the catalogue; checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BaseId(u16);

impl BaseId {
    /// That of a unit which is not started.
    pub(crate) const NONE: Self = Self(0);
    /// 0x480 to 0x53F.
    pub const DEFAULT: Self = Self(0x480);
    /// The largest base: above it the block does not fit into 11 bits.
    pub const MAX: u16 = 0x800 - BLOCK;

    /// `None` above [`Self::MAX`].
    #[must_use]
    pub const fn new(id: u16) -> Option<Self> {
        if id <= Self::MAX { Some(Self(id)) } else { None }
    }

    /// The identifier.
    #[must_use]
    pub const fn get(self) -> u16 {
        self.0
    }

    /// The identifier at this offset.
    #[must_use]
    pub const fn plus(self, offset: u16) -> u16 {
        self.0.wrapping_add(offset)
    }

    /// The offset of an identifier of the block.
    #[must_use]
    pub const fn offset_of(self, id: u16) -> Option<u16> {
        match id.checked_sub(self.0) {
            Some(offset) if offset < BLOCK => Some(offset),
            _ => None,
        }
    }
}
