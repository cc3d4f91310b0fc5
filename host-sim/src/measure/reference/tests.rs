//! The reference against results that were derived by hand.

use super::horizon::{Role, chain, horizon};
use super::*;
use PositionRule::{Euler, Trapezoid};

const STEP_S: f64 = 0.01;

fn law() -> Parameters {
    Parameters {
        length_m: 4.8,
        standstill_m: 2.0,
        target_speed_mps: 11.0,
        catch_up_mps: f64::INFINITY,
        time_gap_s: 1.0,
        gain: 1.0,
        damping_s: 2.0,
        feed_forward: 0.0,
        lag_s: 0.3,
        acceleration_mps2: 2.0,
        braking_mps2: 3.5,
        jerk_mps3: 2.5,
    }
}

fn moving(speed_mps: f64, acceleration_mps2: f64) -> State {
    State { position_m: 0.0, speed_mps, acceleration_mps2, demand_mps2: acceleration_mps2 }
}

fn near(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is not within {tolerance} of {b}");
}

#[test]
fn the_lag_is_the_analytic_solution_in_one_step_or_in_many() {
    let (start, demand, lag_s, time_s) = (moving(10.0, -1.0), 1.5, 0.4, 2.0);
    let one = actuated(&start, demand, lag_s, time_s, Trapezoid);
    let many = (0..200).fold(start, |state, _| actuated(&state, demand, lag_s, time_s / 200.0, Trapezoid));
    let faded = 1.0 - f64::exp(-time_s / lag_s);
    let speed = 10.0 + demand * time_s + (-1.0 - demand) * lag_s * faded;
    near(many.acceleration_mps2, demand + (-1.0 - demand) * (1.0 - faded), 1e-12);
    near(many.acceleration_mps2, one.acceleration_mps2, 1e-12);
    near(many.speed_mps, speed, 1e-12);
    near(one.speed_mps, speed, 1e-12);
    let position = 10.0 * time_s + demand * time_s * time_s / 2.0 + (-1.0 - demand) * lag_s * (time_s - lag_s * faded);
    near(many.position_m, position, 1e-4);
}

#[test]
fn without_lag_the_acceleration_is_the_demand() {
    let next = actuated(&moving(10.0, -1.0), 2.0, 0.0, 0.5, Trapezoid);
    assert_eq!(next, State { position_m: 5.25, speed_mps: 11.0, acceleration_mps2: 2.0, demand_mps2: 2.0 });
    assert_eq!(actuated(&moving(10.0, -1.0), 2.0, 0.0, 0.5, Euler).position_m, 5.0);
}

#[test]
fn a_vehicle_does_not_reverse() {
    let next = actuated(&moving(0.125, -3.0), -3.0, 0.3, 0.5, Trapezoid);
    assert_eq!(next, State { position_m: 0.03125, speed_mps: 0.0, acceleration_mps2: 0.0, demand_mps2: -3.0 });
}

#[test]
fn a_fading_acceleration_adds_two_seconds_of_itself_to_the_speed() {
    let end = horizon(moving(10.0, 1.2), Role::Silent, &law(), STEP_S, 10_000, Trapezoid)[10_000];
    near(end.speed_mps, 12.4, 1e-9);
    near(end.acceleration_mps2, 0.0, 1e-9);
    near(end.position_m, 12.4 * 100.0 - 2.4 * 2.0, 1e-4);
    assert_eq!(end.demand_mps2, 0.0);
}

#[test]
fn a_leader_converges_to_its_target_speed_from_either_side() {
    for speed in [0.0, 8.0, 11.0, 20.0] {
        let end = horizon(moving(speed, 0.0), Role::Leader, &law(), STEP_S, 12_000, Trapezoid)[12_000];
        near(end.speed_mps, 11.0, 1e-6);
        near(end.acceleration_mps2, 0.0, 1e-6);
    }
}

#[test]
fn a_leader_far_above_its_target_speed_brakes_no_harder_than_its_law() {
    assert_eq!(demand_lead(&moving(40.0, 0.0), &law()), -3.5);
    assert_eq!(demand_lead(&moving(40.0, 0.0), &Parameters { target_speed_mps: 0.05, ..law() }), -3.5);
    assert_eq!(demand_lead(&moving(0.0, 0.0), &law()), 0.73);
}

#[test]
fn equation_13_holds_with_the_demanded_speed_put_back_in() {
    for (speed, gap, speed_ahead, step_s) in [(9.0, 14.0, 11.0, 0.01), (20.0, 3.0, 5.0, 0.1), (0.0, 30.0, 9.0, 1.0)] {
        let (state, law) = (State { position_m: 100.0, ..moving(speed, 0.0) }, law());
        let ahead = Ahead { position_m: 100.0 + gap + 4.8, speed_mps: speed_ahead, gained_mps: 0.0, length_m: 4.8 };
        let demand = demand_follow(&state, &ahead, &law, step_s);
        let wanted = speed + demand * step_s;
        let spacing = state.position_m + speed * step_s - ahead.position_m + 4.8 + 2.0 + wanted * law.time_gap_s;
        let residual = wanted - speed + law.gain * step_s * (spacing + law.damping_s * (wanted - speed_ahead));
        near(residual, 0.0, 1e-11);
        let share = law.gain / (1.0 + law.gain * step_s * (law.time_gap_s + law.damping_s));
        let closed = (law.time_gap_s + step_s) * speed + law.damping_s * (speed - speed_ahead) - gap + 2.0;
        near(demand, -share * closed, 1e-10);
    }
}

#[test]
fn far_behind_the_speed_to_catch_up_with_is_approached_and_held() {
    let law = Parameters { catch_up_mps: 13.2, ..law() };
    let mut state = moving(5.0, 0.0);
    for _ in 0..6_000 {
        let ahead = Ahead { position_m: state.position_m + 300.0, speed_mps: 11.0, gained_mps: 0.0, length_m: 4.8 };
        let demand = limited(demand_follow(&state, &ahead, &law, STEP_S), state.demand_mps2, &law, STEP_S);
        state = actuated(&state, demand, law.lag_s, STEP_S, Trapezoid);
        assert!(state.speed_mps < 13.3);
    }
    near(state.speed_mps, 13.2, 1e-3);
}

#[test]
fn the_demand_respects_both_ranges_and_the_higher_lower_end_where_they_do_not_meet() {
    let law = law();
    assert_eq!(limited(9.0, 1.99, &law, 0.1), 2.0);
    assert_eq!(limited(-9.0, -3.4, &law, 0.1), -3.5);
    assert_eq!(limited(9.0, 0.0, &law, 0.1), 0.25);
    assert_eq!(limited(-9.0, 0.0, &law, 0.1), -0.25);
    assert_eq!(limited(0.1, 0.0, &law, 0.1), 0.1);
    assert_eq!(limited(0.0, -6.0, &law, 0.1), -3.5);
    assert_eq!(limited(9.0, 6.0, &law, 0.1), 5.75);
}

#[test]
fn a_string_settles_at_the_desired_gap() {
    for (rule, step_s) in [(Trapezoid, 0.01), (Trapezoid, 0.1), (Euler, 0.1)] {
        let string: Vec<_> = (0..8u8)
            .map(|n| {
                let place = f64::from(n);
                (State { position_m: -17.0 * place, ..moving(9.0 + place / 4.0, 0.0) }, law())
            })
            .collect();
        let steps = (200.0 / step_s) as usize;
        let ends: Vec<_> = chain(&string, step_s, steps, rule).iter().map(|states| states[steps]).collect();
        for pair in ends.windows(2) {
            near(pair[1].speed_mps, 11.0, 1e-6);
            near(pair[0].position_m - pair[1].position_m, 4.8 + 2.0 + 11.0 * 1.0, 1e-5);
        }
    }
}

#[test]
fn a_string_in_equilibrium_stays_there() {
    let string: Vec<_> =
        (0..8u8).map(|n| (State { position_m: -17.8 * f64::from(n), ..moving(11.0, 0.0) }, law())).collect();
    for states in chain(&string, STEP_S, 400, Trapezoid) {
        near(states[400].position_m - states[0].position_m, 44.0, 1e-9);
        near(states[400].demand_mps2, 0.0, 1e-9);
    }
}

#[test]
fn as_printed_nothing_limits_the_step() {
    let law = law().as_printed();
    let ahead = [State { position_m: 8.0, ..moving(0.0, 0.0) }; 2];
    let role = Role::Follower { ahead: &ahead, length_m: 4.8 };
    let next = horizon(moving(12.0, 0.0), role, &law, 0.1, 1, Euler)[1];
    near(next.speed_mps, (12.0 - 0.1 * (1.2 - 8.0 + 4.8)) / (1.0 + 0.1 * 3.0), 1e-12);
    near(next.position_m, 1.2, 1e-12);
}

#[test]
fn as_printed_a_leader_told_to_stop_stands_in_one_step() {
    let law = Parameters { target_speed_mps: 0.0, ..law() }.as_printed();
    let states = horizon(moving(12.0, 0.0), Role::Leader, &law, 0.1, 3, Euler);
    near(states[3].position_m, 1.2, 1e-12);
    assert_eq!(states[3].speed_mps, 0.0);
}
