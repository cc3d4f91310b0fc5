//! Messages of several frames: parts enter, whole messages leave; parts that do not belong together are refused.
//!
//! Tags alone do not tell messages apart: they come round after four, and a part whose other half was lost waits. So the
//! parts of a message have to come together, within a time in which tags do not come round; and as messages may be overtaken,
//! so that those of one tag meet, their counters have to be those of one message (see [`tie`](super::tie)).

use super::bits::Payload;
use super::tie::Tie;
use crate::health::Cause;
use crate::time::{Duration, Instant};

/// One part of a message.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub(super) at: Instant,
    /// Within this the other parts come.
    pub(super) within: Duration,
    pub(super) part: u8,
    pub(super) tag: u8,
    /// Of the frame.
    pub(super) counter: u8,
    pub(super) payload: Payload,
}

impl Piece {
    /// The same as that part.
    pub(super) const fn of(self, part: u8) -> Self {
        Self { part, ..self }
    }
}

/// The parts of one message so far. Parts may come in any order; their counters go up by `STEP` from part to part: not at all where
/// they have identifiers of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Assembly<const PARTS: usize, const STEP: u8> {
    parts: [Payload; PARTS],
    /// Bit `n` is set if part `n` is here.
    held: u8,
    tag: u8,
    /// When the first of them came.
    since: Instant,
    tie: Tie<STEP>,
}

impl<const PARTS: usize, const STEP: u8> Assembly<PARTS, STEP> {
    #[allow(clippy::cast_possible_truncation)] // at most 8 parts
    const ALL: u8 = match 1u8.checked_shl(PARTS as u32) {
        Some(power) => power.wrapping_sub(1),
        None => u8::MAX,
    };

    /// Nothing so far: all zero.
    pub(super) const NEW: Self =
        Self { parts: [Payload::EMPTY; PARTS], held: 0, tag: 0, since: Instant::ZERO, tie: Tie::NONE };

    /// The parts of the message that was whole last.
    pub(super) const fn parts(&self) -> &[Payload; PARTS] {
        &self.parts
    }

    /// Takes one part. Returns whether it was the last one missing; then all are in [`parts`](Self::parts) until the next one comes.
    ///
    /// # Errors
    /// `Torn`, once for each message that stays incomplete because this part belongs to another one (its tag differs,
    /// this part is here already, it was received more than `within` apart from the first one, or with it the counters are not
    /// those of one message); the part then begins the new message. `Range` for a part that there is not.
    pub(super) fn add(&mut self, piece: &Piece) -> Result<bool, Cause> {
        let Piece { at, within, part, tag, counter, payload } = *piece;
        let place = self.parts.get_mut(usize::from(part)).ok_or(Cause::Range)?;
        *place = payload;
        self.tie.note(part, counter);
        let bit = 1u8.checked_shl(u32::from(part)).unwrap_or(0);
        let apart = at.since(self.since);
        let is_together = apart <= within && apart >= Duration::ZERO.minus(within);
        let mut torn = self.held != 0 && (self.tag != tag || self.held & bit != 0 || !is_together);
        if !torn && self.held | bit == Self::ALL {
            #[allow(clippy::cast_possible_truncation)] // at most 8 parts
            if self.tie.holds(PARTS as u8) {
                self.held = 0;
                return Ok(true);
            }
            torn = true;
        }
        if torn || self.held == 0 {
            (self.held, self.since) = (0, at);
        }
        self.held |= bit;
        self.tag = tag;
        if torn { Err(Cause::Torn) } else { Ok(false) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const P: Payload = Payload::EMPTY;
    const WITHIN: Duration = Duration::from_millis(50);

    /// Of a message whose first part has the counter 0.
    fn piece(micros: u64, part: u8, tag: u8) -> Piece {
        Piece { at: Instant::from_micros(micros), within: WITHIN, part, tag, counter: part, payload: P }
    }

    #[test]
    fn parts_of_one_tag_make_a_message_in_any_order() {
        let mut assembly = Assembly::<3, 1>::NEW;
        for order in [[0, 1, 2], [2, 0, 1]] {
            assert_eq!(assembly.add(&piece(7, order[0], 1)), Ok(false));
            assert_eq!(assembly.add(&piece(7, order[1], 1)), Ok(false));
            assert_eq!(assembly.add(&piece(7, order[2], 1)), Ok(true));
            assert_eq!(assembly.parts(), &[P; 3]);
        }
    }

    #[test]
    fn a_message_that_stays_incomplete_is_torn_once_and_the_next_is_whole() {
        let mut assembly = Assembly::<3, 1>::NEW;
        assert_eq!(assembly.add(&piece(7, 0, 1)), Ok(false));
        assert_eq!(assembly.add(&piece(7, 1, 1)), Ok(false));
        assert_eq!(assembly.add(&piece(7, 0, 2)), Err(Cause::Torn));
        assert_eq!(assembly.add(&piece(7, 1, 2)), Ok(false));
        assert_eq!(assembly.add(&piece(7, 2, 2)), Ok(true));
    }

    #[test]
    fn the_same_part_twice_under_one_tag_is_another_message() {
        let mut assembly = Assembly::<2, 1>::NEW;
        assert_eq!(assembly.add(&piece(7, 0, 1)), Ok(false));
        assert_eq!(assembly.add(&piece(7, 0, 1)), Err(Cause::Torn));
        assert_eq!(assembly.add(&piece(7, 1, 1)), Ok(true));
        assert_eq!(assembly.add(&piece(7, 2, 1)), Err(Cause::Range));
    }

    #[test]
    fn parts_that_come_too_far_apart_make_no_message_whichever_comes_first() {
        let torn = Err(Cause::Torn);
        for (then, later) in [(0, 50_001), (50_001, 0), (0, 600_000_000)] {
            let mut assembly = Assembly::<2, 1>::NEW;
            assert_eq!(assembly.add(&piece(then, 0, 1)), Ok(false));
            assert_eq!(assembly.add(&piece(later, 1, 1)), torn, "{then} {later}");
            // What came late begins a new message.
            assert_eq!(assembly.add(&piece(later, 0, 1)), Ok(true));
        }
        for (then, later) in [(0, 50_000), (50_000, 0)] {
            let mut assembly = Assembly::<2, 1>::NEW;
            assert_eq!(assembly.add(&piece(then, 0, 1)), Ok(false));
            assert_eq!(assembly.add(&piece(later, 1, 1)), Ok(true), "{then} {later}");
        }
    }

    #[test]
    fn the_time_counts_from_the_first_part() {
        let mut assembly = Assembly::<3, 1>::NEW;
        assert_eq!(assembly.add(&piece(0, 0, 1)), Ok(false));
        assert_eq!(assembly.add(&piece(30_000, 1, 1)), Ok(false));
        assert_eq!(assembly.add(&piece(60_000, 2, 1)), Err(Cause::Torn));
    }

    #[test]
    fn parts_of_two_messages_with_one_tag_make_none_and_the_later_is_whole() {
        let of = |message: u8, part| Piece { counter: message + part, ..piece(7, part, 1) };
        for (lost, rest) in [(0, [1, 2]), (2, [0, 1])] {
            let mut assembly = Assembly::<3, 1>::NEW;
            (0..3).filter(|part| *part != lost).for_each(|part| assert_eq!(assembly.add(&of(0, part)), Ok(false)));
            assert_eq!(assembly.add(&of(3, lost)), Err(Cause::Torn));
            assert_eq!(assembly.add(&of(3, rest[0])), Ok(false));
            assert_eq!(assembly.add(&of(3, rest[1])), Ok(true));
        }
    }
}
