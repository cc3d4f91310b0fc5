//! The plant against closed forms, against eq. 1 integrated in far smaller steps, and behind the core's inversion.

use holdover::units::{Acceleration, Speed};

use super::*;
use crate::input::kind::{Difference, Kind};

/// A vehicle without resistance, and with limits that do not matter.
fn frictionless(lag_s: f64) -> Machine {
    let (drag, friction, mechanical_n) = (0.0, 0.0, 0.0);
    let kind = Machine::new(Kind::Car, lag_s, &Difference::NONE);
    Machine {
        ratio_per_m: 3.0,
        mass_kg: 1500.0,
        drag,
        friction,
        mechanical_n,
        engine_force_n: 1e5,
        brake_limit_nm: 1e5,
        ..kind
    }
}

#[test]
fn without_resistance_the_motion_is_that_of_a_first_order_lag() {
    let mut plant = Plant::cruising(frictionless(0.3), 3.0, 10.0);
    plant.drive(Effort::BrakeTorque(1000), 0.7); // 3 · 1000 N on 1500 kg
    let (u, b, lag, h): (f64, f64, f64, f64) = (-2.0, 2.0, 0.3, 0.7);
    let kept = (-h / lag).exp();
    let speed = 10.0 + u * h + b * lag * (1.0 - kept);
    let position = 3.0 + 10.0 * h + 0.5 * u * h * h + b * lag * (h - lag * (1.0 - kept));
    assert!((plant.speed_mps - speed).abs() < 1e-9);
    assert!((plant.position_m - position).abs() < 1e-9);
    assert!((plant.acceleration_mps2 - (u + b * kept)).abs() < 1e-9);
}

#[test]
fn a_braking_vehicle_stops_after_v_squared_over_2_a_and_stays() {
    let mut plant = Plant::cruising(frictionless(0.0), 0.0, 10.0);
    for _ in 0..400 {
        plant.drive(Effort::BrakeTorque(2500), 0.01);
    }
    assert!((plant.position_m - 10.0).abs() < 1e-3, "{}", plant.position_m);
    assert_eq!((plant.speed_mps, plant.acceleration_mps2), (0.0, 0.0));
}

/// Eq. 1 with lags by Euler steps of 10 µs: speed and position after `time_s`.
fn euler(machine: &Machine, mut speed: f64, effort: Effort, time_s: f64) -> (f64, f64) {
    let start = Plant::cruising(*machine, 0.0, speed);
    let (mut position, mut engine, mut brake) = (0.0, start.engine_n, start.brake_nm);
    let h = 1e-5;
    for _ in 0..(time_s / h).round() as u64 {
        let (force, torque) = match effort {
            Effort::Force(n) => (f64::from(n).min(machine.engine_limit_n(speed)), 0.0),
            Effort::BrakeTorque(nm) => (0.0, f64::from(nm).min(machine.brake_limit_nm)),
        };
        engine += (force - engine) * h / machine.lag_s;
        brake += (torque - brake) * h / machine.lag_s;
        let a = (engine - machine.ratio_per_m * brake - machine.resistance_n(speed)) / machine.mass_kg;
        position += speed * h + 0.5 * a * h * h;
        speed = (speed + a * h).max(0.0);
    }
    (position, speed)
}

#[test]
fn the_whole_of_eq_1_agrees_with_steps_of_ten_microseconds() {
    let uphill = Difference { mass_scale: 1.3, grade: 0.04, headwind_mps: 8.0, throttle: 1.0 };
    for kind in Kind::ALL {
        for difference in [Difference::NONE, uphill] {
            let machine = Machine::new(kind, kind.lag_s(), &difference);
            for effort in [Effort::Force(0), Effort::Force(4_000), Effort::Force(60_000), Effort::BrakeTorque(1_500)] {
                let (position, speed) = euler(&machine, 20.0, effort, 4.0);
                let mut plant = Plant::cruising(machine, 0.0, 20.0);
                for _ in 0..400 {
                    plant.drive(effort, 0.01);
                }
                let off = (plant.position_m - position, plant.speed_mps - speed);
                assert!(off.0.abs() < 5e-4 && off.1.abs() < 5e-4, "{kind:?} {difference:?} {effort:?} {off:?}");
            }
        }
    }
}

/// The largest difference between the acceleration reached and the demand behind a first-order lag. The demand swings
/// by 0.6 m/s² with a period of 12 s, which is within the power of every kind.
fn off_from_the_lag(kind: Kind, difference: &Difference) -> f64 {
    let lag_s = kind.lag_s();
    let mut plant = Plant::cruising(Machine::new(kind, lag_s, difference), 0.0, 15.0);
    let (mut lagged, mut worst) = (0.0, 0.0f64);
    for tick in 0..1200 {
        let demand = 0.6 * (f64::from(tick) * 0.01 * std::f64::consts::TAU / 12.0).sin();
        let speed = Speed::from_mm_per_s((plant.speed_mps * 1e3).round() as i32);
        let effort = kind.body().effort(Acceleration::from_mm_per_s2((demand * 1e3).round() as i32), speed);
        plant.drive(effort, 0.01);
        lagged += (demand - lagged) * (1.0 - (-0.01 / lag_s).exp());
        worst = worst.max((plant.acceleration_mps2 - lagged).abs());
    }
    worst
}

#[test]
fn with_true_parameters_the_acceleration_reached_is_the_demand_behind_the_lag() {
    // The remainder is the change of resistance while the actuators lag: little more than 1 % of the demand.
    for kind in Kind::ALL {
        let worst = off_from_the_lag(kind, &Difference::NONE);
        assert!(worst < 0.01, "{kind:?}: {worst}");
    }
}

#[test]
fn a_grade_and_a_wind_take_their_share_of_the_acceleration() {
    let uphill = off_from_the_lag(Kind::Car, &Difference { grade: 0.04, ..Difference::NONE });
    assert!((0.38..0.41).contains(&uphill), "four per cent of g: {uphill}");
    let machine = Machine::new(Kind::Car, 0.3, &Difference { grade: 0.04, ..Difference::NONE });
    let level = Machine::new(Kind::Car, 0.3, &Difference::NONE);
    let weight = 1500.0 * 9.806_65 * 0.04 / (1.0f64 + 0.04 * 0.04).sqrt();
    assert!((machine.resistance_n(10.0) - level.resistance_n(10.0) - weight).abs() < 1e-9);
    let windy = Machine::new(Kind::Car, 0.3, &Difference { headwind_mps: 10.0, ..Difference::NONE });
    assert!((windy.resistance_n(10.0) - level.resistance_n(10.0) - 0.4 * 300.0).abs() < 1e-9);
    let tail = Machine::new(Kind::Car, 0.3, &Difference { headwind_mps: -30.0, ..Difference::NONE });
    assert!((tail.resistance_n(10.0) - (0.4 * -400.0 + 20.0 + 150.0)).abs() < 1e-9, "it pushes");
}

#[test]
fn the_engines_force_is_limited_by_power_and_throttle() {
    let full = Machine::new(Kind::Car, 0.3, &Difference::NONE);
    assert_eq!((full.engine_limit_n(0.0), full.engine_limit_n(10.0), full.engine_limit_n(40.0)), (6e3, 6e3, 2.5e3));
    let limp = Machine::new(Kind::Car, 0.3, &Difference { throttle: 0.2, ..Difference::NONE });
    assert_eq!((limp.engine_limit_n(10.0), limp.engine_limit_n(40.0)), (1.2e3, 500.0));
    let mut plant = Plant::cruising(limp, 0.0, 10.0);
    plant.drive(Effort::Force(60_000), 3.0);
    assert!(plant.acceleration_mps2 < (1.2e3 - 190.0) / 1500.0, "{plant:?}");
}

#[test]
fn every_kind_can_do_what_it_publishes() {
    for kind in Kind::ALL {
        let machine = Machine::new(kind, kind.lag_s(), &Difference::NONE);
        let limits = kind.limits();
        let most: f64 = limits.acceleration.get().to_num();
        assert!(machine.engine_limit_n(5.0) > machine.mass_kg * most + machine.resistance_n(5.0), "{kind:?}");
        let hardest: f64 = limits.emergency_braking.get().to_num();
        assert!(machine.brake_limit_nm * machine.ratio_per_m > machine.mass_kg * hardest, "{kind:?}");
        assert!(machine.brake_limit_nm * machine.ratio_per_m < 1.15 * machine.mass_kg * hardest, "{kind:?}");
        assert_eq!(Kind::named(kind.name()), Some(kind));
    }
}

#[test]
fn a_vehicle_on_a_hill_neither_rolls_back_nor_waits_for_its_brakes() {
    let machine = Machine::new(Kind::Car, 0.3, &Difference { grade: 0.1, ..Difference::NONE });
    let mut plant = Plant::cruising(machine, 0.0, 5.0);
    for _ in 0..500 {
        plant.drive(Effort::BrakeTorque(3_000), 0.01);
    }
    let stopped = plant.position_m;
    plant.drive(Effort::Force(0), 2.0);
    assert_eq!((plant.position_m, plant.speed_mps, plant.acceleration_mps2), (stopped, 0.0, 0.0));
    plant.drive(Effort::Force(5_000), 0.3);
    assert!(plant.acceleration_mps2 > 0.5, "{plant:?}");
}
