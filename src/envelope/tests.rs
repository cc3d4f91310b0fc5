//! Facts about the gate: each check against a one-line oracle with values dense around its boundary, and the safe distance
//! against a float64 simulation of emergency braking.

use super::*;
use crate::model::bound::Bound;
use crate::units::{Distance, FineSeconds, Fraction, Jerk};

const LIMITS: Envelope = Envelope {
    acceleration: Acceleration::from_mm_per_s2(2000),
    braking: Acceleration::from_mm_per_s2(6000),
    jerk: Jerk::from_mm_per_s3(10_000),
    speed: Speed::from_mm_per_s(30_000),
    margin: Distance::from_mm(500),
    delay: Duration::from_millis(10),
    lag_tolerance: Fraction::ZERO,
};
const PERIOD: Duration = Duration::from_millis(10);
const FREE: Situation = Situation { is_fresh: true, spare: Spare::ENDLESS };

fn ego(speed: i32, acceleration: i32, last: i32) -> Ego {
    Ego {
        position: Position::ZERO,
        speed: Speed::from_mm_per_s(speed),
        acceleration: Acceleration::from_mm_per_s2(acceleration),
        last: Acceleration::from_mm_per_s2(last),
        lag: FineSeconds::from_millis(300),
    }
}

fn around(mm: i32) -> impl Iterator<Item = i32> {
    (mm - 5..=mm + 5).chain([-60_000, -1, 0, 1, 60_000])
}

#[test]
fn nothing_beyond_the_absolute_limits_gets_out() {
    for desired in around(2000).chain(around(-6000)).map(Acceleration::from_mm_per_s2) {
        for last in around(2000).chain(around(-6000)).filter(|last| (-6000..=2000).contains(last)) {
            let out = gate(&LIMITS, desired, &ego(0, 0, last), &FREE, PERIOD, PERIOD);
            assert!(out <= LIMITS.acceleration && out >= LIMITS.braking.negated(), "{desired:?} {last:?}");
        }
    }
}

#[test]
fn no_change_is_faster_than_the_limit_on_jerk() {
    for desired in around(100).chain(around(-100)) {
        let out =
            gate(&LIMITS, Acceleration::from_mm_per_s2(desired), &ego(0, 0, 0), &FREE, PERIOD, PERIOD).to_mm_per_s2();
        assert_eq!(out, desired.clamp(-100, 100));
    }
}

#[test]
fn at_the_speed_limit_nothing_accelerates() {
    for speed in around(30_000) {
        let cap = speed_cap(&LIMITS, Speed::from_mm_per_s(speed));
        assert_eq!(cap == Acceleration::ZERO, speed >= 30_000, "{speed}");
    }
}

#[test]
fn a_stale_ego_does_not_accelerate() {
    let stale = Situation { is_fresh: false, ..FREE };
    for desired in around(0) {
        let out = gate(&LIMITS, Acceleration::from_mm_per_s2(desired), &ego(10_000, 0, 0), &stale, PERIOD, PERIOD);
        assert_eq!(out.to_mm_per_s2(), desired.clamp(-100, 0));
    }
}

#[test]
fn the_gate_only_ever_makes_a_demand_more_careful() {
    for desired in (-7000..3000).step_by(370) {
        for room in (-10_000..100_000).step_by(7_310) {
            let ego = ego(15_000, 0, desired.clamp(-6000, 2000));
            let spare = spare(&LIMITS, &ego, &Obstacle::standing(Position::from_mm(room)));
            let situation = Situation { is_fresh: true, spare };
            let out = gate(&LIMITS, Acceleration::from_mm_per_s2(desired), &ego, &situation, PERIOD, PERIOD);
            assert!(out.to_mm_per_s2() <= desired || desired < -6000, "{desired} {room} {out:?}");
        }
    }
}

#[test]
fn the_highest_and_the_lowest_command_are_a_tick_of_jerk_away_from_the_last_one() {
    for last in around(2000).chain(around(-6000)).chain(around(-5900)).filter(|last| last.abs() < 20_000) {
        let mm_per_s2 = Acceleration::from_mm_per_s2;
        assert_eq!(ceiling(&LIMITS, mm_per_s2(last), PERIOD).to_mm_per_s2(), last + 100);
        assert_eq!(floor(&LIMITS, mm_per_s2(last), PERIOD).to_mm_per_s2(), (last - 100).max(-6000), "{last}");
    }
}

#[test]
fn a_command_is_encoded_a_step_down_and_never_beyond_the_hardest_braking() {
    for braking in [6_000, 5_999] {
        let limits = Envelope { braking: Acceleration::from_mm_per_s2(braking), ..LIMITS };
        for bits in (-braking..2000).step_by(97).chain(-braking..-braking + 9).chain(-4..5).flat_map(|mm| {
            let word = Acceleration::from_mm_per_s2(mm).to_bits();
            [word - 1, word, word + 1]
        }) {
            let command = Acceleration::from_bits(bits).max(limits.braking.negated());
            let told = encodable(&limits, command);
            let steps = told.to_steps(ACCELERATION_STEPS);
            assert_eq!(Acceleration::from_steps(steps, ACCELERATION_STEPS), told);
            let is_next_down = told <= command && command < Acceleration::from_steps(steps + 1, ACCELERATION_STEPS);
            let is_bottom = Acceleration::from_steps(steps - 1, ACCELERATION_STEPS) < limits.braking.negated();
            assert!(is_next_down || is_bottom, "{braking} {command:?} {told:?}");
            assert!(told >= limits.braking.negated(), "{braking} {command:?} {told:?}");
        }
    }
}

#[test]
fn it_is_safe_as_long_as_emergency_braking_stops_in_time() {
    for (speed, last) in [(0, 200), (3_000, 0), (3_000, -5_950), (20_000, 1_000), (40_000, -6_000)] {
        let ego = ego(speed, last, last);
        let lowest = floor(&LIMITS, ego.last, PERIOD);
        for room in (-1..150_000).step_by(61) {
            // The theory's V <= S, in float64.
            let (b, j, h, lag) = (6.0, 10.0, 0.02, 0.3);
            let (v, a, u) = (f64::from(speed) / 1e3, f64::from(last) / 1e3, lowest.get().to_num::<f64>());
            let way = (v + lag * a + 0.5 * j * ((u + b) / j + h).powi(2)).powi(2) / (2.0 * b);
            let left = room as f64 / 1e3 - 0.5 - lag * v;
            if (way - left).abs() > 1e-3 {
                let found = is_safe(&LIMITS, &ego, &Obstacle::standing(Position::from_mm(room)), PERIOD);
                assert_eq!(found, way <= left, "{speed} {last} {room} {way}");
            }
        }
    }
}

#[test]
fn who_stands_and_is_told_to_brake_is_safe_wherever_it_stands() {
    for (last, expected) in [(-100, true), (0, true), (150, false)] {
        let found = is_safe(&LIMITS, &ego(0, 0, last), &Obstacle::standing(Position::ZERO), PERIOD);
        assert_eq!(found, expected, "{last}");
    }
}

#[test]
fn the_rear_of_a_vehicle_is_its_near_end_less_its_length() {
    use crate::model::bound::{AccelerationRange, Uncertainty};
    let (at, uncertainty) = (crate::time::Instant::ZERO, Uncertainty::default());
    for (front, length) in [(0, 0), (50_000, 4_800), (-7, 18_750)] {
        let bound = Bound::around(
            at,
            Position::from_mm(front),
            Speed::from_mm_per_s(7_000),
            &uncertainty,
            &AccelerationRange::WORST,
        );
        let found = Obstacle::rear(&bound, Distance::from_mm(length), &AccelerationRange::WORST);
        assert_eq!(found.position.to_mm(), front - i64::from(length));
        assert_eq!((found.speed.to_mm_per_s(), found.braking), (7_000, AccelerationRange::WORST.braking));
    }
}

#[test]
fn a_crossing_vehicle_is_waited_for_until_its_rear_has_left() {
    let (area, length, ends) = (Position::from_mm(50_000), Distance::from_mm(4_800), Position::from_mm(20_000));
    for front in 24_790..=24_810 {
        let stop = stop_before_conflict(area, Position::from_mm(front), length, ends);
        assert_eq!(stop.is_some(), front - 4_800 < 20_000, "{front}");
    }
}

/// The way until rest, if this demand holds for one tick and emergency braking follows; in float64, with steps of 1 ms.
fn braking_way(limits: &Envelope, speed: f64, acceleration: f64, first: f64) -> f64 {
    let (b, j) = (f64::from(limits.braking.to_mm_per_s2()) / 1e3, f64::from(limits.jerk.to_mm_per_s3()) / 1e3);
    let (mut v, mut a, mut u, mut way) = (speed, acceleration, first, 0.0);
    let mut tick = 0;
    while v > 0.0 && tick < 100_000 {
        if tick % 10 == 0 && tick > 0 {
            u = (u - j * 0.01).max(-b);
        }
        let h = 1e-3;
        let kept = (-h / 0.3f64).exp();
        let next = v + u * h + (a - u) * 0.3 * (1.0 - kept);
        way += 0.5 * (v + next.max(0.0)) * h;
        a = u + (a - u) * kept;
        v = next;
        tick += 1;
    }
    way
}

#[test]
fn the_largest_acceleration_leaves_enough_room_to_stop_and_not_much_more() {
    let (b, j, h, lag) = (6.0, 10.0, 0.01, 0.3);
    let (mut tightest, mut judged) = (f64::MAX, 0);
    for speed in (1_000..40_000).step_by(1_730) {
        for acceleration in [-5000, -2000, 0, 1500] {
            for room in (1_000..120_000).step_by(1_110) {
                let ego = ego(speed, acceleration, acceleration);
                let point = Obstacle::standing(Position::from_mm(room));
                let cap = distance_cap(&LIMITS, spare(&LIMITS, &ego, &point), PERIOD);
                if cap < LIMITS.braking.negated() || cap > LIMITS.acceleration {
                    continue;
                }
                let (first, v): (f64, f64) = (cap.get().to_num(), f64::from(speed) / 1e3);
                let left = room as f64 / 1e3 - braking_way(&LIMITS, v, f64::from(acceleration) / 1e3, first);
                // The margin, the delay, what the bounds on the lag's end and on the ramp give away, and the steps of the ramp.
                let rise = (first + b) / j;
                let given_away = 0.5 * b * lag * lag + j * (rise + h).powi(3) / 6.0;
                let z = (v + lag * f64::from(acceleration) / 1e3).max(0.0);
                let bound = |reaction: f64| (z + 0.5 * j * (rise + reaction).powi(2)).powi(2) / (2.0 * b);
                let delay = bound(2.0 * h) - bound(h);
                let staircase = v * 0.5 * j * rise * h / b;
                assert!(left <= 0.5 + delay + given_away + staircase + 0.05, "{speed} {acceleration} {room}: {left}");
                (tightest, judged) = (tightest.min(left), judged + 1);
            }
        }
    }
    assert!(tightest >= 0.5 && judged > 300, "{tightest} of {judged}");
}
