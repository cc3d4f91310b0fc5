//! Figures of merit: series of samples enter, numbers leave. There is no state and no output; the units are those named
//! here.
//!
//! Three rules hold throughout. An empty series has no figure (`None`), which is not the same as 0. A sample that is
//! not a number makes the figure not a number, so it never passes a limit unseen. Times are compared with a tolerance
//! of one nanosecond, because a tick's time is a product of a count and a step that binary fractions cannot hold.

/// Errors count from this time of a run on, in seconds. Before it the link has not settled.
pub const SETTLED_FROM_S: f64 = 1.0;

/// A vehicle slower than this, in m/s, is at standstill.
pub const STANDING_BELOW_MPS: f64 = 0.1;

/// A vehicle at standstill for this time or longer, in seconds, has made a full stop.
pub const FULL_STOP_FROM_S: f64 = 0.5;

/// The age classes `[from, to)` of an estimate, in seconds. The last class has no end.
pub const AGE_CLASSES_S: [(f64, f64); 6] =
    [(0.0, 0.1), (0.1, 0.5), (0.5, 1.0), (1.0, 2.0), (2.0, 5.0), (5.0, f64::INFINITY)];

const TIME_TOLERANCE_S: f64 = 1e-9;

/// The errors of one class of samples; every figure is `None` where the class is empty.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ErrorStatistics {
    /// Number of samples in the class.
    pub count: usize,
    /// Root of the mean square.
    pub rms: Option<f64>,
    /// 99th percentile of the magnitude, by nearest rank.
    pub p99: Option<f64>,
    /// Largest magnitude.
    pub max: Option<f64>,
}

impl ErrorStatistics {
    /// The figures of `errors`, signed or not, in their unit.
    pub fn of(errors: &[f64]) -> Self {
        Self { count: errors.len(), rms: rms(errors), p99: percentile_abs(errors, 99.0), max: max_abs(errors) }
    }
}

/// Root of the mean square of `values`.
pub fn rms(values: &[f64]) -> Option<f64> {
    let sum: f64 = values.iter().map(|value| value * value).sum();
    (!values.is_empty()).then(|| (sum / values.len() as f64).sqrt())
}

/// Largest magnitude of `values`.
pub fn max_abs(values: &[f64]) -> Option<f64> {
    values.iter().map(|value| value.abs()).reduce(|a, b| if a > b || a.is_nan() { a } else { b })
}

/// The `percent`-th percentile of the magnitudes by nearest rank: the `⌈percent/100 · n⌉`-th smallest of `n`. It is the
/// smallest for 0 or less, and the largest for 100 or more. It is always one of the samples, never between two.
pub fn percentile_abs(values: &[f64], percent: f64) -> Option<f64> {
    if values.is_empty() || values.iter().any(|value| value.is_nan()) {
        return values.first().map(|_| f64::NAN);
    }
    let mut magnitudes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
    // The product comes before the division: 99 · 100 / 100 is exactly 99, while 0.07 · 100 would be above 7.
    let rank = (percent * values.len() as f64 / 100.0).ceil().clamp(1.0, values.len() as f64) as usize;
    let (_, magnitude, _) = magnitudes.select_nth_unstable_by(rank - 1, f64::total_cmp);
    Some(*magnitude)
}

/// Smallest bumper gap of `(t_s, gap_m)` samples, in metres; negative where vehicles overlapped.
pub fn smallest_gap(gaps: &[(f64, f64)]) -> Option<f64> {
    smallest(gaps)
}

/// Lowest speed of `(t_s, speed_mps)` samples, in m/s.
pub fn lowest_speed(speeds: &[(f64, f64)]) -> Option<f64> {
    smallest(speeds)
}

fn smallest(samples: &[(f64, f64)]) -> Option<f64> {
    samples.iter().map(|sample| sample.1).reduce(|a, b| if a < b || a.is_nan() { a } else { b })
}

/// Full stops of one vehicle: episodes in which its speed stays below 0.1 m/s for 0.5 s or more. `speeds` are
/// `(t_s, speed_mps)` in order of time. A sample holds until the next one; the last one ends the series.
pub fn full_stops(speeds: &[(f64, f64)]) -> usize {
    let mut tally = StandTally::default();
    speeds.iter().for_each(|&(at, speed)| tally.note(at, speed));
    tally.finish()
}

/// The full stops of one vehicle so far.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StandTally {
    stops: usize,
    standing_since: Option<f64>,
    last_s: f64,
}

impl StandTally {
    /// A speed at a time, in order of time.
    pub fn note(&mut self, at: f64, speed: f64) {
        let since = *self.standing_since.get_or_insert(at);
        if speed >= STANDING_BELOW_MPS || speed.is_nan() {
            self.stops += usize::from(lasts(since, at));
            self.standing_since = None;
        }
        self.last_s = at;
    }

    /// All full stops; the last sample ends the series.
    pub fn finish(self) -> usize {
        self.stops + usize::from(self.standing_since.is_some_and(|since| lasts(since, self.last_s)))
    }
}

fn lasts(from: f64, to: f64) -> bool {
    to - from >= FULL_STOP_FROM_S - TIME_TOLERANCE_S
}

/// Collisions of one pair of vehicles: episodes in which the bumper gap is below 0. A gap of exactly 0 is not a
/// collision. `gaps` are `(t_s, gap_m)` in order of time.
pub fn collisions(gaps: &[(f64, f64)]) -> usize {
    let overlaps = |gap: f64| gap < 0.0;
    let first = gaps.first().is_some_and(|first| overlaps(first.1));
    usize::from(first) + gaps.windows(2).filter(|pair| !overlaps(pair[0].1) && overlaps(pair[1].1)).count()
}

/// The errors of `(t_s, error)` samples from `from_s` on.
pub fn errors_since(samples: &[(f64, f64)], from_s: f64) -> Vec<f64> {
    samples.iter().filter(|sample| sample.0 >= from_s - TIME_TOLERANCE_S).map(|sample| sample.1).collect()
}

/// The figures of `(t_s, error)` samples from `from_s` on.
pub fn error_statistics_since(samples: &[(f64, f64)], from_s: f64) -> ErrorStatistics {
    ErrorStatistics::of(&errors_since(samples, from_s))
}

/// The figures of `(age_s, error)` samples in each of [`AGE_CLASSES_S`], whose limits are compared exactly. An age
/// below 0 (a stamp ahead of the clock) belongs to the first class, an unknown age (not a number) to the last.
pub fn errors_by_age(samples: &[(f64, f64)]) -> [ErrorStatistics; AGE_CLASSES_S.len()] {
    let mut classes: [Vec<f64>; AGE_CLASSES_S.len()] = Default::default();
    for &(age, error) in samples {
        let class = AGE_CLASSES_S.iter().position(|&(_, to)| age < to).unwrap_or(AGE_CLASSES_S.len() - 1);
        classes[class].push(error);
    }
    classes.map(|errors| ErrorStatistics::of(&errors))
}

/// The figures of `(outage_s, error)` samples for each length in `outages_s`, in that order. A sample counts for the
/// length that it names. A sample of a length that is not in `outages_s` is not counted.
pub fn errors_by_outage(samples: &[(f64, f64)], outages_s: &[f64]) -> Vec<ErrorStatistics> {
    let of_length = |outage: f64| -> Vec<f64> {
        samples.iter().filter(|s| (s.0 - outage).abs() <= TIME_TOLERANCE_S).map(|s| s.1).collect()
    };
    outages_s.iter().map(|&outage| ErrorStatistics::of(&of_length(outage))).collect()
}
