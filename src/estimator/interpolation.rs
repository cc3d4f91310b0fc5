//! Reading between two steps: the states at both ends of an interval and a time inside it enter, the position and speed
//! on the cubic that meets both positions and both speeds leave.

use super::horizon::Grid;
use crate::fixed::{divide, mul_hi, ratio, saturate_i32, shl_saturating};
use crate::model::{Reading, Step};
use crate::time::{Duration, Instant};
use crate::units::{Distance, Speed};

/// The cubic Hermite curve of an interval, ready to be read many times.
///
/// Let `s = after/whole`, `w` the way, and `a` and `b` the ways that the speeds at the two ends would make. Then
/// `r = s [ a + s ( 3w - 2a - b + s (a + b - 2w) ) ]` and `v = ( a + 2 s (3w - 2a - b) + 3 s² (a + b - 2w) ) / whole`. The speed is
/// computed as the mix of the speeds at both ends, plus the bend.
#[derive(Clone, Copy, Debug)]
pub struct Cubic {
    from: Reading,
    way: Distance,
    end_speed: Speed,
    whole: Duration,
    /// `a`.
    line: Distance,
    /// `3w - 2a - b`.
    square: Distance,
    /// `a + b - 2w`.
    cubic: Distance,
}

impl Cubic {
    /// The curve from a reading, over this way, to an end speed, in this time.
    #[must_use]
    pub fn new(from: Reading, way: Distance, end_speed: Speed, whole: Duration) -> Self {
        let seconds = whole.seconds();
        let (line, end) = (from.speed.over(seconds), end_speed.over(seconds));
        let cubic = line.plus(end).minus(way).minus(way);
        Self { from, way, end_speed, whole, line, square: way.minus(line).minus(cubic), cubic }
    }

    /// The reading at this time after the start. Times outside the interval are taken at its ends. The speed is never negative.
    #[must_use]
    pub fn at(&self, after: Duration) -> Reading {
        let Self { from, way, end_speed, whole, .. } = *self;
        if after <= Duration::ZERO {
            return from;
        }
        if after >= whole {
            return Reading { position: from.position.ahead(way), speed: end_speed };
        }
        // s in 31 bits, below 1.
        let (way, bend) = self.bent(saturate_i32(ratio(after.as_micros(), whole.as_micros(), 31)));
        // From 20 to 23 fraction bits is a factor of 8; from per microsecond to per second is a factor of 1e6.
        let bend = i64::from(bend.to_bits()).saturating_mul(8_000_000);
        let bend_speed = Speed::from_bits(saturate_i32(ratio(bend, whole.as_micros(), 0)));
        Reading { position: from.position.ahead(way), speed: from.speed.plus(bend_speed).max(Speed::ZERO) }
    }

    /// The way at the share `s` of the interval, in 31 bits; and by how much the way of the whole at the speed there is more than `a`:
    /// `s (2 square + 3 s cubic)`.
    #[inline(always)]
    fn bent(&self, s: i32) -> (Distance, Distance) {
        let Self { line, square, cubic, .. } = *self;
        let share = |d: Distance| Distance::from_bits(shl_saturating::<1>(mul_hi(d.to_bits(), s)));
        let way = share(line.plus(share(square.plus(share(cubic)))));
        (way, share(square.plus(square).plus(share(cubic.plus(cubic).plus(cubic)))))
    }
}

/// A [`Cubic`] that is read many times: what is divided by the whole interval is multiplied with this instead.
#[derive(Clone, Copy, Debug)]
struct Reciprocal {
    /// `2^(31 + bits)/whole`, between 2³¹ and 2³².
    word: u32,
    /// The bits of the whole interval in microseconds.
    bits: u32,
}

impl Reciprocal {
    /// Of a time, at least a microsecond, and at most 2³² of them.
    #[allow(clippy::cast_possible_truncation)] // below 2³², because the divisor has the highest of its bits set
    fn of(whole: Duration) -> Self {
        let whole = whole.as_micros().unsigned_abs().clamp(1, u32::MAX.into());
        let bits = 64u32.saturating_sub(whole.leading_zeros());
        let word = divide(1u64.wrapping_shl(bits.saturating_add(31)), whole).min(u32::MAX.into()) as u32;
        Self { word, bits }
    }

    /// The share that a shorter time is of the interval, in 31 bits.
    #[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap)] // below the whole, and so below 1
    fn share(self, after: Duration) -> i32 {
        let after = after.as_micros().unsigned_abs() as u32;
        let share = u64::from(after).wrapping_mul(self.word.into()).wrapping_shr(self.bits);
        share.min(i32::MAX.unsigned_abs().into()) as i32
    }

    /// The speed that makes this way in the interval.
    #[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap)] // the halves
    fn speed(self, way: Distance) -> Speed {
        // The way by 2^bits microseconds, in 20 bits and then, per second, in 23.
        let scaled = i64::from(way.to_bits()).wrapping_mul(self.word.into()) >> 31;
        Speed::from_bits(saturate_i32(scaled.wrapping_mul(8_000_000).wrapping_shr(self.bits))) // below 2⁵⁵
    }
}

/// Where a vehicle is before the first step of its horizon: between the horizon's anchor and that step, and before the anchor.
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    start: Instant,
    curve: Cubic,
    by_whole: Reciprocal,
}

impl Approach {
    /// The curve from a state at an instant, over this way, to a speed, in this time.
    #[must_use]
    pub fn new(start: Instant, from: Reading, way: Distance, end_speed: Speed, whole: Duration) -> Self {
        Self { start, curve: Cubic::new(from, way, end_speed, whole), by_whole: Reciprocal::of(whole) }
    }

    /// The reading at an instant. Before the anchor the vehicle moves at the anchor's speed.
    #[must_use]
    pub fn at(&self, at: Instant) -> Reading {
        let (way, speed) = self.after(at.since(self.start));
        Reading { position: self.curve.from.position.ahead(way), speed }
    }

    /// The same at a step of the grid, as a follower's prediction takes it.
    #[must_use]
    pub fn at_step(&self, index: i64, grid: &Grid) -> Step {
        let (way, speed) = self.after(grid.since(index, self.start));
        Step { position: self.curve.from.position.ring().ahead(way), speed }
    }

    /// The way and the speed after this time.
    #[inline(always)]
    fn after(&self, since: Duration) -> (Distance, Speed) {
        let Cubic { from, way, end_speed, whole, .. } = self.curve;
        if since >= whole {
            return (way, end_speed);
        }
        if since < Duration::ZERO {
            // The time is at most the age of a sample. For a second the product fits the format; longer times saturate at 4 s.
            return (from.speed.over(since.seconds()), from.speed);
        }
        let (way, bend) = self.curve.bent(self.by_whole.share(since));
        (way, from.speed.plus(self.by_whole.speed(bend)).max(Speed::ZERO))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Position;

    #[test]
    fn an_approach_is_its_cubic_to_a_thousandth_of_a_millimetre() {
        let from = Reading { position: Position::from_mm(70_000), speed: Speed::from_mm_per_s(21_000) };
        for (whole, way, end) in [
            (1, 0, 21_000),
            (9_999, 205, 20_000),
            (40_000, 830, 20_700),
            (1_000_000, 19_000, 15_000),
            (9_900_000, 120_000, 0),
        ] {
            let (way, end, length) = (Distance::from_mm(way), Speed::from_mm_per_s(end), Duration::from_micros(whole));
            let (cubic, start) = (Cubic::new(from, way, end, length), Instant::from_micros(5_000_000));
            let approach = Approach::new(start, from, way, end, length);
            for after in (0..=whole).step_by((whole as usize / 97).max(1)).map(Duration::from_micros) {
                let (one, other) = (approach.at(start.plus(after)), cubic.at(after));
                let off = one.position.ahead_of(other.position).magnitude();
                assert!(off <= Distance::from_bits(2), "{whole} {after:?}: {off:?}");
                // Of the interval's shortest times a way is a word or two.
                let off = one.speed.minus(other.speed).magnitude().to_bits();
                assert!(i64::from(off) <= 64 + 32_000_000 / whole, "{whole} {after:?}: {off}");
            }
        }
    }

    #[test]
    fn a_cubic_motion_is_read_exactly() {
        // r = 3 t - 0.5 t² + 0.2 t³ over 1 s and over 10 ms.
        for whole in [10_000i64, 100_000, 1_000_000] {
            let h = whole as f64 * 1e-6;
            let r = |t: f64| 13.0 * t - 0.5 * t * t + 0.2 * t * t * t;
            let v = |t: f64| 13.0 - t + 0.6 * t * t;
            let metres = |x: f64| Distance::from_ratio((x * 1e9).round() as i64 / 1000, 1_000_000);
            let speed = |x: f64| Speed::from_ratio((x * 1e6).round() as i64, 1_000_000);
            let from = Reading { position: Position::ZERO, speed: speed(v(0.0)) };
            for share in 0..=20 {
                let after = whole * share / 20;
                let curve = Cubic::new(from, metres(r(h)), speed(v(h)), Duration::from_micros(whole));
                let reading = curve.at(Duration::from_micros(after));
                let t = after as f64 * 1e-6;
                assert!((reading.position.get().to_num::<f64>() - r(t)).abs() < 1e-5, "{whole} {share}");
                let tolerance = 2e-6 + 8e-6 / h; // the ways at both ends are rounded to a micrometre each
                assert!((reading.speed.get().to_num::<f64>() - v(t)).abs() < tolerance, "{whole} {share}");
            }
        }
    }
}
