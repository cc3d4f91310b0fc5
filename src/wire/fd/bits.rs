//! The data of a long frame as bits: numbers of up to 57 bits are read from it and written into it, at any bit. Bits are numbered
//! as in [`super::super::bits`].

/// The most bytes of a frame.
const MOST: usize = 64;
/// A number is moved as one word, which may begin at the last byte.
const WORD: usize = 8;

/// The bits.
#[derive(Clone)]
pub(in crate::wire) struct Bits([u8; MOST + WORD]);

impl Bits {
    /// Every bit 0.
    pub(in crate::wire) const EMPTY: Self = Self([0; MOST + WORD]);

    /// Of a frame's data, of which 64 bytes count.
    pub(in crate::wire) fn of(data: &[u8]) -> Self {
        let mut bits = Self::EMPTY;
        let length = data.len().min(MOST);
        if let (Some(to), Some(from)) = (bits.0.get_mut(..length), data.get(..length)) {
            to.copy_from_slice(from);
        }
        bits
    }

    /// The first bytes, 64 at the most.
    pub(in crate::wire) fn bytes_mut(&mut self, length: usize) -> &mut [u8] {
        self.0.get_mut(..length.min(MOST)).unwrap_or_default()
    }

    /// The bits `start..start + length`; those beyond the 64th byte read as 0.
    pub(in crate::wire) fn get(&self, start: u16, length: u8) -> u64 {
        let word = self.0.get(usize::from(start / 8)..).and_then(<[u8]>::first_chunk::<WORD>);
        word.map_or(0, |word| u64::from_le_bytes(*word)).wrapping_shr(u32::from(start % 8)) & mask(length)
    }

    /// Replaces the same bits by the low bits of `raw`.
    pub(in crate::wire) fn put(&mut self, start: u16, length: u8, raw: u64) {
        let place = self.0.get_mut(usize::from(start / 8)..).and_then(<[u8]>::first_chunk_mut::<WORD>);
        let Some(place) = place else { return };
        let (shift, mask) = (u32::from(start % 8), mask(length));
        let word = u64::from_le_bytes(*place) & !mask.wrapping_shl(shift) | (raw & mask).wrapping_shl(shift);
        *place = word.to_le_bytes();
    }
}

const fn mask(length: u8) -> u64 {
    match 1u64.checked_shl(length as u32) {
        Some(power) => power.wrapping_sub(1),
        None => u64::MAX,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_written_is_read_and_nothing_else_changes(
            data in proptest::array::uniform32(any::<u16>()), raw: u64, start in 0u16..512, length in 1u8..=57, other in 0u16..512,
        ) {
            let length = length.min((512 - start).min(57) as u8);
            let bytes: Vec<u8> = data.iter().flat_map(|word| word.to_le_bytes()).collect();
            let before = Bits::of(&bytes);
            let mut after = before.clone();
            after.put(start, length, raw);
            prop_assert_eq!(after.get(start, length), raw & mask(length));
            if other < start || other >= start + u16::from(length) {
                prop_assert_eq!(after.get(other, 1), before.get(other, 1));
            }
        }

        #[test]
        fn no_place_and_no_length_is_a_panic(data: Vec<u8>, raw: u64, start: u16, length: u8) {
            let mut bits = Bits::of(&data);
            bits.put(start, length, raw);
            let _ = (bits.get(start, length), bits.bytes_mut(start.into()));
        }
    }
}
