//! The configuration is checked once, at start: every value enters at, just inside and just beyond the ends of its range,
//! and exactly the values outside are refused, by name.

use holdover::config::{Config, ConfigError, Envelope};
use holdover::time::Duration;
use holdover::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};
use holdover::wire::StationHash;

const CAPACITY: usize = 400;
const MS: i64 = 1_000;

/// Sets a value dense around both ends of its range, and far outside; it is refused exactly outside.
#[track_caller]
fn range(error: ConfigError, [low, high]: [i64; 2], set: impl Fn(&mut Config, i64)) {
    // An end in the far half of 64 bits is none.
    let around = |end: i64| (-3..=3).map(move |by| if end == i64::MAX / 2 { end } else { end + by });
    let far = [i64::from(i32::MIN), -1, 0, 1, i64::from(i32::MAX)];
    for value in around(low).chain(around(high)).chain(far) {
        let mut config = Config::car(StationHash(1));
        set(&mut config, value);
        let expected = if (low..=high).contains(&value) { Ok(()) } else { Err(error) };
        assert_eq!(config.check(CAPACITY), expected, "{value}");
    }
}

fn int(value: i64) -> i32 {
    value.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
}

#[test]
fn the_default_configuration_of_a_car_is_accepted() {
    assert_eq!(Config::car(StationHash(1)).check(CAPACITY), Ok(()));
}

#[test]
fn a_period_or_step_outside_its_range_is_refused() {
    range(ConfigError::Period, [MS, 100 * MS], |config, micros| config.period = Duration::from_micros(micros));
    range(ConfigError::Step, [MS, 1_000 * MS], |config, micros| {
        config.prediction.step = Duration::from_micros(micros);
        config.prediction.horizon = config.prediction.step.times(8).min(Duration::from_millis(25_500));
    });
}

#[test]
fn a_horizon_that_is_too_short_or_beyond_the_capacity_is_refused() {
    range(ConfigError::Horizon, [20 * MS, 3_990 * MS - 1], |config, micros| {
        config.prediction.step = Duration::from_millis(10);
        config.prediction.horizon = Duration::from_micros(micros); // with 400 steps, two of which are extra
    });
    range(ConfigError::Horizon, [2_000 * MS, 25_500 * MS], |config, micros| {
        config.prediction.step = Duration::from_millis(1_000);
        config.prediction.horizon = Duration::from_micros(micros);
    });
    let config = Config::car(StationHash(1));
    for (capacity, expected) in [(359, Ok(())), (358, Err(ConfigError::Horizon)), (0, Err(ConfigError::Horizon))] {
        assert_eq!((config.steps(), config.check(capacity)), (359, expected));
    }
}

#[test]
fn a_length_lag_or_body_outside_its_range_is_refused() {
    range(ConfigError::Length, [0, 40_950], |config, mm| config.length = Distance::from_mm(int(mm)));
    // With the envelope the longest lag is less, because the real one may be longer by its tolerance.
    range(ConfigError::Lag, [0, 1_998], |config, millis| {
        config.envelope = None;
        config.lag = FineSeconds::from_millis(int(millis));
    });
    range(ConfigError::Body, [300, 40_000], |config, kg| config.body.mass_kg = u32::try_from(kg).unwrap_or(0));
    range(ConfigError::Body, [1, 100_000], |config, r| config.body.ratio_milli = u32::try_from(r).unwrap_or(0));
    range(ConfigError::Body, [0, 20_000], |config, c| config.body.drag_milli = u32::try_from(c).unwrap_or(u32::MAX));
    range(ConfigError::Body, [0, 1_000_000], |config, c| {
        config.body.friction_milli = u32::try_from(c).unwrap_or(u32::MAX);
    });
    range(ConfigError::Body, [0, 10_000], |config, n| {
        config.body.mechanical_n = u32::try_from(n).unwrap_or(u32::MAX);
    });
}

#[test]
fn limits_outside_their_ranges_are_refused() {
    let set = |mm: i64| Acceleration::from_mm_per_s2(int(mm));
    // Below 730 mm/s² the free road asks for more than there is, which has a name of its own.
    range(ConfigError::Limits, [1, 20_460], |config, mm| {
        config.limits.acceleration = set(mm);
        config.law.free_road_acceleration = Acceleration::from_mm_per_s2(100).min(config.limits.acceleration);
        if (1..100).contains(&mm) {
            *config = Config::car(StationHash(1));
        }
    });
    range(ConfigError::Limits, [1, 6_000], |config, mm| config.limits.braking = set(mm));
    // The envelope's braking has a name of its own.
    range(ConfigError::Limits, [4_000, 20_460], |config, mm| {
        config.envelope = None;
        config.limits.emergency_braking = set(mm);
    });
    range(ConfigError::Limits, [201, 51_150], |config, mm| config.limits.jerk = Jerk::from_mm_per_s3(int(mm)));
}

#[test]
fn a_law_outside_its_ranges_is_refused() {
    range(ConfigError::TimeGap, [100, 3_995], |config, ms| config.law.time_gap = Seconds::from_millis(int(ms)));
    range(ConfigError::TimeGap, [100, 3_995], |config, ms| {
        config.law.silent_time_gap = Seconds::from_millis(int(ms));
    });
    range(ConfigError::Standstill, [0, 10_230], |config, mm| config.law.standstill = Distance::from_mm(int(mm)));
    range(ConfigError::Gain, [10, 3_999], |config, milli| config.law.gain = Gain::from_milli(int(milli)));
    range(ConfigError::Gain, [0, 3_999], |config, milli| config.law.damping = Seconds::from_millis(int(milli)));
    for (milli, ms, expected) in [
        (0, 1, Ok(())),
        (1, 30, Err(ConfigError::FeedForward)),
        (499, 30, Err(ConfigError::FeedForward)),
        (500, 30, Ok(())),
        (501, 30, Err(ConfigError::FeedForward)),
        (1_000, 30, Err(ConfigError::FeedForward)),
        (-500, 30, Err(ConfigError::FeedForward)),
        (500, 7, Err(ConfigError::FeedForward)),
        (500, 8, Ok(())),
    ] {
        for (of_step, of_period) in [(ms, 30), (30, ms)] {
            let mut config = Config::car(StationHash(1));
            config.law.feed_forward = Fraction::from_milli(milli);
            config.prediction.step = Duration::from_millis(of_step);
            config.prediction.horizon = config.prediction.step.times(8);
            config.period = Duration::from_millis(of_period);
            assert_eq!(config.check(CAPACITY), expected, "{milli} {of_step} {of_period}");
        }
    }
    range(ConfigError::Speed, [0, 65_534], |config, mm| config.law.target_speed = Speed::from_mm_per_s(int(mm)));
    range(ConfigError::Speed, [0, 65_534], |config, mm| config.law.max_speed = Speed::from_mm_per_s(int(mm)));
    range(ConfigError::CatchUp, [0, 15], |config, steps| {
        config.law.catch_up = Fraction::from_milli(int(50 * steps));
    });
    range(ConfigError::FreeRoad, [100, 2_500], |config, mm| {
        config.law.free_road_acceleration = Acceleration::from_mm_per_s2(int(mm));
    });
}

#[test]
fn no_gain_in_range_is_unstable_at_a_step_in_range() {
    // k δt² < 4 + 2 k δt (t_g + γ) with k < 4 and δt <= 1 s always holds; the name is there for wider ranges to come.
    for gain in [10, 3_999] {
        for time_gap in [100, 3_995] {
            for damping in [0, 3_999] {
                for step in [1, 1_000] {
                    let mut config = Config::car(StationHash(1));
                    config.law.gain = Gain::from_milli(gain);
                    config.law.time_gap = Seconds::from_millis(time_gap);
                    config.law.damping = Seconds::from_millis(damping);
                    config.prediction.step = Duration::from_millis(step);
                    config.prediction.horizon = Duration::from_millis(step * 10);
                    assert_eq!(config.check(CAPACITY), Ok(()), "{gain} {time_gap} {damping} {step}");
                }
            }
        }
    }
}

#[test]
fn times_of_the_link_outside_their_ranges_are_refused() {
    type Set = fn(&mut Config, Duration);
    let at_least_one: [Set; 6] = [
        |config, time| config.link.period = time,
        |config, time| config.link.slot_reuse = time,
        |config, time| config.link.holdover = time,
        |config, time| config.link.ego_timeout = time,
        |config, time| config.link.request_timeout = time,
        |config, time| config.link.sync_timeout = time,
    ];
    for set in at_least_one {
        range(ConfigError::Link, [1, i64::MAX / 2], |config, micros| set(config, Duration::from_micros(micros)));
    }
    let car = Config::car(StationHash(1)).link;
    let bounded: [(Set, [i64; 2]); 5] = [
        (|config, time| config.link.tolerance = time, [0, i64::MAX / 2]),
        (|config, time| config.link.stale = time, [1, 10_000 * MS]),
        // What the clock may be off by must not be refused as future.
        (|config, time| config.link.future = time, [car.clock_error.as_micros(), 1_000 * MS - 1]),
        (|config, time| config.link.clock_error = time, [0, car.future.as_micros()]),
        (|config, time| config.link.assumed_delay = time, [0, 2_000 * MS]),
    ];
    for (set, ends) in bounded {
        range(ConfigError::Link, ends, |config, micros| set(config, Duration::from_micros(micros)));
    }
}

#[test]
fn an_envelope_outside_its_ranges_is_refused() {
    const SOUND: Envelope = Envelope {
        acceleration: Acceleration::from_mm_per_s2(2_000),
        braking: Acceleration::from_mm_per_s2(6_000),
        jerk: Jerk::from_mm_per_s3(10_000),
        speed: Speed::from_mm_per_s(30_000),
        margin: Distance::from_mm(500),
        delay: Duration::from_millis(30),
        lag_tolerance: Fraction::from_milli(200),
    };
    type Set = fn(&mut Envelope, i32);
    // In bits of their formats; braking and jerk from what a command can say, braking up to the car's emergency braking.
    let least_braking = i64::from(Acceleration::from_mm_per_s2(100).to_bits());
    let least_jerk = i64::from(Jerk::from_mm_per_s3(100).to_bits());
    let hardest = i64::from(Config::car(StationHash(1)).limits.emergency_braking.to_bits());
    let bounded: [(Set, [i64; 2]); 7] = [
        (|envelope, bits| envelope.acceleration = Acceleration::from_bits(bits), [1, i64::MAX / 2]),
        (|envelope, bits| envelope.braking = Acceleration::from_bits(bits), [least_braking, hardest]),
        (|envelope, bits| envelope.jerk = Jerk::from_bits(bits), [least_jerk, i64::MAX / 2]),
        (|envelope, bits| envelope.speed = Speed::from_bits(bits), [1, i64::MAX / 2]),
        (|envelope, bits| envelope.margin = Distance::from_bits(bits), [0, i64::MAX / 2]),
        (|envelope, micros| envelope.delay = Duration::from_micros(micros.into()), [0, 500 * MS]),
        (|envelope, bits| envelope.lag_tolerance = Fraction::from_bits(bits), [0, i64::from(Fraction::ONE.to_bits())]),
    ];
    for (set, ends) in bounded {
        range(ConfigError::Envelope, ends, |config, bits| {
            let mut envelope = SOUND;
            set(&mut envelope, int(bits));
            config.envelope = Some(envelope);
        });
    }
    // The longest lag that is tolerated has to be one that can be computed with.
    for (millis, expected) in [(0, Ok(())), (1_664, Ok(())), (1_666, Err(ConfigError::Envelope))] {
        let lag = FineSeconds::from_millis(millis);
        let config = Config { lag, envelope: Some(SOUND), ..Config::car(StationHash(1)) };
        assert_eq!(config.check(CAPACITY), expected, "{millis}");
    }
}

#[test]
fn a_unit_is_not_made_of_a_configuration_that_is_refused() {
    let config = Config { period: Duration::ZERO, ..Config::car(StationHash(1)) };
    assert_eq!(holdover::OnboardUnit::<2, 2, CAPACITY>::new(&config).err(), Some(ConfigError::Period));
}
