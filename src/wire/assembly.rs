//! Messages of several frames: parts enter, whole messages leave; parts that do not belong together are refused.
//!
//! Tags alone do not tell messages apart: they come round after four, and a part whose other half was lost waits. So the
//! parts of a message have to come together, within a time in which tags do not come round.

use super::bits::Payload;
use crate::health::Refusal;
use crate::time::{Duration, Instant};

/// The parts of one message so far. Parts may come in any order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Assembly<const PARTS: usize> {
    parts: [Payload; PARTS],
    /// Bit `n` is set if part `n` is here.
    held: u8,
    tag: u8,
    /// When the first of them came.
    since: Instant,
}

impl<const PARTS: usize> Assembly<PARTS> {
    #[allow(clippy::cast_possible_truncation)] // at most 8 parts
    const ALL: u8 = match 1u8.checked_shl(PARTS as u32) {
        Some(power) => power.wrapping_sub(1),
        None => u8::MAX,
    };

    pub(super) const fn new() -> Self {
        Self { parts: [Payload::EMPTY; PARTS], held: 0, tag: 0, since: Instant::ZERO }
    }

    /// Takes one part; the whole message if it was the last one missing.
    ///
    /// # Errors
    /// `Torn`, once for each message that stays incomplete because this part belongs to another one (its tag differs,
    /// this part is here already, or it was received more than `within` apart from the first one); the part then begins the
    /// new message. `Range` for a part that there is not.
    pub(super) fn add(
        &mut self,
        at: Instant,
        within: Duration,
        part: u8,
        tag: u8,
        payload: Payload,
    ) -> Result<Option<[Payload; PARTS]>, Refusal> {
        let place = self.parts.get_mut(usize::from(part)).ok_or(Refusal::Range)?;
        *place = payload;
        let bit = 1u8.checked_shl(u32::from(part)).unwrap_or(0);
        let apart = at.since(self.since);
        let is_together = apart <= within && apart >= Duration::ZERO.minus(within);
        let torn = self.held != 0 && (self.tag != tag || self.held & bit != 0 || !is_together);
        if torn || self.held == 0 {
            (self.held, self.since) = (0, at);
        }
        self.held |= bit;
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
    const WITHIN: Duration = Duration::from_millis(50);

    fn at(micros: u64) -> Instant {
        Instant::from_micros(micros)
    }

    #[test]
    fn parts_of_one_tag_make_a_message_in_any_order() {
        let mut assembly = Assembly::<3>::new();
        for order in [[0, 1, 2], [2, 0, 1]] {
            assert_eq!(assembly.add(at(7), WITHIN, order[0], 1, P), Ok(None));
            assert_eq!(assembly.add(at(7), WITHIN, order[1], 1, P), Ok(None));
            assert_eq!(assembly.add(at(7), WITHIN, order[2], 1, P), Ok(Some([P; 3])));
        }
    }

    #[test]
    fn a_message_that_stays_incomplete_is_torn_once_and_the_next_is_whole() {
        let mut assembly = Assembly::<3>::new();
        assert_eq!(assembly.add(at(7), WITHIN, 0, 1, P), Ok(None));
        assert_eq!(assembly.add(at(7), WITHIN, 1, 1, P), Ok(None));
        assert_eq!(assembly.add(at(7), WITHIN, 0, 2, P), Err(Refusal::Torn));
        assert_eq!(assembly.add(at(7), WITHIN, 1, 2, P), Ok(None));
        assert_eq!(assembly.add(at(7), WITHIN, 2, 2, P), Ok(Some([P; 3])));
    }

    #[test]
    fn the_same_part_twice_under_one_tag_is_another_message() {
        let mut assembly = Assembly::<2>::new();
        assert_eq!(assembly.add(at(7), WITHIN, 0, 1, P), Ok(None));
        assert_eq!(assembly.add(at(7), WITHIN, 0, 1, P), Err(Refusal::Torn));
        assert_eq!(assembly.add(at(7), WITHIN, 1, 1, P), Ok(Some([P; 2])));
        assert_eq!(assembly.add(at(7), WITHIN, 2, 1, P), Err(Refusal::Range));
    }

    #[test]
    fn parts_that_come_too_far_apart_make_no_message_whichever_comes_first() {
        let torn = Err(Refusal::Torn);
        for (then, later) in [(0, 50_001), (50_001, 0), (0, 600_000_000)] {
            let mut assembly = Assembly::<2>::new();
            assert_eq!(assembly.add(at(then), WITHIN, 0, 1, P), Ok(None));
            assert_eq!(assembly.add(at(later), WITHIN, 1, 1, P), torn, "{then} {later}");
            // What came late begins a new message.
            assert_eq!(assembly.add(at(later), WITHIN, 0, 1, P), Ok(Some([P; 2])));
        }
        for (then, later) in [(0, 50_000), (50_000, 0)] {
            let mut assembly = Assembly::<2>::new();
            assert_eq!(assembly.add(at(then), WITHIN, 0, 1, P), Ok(None));
            assert_eq!(assembly.add(at(later), WITHIN, 1, 1, P), Ok(Some([P; 2])), "{then} {later}");
        }
    }

    #[test]
    fn the_time_counts_from_the_first_part() {
        let mut assembly = Assembly::<3>::new();
        assert_eq!(assembly.add(at(0), WITHIN, 0, 1, P), Ok(None));
        assert_eq!(assembly.add(at(30_000), WITHIN, 1, 1, P), Ok(None));
        assert_eq!(assembly.add(at(60_000), WITHIN, 2, 1, P), Err(Refusal::Torn));
    }
}
