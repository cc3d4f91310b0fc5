//! The payload of a frame as one word of bits: bit fields are read from it and written into it.
//!
//! Bit `n` is bit `n % 8` of byte `n / 8`, which is the DBC's numbering of little-endian (Intel, `@1`) signals. Bits
//! 0 to 11 belong to the E2E header (CRC in byte 0, counter in the low nibble of byte 1), so 52 bits are left.

/// First bit that a field may use.
pub const FIRST_BIT: u32 = 12;

/// The 52 bits after the E2E header.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Payload(u64);

impl Payload {
    /// Every bit 0.
    pub const EMPTY: Self = Self(0);

    /// Of a frame's data; the E2E header is dropped.
    #[must_use]
    pub const fn from_bytes(data: [u8; 8]) -> Self {
        Self(u64::from_le_bytes(data) & !mask(FIRST_BIT))
    }

    /// A frame's data with the E2E header 0.
    #[must_use]
    pub const fn to_bytes(self) -> [u8; 8] {
        self.0.to_le_bytes()
    }

    /// The bits `start..start + length` as an unsigned number; bits beyond the 64th read as 0.
    #[inline]
    #[must_use]
    pub const fn unsigned(self, start: u32, length: u32) -> u64 {
        shifted_right(self.0, start) & mask(length)
    }

    /// The same bits as a number in two's complement.
    #[inline]
    #[must_use]
    #[allow(clippy::cast_possible_wrap)] // the sign bit is moved to the top on purpose, and back with its copies
    pub const fn signed(self, start: u32, length: u32) -> i64 {
        let unused = 64u32.saturating_sub(length);
        (self.unsigned(start, length).wrapping_shl(unused) as i64).wrapping_shr(unused)
    }

    /// With these bits replaced by the low bits of `raw`.
    #[inline]
    #[must_use]
    pub const fn with(self, start: u32, length: u32, raw: u64) -> Self {
        let place = shifted_left(mask(length), start);
        Self((self.0 & !place) | (shifted_left(raw, start) & place))
    }
}

const fn mask(length: u32) -> u64 {
    !shifted_left(u64::MAX, length)
}

const fn shifted_left(word: u64, bits: u32) -> u64 {
    match word.checked_shl(bits) {
        Some(shifted) => shifted,
        None => 0,
    }
}

const fn shifted_right(word: u64, bits: u32) -> u64 {
    match word.checked_shr(bits) {
        Some(shifted) => shifted,
        None => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_written_is_read_and_nothing_else_changes(
            word: u64, raw: u64, start in 12u32..64, length in 1u32..=52, other in 12u32..64,
        ) {
            let length = length.min(64 - start);
            let before = Payload::from_bytes(word.to_le_bytes());
            let after = before.with(start, length, raw);
            prop_assert_eq!(after.unsigned(start, length), raw & mask(length));
            if other < start || other >= start + length {
                prop_assert_eq!(after.unsigned(other, 1), before.unsigned(other, 1));
            }
        }

        #[test]
        fn no_place_and_no_length_is_a_panic(word: u64, raw: u64, start: u32, length: u32) {
            let payload = Payload::from_bytes(word.to_le_bytes()).with(start, length, raw);
            let _ = (payload.unsigned(start, length), payload.signed(start, length));
        }
    }

    #[test]
    fn bits_are_numbered_as_in_a_dbc() {
        let payload = Payload::from_bytes([0xFF, 0x8F, 0x01, 0, 0, 0, 0, 0x80]);
        assert_eq!(payload.to_bytes(), [0, 0x80, 0x01, 0, 0, 0, 0, 0x80]);
        assert_eq!(payload.unsigned(12, 8), 0x18);
        assert_eq!(payload.signed(60, 4), -8);
        assert_eq!(payload.signed(12, 4), -8);
    }
}
