//! Reading between two steps: the states at both ends of an interval and a time inside it enter, the position and speed
//! on the cubic that meets both positions and both speeds leave.

use crate::fixed::{mul_hi, ratio, saturate_i32, shl_saturating};
use crate::model::Reading;
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
        let Self { from, way, end_speed, whole, line, square, cubic } = *self;
        if after <= Duration::ZERO {
            return from;
        }
        if after >= whole {
            return Reading { position: from.position.ahead(way), speed: end_speed };
        }
        // s in 31 bits, below 1.
        let s = saturate_i32(ratio(after.as_micros(), whole.as_micros(), 31));
        let share = |d: Distance| Distance::from_bits(shl_saturating::<1>(mul_hi(d.to_bits(), s)));
        let position = share(line.plus(share(square.plus(share(cubic)))));
        // dr/dt = [ a + s (2 square + 3 s cubic) ] / whole
        let bend = share(square.plus(square).plus(share(cubic.plus(cubic).plus(cubic))));
        // From 20 to 23 fraction bits is a factor of 8; from per microsecond to per second is a factor of 1e6.
        let bend = i64::from(bend.to_bits()).saturating_mul(8_000_000);
        let bend_speed = Speed::from_bits(saturate_i32(ratio(bend, whole.as_micros(), 0)));
        Reading { position: from.position.ahead(position), speed: from.speed.plus(bend_speed).max(Speed::ZERO) }
    }
}

/// Where a vehicle is before the first step of its horizon: between the horizon's anchor and that step, and before the anchor.
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    start: Instant,
    curve: Cubic,
}

impl Approach {
    /// The curve from a state at an instant, over this way, to a speed, in this time.
    #[must_use]
    pub fn new(start: Instant, from: Reading, way: Distance, end_speed: Speed, whole: Duration) -> Self {
        Self { start, curve: Cubic::new(from, way, end_speed, whole) }
    }

    /// The reading at an instant. Before the anchor the vehicle moves at the anchor's speed.
    #[must_use]
    pub fn at(&self, at: Instant) -> Reading {
        let since = at.since(self.start);
        if since >= Duration::ZERO {
            return self.curve.at(since);
        }
        // The time is at most the age of a sample. For a second the product fits the format; longer times saturate at 4 s.
        let Reading { position, speed } = self.curve.from;
        Reading { position: position.ahead(speed.over(since.seconds())), speed }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Position;

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
