//! Messages of several frames: parts enter, whole messages leave; parts that do not belong together are refused.

use super::bits::Payload;
use crate::health::Refusal;

/// The parts of one message so far. Parts may come in any order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Assembly<const PARTS: usize> {
    parts: [Payload; PARTS],
    /// Bit `n` is set if part `n` is here.
    held: u8,
    tag: u8,
}

impl<const PARTS: usize> Assembly<PARTS> {
    #[allow(clippy::cast_possible_truncation)] // at most 8 parts
    const ALL: u8 = match 1u8.checked_shl(PARTS as u32) {
        Some(power) => power.wrapping_sub(1),
        None => u8::MAX,
    };

    pub(super) const fn new() -> Self {
        Self { parts: [Payload::EMPTY; PARTS], held: 0, tag: 0 }
    }

    /// Takes one part; the whole message if it was the last one missing.
    ///
    /// # Errors
    /// `Torn`, once for each message that stays incomplete because this part belongs to another one (its tag differs,
    /// or this part is here already); the part then begins the new message. `Range` for a part that there is not.
    pub(super) fn add(&mut self, part: u8, tag: u8, payload: Payload) -> Result<Option<[Payload; PARTS]>, Refusal> {
        let place = self.parts.get_mut(usize::from(part)).ok_or(Refusal::Range)?;
        *place = payload;
        let bit = 1u8.checked_shl(u32::from(part)).unwrap_or(0);
        let torn = self.held != 0 && (self.tag != tag || self.held & bit != 0);
        self.held = if torn { bit } else { self.held | bit };
        self.tag = tag;
        if self.held == Self::ALL {
            self.held = 0;
            return Ok(Some(self.parts));
        }
        if torn { Err(Refusal::Torn) } else { Ok(None) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const P: Payload = Payload::EMPTY;

    #[test]
    fn parts_of_one_tag_make_a_message_in_any_order() {
        let mut assembly = Assembly::<3>::new();
        for order in [[0, 1, 2], [2, 0, 1]] {
            assert_eq!(assembly.add(order[0], 1, P), Ok(None));
            assert_eq!(assembly.add(order[1], 1, P), Ok(None));
            assert_eq!(assembly.add(order[2], 1, P), Ok(Some([P; 3])));
        }
    }

    #[test]
    fn a_message_that_stays_incomplete_is_torn_once_and_the_next_is_whole() {
        let mut assembly = Assembly::<3>::new();
        assert_eq!(assembly.add(0, 1, P), Ok(None));
        assert_eq!(assembly.add(1, 1, P), Ok(None));
        assert_eq!(assembly.add(0, 2, P), Err(Refusal::Torn));
        assert_eq!(assembly.add(1, 2, P), Ok(None));
        assert_eq!(assembly.add(2, 2, P), Ok(Some([P; 3])));
    }

    #[test]
    fn the_same_part_twice_under_one_tag_is_another_message() {
        let mut assembly = Assembly::<2>::new();
        assert_eq!(assembly.add(0, 1, P), Ok(None));
        assert_eq!(assembly.add(0, 1, P), Err(Refusal::Torn));
        assert_eq!(assembly.add(1, 1, P), Ok(Some([P; 2])));
        assert_eq!(assembly.add(2, 1, P), Err(Refusal::Range));
    }
}
