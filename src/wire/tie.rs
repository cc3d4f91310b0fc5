//! What ties the frames of one message: the counters of frames that make a message of one tag enter; whether it is one message
//! leaves.
//!
//! Tags come round after four messages, and one that was held back is overtaken by others: two messages with one tag may be on
//! the bus one after the other, and if a frame of the first is lost, what is left of it and a frame of the second would make
//! a message that nobody sent. But a sender counts every frame, lost or not. So the counters of a message's frames
//! differ by the same in every message, and by something else where they are frames of two.
//!
//! What they differ by is the sender's: 0 between identifiers, which count for themselves, and 1 from part to part of one
//! identifier, if it begins to count with all of them at once, as the catalogue's does. One that begins otherwise, or has left a
//! frame out, is understood from the [`RECOVERY`]th message in a row on that differs by the same; until then its messages are lost.

use super::e2e::COUNTERS;

/// So many messages in a row tell what a sender's counters differ by.
pub const RECOVERY: u8 = 3;
/// Bits of a counter.
const NIBBLE: u32 = 4;

/// The counters of up to 5 parts, 4 bits each. From part to part they go up by `STEP`, if nothing else is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tie<const STEP: u8> {
    /// As they came; those of parts that did not are left from before.
    counters: u32,
    /// What those of parts 1 to 4 are ahead of part 0's in a message, beside that.
    usual: u16,
    /// What they were ahead in the last that was none.
    other: u16,
    /// In how many in a row.
    seen: u8,
}

impl<const STEP: u8> Tie<STEP> {
    /// Nothing was counted yet: all zero.
    pub(super) const NONE: Self = Self { counters: 0, usual: 0, other: 0, seen: 0 };

    /// Takes note of a part's counter.
    pub(super) fn note(&mut self, part: u8, counter: u8) {
        let place = u32::from(part).wrapping_mul(NIBBLE);
        self.counters = (self.counters & !0xFu32.wrapping_shl(place)) | u32::from(counter & 0xF).wrapping_shl(place);
    }

    /// Whether so many parts, of all of which the counters were noted, are one message.
    pub(super) fn holds(&mut self, parts: u8) -> bool {
        let ahead = self.ahead(parts);
        if ahead != self.usual {
            self.seen = if self.other == ahead { self.seen.saturating_add(1) } else { 1 };
            self.other = ahead;
            if self.seen < RECOVERY {
                return false;
            }
            self.usual = ahead;
        }
        self.seen = 0;
        true
    }

    /// What the counters of the parts after the first are ahead of that one's, beside the steps.
    fn ahead(&self, parts: u8) -> u16 {
        let of = |part: u8| (self.counters.wrapping_shr(u32::from(part).wrapping_mul(NIBBLE)) & 0xF) as u8;
        let beside = |part: u8| of(0).wrapping_add(STEP.wrapping_mul(part)) % COUNTERS;
        let ahead = |part: u8| u16::from(of(part).wrapping_add(COUNTERS).wrapping_sub(beside(part)) % COUNTERS);
        (1..parts).rev().fold(0, |all, part| all.wrapping_shl(NIBBLE) | ahead(part))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether messages with these counters hold, one after the other.
    fn hold<const PARTS: usize, const STEP: u8>(mut tie: Tie<STEP>, messages: &[[u8; PARTS]]) -> Vec<bool> {
        let one = |counters: &[u8; PARTS]| {
            (0..).zip(counters).for_each(|(part, counter)| tie.note(part, *counter));
            tie.holds(PARTS as u8)
        };
        messages.iter().map(one).collect()
    }

    #[test]
    fn identifiers_of_their_own_count_alike_and_parts_of_one_follow_one_another() {
        assert_eq!(hold(Tie::<0>::NONE, &[[3, 3], [14, 14], [0, 0], [0, 1]]), [true, true, true, false]);
        let of_one = [[0, 1, 2], [13, 14, 0], [14, 0, 1], [3, 1, 2]];
        assert_eq!(hold(Tie::<1>::NONE, &of_one), [true, true, true, false]);
        assert_eq!(hold(Tie::<1>::NONE, &[[12, 13, 14, 0, 1], [0, 1, 2, 3, 3]]), [true, false]);
    }

    #[test]
    fn counters_that_differ_by_something_else_are_understood_from_the_third_message_on() {
        let messages = [[0, 4], [1, 5], [14, 3], [0, 4], [1, 1], [2, 2], [3, 3]];
        assert_eq!(hold(Tie::<0>::NONE, &messages), [false, false, true, true, false, false, true]);
    }

    #[test]
    fn what_differs_otherwise_each_time_or_not_in_a_row_is_never_understood() {
        assert_eq!(hold(Tie::<0>::NONE, &[[0, 4], [0, 5], [0, 4], [0, 4]]), [false; 4]);
        let messages = [[0, 4], [7, 7], [0, 4], [0, 4], [8, 8], [0, 4]];
        assert_eq!(hold(Tie::<0>::NONE, &messages), [false, true, false, false, true, false]);
    }
}
