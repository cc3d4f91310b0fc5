//! Intervals of real numbers with ends of 64 bits. Every operation rounds outward, so that the exact result is inside.

use std::ops::{Add, Mul, Sub};

/// From `low` to `high`.
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

fn outward(low: f64, high: f64) -> Interval {
    Interval { low: low.next_down(), high: high.next_up() }
}

impl Interval {
    /// This number alone.
    pub fn exactly(number: f64) -> Self {
        Self { low: number, high: number }
    }

    /// A word with this many fraction bits; exact below 2⁵³.
    pub fn word(word: i64, fraction: i32) -> Self {
        Self::exactly(word as f64 * 2f64.powi(-fraction))
    }

    /// A quotient of integers.
    pub fn ratio(numerator: f64, denominator: f64) -> Self {
        Self::exactly(numerator).per(Self::exactly(denominator))
    }

    /// Quotient; the divisor is above 0.
    pub fn per(self, divisor: Self) -> Self {
        assert!(divisor.low > 0.0);
        let ends = [self.low / divisor.low, self.low / divisor.high, self.high / divisor.low, self.high / divisor.high];
        outward(ends.into_iter().fold(f64::MAX, f64::min), ends.into_iter().fold(f64::MIN, f64::max))
    }

    /// Its square.
    pub fn square(self) -> Self {
        let (a, b) = (self.low * self.low, self.high * self.high);
        let least = if self.low < 0.0 && self.high > 0.0 { 0.0 } else { a.min(b) };
        Self { low: least.next_down().max(0.0), high: a.max(b).next_up() }
    }

    /// The larger of this and 0.
    pub fn positive(self) -> Self {
        Self { low: self.low.max(0.0), high: self.high.max(0.0) }
    }

    /// `e^-self`, for a value that is not negative. It is divided by 2ⁿ to below 1/16, put into a series whose terms alternate and fall,
    /// and the result is squared n times.
    pub fn decayed(self) -> Self {
        Self { low: decayed(self.high).low, high: decayed(self.low).high }
    }
}

fn decayed(x: f64) -> Interval {
    if x > 64.0 {
        return Interval { low: 0.0, high: 1e-27 };
    }
    let halvings = (x * 16.0).max(1.0).log2().ceil() as i32;
    let small = Interval::exactly(x * 2f64.powi(-halvings));
    let one = Interval::exactly(1.0);
    let (mut sum, mut term) = (one, one);
    for n in 1..12 {
        term = (Interval::exactly(0.0) - term * small).per(Interval::exactly(f64::from(n)));
        sum = sum + term;
    }
    let rest = term.low.abs().max(term.high.abs());
    let mut power = outward(sum.low - rest, sum.high + rest);
    (0..halvings).for_each(|_| power = power.square());
    power
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        outward(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        outward(self.low - other.high, self.high - other.low)
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let ends = [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        outward(ends.into_iter().fold(f64::MAX, f64::min), ends.into_iter().fold(f64::MIN, f64::max))
    }
}

#[test]
fn what_decays_is_between_its_ends_and_they_are_close() {
    for x in [0.0, 1e-9, 0.01, 0.0625, 0.1, 1.0 / 3.0, 1.0, 5.0, 31.0, 63.9] {
        let found = Interval::exactly(x).decayed();
        let known = (-x).exp();
        assert!(found.low <= known * (1.0 + 1e-15) && known * (1.0 - 1e-15) <= found.high, "{x}: {found:?}");
        assert!(found.high - found.low <= 1e-10 * known, "{x}: {found:?}");
    }
}
