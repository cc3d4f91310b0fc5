//! Distributions: values enter, the points of a cumulative distribution or the bins of a histogram leave.

/// A bin `[from, to)` of a histogram; the last one includes its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bin {
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Number of values in it.
    pub count: usize,
}

/// The empirical distribution of the finite magnitudes of `values`, as a staircase of `(magnitude, percentage)`.
/// Magnitudes below `least` are drawn at `least`, because a logarithmic axis has no place for 0.
pub fn cumulative(values: &[f64], least: f64) -> Vec<(f64, f64)> {
    let mut magnitudes: Vec<f64> = values.iter().map(|value| value.abs()).filter(|m| m.is_finite()).collect();
    magnitudes.sort_unstable_by(f64::total_cmp);
    let share = |rank: usize| 100.0 * rank as f64 / magnitudes.len() as f64;
    let step = |(rank, &magnitude): (usize, &f64)| {
        let at = magnitude.max(least);
        [(at, share(rank)), (at, share(rank + 1))]
    };
    magnitudes.iter().enumerate().flat_map(step).collect()
}

/// A histogram of the finite values, in `count` bins of equal width from the smallest to the largest; empty without
/// values. If all values are equal, there is a single bin around them.
pub fn histogram(values: &[f64], count: usize) -> Vec<Bin> {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let (Some(low), Some(high)) = (finite().reduce(f64::min), finite().reduce(f64::max)) else { return Vec::new() };
    if low == high || count <= 1 {
        let half = (high - low).max(low.abs() * 1e-3).max(1e-9) / 2.0;
        let middle = low + (high - low) / 2.0;
        return vec![Bin { from: middle - half, to: middle + half, count: finite().count() }];
    }
    let width = (high - low) / count as f64;
    let edge = |index: usize| low + width * index as f64;
    let mut bins: Vec<Bin> = (0..count).map(|i| Bin { from: edge(i), to: edge(i + 1), count: 0 }).collect();
    for value in finite() {
        let index = (((value - low) / width) as usize).min(count - 1);
        bins[index].count += 1;
    }
    bins
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distribution_climbs_by_equal_steps_to_the_whole() {
        assert_eq!(
            cumulative(&[0.0, -4.0, 2.0, f64::NAN, 2.0], 0.5),
            [(0.5, 0.0), (0.5, 25.0), (2.0, 25.0), (2.0, 50.0), (2.0, 50.0), (2.0, 75.0), (4.0, 75.0), (4.0, 100.0)]
        );
        assert!(cumulative(&[], 0.1).is_empty());
    }

    #[test]
    fn every_finite_value_falls_into_one_bin() {
        let values = [0.0, 0.999, 1.0, 1.5, 2.0, 9.0, 10.0, f64::INFINITY];
        let bins = histogram(&values, 10);
        assert_eq!(bins.iter().map(|bin| bin.count).collect::<Vec<_>>(), [2, 2, 1, 0, 0, 0, 0, 0, 0, 2]);
        assert_eq!(histogram(&[3.0; 7], 10).iter().map(|bin| bin.count).collect::<Vec<_>>(), [7]);
        assert!(histogram(&[f64::NAN], 10).is_empty());
    }
}
