//! Facts about the bound's arithmetic: it is never inside of what float64 says, and outside of it by micrometres only; with values dense
//! around every boundary.

use super::*;

const AT: Instant = Instant::from_micros(1_000_000_000);
const REACH: AccelerationRange = AccelerationRange {
    acceleration: Acceleration::from_mm_per_s2(2_500),
    braking: Acceleration::from_mm_per_s2(8_000),
};
const EXACT: Uncertainty =
    Uncertainty { position: Distance::ZERO, speed: Speed::ZERO, earlier: Duration::ZERO, later: Duration::ZERO };

fn later(micros: i64) -> Instant {
    AT.plus(Duration::from_micros(micros))
}

fn around(mm: i64, mm_per_s: i32, uncertainty: &Uncertainty) -> Bound {
    Bound::around(AT, Position::from_mm(mm), Speed::from_mm_per_s(mm_per_s), uncertainty, &REACH)
}

/// The four ends, in metres and metres per second.
fn ends(bound: &Bound) -> [f64; 4] {
    let metres = |position: Position| position.to_bits() as f64 / f64::from(1 << 20);
    let mps = |speed: Speed| f64::from(speed.to_bits()) / f64::from(1 << 23);
    [
        metres(bound.lowest_position()),
        metres(bound.highest_position()),
        mps(bound.lowest_speed()),
        mps(bound.highest_speed()),
    ]
}

/// Braking from `v` for `t`, in float64: way and speed.
fn braked(v: f64, b: f64, t: f64) -> (f64, f64) {
    let t = t.min(v / b);
    (v * t - 0.5 * b * t * t, v - b * t)
}

/// Accelerating up to the top speed, in float64: way and speed.
fn accelerated(v: f64, a: f64, t: f64) -> (f64, f64) {
    let rising = t.min((65.534 - v).max(0.0) / a);
    let top = v + a * rising;
    ((v + 0.5 * a * rising) * rising + top * (t - rising), top)
}

/// Moments around one moment: microseconds from it, and far away from it.
fn moments(around: f64) -> impl Iterator<Item = i64> {
    let around = (around * 1e6).round() as i64;
    (around - 4..=around + 4).chain([1, 2, 999, 10_000, 1_000_000, 60_000_000]).filter(|micros| *micros > 0)
}

#[test]
fn both_ends_are_those_of_float64_rounded_away_from_the_truth() {
    for mm_per_s in [0, 1, 2, 777, 8_000, 13_400, 40_001, 65_533, 65_534] {
        let v = f64::from(mm_per_s) / 1e3;
        let start = around(123_456, mm_per_s, &EXACT);
        for micros in moments(v / 8.0).chain(moments((65.534 - v) / 2.5)) {
            let t = micros as f64 * 1e-6;
            let [low, high, slow, fast] = ends(&start.after(later(micros), &REACH));
            let (near, near_speed) = braked(v, 8.0, t);
            let (far, far_speed) = accelerated(v, 2.5, t);
            // Rounded to micrometres and then to words. An error of up to 2 µm/s in the speed grows with time.
            let off = 4e-6 + 2e-6 * t;
            for (outer, truth, sign, off) in [
                (low, 123.456 + near, 1.0, off),
                (high, 123.456 + far, -1.0, off),
                (slow, near_speed, 1.0, 4e-6),
                (fast, far_speed, -1.0, 4e-6),
            ] {
                let outside = (truth - outer) * sign;
                // A decimal start loses 0.5 µm by its word.
                assert!((-5e-7..off).contains(&outside), "{mm_per_s} mm/s after {micros} µs: {outer} for {truth}");
            }
        }
    }
}

#[test]
fn a_bound_is_left_as_it_is_at_its_own_instant_and_before() {
    let bound = around(5_000, 9_000, &EXACT);
    for micros in [0, -1, -5_000_000] {
        assert_eq!(bound.after(later(micros), &REACH), bound);
    }
    assert_ne!(bound.after(later(1), &REACH), bound);
    assert_eq!(bound.after(later(77), &REACH).at(), later(77));
}

#[test]
fn after_an_hour_the_far_end_says_nothing_and_the_near_end_has_stopped() {
    let bound = around(5_000, 60_000, &EXACT);
    let hour = bound.after(later(LONGEST), &REACH);
    assert!(hour.highest_position() < Position::from_mm(240_000_000));
    let more = bound.after(later(LONGEST + 1), &REACH);
    assert!(
        more.highest_position() >= Position::from_mm(8_000_000_000) && more.highest_speed() >= hour.highest_speed()
    );
    assert_eq!(more.lowest_position(), hour.lowest_position());
    assert_eq!(more.lowest_speed(), Speed::ZERO);
}

#[test]
fn the_nearest_stop_is_v_squared_over_2_b_ahead_and_stays_there() {
    for mm_per_s in (0..=65_534).step_by(331) {
        let bound = around(0, mm_per_s, &EXACT);
        let stop = bound.nearest_stop(&REACH);
        let exact = (f64::from(mm_per_s) / 1e3).powi(2) / 16.0;
        let found = stop.to_bits() as f64 / f64::from(1 << 20);
        assert!((0.0..2e-5).contains(&(exact - found)) || (exact - found).abs() < 1e-9, "{mm_per_s}: {found} {exact}");
        // Rounding may move it back by micrometres, but never forward.
        for micros in [10_000, 1_000_000, 9_000_000, 100_000_000] {
            let again = bound.after(later(micros), &REACH).nearest_stop(&REACH);
            assert!(again <= stop && stop.ahead_of(again) < Distance::from_mm(1), "{mm_per_s} {micros}");
        }
    }
}

#[test]
fn accuracies_widen_to_both_sides_and_a_speed_is_never_below_zero() {
    for (position, speed) in [(0, 0), (1, 1), (50, 20), (6_300, 1_240)] {
        let uncertainty =
            Uncertainty { position: Distance::from_mm(position), speed: Speed::from_mm_per_s(speed), ..EXACT };
        for mm_per_s in [0, 1, 20, 1_239, 1_240, 1_241, 30_000] {
            let [low, high, slow, fast] = ends(&around(10_000, mm_per_s, &uncertainty));
            let (off, faster, v) = (f64::from(position) / 1e3, f64::from(speed) / 1e3, f64::from(mm_per_s) / 1e3);
            for (found, exact) in
                [(low, 10.0 - off), (high, 10.0 + off), (slow, (v - faster).max(0.0)), (fast, v + faster)]
            {
                assert!((found - exact).abs() < 4e-6, "{position} {speed} {mm_per_s}: {found} {exact}");
            }
        }
    }
}

#[test]
fn a_doubtful_instant_lets_the_far_end_run_ahead_and_both_speeds_apart() {
    for (earlier, after) in [(0, 0), (500, 500), (1_960_000, 40_000), (500, -200), (500, -500), (500, -900)] {
        let (earlier, later) = (Duration::from_micros(earlier), Duration::from_micros(after));
        let bound = around(10_000, 20_000, &Uncertainty { earlier, later, ..EXACT });
        assert_eq!(bound.at(), AT.plus(later));
        let t = (earlier.plus(later).as_micros().max(0)) as f64 * 1e-6;
        let [low, high, slow, fast] = ends(&bound);
        let (way, top) = accelerated(20.0, 2.5, t);
        for (found, exact) in [(low, 10.0), (high, 10.0 + way), (slow, 20.0 - 8.0 * t), (fast, top)] {
            assert!((found - exact).abs() < 1e-5, "{earlier:?} {later:?}: {found} {exact}");
        }
    }
}

#[test]
fn two_bounds_agree_as_long_as_they_touch() {
    let uncertainty = Uncertainty { position: Distance::from_mm(1_000), speed: Speed::from_mm_per_s(1_000), ..EXACT };
    let one = around(0, 10_000, &uncertainty);
    for mm in [-2_001, -2_000, -1_999, -1, 0, 1, 1_999, 2_000, 2_001] {
        for mm_per_s in [7_999, 8_000, 8_001, 10_000, 11_999, 12_000, 12_001] {
            let other = around(mm, mm_per_s, &uncertainty);
            let agree = mm.abs() <= 2_000 && (mm_per_s - 10_000i32).abs() <= 2_000;
            for both in [one.and(&other, &REACH), other.and(&one, &REACH)] {
                assert_eq!(both.is_some(), agree, "{mm} {mm_per_s}");
                let Some(both) = both else { continue };
                let ([low, high, slow, fast], [l1, h1, s1, f1], [l2, h2, s2, f2]) =
                    (ends(&both), ends(&one), ends(&other));
                assert_eq!([low, high, slow, fast], [l1.max(l2), h1.min(h2), s1.max(s2), f1.min(f2)]);
            }
        }
    }
}

#[test]
fn two_bounds_are_compared_at_the_later_instant() {
    let (early, late) = (around(0, 10_000, &EXACT), around(1_000, 9_000, &EXACT).after(later(1_000_000), &REACH));
    let both = early.and(&late, &REACH);
    assert_eq!(both, late.and(&early, &REACH));
    assert_eq!(both.map(|both| both.at()), Some(late.at()));
}

#[test]
fn what_is_published_is_taken_but_a_rest_takes_finite_time() {
    let limits = |acceleration, emergency| Limits {
        acceleration: Acceleration::from_mm_per_s2(acceleration),
        braking: Acceleration::from_mm_per_s2(1_000),
        jerk: crate::units::Jerk::from_mm_per_s3(1_000),
        emergency_braking: Acceleration::from_mm_per_s2(emergency),
    };
    for value in [0, 99, 100, 101, 8_000, 20_460] {
        let reach = AccelerationRange::published(&limits(value, value));
        assert_eq!(
            (reach.acceleration.to_mm_per_s2(), reach.braking.to_mm_per_s2()),
            ((value + 10).max(100), value.max(1_000)),
            "the harder of the two brakings, and a step of the effort"
        );
    }
    assert_eq!(AccelerationRange::published(&limits(300, 7_000)).braking.to_mm_per_s2(), 7_000);
    assert_eq!(AccelerationRange::published(&limits(300, 7_000)).acceleration.to_mm_per_s2(), 310);
}

#[test]
fn quotients_are_rounded_to_the_side_they_say() {
    for dividend in -25..=25i64 {
        for divisor in 1..=7i64 {
            let exact = dividend as f64 / divisor as f64;
            assert_eq!(
                (floor(dividend, divisor), ceil(dividend, divisor)),
                (exact.floor() as i64, exact.ceil() as i64)
            );
        }
    }
    for word in -3_000_000..=3_000_000i64 {
        if word % 997 == 0 {
            let exact = word as f64 / 1.048_576;
            assert_eq!((micro_down_64(word, 20), micro_up_64(word, 20)), (exact.floor() as i64, exact.ceil() as i64));
            assert_eq!(floor_shifted(word, 20), (word as f64 * 1.048_576).floor() as i64);
        }
    }
}

#[test]
fn a_bound_that_is_moved_contains_what_it_contained_there() {
    let reach = AccelerationRange::WORST;
    let speed = Speed::from_mm_per_s(10_000);
    let bound = Bound::around(Instant::ZERO, Position::from_mm(5_000), speed, &Uncertainty::default(), &reach);
    for bits in [-1_048_577, -1_048_576, -2, -1, 0, 1, 2, 1_048_576, 1_048_577, i32::MAX, i32::MIN] {
        let moved = bound.shifted(Distance::from_bits(bits));
        let exact = |position: Position| position.to_bits() + i64::from(bits);
        let near = exact(bound.lowest_position()) - moved.lowest_position().to_bits();
        let far = moved.highest_position().to_bits() - exact(bound.highest_position());
        // A micrometre is 1.05 bits, and each reading rounds once more.
        assert!((0..=3).contains(&near) && (0..=3).contains(&far), "{bits}: {near} {far}");
        assert_eq!((moved.lowest_speed(), moved.highest_speed()), (bound.lowest_speed(), bound.highest_speed()));
        assert_eq!(moved.at(), bound.at());
    }
}

#[test]
fn a_position_stays_inside_its_bound_however_far_the_unit_has_driven() {
    for km in [16, 8_796, 8_797, 40_075, 500_000, -8_797, -500_000] {
        let position = Position::from_mm(km * 1_000_000 + 1);
        let bound = Bound::around(AT, position, Speed::ZERO, &Uncertainty::default(), &REACH);
        let (low, high) = (bound.lowest_position(), bound.highest_position());
        assert!(low <= position && position <= high, "{km} km: {low:?} {high:?}");
        let [behind, ahead] = [position.ahead_of(low), high.ahead_of(position)];
        assert!(behind.max(ahead) <= Distance::from_bits(2), "{km} km: {behind:?} {ahead:?}");
    }
}

#[test]
fn a_place_and_a_speed_come_near_a_bound_to_within_what_is_allowed_and_two_micrometres() {
    let wide = Uncertainty { position: Distance::from_mm(50), speed: Speed::from_mm_per_s(30), ..EXACT };
    let bound = around(10_000, 15_000, &wide);
    let is_near = |mm: f64, mm_per_s: f64| {
        let position = Position::from_bits((mm * 1e-3 * f64::from(1 << 20)).round() as i64);
        let speed = Speed::from_bits((mm_per_s * 1e-3 * f64::from(1 << 23)).round() as i32);
        bound.comes_near(position, Distance::from_mm(10), speed, Speed::from_mm_per_s(5))
    };
    for side in [-1.0, 1.0] {
        assert!(is_near(10_000.0 + side * 59.999, 15_000.0 + side * 34.999));
        assert!(!is_near(10_000.0 + side * 60.004, 15_000.0) && !is_near(10_000.0, 15_000.0 + side * 35.004));
    }
}

#[test]
fn two_bounds_are_apart_by_position_alone_and_at_the_later_instant() {
    let narrow = Uncertainty { position: Distance::from_mm(100), ..EXACT };
    let is_apart = |mm: i64, micros: i64, mm_per_s: i32| {
        let (position, speed) = (Position::from_mm(mm), Speed::from_mm_per_s(mm_per_s));
        let other = Bound::around(later(micros), position, speed, &narrow, &REACH);
        let here = around(10_000, 15_000, &narrow);
        assert_eq!(here.is_apart_from(&other, &REACH), other.is_apart_from(&here, &REACH));
        here.is_apart_from(&other, &REACH)
    };
    // At the same instant they touch 0.2 m apart, whatever their speeds.
    for side in [-1, 1] {
        assert!(!is_apart(10_000 + side * 199, 0, 0) && is_apart(10_000 + side * 201, 0, 15_000));
    }
    // At 15 m/s a vehicle is 1.5 m farther on after 0.1 s, and was 1.5 m farther back before; the limits add 12.5 and 40 mm.
    for micros in [-100_000, 100_000] {
        let there = 10_000 + micros * 15 / 1_000;
        assert!(!is_apart(there, micros, 15_000));
        assert!(is_apart(there + 245, micros, 15_000) && is_apart(there - 245, micros, 15_000), "{micros}");
    }
}
