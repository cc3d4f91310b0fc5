//! The first identifier of the block in which the catalogue lies: an identifier of the bus enters and its offset in the catalogue
//! leaves, and back.

use super::catalogue::BLOCK;
use super::identifier::Identifier;

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
    pub(super) const fn plus(self, offset: u16) -> Identifier {
        self.first().plus(offset as u32)
    }

    /// The offset of an identifier of the block.
    #[must_use]
    pub(super) const fn offset_of(self, id: Identifier) -> Option<u16> {
        let offset = id.since(self.first());
        #[allow(clippy::cast_possible_truncation)] // below the block's length
        if offset < BLOCK as u32 { Some(offset as u16) } else { None }
    }

    const fn first(self) -> Identifier {
        match Identifier::standard(self.0) {
            Some(first) => first,
            None => Identifier::NONE, // never: it was checked
        }
    }
}
