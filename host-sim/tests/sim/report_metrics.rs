//! Facts about the figures of merit, with values dense around each boundary.

use holdover_sim::measure::metrics::*;
use proptest::prelude::*;

/// Values at, just beside, and well beside a boundary.
fn around(boundary: f64) -> [f64; 7] {
    [
        boundary - 1.0,
        boundary - 0.01,
        boundary.next_down(),
        boundary,
        boundary.next_up(),
        boundary + 0.01,
        boundary + 1.0,
    ]
}

/// Samples every 10 ms from 0 on.
fn every_10_ms(values: impl IntoIterator<Item = f64>) -> Vec<(f64, f64)> {
    values.into_iter().enumerate().map(|(k, value)| (k as f64 * 0.01, value)).collect()
}

#[test]
fn an_empty_series_has_no_figure() {
    assert_eq!(rms(&[]), None);
    assert_eq!(max_abs(&[]), None);
    assert_eq!(percentile_abs(&[], 99.0), None);
    assert_eq!(smallest_gap(&[]), None);
    assert_eq!(lowest_speed(&[]), None);
    assert_eq!(full_stops(&[]), 0);
    assert_eq!(collisions(&[]), 0);
    assert_eq!(ErrorStatistics::of(&[]), ErrorStatistics { count: 0, rms: None, p99: None, max: None });
}

#[test]
fn a_sample_that_is_not_a_number_shows_in_every_figure() {
    for values in [[f64::NAN, 1.0, 2.0], [1.0, f64::NAN, 2.0], [1.0, 2.0, f64::NAN]] {
        assert!(rms(&values).is_some_and(f64::is_nan));
        assert!(max_abs(&values).is_some_and(f64::is_nan));
        assert!(percentile_abs(&values, 1.0).is_some_and(f64::is_nan));
        assert!(smallest_gap(&every_10_ms(values)).is_some_and(f64::is_nan));
    }
}

#[test]
fn rms_and_maximum_do_not_know_signs() {
    assert_eq!(rms(&[3.0, -4.0, 0.0, 0.0]), Some(2.5));
    assert_eq!(max_abs(&[3.0, -4.0, 1.0]), Some(4.0));
    assert_eq!(max_abs(&[-0.0]), Some(0.0));
}

#[test]
fn nearest_rank_follows_its_definition() {
    let five = [15.0, -20.0, 35.0, -40.0, 50.0];
    for (percent, expected) in [
        (0.0, 15.0),
        (5.0, 15.0),
        (20.0, 15.0),
        (20.1, 20.0),
        (30.0, 20.0),
        (40.0, 20.0),
        (50.0, 35.0),
        (100.0, 50.0),
        (250.0, 50.0),
    ] {
        assert_eq!(percentile_abs(&five, percent), Some(expected), "{percent} %");
    }
    let hundred: Vec<f64> = (1..=100).rev().map(f64::from).collect();
    for percent in 1..=100 {
        assert_eq!(percentile_abs(&hundred, f64::from(percent)), Some(f64::from(percent)));
    }
    assert_eq!(percentile_abs(&(1..=101).map(f64::from).collect::<Vec<_>>(), 99.0), Some(100.0));
    assert_eq!(percentile_abs(&[7.0], 99.0), Some(7.0));
}

#[test]
fn a_vehicle_stands_below_a_tenth_of_a_metre_per_second() {
    for speed in around(STANDING_BELOW_MPS) {
        let stops = full_stops(&every_10_ms([speed; 51]));
        assert_eq!(stops, usize::from(speed < 0.1), "speed {speed}");
    }
}

#[test]
fn a_full_stop_takes_half_a_second() {
    for standing in [1, 49, 50, 51, 100] {
        let speeds = [1.0; 30].into_iter().chain(vec![0.0; standing]).chain([1.0; 30]);
        assert_eq!(full_stops(&every_10_ms(speeds)), usize::from(standing >= 50), "{standing} samples");
    }
}

#[test]
fn a_stop_at_either_end_of_the_series_counts() {
    let at_the_start = [0.0; 50].into_iter().chain([5.0; 10]);
    assert_eq!(full_stops(&every_10_ms(at_the_start)), 1);
    for standing in [49, 50, 51, 52] {
        let at_the_end = [5.0; 10].into_iter().chain(vec![0.0; standing]);
        assert_eq!(full_stops(&every_10_ms(at_the_end)), usize::from(standing >= 51), "{standing} samples");
    }
}

#[test]
fn one_moving_sample_parts_two_stops() {
    let twice = [0.0; 50].into_iter().chain([0.1]).chain([0.0; 50]).chain([0.1]);
    assert_eq!(full_stops(&every_10_ms(twice)), 2);
    let neither = [0.0; 49].into_iter().chain([0.1]).chain([0.0; 49]).chain([0.1]);
    assert_eq!(full_stops(&every_10_ms(neither)), 0);
}

#[test]
fn touching_is_no_collision_and_each_episode_is_one() {
    for gap in around(0.0) {
        assert_eq!(collisions(&[(0.0, gap)]), usize::from(gap < 0.0), "gap {gap}");
    }
    assert_eq!(collisions(&every_10_ms([1.0, -0.1, -2.0, -0.1, 0.0, 1.0])), 1);
    assert_eq!(collisions(&every_10_ms([-0.1, 0.0, -0.1, 3.0, -0.1])), 3);
}

#[test]
fn the_smallest_gap_may_be_negative() {
    assert_eq!(smallest_gap(&every_10_ms([3.0, -0.5, 2.0])), Some(-0.5));
    assert_eq!(lowest_speed(&every_10_ms([3.0, 0.5, 2.0])), Some(0.5));
}

#[test]
fn errors_count_from_their_first_second_on() {
    // Ten steps of 0.1 s summed up are 0.999…9 s, which is the tick at 1 s all the same.
    let summed: f64 = [0.1; 10].iter().sum();
    assert!(summed < 1.0);
    let samples = [(0.0, 9.0), (0.99, 9.0), (1.0 - 1e-6, 9.0), (summed, 3.0), (1.0, -4.0), (1.01, 0.0), (2.0, 0.0)];
    let statistics = error_statistics_since(&samples, SETTLED_FROM_S);
    assert_eq!(statistics, ErrorStatistics { count: 4, rms: Some(2.5), p99: Some(4.0), max: Some(4.0) });
}

#[test]
fn each_age_belongs_to_one_half_open_class() {
    for (index, &(from, to)) in AGE_CLASSES_S.iter().enumerate() {
        for age in [from, from.next_up(), (from + to.min(9.0)) / 2.0, to.min(9.0).next_down()] {
            let counts = errors_by_age(&[(age, 1.0)]).map(|class| class.count);
            let mut expected = [0; AGE_CLASSES_S.len()];
            expected[index] = 1;
            assert_eq!(counts, expected, "age {age}");
        }
    }
    assert!(AGE_CLASSES_S.windows(2).all(|pair| pair[0].1 == pair[1].0), "no gap between classes");
    assert_eq!(errors_by_age(&[(-0.001, 1.0)])[0].count, 1);
    assert_eq!(errors_by_age(&[(f64::NAN, 1.0)])[5].count, 1);
}

#[test]
fn an_empty_age_class_has_a_count_of_zero_and_no_figures() {
    let classes = errors_by_age(&[(0.05, 2.0), (0.06, -2.0), (3.0, 1.0)]);
    assert_eq!(classes[0], ErrorStatistics { count: 2, rms: Some(2.0), p99: Some(2.0), max: Some(2.0) });
    assert_eq!(classes[1], ErrorStatistics::default());
    assert_eq!(classes[4].max, Some(1.0));
}

#[test]
fn outages_keep_the_order_they_were_asked_in() {
    let samples = [(0.5, 1.0), (4.0, -8.0), (0.1 + 0.2, 5.0), (0.5, -1.0), (2.0, 3.0)];
    let classes = errors_by_outage(&samples, &[4.0, 0.5, 0.3, 1.0]);
    assert_eq!(classes.iter().map(|class| class.count).collect::<Vec<_>>(), [1, 2, 1, 0]);
    assert_eq!(classes[0].max, Some(8.0));
    assert_eq!(classes[1].rms, Some(1.0));
    assert_eq!(classes[3].rms, None);
}

proptest! {
    #[test]
    fn percentiles_rise_to_the_maximum_and_are_samples(values in prop::collection::vec(-1e3..1e3, 1..200), p in 0.0..100.0) {
        let at = percentile_abs(&values, p).unwrap();
        let above = percentile_abs(&values, p + 5.0).unwrap();
        prop_assert!(at <= above && above <= max_abs(&values).unwrap());
        prop_assert!(values.iter().any(|value| value.abs() == at));
        let not_above = values.iter().filter(|value| value.abs() <= at).count() as f64;
        prop_assert!(not_above >= p / 100.0 * values.len() as f64 - 1e-9);
    }

    #[test]
    fn classes_by_age_share_all_samples_out(samples in prop::collection::vec((0.0..9.0, -5.0..5.0), 0..200)) {
        let classes = errors_by_age(&samples);
        prop_assert_eq!(classes.iter().map(|class| class.count).sum::<usize>(), samples.len());
        let errors: Vec<f64> = samples.iter().map(|sample| sample.1).collect();
        let largest = classes.iter().filter_map(|class| class.max).reduce(f64::max);
        prop_assert_eq!(largest, max_abs(&errors));
    }
}
