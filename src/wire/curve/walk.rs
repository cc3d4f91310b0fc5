//! A horizon between its knots, piece after piece: a curve and a grid of times enter, way and speed at each of them leave.

use super::{Curve, Piece, SHORTEST, Segment, share_of};
use crate::fixed::quotient;
use crate::time::Duration;
use crate::units::{Distance, Speed};
use crate::wire::horizon::SHARES_PER_MILLE;

impl Curve {
    /// All pieces in the order of time, each with its start.
    pub(super) const fn pieces(&self) -> Pieces {
        Pieces {
            curve: *self,
            stretch: 0,
            end: 0,
            start: 0,
            segment: Segment { pieces: [Piece::NOTHING; 3] },
            place: 3,
        }
    }

    /// Way and speed on a uniform grid (steps of at least 1 ms), from this time after the motion's stamp (or the stamp,
    /// if it is earlier) to the horizon's end.
    pub fn walk(&self, first: Duration, step: Duration) -> impl Iterator<Item = (Distance, Speed)> + use<> {
        self.runs(first, step).flatten()
    }

    /// The same, piece by piece.
    pub(crate) fn runs(&self, first: Duration, step: Duration) -> impl Iterator<Item = Run> + use<> {
        let (mut next, step) = (first.as_micros().max(0), step.as_micros().max(SHORTEST));
        self.pieces().filter_map(move |(start, piece)| {
            let passed = next.saturating_sub(start);
            let until_end = piece.micros.saturating_sub(passed);
            if until_end < 0 {
                return None;
            }
            let readings = quotient(until_end, step).saturating_add(1);
            next = next.saturating_add(readings.saturating_mul(step));
            let left = usize::try_from(readings).unwrap_or(usize::MAX);
            Some(Run { share: piece.share_of(passed), share_step: piece.share_of(step), left, piece })
        })
    }
}

/// See [`Curve::pieces`]: one stretch is made after the other.
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

impl Iterator for Pieces {
    type Item = (i64, Piece);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            while let Some(piece) = self.segment.pieces.get(self.place) {
                self.place = self.place.wrapping_add(1); // below 3
                if piece.micros > 0 {
                    let start = self.start;
                    self.start = start.saturating_add(piece.micros);
                    return Some((start, *piece));
                }
            }
            let end = share_of(self.curve.length, *SHARES_PER_MILLE.get(self.stretch)?);
            let [from, to] = self.curve.states.get(self.stretch..)?.first_chunk()?;
            self.segment = Segment::new(from, to, Duration::from_micros(end.saturating_sub(self.end)));
            (self.start, self.end) = (self.end, end);
            (self.stretch, self.place) = (self.stretch.wrapping_add(1), 0);
        }
    }
}

/// The readings that lie in one piece: each is one addition and [`Piece::at_fraction`].
pub(crate) struct Run {
    piece: Piece,
    left: usize,
    share: i32,
    share_step: i32,
}

impl Run {
    /// How many readings are left.
    pub(crate) const fn len(&self) -> usize {
        self.left
    }
}

impl Iterator for Run {
    type Item = (Distance, Speed);

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        self.left = self.left.checked_sub(1)?;
        let reading = self.piece.at_fraction(self.share);
        self.share = self.share.wrapping_add(self.share_step); // beyond 1 it is not read any more
        Some(reading)
    }
}
