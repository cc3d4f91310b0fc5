//! The throughput of a corridor: the times at which vehicles left enter; their number a minute while vehicles arrive leaves.

/// The roads fill for so long, in seconds.
pub const WARM_UP_S: f64 = 60.0;

/// Exits a minute from [`WARM_UP_S`] on until the arrivals end, on average over runs. `None` if the arrivals end before, and without runs.
#[must_use]
pub fn exits_per_min<'a>(runs: impl IntoIterator<Item = &'a [f64]>, duration_s: f64) -> Option<f64> {
    let span_s = duration_s - WARM_UP_S;
    let counts: Vec<usize> = runs.into_iter().map(|exits_s| within(exits_s, duration_s)).collect();
    let seen_s = span_s * counts.len() as f64;
    (seen_s > 0.0).then(|| 60.0 * counts.iter().sum::<usize>() as f64 / seen_s)
}

fn within(exits_s: &[f64], duration_s: f64) -> usize {
    exits_s.iter().filter(|exit_s| (WARM_UP_S..duration_s).contains(*exit_s)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exits_count_from_a_minute_on_until_the_arrivals_end() {
        let exits_s = [10.0, 59.9, 60.0, 100.0, 179.9, 180.0, 250.0];
        assert_eq!(exits_per_min([&exits_s[..]], 180.0), Some(1.5));
        let runs = [&exits_s[..], &[]];
        assert_eq!(exits_per_min(runs, 180.0), Some(0.75));
    }

    #[test]
    fn where_the_arrivals_end_within_a_minute_there_is_no_figure() {
        assert_eq!(exits_per_min([&[30.0][..]], 60.0), None);
        assert_eq!(exits_per_min([], 600.0), None);
    }
}
