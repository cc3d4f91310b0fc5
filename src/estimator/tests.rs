//! Facts about horizons: what they are anchored to, how they are extended, and what becomes of a follower whose
//! predecessor is not there.

use super::*;
use crate::config::Config;
use crate::model::{State, Step, TargetStep};
use crate::peers::plausibility::{Belief, Certainty};
use crate::time::Stamp;
use crate::units::{Acceleration, FineSeconds, Fraction, Gain, Jerk, Position, Seconds, Speed};
use crate::wire::driving_parameters::{DrivingParameters, Limits};

const STEPS: usize = 64;
const GRID: Grid = Grid { origin: Instant::from_micros(9_000_000), step: Duration::from_millis(10) };
const MODEL: Model = Model::HOLDOVER;

/// A leader that wants 10 m/s.
pub(crate) fn leader() -> DrivingParameters {
    DrivingParameters {
        length: Distance::from_mm(4_800),
        standstill: Distance::from_mm(2_000),
        predecessor: Predecessor::None,
        target_speed: Speed::from_mm_per_s(10_000),
        catch_up: Fraction::from_milli(200),
        time_gap: Seconds::from_millis(1_000),
        gain: Gain::from_milli(500),
        damping: Seconds::from_millis(2_000),
        feed_forward: Fraction::ZERO,
        lag: FineSeconds::from_millis(300),
        limits: Limits {
            acceleration: Acceleration::from_mm_per_s2(2_500),
            braking: Acceleration::from_mm_per_s2(4_000),
            jerk: Jerk::from_mm_per_s3(5_000),
            emergency_braking: Acceleration::from_mm_per_s2(8_000),
        },
        horizon_tenths: 0,
    }
}

fn follower() -> DrivingParameters {
    DrivingParameters { predecessor: Predecessor::Station(StationHash(1)), ..leader() }
}

/// A sample of this age before the grid's step 0.
fn sample(age_us: i64, mm_per_s: i32, mm_per_s2: i32) -> Sample {
    let at = GRID.origin.minus(Duration::from_micros(age_us));
    Sample {
        at,
        received: at,
        stamp: Stamp::default(),
        position: Position::from_mm(5_000_000),
        speed: Speed::from_mm_per_s(mm_per_s),
        acceleration: Acceleration::from_mm_per_s2(mm_per_s2),
        demand: Acceleration::from_mm_per_s2(mm_per_s2),
        position_accuracy: None,
        speed_accuracy: None,
        is_timed: true,
        station: StationHash(1),
        tag: 0,
    }
}

/// A vehicle model, with its prediction step behind a car.
fn course(vehicle: VehicleModel, model: &Model) -> (VehicleModel, Stride) {
    (vehicle, vehicle.over(GRID.step, CAR, model))
}

const CAR: Distance = Distance::from_mm(4_800);

fn forecast<'a>(
    stride: &'a Stride,
    length: usize,
    model: &'a Model,
    ahead: Option<&'a Horizon<STEPS>>,
) -> Forecast<'a, STEPS> {
    Forecast { grid: &GRID, length, model, stride, ahead, delay: None }
}

fn news(sample: &Sample, vehicle: VehicleModel) -> News<'_> {
    News { sample, received: None, vehicle, length_ahead: CAR }
}

fn anchored(
    parameters: &DrivingParameters,
    sample: &Sample,
    length: usize,
    ahead: Option<&Horizon<STEPS>>,
) -> Horizon<STEPS> {
    let mut horizon = Horizon::empty();
    let (vehicle, stride) = course(VehicleModel::of_parameters(parameters, &MODEL), &MODEL);
    forecast(&stride, length, &MODEL, ahead).anchor(&mut horizon, 0, &news(sample, vehicle));
    horizon
}

fn metres(reading: Reading) -> f64 {
    reading.position.get().to_num()
}

#[test]
fn a_sample_of_any_age_is_brought_to_now_by_the_model() {
    for age_us in [0, 100, 5_000, 9_900, 10_000, 137_300, 2_500_000] {
        let horizon = anchored(&leader(), &sample(age_us, 10_000, 0), 20, None);
        assert_eq!((horizon.first(), horizon.last(), horizon.len()), (0, 19, 20), "{age_us}");
        let now = horizon.read(GRID.origin, &GRID, true).unwrap();
        assert!((metres(now) - 5_000.0 - age_us as f64 * 1e-5).abs() < 1e-5, "{age_us}: {now:?}");
    }
}

#[test]
fn an_old_sample_in_few_steps_comes_to_where_it_comes_in_all_steps() {
    for (age_us, tolerance) in [(320_000, 0.0), (2_000_000, 0.0), (3_000_000, 0.001), (9_900_000, 0.025)] {
        let mut first = sample(age_us, 8_000, 0);
        first.position = first.position.ahead(Distance::from_mm(25_000));
        let ahead = anchored(&leader(), &first, STEPS, None);
        let sample = sample(age_us, 12_000, -1_500);
        let horizon = anchored(&follower(), &sample, 20, Some(&ahead));
        let (_, stride) = course(VehicleModel::of_parameters(&follower(), &MODEL), &MODEL);
        let mut state = State {
            position: sample.position.ring(),
            speed: sample.speed,
            acceleration: sample.acceleration,
            demand: sample.demand,
            ..State::default()
        };
        let mut before = first.speed;
        for index in 1 - age_us / 10_000..=0 {
            let reading = ahead.read(GRID.time_of(index), &GRID, true).unwrap();
            let end = Step { position: reading.position.ring(), speed: reading.speed };
            let before = core::mem::replace(&mut before, reading.speed);
            state = stride.take(state, Some(TargetStep::between(before, &end)));
        }
        let now = horizon.read(GRID.origin, &GRID, true).unwrap();
        let off = metres(now) - horizon.absolute(state.position).get().to_num::<f64>();
        assert!(off.abs() <= tolerance, "{age_us}: {off}");
    }
}

#[test]
fn a_sample_from_the_future_is_where_its_horizon_begins_and_before_it_speed_is_constant() {
    let horizon = anchored(&leader(), &sample(-4_000, 10_000, 0), 20, None);
    assert_eq!((horizon.first(), horizon.last()), (1, 19));
    for (after_us, expected) in [(0, 4_999.96), (4_000, 5_000.0), (7_000, 5_000.03), (10_000, 5_000.06)] {
        let reading = horizon.read(GRID.origin.plus(Duration::from_micros(after_us)), &GRID, true).unwrap();
        assert!((metres(reading) - expected).abs() < 1e-5, "{after_us}: {reading:?}");
    }
}

#[test]
fn a_horizon_that_is_extended_is_the_one_that_was_longer_from_the_start() {
    let ahead = anchored(&leader(), &sample(0, 8_000, 500), STEPS, None);
    for (parameters, ahead) in [(leader(), None), (follower(), Some(&ahead))] {
        let sample = sample(23_400, 12_000, -1_500);
        let long = anchored(&parameters, &sample, 50, ahead);
        let mut extended = anchored(&parameters, &sample, 20, ahead);
        let (_, stride) = course(VehicleModel::of_parameters(&parameters, &MODEL), &MODEL);
        let forecast = forecast(&stride, 20, &MODEL, ahead);
        for present in [1, 2, 12, 30] {
            forecast.extend(&mut extended, present);
            assert_eq!((extended.first(), extended.len()), (present, 20));
        }
        assert_eq!(extended.tip(), long.tip());
        for index in 30..50 {
            assert_eq!(extended.at(index), long.at(index), "{index}");
        }
    }
}

#[test]
fn after_a_pause_longer_than_the_ring_there_is_nothing_to_extend() {
    let mut horizon = anchored(&leader(), &sample(0, 10_000, 0), 20, None);
    let (_, stride) = course(VehicleModel::of_parameters(&leader(), &MODEL), &MODEL);
    let forecast = forecast(&stride, 20, &MODEL, None);
    let mut within = horizon.clone();
    forecast.extend(&mut within, STEPS as i64);
    assert_eq!((within.last(), within.at(STEPS as i64).is_some()), (STEPS as i64 + 19, true));
    forecast.extend(&mut horizon, STEPS as i64 + 1);
    assert!(horizon.is_empty());
}

#[test]
fn a_horizon_that_ends_is_kept_from_its_sample_on_and_never_extended() {
    let model = Model { endless: false, ..MODEL };
    let (vehicle, stride) = course(VehicleModel::of_parameters(&leader(), &model), &model);
    let forecast = forecast(&stride, 20, &model, None);
    let mut horizon = Horizon::empty();
    forecast.anchor(&mut horizon, 0, &news(&sample(50_000, 10_000, 0), vehicle));
    assert_eq!((horizon.first(), horizon.last()), (-5, 14));
    let before = horizon.clone();
    forecast.extend(&mut horizon, 12);
    assert_eq!((horizon.first(), horizon.last(), horizon.tip()), (before.first(), before.last(), before.tip()));
}

#[test]
fn a_follower_whose_predecessor_was_never_heard_fades() {
    let mut config = Config::car(StationHash(9));
    config.prediction.step = Duration::from_millis(10); // all times below are steps
    let mut estimator = Estimator::<2, STEPS>::idle();
    estimator.start(&config, STEPS);
    estimator.start_grid(GRID.origin);
    let mut peers = Peers::<2, 4>::idle();
    peers.start(config.link.period);
    let track = peers.get_mut(crate::wire::Slot(1)).unwrap();
    let braking = Sample { station: StationHash(2), ..sample(0, 10_000, -1_500) };
    track.admit(&braking, &Certainty::NONE, Belief::Agrees);
    track.publish(
        GRID.origin,
        DrivingParameters { predecessor: Predecessor::Station(StationHash(77)), ..leader() },
        Duration::from_millis(10_000),
    );
    estimator.note_change(&peers);
    estimator.note_news(1);
    estimator.update(GRID.origin, &peers, None, 0, None);
    for hundredths in [0, 10, 40, 60] {
        let t = f64::from(hundredths) * 0.01;
        let at = GRID.origin.plus(Duration::from_millis(i64::from(hundredths) * 10));
        let reading = estimator.read(1, at).unwrap();
        let exact = 10.0 - 1.5 * 2.0 * (1.0 - (-t / 2.0).exp());
        assert!((reading.speed.get().to_num::<f64>() - exact).abs() < 1e-5, "{t} s: {reading:?}");
    }
}

#[test]
fn a_follower_is_predicted_behind_its_predecessor_in_whatever_slots_they_are() {
    let config = Config::car(StationHash(9));
    for (front, back) in [(0, 1), (1, 0)] {
        let mut estimator = Estimator::<2, STEPS>::idle();
        estimator.start(&config, STEPS);
        estimator.start_grid(GRID.origin);
        let mut peers = Peers::<2, 4>::idle();
        peers.start(config.link.period);
        // The leader stands; the follower is 20 m behind it at 10 m/s, and brakes.
        let stands = DrivingParameters { target_speed: Speed::ZERO, ..leader() };
        let front_sample = sample(0, 0, 0);
        let back_sample =
            Sample { station: StationHash(2), position: Position::from_mm(4_980_000), ..sample(0, 10_000, 0) };
        for (slot, sample, parameters) in [(front, front_sample, stands), (back, back_sample, follower())] {
            let track = peers.get_mut(crate::wire::Slot(slot)).unwrap();
            track.admit(&sample, &Certainty::NONE, Belief::Agrees);
            track.publish(GRID.origin, parameters, Duration::from_millis(10_000));
            estimator.note_news(usize::from(slot));
        }
        estimator.note_change(&peers);
        estimator.update(GRID.origin, &peers, None, 0, None);
        let end = GRID.origin.plus(Duration::from_millis(600));
        let (leads, follows) = (estimator.read(front.into(), end).unwrap(), estimator.read(back.into(), end).unwrap());
        assert_eq!(metres(leads), 5_000.0);
        assert!(follows.speed < Speed::from_mm_per_s(9_700), "{front} {back}: {follows:?}");
    }
}
