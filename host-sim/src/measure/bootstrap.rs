//! Bootstrap intervals: how many runs there are and a figure of any choice of them enter; the interval that holds the figure
//! with 95 % confidence leaves.
//!
//! The runs are drawn again with replacement, as many as there are, and the figure is taken of each draw; the interval is
//! from the 2.5th to the 97.5th percentile of these figures (B. Efron, 1979). Only whole runs are drawn, because what one run
//! measures at two times depends on itself. A largest value has no such interval: no draw exceeds it. The draws are the same
//! each time, and on one thread, so that an interval depends on the results alone.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// An interval: its lower and its upper end.
pub type Interval = [f64; 2];

/// With fewer runs than this an interval would say little.
pub const LEAST_RUNS: usize = 5;

/// Number of draws.
const DRAWS: usize = 1000;

/// Seed of the draws.
const SEED: u64 = 1979;

/// The interval of a figure of `runs` runs; the figure is told the numbers of the runs that were drawn. `None` for too few
/// runs, and where a draw has no figure.
pub fn interval(runs: usize, figure: impl Fn(&[usize]) -> Option<f64>) -> Option<Interval> {
    if runs < LEAST_RUNS {
        return None;
    }
    let mut generator = ChaCha8Rng::seed_from_u64(SEED);
    let mut drawn = vec![0; runs];
    let mut figures = Vec::with_capacity(DRAWS);
    for _ in 0..DRAWS {
        // The bias of the remainder is below 1e-15.
        drawn.fill_with(|| (generator.next_u64() % runs as u64) as usize);
        figures.push(figure(&drawn).filter(|figure| figure.is_finite())?);
    }
    figures.sort_unstable_by(f64::total_cmp);
    let end = |share: f64| figures[((DRAWS - 1) as f64 * share).round() as usize];
    Some([end(0.025), end(0.975)])
}

/// The mean of what some runs measured.
#[must_use]
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// The interval of the mean of what each run measured.
#[must_use]
pub fn of_mean(values: &[f64]) -> Option<Interval> {
    interval(values.len(), |drawn| mean(&drawn.iter().map(|run| values[*run]).collect::<Vec<_>>()))
}

/// The squares of one run's errors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Squares {
    sum: f64,
    count: usize,
}

impl Squares {
    /// Those of these errors.
    pub fn of(errors: impl IntoIterator<Item = f64>) -> Self {
        errors
            .into_iter()
            .fold(Self::default(), |all, error| Self { sum: all.sum + error * error, count: all.count + 1 })
    }

    /// The root of the mean square of all these runs together.
    pub fn rms<'a>(runs: impl IntoIterator<Item = &'a Self>) -> Option<f64> {
        let all = runs
            .into_iter()
            .fold(Self::default(), |all, run| Self { sum: all.sum + run.sum, count: all.count + run.count });
        (all.count > 0).then(|| (all.sum / all.count as f64).sqrt())
    }
}

/// An interval in words: `1.2 to 1.4`; nothing without one.
#[must_use]
pub fn spelled(interval: Option<Interval>, number: impl Fn(f64) -> String) -> String {
    interval.map_or(String::new(), |[low, high]| format!("{} to {}", number(low), number(high)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_mean_is_that_of_the_theory() {
        // A uniform distribution of 0 to 1 has a standard deviation of 0.2887, the mean of 100 one of 0.02887.
        let values: Vec<f64> = (0..100).map(|n| (f64::from(n) + 0.5) / 100.0).collect();
        let [low, high] = of_mean(&values).unwrap();
        assert!(
            (low - (0.5 - 1.96 * 0.02887)).abs() < 0.006 && (high - (0.5 + 1.96 * 0.02887)).abs() < 0.006,
            "{low} {high}"
        );
        assert_eq!(of_mean(&values), of_mean(&values));
    }

    #[test]
    fn ninety_five_of_a_hundred_intervals_hold_the_truth() {
        let mut generator = ChaCha8Rng::seed_from_u64(7);
        let mut uniform = || (generator.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        let holds = (0..200).filter(|_| {
            let values: Vec<f64> = (0..30).map(|_| uniform()).collect();
            let [low, high] = of_mean(&values).unwrap();
            (low..=high).contains(&0.5)
        });
        let share = holds.count() as f64 / 200.0;
        assert!((0.89..=0.98).contains(&share), "{share}");
    }

    #[test]
    fn few_runs_and_runs_without_a_figure_have_no_interval() {
        assert_eq!(of_mean(&[1.0; LEAST_RUNS - 1]), None);
        assert_eq!(of_mean(&[1.0; LEAST_RUNS]), Some([1.0, 1.0]));
        assert_eq!(interval(9, |drawn| (drawn[0] > 0).then_some(1.0)), None);
        let runs = [Squares::of([3.0, -3.0]), Squares::of([]), Squares::of([0.0, 0.0])];
        assert_eq!(Squares::rms(&runs), Some(4.5f64.sqrt()));
        assert_eq!(Squares::rms(&runs[1..2]), None);
    }
}
