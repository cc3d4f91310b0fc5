//! A horizon between its knots, piece after piece: a curve and a grid of times enter, way and speed at each of them leave.

use super::{Curve, Piece, SHORTEST, Segment, share_of};
use crate::fixed::quotient;
use crate::time::Duration;
use crate::units::{Distance, Speed};
use crate::wire::horizon::KNOTS_PER_MILLE;

impl Curve {
    /// All pieces in the order of time.
    pub(super) const fn pieces(&self) -> Pieces {
        Pieces { curve: *self, stretch: 0, end: 0, start: 0, segment: Segment::NOTHING, place: 3 }
    }

    /// Way and speed on a uniform grid (steps of at least 1 ms), from this time after the motion's stamp (or the stamp,
    /// if it is earlier) to the horizon's end.
    pub fn walk(&self, first: Duration, step: Duration) -> impl Iterator<Item = (Distance, Speed)> + use<> {
        let mut runs = self.runs(first, step);
        core::iter::from_fn(move || {
            loop {
                match runs.run().next() {
                    Some(reading) => return Some(reading),
                    None if runs.turn() => {}
                    None => return None,
                }
            }
        })
    }

    /// The same, piece by piece: before the first [`Runs::turn`] there are no readings.
    pub(crate) fn runs(&self, first: Duration, step: Duration) -> Runs {
        let (next, step) = (first.as_micros().max(0), step.as_micros().max(SHORTEST));
        Runs { pieces: self.pieces(), next, step, cursor: Cursor { left: 0, share: 0, share_step: 0 } }
    }
}

/// See [`Curve::pieces`]: one stretch is made after the other, each where the one before was.
pub(super) struct Pieces {
    curve: Curve,
    /// Stretches that were made, and where the last of them ends.
    stretch: usize,
    end: i64,
    segment: Segment,
    /// The next piece of the segment, and its start.
    place: usize,
    start: i64,
}

impl Pieces {
    /// The next piece, with its start.
    pub(super) fn advance(&mut self) -> Option<(i64, &Piece)> {
        loop {
            while let Some(piece) = self.segment.pieces.get(self.place) {
                self.place = self.place.wrapping_add(1); // at most 3
                if piece.micros > 0 {
                    let start = self.start;
                    self.start = start.saturating_add(piece.micros);
                    return Some((start, self.piece()));
                }
            }
            let end = share_of(self.curve.length, *KNOTS_PER_MILLE.get(self.stretch)?);
            let [from, to] = self.curve.states.get(self.stretch..)?.first_chunk()?;
            self.segment.make(from, to, Duration::from_micros(end.saturating_sub(self.end)));
            (self.start, self.end) = (self.end, end);
            (self.stretch, self.place) = (self.stretch.wrapping_add(1), 0);
        }
    }

    /// The piece that [`Self::advance`] told last.
    fn piece(&self) -> &Piece {
        self.segment.pieces.get(self.place.wrapping_sub(1)).unwrap_or(&Piece::NOTHING)
    }
}

/// The readings on the grid, in one run for each piece.
pub(crate) struct Runs {
    pieces: Pieces,
    /// The time of the first reading of the next run, and the time between two.
    next: i64,
    step: i64,
    cursor: Cursor,
}

/// Which reading of a piece is next.
struct Cursor {
    left: usize,
    share: i32,
    share_step: i32,
}

impl Runs {
    /// Goes on to the next piece in which readings lie; `false` if there is none. It is a call, because it is much code and is needed in
    /// two places.
    #[cfg_attr(not(target_pointer_width = "64"), inline(never))]
    pub(crate) fn turn(&mut self) -> bool {
        while let Some((start, piece)) = self.pieces.advance() {
            let passed = self.next.saturating_sub(start);
            let until_end = piece.micros.saturating_sub(passed);
            if until_end < 0 {
                continue;
            }
            let readings = quotient(until_end, self.step).saturating_add(1);
            self.next = self.next.saturating_add(readings.saturating_mul(self.step));
            let left = usize::try_from(readings).unwrap_or(usize::MAX);
            self.cursor = Cursor { left, share: piece.share_of(passed), share_step: piece.share_of(self.step) };
            return true;
        }
        false
    }

    /// The readings in this piece that are left.
    pub(crate) fn run(&mut self) -> Run<'_> {
        Run { piece: self.pieces.piece(), cursor: &mut self.cursor }
    }
}

/// The readings that lie in one piece: each is one addition and [`Piece::at_fraction`].
pub(crate) struct Run<'a> {
    piece: &'a Piece,
    cursor: &'a mut Cursor,
}

impl Run<'_> {
    /// How many readings are left.
    pub(crate) const fn len(&self) -> usize {
        self.cursor.left
    }
}

impl Iterator for Run<'_> {
    type Item = (Distance, Speed);

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        self.cursor.left = self.cursor.left.checked_sub(1)?;
        let reading = self.piece.at_fraction(self.cursor.share);
        self.cursor.share = self.cursor.share.wrapping_add(self.cursor.share_step); // beyond 1 it is not read any more
        Some(reading)
    }
}
