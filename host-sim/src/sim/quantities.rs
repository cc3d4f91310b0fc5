//! Physical quantities: the simulation's float64 enters, the core's fixed-point formats leave.

use holdover::time::Duration;
use holdover::units::{Acceleration, Distance, FineSeconds, Fraction, Position, Seconds, Speed};

use super::time::micros;

/// To the core's format, to nearest.
#[must_use]
pub fn metres(m: f64) -> Position {
    Position::from_bits((m * f64::from(1 << 20)).round() as i64)
}

/// To the core's format, to nearest.
#[must_use]
pub fn distance(m: f64) -> Distance {
    Distance::from_bits((m * f64::from(1 << 20)).round() as i32)
}

/// To the core's format, to nearest.
#[must_use]
pub fn speed(mps: f64) -> Speed {
    Speed::from_bits((mps.max(0.0) * f64::from(1 << 23)).round() as i32)
}

/// To the core's format, to nearest.
#[must_use]
pub fn acceleration(mps2: f64) -> Acceleration {
    Acceleration::from_bits((mps2 * f64::from(1 << 25)).round() as i32)
}

/// To the core's format, to nearest.
#[must_use]
pub fn seconds(s: f64) -> Seconds {
    Seconds::from_bits((s * f64::from(1 << 29)).round() as i32)
}

/// To the core's format, to nearest.
#[must_use]
pub fn fine_seconds(s: f64) -> FineSeconds {
    FineSeconds::from_bits((s * f64::from(1 << 30)).round() as i32)
}

/// To the nearest twentieth, as a share is published.
#[must_use]
pub fn share(of_one: f64) -> Fraction {
    Fraction::from_milli((of_one * 20.0).round() as i32 * 50)
}

/// To thousandths.
#[must_use]
pub fn thousandths(of_one: f64) -> Fraction {
    Fraction::from_milli((of_one * 1e3).round() as i32)
}

/// To the core's format, to nearest.
#[must_use]
pub fn duration(s: f64) -> Duration {
    Duration::from_micros(micros(s))
}
