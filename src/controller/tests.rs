//! Facts about the controller: what it demands on each course, and that it never demands what the vehicle's limits do
//! not allow.

use super::*;
use crate::model::Aim;
use crate::units::Position;
use crate::wire::StationHash;

/// A car that keeps 1 s: the scenes are laid out for that.
fn config() -> Config {
    let mut config = Config::car(StationHash(1));
    config.law.time_gap = Seconds::from_millis(1_000);
    config
}

fn at(millis: u64) -> Instant {
    Instant::from_micros(millis * 1000)
}

fn ego(mm_per_s: i32) -> State {
    State { speed: Speed::from_mm_per_s(mm_per_s), ..State::default() }
}

fn mm(demand: Acceleration) -> i32 {
    demand.to_mm_per_s2()
}

fn leads(config: &Config, target_mm_per_s: i32) -> Course {
    let aim =
        Aim::Lead { largest: config.law.free_road_acceleration, target_speed: Speed::from_mm_per_s(target_mm_per_s) };
    Course::Law { vehicle: config.vehicle_model(aim), target: None, cap: Acceleration::MAX }
}

/// Behind a vehicle of 4.8 m, whose front bumper is that far ahead.
fn follows(config: &Config, ahead_mm: i64, mm_per_s: i32) -> Course {
    let law = &config.law;
    let aim = Aim::Follow { law: law.consensus(), standstill: law.standstill, catch_up: Speed::from_mm_per_s(48_000) };
    let reading = Reading { position: Position::from_mm(ahead_mm), speed: Speed::from_mm_per_s(mm_per_s) };
    Course::Law {
        vehicle: config.vehicle_model(aim),
        target: Some(Target { reading, gained: Speed::ZERO, length: Distance::from_mm(4_800) }),
        cap: Acceleration::MAX,
    }
}

/// The demand after so many periods of the same.
fn after(periods: u64, config: &Config, ego: Option<State>, course: &Course) -> Acceleration {
    let mut controller = Controller::new(config.period);
    for period in 0..periods {
        let ego = ego.map(|ego| State { demand: controller.last_demand(), ..ego });
        controller.drive(config, at(10 * period), ego.as_ref(), course);
    }
    controller.last_demand()
}

#[test]
fn on_a_free_road_it_accelerates_as_the_law_says_and_stops_at_the_speed_wanted() {
    let config = config();
    assert_eq!(mm(after(100, &config, Some(ego(0)), &leads(&config, 10_000))), 730);
    assert_eq!(mm(after(100, &config, Some(ego(5_000)), &leads(&config, 10_000))), 684); // 0.73 (1 - 2⁻⁴)
    assert_eq!(mm(after(100, &config, Some(ego(10_000)), &leads(&config, 10_000))), 0);
}

#[test]
fn behind_a_target_it_demands_what_equation_7_says() {
    let config = config();
    // k = 0.5, γ = 2 s, t_g = 1 s, s_0 = 2 m: 16.8 m is the gap wanted at 10 m/s; the semi-implicit step takes a little.
    let law = |ahead_m: f64, speed: f64, own: f64| {
        let share = 0.5 / (1.0 + 0.5 * 0.01 * 3.0);
        -share * (-ahead_m + 4.8 + 2.0 + own * 1.01 + 2.0 * (own - speed))
    };
    for (ahead_mm, speed, own) in [(16_800, 10_000, 10_000), (18_000, 10_000, 10_000), (15_000, 9_500, 10_000)] {
        let demand = after(200, &config, Some(ego(own)), &follows(&config, ahead_mm, speed));
        let exact = law(ahead_mm as f64 / 1e3, f64::from(speed) / 1e3, f64::from(own) / 1e3);
        assert!((demand.get().to_num::<f64>() - exact).abs() < 1e-4, "{ahead_mm} {speed} {own}: {demand:?} {exact}");
    }
}

#[test]
fn every_course_of_its_own_keeps_to_the_limits_on_acceleration_and_jerk() {
    let mut config = config();
    config.law.max_speed = Speed::from_mm_per_s(20_000);
    let wall = Reading { position: Position::from_mm(1_000), speed: Speed::ZERO };
    let far = Reading { position: Position::from_mm(900_000), speed: Speed::from_mm_per_s(60_000) };
    let courses = [
        leads(&config, 60_000),
        leads(&config, 0),
        follows(&config, 900_000, 60_000),
        follows(&config, 1_000, 0),
        Course::Cruise { ahead: wall, target_speed: Speed::from_mm_per_s(60_000) },
        Course::Cruise { ahead: far, target_speed: Speed::from_mm_per_s(60_000) },
        Course::GrowingBraking { ahead: None, since: None },
        Course::Brake,
    ];
    let limits = config.limits;
    let slew = limits.jerk.over(config.period.fine_seconds());
    for speed in [0, 10_000, 20_000, 21_000, 60_000] {
        let mut controller = Controller::new(config.period);
        for period in 0..4_000u64 {
            // Another course every 0.2 to 1.4 s, so that every one follows on every other.
            let course = &courses[(period as usize / 20 * 7 + period as usize / 140) % courses.len()];
            let last = controller.last_demand();
            let ego = State { demand: last, ..ego(speed) };
            let demand = controller.drive(&config, at(10 * period), Some(&ego), course);
            assert!(demand <= limits.acceleration && demand >= limits.braking.negated(), "{course:?}: {demand:?}");
            assert!(demand.minus(last).magnitude() <= slew, "{course:?}: {last:?} to {demand:?}");
        }
    }
}

#[test]
fn beyond_its_speed_limit_it_does_not_accelerate() {
    let config =
        Config { law: crate::config::Law { max_speed: Speed::from_mm_per_s(20_000), ..config().law }, ..config() };
    for (speed, expected) in [(19_000, 730), (19_900, 200), (20_000, 0), (20_500, -1_000), (60_000, -4_000)] {
        let demand = after(300, &config, Some(ego(speed)), &leads(&config, 65_534));
        assert!((mm(demand) - expected).abs() <= 10, "{speed}: {demand:?}");
    }
}

#[test]
fn the_braking_grows_by_half_a_metre_per_second_squared_every_second() {
    let config = config();
    for (periods, expected) in [(1, 0), (101, -500), (401, -2_000), (801, -4_000), (2_000, -4_000)] {
        assert_eq!(
            mm(after(periods, &config, Some(ego(20_000)), &Course::GrowingBraking { ahead: None, since: None })),
            expected
        );
    }
}

#[test]
fn without_the_ego_s_state_any_law_is_braking_at_the_limit_on_jerk() {
    let config = config();
    for course in [leads(&config, 10_000), follows(&config, 100_000, 10_000), Course::Brake] {
        for (periods, expected) in [(1, -50), (10, -500), (80, -4_000), (200, -4_000)] {
            assert_eq!(mm(after(periods, &config, None, &course)), expected, "{course:?}");
        }
    }
}

#[test]
fn while_another_drives_it_keeps_up_with_what_is_demanded_and_starts_from_there() {
    let config = config();
    let mut controller = Controller::new(config.period);
    let demand = Acceleration::from_mm_per_s2(-1_230);
    assert_eq!(controller.drive(&config, at(0), None, &Course::Yield { demand }), demand);
    assert_eq!(mm(controller.drive(&config, at(10), None, &Course::Brake)), -1_280);
}

#[test]
fn what_was_really_commanded_is_what_the_next_demand_starts_from() {
    let config = config();
    let mut controller = Controller::new(config.period);
    controller.correct(Acceleration::from_mm_per_s2(-3_000));
    assert_eq!(mm(controller.drive(&config, at(0), None, &Course::Brake)), -3_050);
}

#[test]
fn news_after_a_silence_reaches_the_law_little_by_little() {
    let config = config();
    let course = follows(&config, 15_800, 10_000); // a metre less than wanted
    let seen = Reading { position: Position::from_mm(16_800), speed: Speed::from_mm_per_s(10_000) };
    let said = Reading { position: Position::from_mm(15_800), ..seen };
    let mut controller = Controller::new(config.period);
    controller.blend_from(seen, said);
    let mut demands = Vec::new();
    for period in 0..300u64 {
        let ego = State { demand: controller.last_demand(), ..ego(10_000) };
        demands.push(mm(controller.drive(&config, at(10 * period), Some(&ego), &course)));
    }
    assert!((-80..=0).contains(&demands[0]), "{}", demands[0]);
    assert!(demands.is_sorted_by(|a, b| a >= b));
    assert_eq!(demands[299], mm(after(300, &config, Some(ego(10_000)), &course)));
}

#[test]
fn another_association_with_other_gains_does_not_make_the_demand_jump() {
    let config = config();
    let mut controller = Controller::new(config.period);
    let aim = |gain: i32, damping: i32| Aim::Follow {
        law: Consensus {
            gain: Gain::from_milli(gain),
            damping: Seconds::from_millis(damping),
            ..config.law.consensus()
        },
        standstill: config.law.standstill,
        catch_up: Speed::from_mm_per_s(48_000),
    };
    // From the softest gains of the table behind one target to the firmest behind another, and back.
    let courses = [(250, 3_870, 22_000), (600, 1_680, 20_000), (250, 3_870, 22_000)].map(|(gain, damping, ahead)| {
        let reading = Reading { position: Position::from_mm(ahead), speed: Speed::from_mm_per_s(9_000) };
        Course::Law {
            vehicle: config.vehicle_model(aim(gain, damping)),
            target: Some(Target { reading, gained: Speed::ZERO, length: crate::parameters::DEFAULT_LENGTH }),
            cap: Acceleration::MAX,
        }
    });
    let (mut before, mut settled) = (Acceleration::ZERO, [Acceleration::ZERO; 3]);
    for period in 0..600_usize {
        let ego = State { demand: before, ..ego(10_000) };
        let demand = controller.drive(&config, at(10 * period as u64), Some(&ego), &courses[period / 200]);
        let change = demand.minus(before).magnitude();
        assert!(change <= config.limits.jerk.over(config.period.fine_seconds()), "{period}: {change:?}");
        before = demand;
        settled[period / 200] = demand;
    }
    let apart = settled[1].minus(settled[0]);
    assert!(apart > Acceleration::from_mm_per_s2(300) && settled[2] == settled[0], "{settled:?}");
}
