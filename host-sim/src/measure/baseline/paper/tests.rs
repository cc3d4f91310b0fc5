//! Facts about Algorithm 1: whose horizon is computed when, and from what.

use super::*;

const STEP_S: f64 = 0.1;

fn parameters(predecessor: Option<usize>, target_speed_mps: f64) -> HeardParameters {
    HeardParameters {
        length_m: 5.0,
        standstill_m: 2.0,
        leads: predecessor.is_none(),
        predecessor,
        target_speed_mps,
        catch_up: 0.2,
        time_gap_s: 1.0,
        gain: 0.25,
        damping_s: 2.0,
        feed_forward: 0.0,
        lag_s: 0.3,
        acceleration_mps2: 2.0,
        braking_mps2: 4.0,
        jerk_mps3: 3.0,
    }
}

fn message(at_s: f64, stamp_s: f64, vehicle: usize, position_m: f64, speed_mps: f64) -> Heard {
    let (acceleration_mps2, demand_mps2) = (0.0, 0.0);
    Heard { at_s, stamp_s, vehicle, position_m, speed_mps, acceleration_mps2, demand_mps2, parameters: None }
}

#[test]
fn a_message_is_read_at_the_next_multiple_of_the_step_and_at_the_multiple_itself() {
    let mut paper = Paper::new(0, STEP_S);
    paper.hear(&message(0.31, 0.3, 0, 5.0, 13.4));
    assert_eq!(paper.estimate(0.39), None);
    assert!(paper.estimate(4.0 * STEP_S).is_some());
    let mut punctual = Paper::new(0, STEP_S);
    punctual.hear(&message(0.3, 0.3, 0, 5.0, 13.4));
    assert!(punctual.estimate(3.0 * STEP_S).is_some());
}

#[test]
fn without_driving_parameters_the_target_speed_is_13_4() {
    let mut paper = Paper::new(0, STEP_S);
    paper.hear(&message(0.0, 0.0, 0, 0.0, 13.4));
    let at_end = paper.estimate(5.0).unwrap();
    assert!((at_end.position_m - 67.0).abs() < 1e-9);
    assert!((at_end.speed_mps - 13.4).abs() < 1e-12);
    assert_eq!(paper.estimate(50.0), Some(at_end));
}

#[test]
fn a_follower_whose_predecessor_is_unheard_goes_for_its_own_target_speed() {
    let mut paper = Paper::new(1, STEP_S);
    paper.hear(&message(0.0, 0.0, 1, 0.0, 9.0).with_parameters(parameters(Some(0), 9.0)));
    assert!((paper.estimate(2.0).unwrap().position_m - 18.0).abs() < 1e-9);
}

#[test]
fn a_horizon_held_keeps_its_anchor_while_its_predecessor_has_news() {
    let mut paper = Paper::new(1, STEP_S);
    paper.hear(&message(0.0, 0.0, 0, 30.0, 10.0).with_parameters(parameters(None, 10.0)));
    paper.hear(&message(0.0, 0.0, 1, 0.0, 10.0).with_parameters(parameters(Some(0), 10.0)));
    let mut silent = paper.clone();
    paper.estimate(0.0);
    paper.hear(&message(1.0, 1.0, 0, 32.0, 0.0));
    assert_eq!(paper.estimate(2.0), silent.estimate(2.0));

    let own = message(1.1, 1.0, 1, 10.0, 10.0);
    paper.hear(&own);
    silent.hear(&own);
    let (braked, free) = (paper.estimate(2.0).unwrap(), silent.estimate(2.0).unwrap());
    assert!(braked.speed_mps < free.speed_mps - 1.0, "{braked:?} {free:?}");
}

#[test]
fn reading_late_is_reading_every_step() {
    let messages: Vec<_> = (0..40)
        .map(|n| {
            let (stamp_s, vehicle) = (0.073 * f64::from(n), n as usize % 3);
            let position_m = 60.0 - 20.0 * vehicle as f64 + 9.0 * stamp_s;
            let ahead = vehicle.checked_sub(1);
            message(stamp_s + 0.03 * f64::from(n % 4), stamp_s, vehicle, position_m, 9.0)
                .with_parameters(parameters(ahead, 11.0))
        })
        .collect();
    let (mut every, mut late) = (Paper::new(2, STEP_S), Paper::new(2, STEP_S));
    for tick in 0..=40 {
        let now_s = f64::from(tick) * STEP_S;
        for heard in messages.iter().filter(|heard| heard.at_s <= now_s && heard.at_s > now_s - STEP_S) {
            every.hear(heard);
        }
        every.estimate(now_s);
    }
    messages.iter().for_each(|heard| late.hear(heard));
    assert_eq!(late.estimate(4.0), every.estimate(4.0));
    assert!(every.estimate(4.0).is_some());
}

#[test]
fn a_ring_of_vehicles_that_follow_one_another_is_broken_not_followed_forever() {
    let mut paper = Paper::new(0, STEP_S);
    paper.hear(&message(0.0, 0.0, 0, 0.0, 10.0).with_parameters(parameters(Some(1), 10.0)));
    paper.hear(&message(0.0, 0.0, 1, 15.0, 10.0).with_parameters(parameters(Some(0), 10.0)));
    let at = paper.estimate(1.0).unwrap();
    assert!((at.position_m - 10.0).abs() < 0.1, "{at:?}");
}

#[test]
fn a_predecessor_that_enters_the_chain_late_brings_its_last_sample() {
    let mut paper = Paper::new(1, STEP_S);
    paper.hear(&message(0.0, 0.0, 0, 30.0, 10.0).with_parameters(parameters(None, 10.0)));
    paper.hear(&message(0.0, 0.0, 1, 0.0, 10.0).with_parameters(parameters(None, 10.0)));
    assert!((paper.estimate(0.5).unwrap().position_m - 5.0).abs() < 1e-9);
    paper.hear(&message(0.6, 0.6, 1, 6.0, 10.0).with_parameters(parameters(Some(0), 10.0)));
    assert!(paper.estimate(3.0).unwrap().speed_mps > 10.5);
}
