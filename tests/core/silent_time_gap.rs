//! The time gap while the vehicle ahead is silent: it opens and closes as a float64 vehicle does by the same rule; the own horizon knows
//! it, and so does who reads the driving parameters.

use crate::rig;
use crate::rig::road::Road;
use crate::rig::{LENGTH, instant, m_of};
use holdover::Config;
use holdover::controller::Mode;
use holdover::time::Duration;
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::{Message, Said};

const SPEED: f64 = 15.0;
const STANDSTILL: f64 = 2.0;

/// Gains of their own, no envelope, and a horizon of 6 s.
fn config() -> Config {
    let mut config = rig::config();
    config.envelope = None;
    config.law.table = false;
    config.prediction.step = Duration::from_millis(100);
    config.prediction.horizon = Duration::from_millis(6_000);
    config
}

/// Behind a target that keeps its speed and says so, at the wanted time gap, both heard for seconds.
fn following(config: &Config) -> Road {
    let mut road = Road::new(config, SPEED, STANDSTILL + SPEED);
    road.wants = SPEED;
    road.rig.wanted = SPEED + 5.0;
    road.power_up();
    road.run(10.0);
    road
}

/// A vehicle in float64 that drives by eq. 5 with a lag of 0.3 s, 1 ms a step, behind one that keeps its speed.
struct Reference {
    gap: f64,
    speed: f64,
    acceleration: f64,
}

impl Reference {
    fn step(&mut self, time_gap: f64) {
        let (k, damping, lag, dt) = (0.5, 2.0, 0.3, 1e-3);
        let wish = k * (self.gap - STANDSTILL - time_gap * self.speed + damping * (SPEED - self.speed));
        self.acceleration += (wish - self.acceleration) * dt / lag;
        self.gap += (SPEED - self.speed) * dt;
        self.speed += self.acceleration * dt;
    }
}

/// The time gap by the rule, so long after the last news in a silence of this length.
fn ruled(after: f64, silence: f64, opened: f64) -> f64 {
    let by = (after.min(silence) - 5.0).max(0.0) / 10.0;
    1.0 + (by.min(opened) - (after - silence).max(0.0) / 10.0).max(0.0)
}

#[test]
fn it_opens_and_closes_as_the_rule_says() {
    // The last motion comes 10 ms before the silence is switched on.
    for (silence, silent_ms, opened) in
        [(4.8, 1_800, 0.0), (10.0, 1_800, 0.8), (10.0, 1_200, 0.2), (10.0, 1_000, 0.0), (14.0, 1_800, 0.8)]
    {
        let mut config = config();
        config.law.silent_time_gap = holdover::units::Seconds::from_millis(silent_ms);
        let mut road = following(&config);
        let mut reference = Reference { gap: road.gap(), speed: road.ego.speed, acceleration: 0.0 };
        road.commands.clear();
        let mut widest = 0.0f64;
        for tick in 0..3_500 {
            let after = f64::from(tick) * 0.01;
            road.senses.v2x = after >= silence;
            road.step();
            (0..10).for_each(|_| reference.step(ruled(after + 0.1, silence, opened)));
            // It turns with an own motion, which may be 100 ms late: 0.02 s of the gap. 0.05 m are of the target's estimate.
            let off = road.gap() - reference.gap;
            assert!(off.abs() < 0.02 * SPEED + 0.05, "{silence} s, {silent_ms} ms, at {after} s: {off} m");
            widest = widest.max(road.gap());
        }
        let (down, up) = road.steepest();
        let hardest = road.commands.iter().fold(0.0f64, |hardest, command| hardest.min(*command));
        // No command differs from the one before by more than 0.04 m/s².
        assert!(down > -4.0 && up < 4.0, "{silence} s, {silent_ms} ms: {down} to {up} m/s³");
        assert!(hardest > -0.8, "{silence} s, {silent_ms} ms: {hardest} m/s²");
        assert!((widest > STANDSTILL + SPEED + 0.1) == (opened > 0.0), "{silence} s, {silent_ms} ms: {widest} m");
    }
}

#[test]
fn what_the_sensor_sees_keeps_it() {
    let mut road = following(&config());
    road.senses.range = true;
    road.run(1.0);
    road.senses.v2x = false;
    let gap = road.gap();
    for _ in 0..1_000 {
        road.step();
        assert!((road.gap() - gap).abs() < 0.05, "{} m instead of {gap} m", road.gap());
    }
}

#[test]
fn the_own_horizon_knows_of_it() {
    let mut road = following(&config());
    road.senses.v2x = false;
    road.run(5.5);
    let mut foreseen = Vec::new();
    for tick in 0..800 {
        // With the own motions every 100 ms.
        let at = road.now;
        if let Some((_, place)) = foreseen.iter().find(|(due, _)| *due == at) {
            let off: f64 = road.ego.position - place;
            // It is foreseen in pieces of a second, and driven by a controller of 10 ms instead of steps of 100 ms.
            assert!(off.abs() < 0.1, "foreseen 4 s ago, {tick} ticks on: {off} m");
        }
        road.step();
        let then = at + 4_000_000;
        let reading = road.rig.unit.estimator().read_own(instant(then)).expect("it has a horizon");
        if at % 100_000 == 0 {
            foreseen.push((then, m_of(reading.position)));
        }
    }
    assert!(foreseen.len() > 40, "{}", foreseen.len());
    // Without the opening it would be 4 s at a tenth of the speed less.
    assert!(road.target.position - LENGTH - road.ego.position > STANDSTILL + 1.5 * SPEED);
}

/// The time gaps that the unit tells in so many ticks, in ms: each when it is another than the one before.
fn told(road: &mut Road, ticks: u32) -> Vec<i32> {
    let mut told = Vec::new();
    for _ in 0..ticks {
        for message in road.step().all {
            if let Message::Own(Said::DrivingParameters(parameters)) = message {
                told.push(parameters.time_gap.to_millis());
            }
        }
    }
    told.dedup();
    told
}

#[test]
fn it_is_told_by_tenths_of_a_second() {
    let mut road = following(&config());
    road.senses.v2x = false;
    assert_eq!(told(&mut road, 1_400), [1_000, 1_100, 1_200, 1_300, 1_400, 1_500, 1_600, 1_700, 1_800]);
}

/// The driver asks for another time gap, in ms.
fn ask_for(road: &mut Road, millis: i32) {
    let request = DriverRequest {
        engaged: true,
        predecessor: road.predecessor,
        target_speed: crate::rig::mps(road.rig.wanted),
        time_gap: Some(holdover::units::Seconds::from_millis(millis)),
    };
    road.rig.put(road.now, &Message::DriverRequest(request)).unwrap();
}

#[test]
fn a_larger_gap_that_the_driver_wants_takes_the_place_of_it() {
    let mut road = following(&config());
    road.senses.v2x = false;
    road.run(10.05);
    road.senses.desk = false;
    road.commands.clear();
    // 0.5 s are opened. The driver wants 0.3 s more, between own motions.
    ask_for(&mut road, 1_300);
    let mut all = told(&mut road, 10);
    assert!(all.iter().all(|told| *told <= 1_600), "{all:?}");
    for _ in 0..39 {
        ask_for(&mut road, 1_300);
        all.extend(told(&mut road, 10));
    }
    let (down, up) = road.steepest();
    assert!(down > -2.0 && up < 2.0, "{down} to {up} m/s³");
    assert_eq!(all.last(), Some(&1_800));
}

#[test]
fn it_goes_on_through_fallback_and_back() {
    let mut road = following(&config());
    road.rig.wanted = SPEED;
    road.senses.v2x = false;
    road.run(15.5);
    assert!(matches!(road.rig.unit.mode(), Mode::Fallback { .. }), "{:?}", road.rig.unit.mode());
    road.senses.v2x = true;
    assert_eq!(told(&mut road, 1_500), [1_800, 1_700, 1_600, 1_500, 1_400, 1_300, 1_200, 1_100, 1_000]);
}

#[test]
fn whoever_drives_himself_begins_with_the_gap_that_he_wants() {
    let mut road = following(&config());
    road.senses.v2x = false;
    road.run(10.0);
    road.senses.v2x = true;
    road.engaged = false;
    road.run(0.5);
    road.engaged = true;
    assert_eq!(told(&mut road, 100), [1_000]);
}
