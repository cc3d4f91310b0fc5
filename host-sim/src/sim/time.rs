//! The time of a run: seconds since its start enter, GNSS time and microseconds leave.

use holdover::time::GnssTime;

/// GNSS time at the start of every run, in microseconds: an arbitrary moment, with all digits in use.
pub const EPOCH_US: u64 = 1_465_000_123_456_700;

/// GNSS time at this time of the run.
#[must_use]
pub fn gnss(at_s: f64) -> GnssTime {
    GnssTime::from_micros(EPOCH_US.saturating_add_signed(micros(at_s)))
}

/// The time in microseconds, rounded to nearest.
#[must_use]
pub fn micros(seconds: f64) -> i64 {
    (seconds * 1e6).round() as i64
}
