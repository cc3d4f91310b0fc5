//! The distribution of a measured time: values enter; their median, 99th percentile and maximum leave.

use serde::Serialize;

/// The figures, in milliseconds; `None` without values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Median, by nearest rank.
    pub p50_ms: Option<f64>,
    /// 99th percentile, by nearest rank.
    pub p99_ms: Option<f64>,
    /// Largest.
    pub max_ms: Option<f64>,
}

impl Spread {
    /// The figures of values in microseconds.
    #[must_use]
    pub fn of(micros: &[i64]) -> Self {
        let mut sorted = micros.to_vec();
        sorted.sort_unstable();
        let millis = |rank: usize| sorted.get(rank.clamp(1, sorted.len().max(1)) - 1).map(|value| *value as f64 * 1e-3);
        Self {
            p50_ms: millis(sorted.len().div_ceil(2)),
            p99_ms: millis((sorted.len() * 99).div_ceil(100)),
            max_ms: millis(sorted.len()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_by_nearest_rank() {
        let values: Vec<i64> = (1..=200).rev().map(|millis| millis * 1000).collect();
        assert_eq!(Spread::of(&values), Spread { p50_ms: Some(100.0), p99_ms: Some(198.0), max_ms: Some(200.0) });
        assert_eq!(Spread::of(&[1500]), Spread { p50_ms: Some(1.5), p99_ms: Some(1.5), max_ms: Some(1.5) });
        assert_eq!(Spread::of(&[]), Spread::default());
    }
}
