//! The range sensor: it narrows what is certain of the target, corrects the estimate in a silence, contradicts what is
//! impossible, and drives the vehicle when nothing is heard.

use crate::rig;
use crate::rig::road::Road;
use crate::rig::{instant, m_of, mps_of};
use holdover::config::Envelope;
use holdover::controller::{FallbackCause, Mode};
use holdover::time::Duration;
use holdover::wire::Predecessor;
use holdover::wire::command::ModeCode;
use holdover::{Config, health::Cause};

/// Following at 20 m/s, everything heard up to now; then a silence of the radio.
fn silent(config: &Config, range: bool) -> Road {
    let mut road = Road::new(config, 20.0, 22.0);
    road.power_up();
    road.run(1.01);
    road.senses.v2x = false;
    road.senses.range = range;
    road
}

fn width(road: &Road) -> (f64, f64) {
    let bound = road.rig.unit.bound(2, instant(road.now)).unwrap();
    let position = m_of(bound.highest_position()) - m_of(bound.lowest_position());
    (position, mps_of(bound.highest_speed()) - mps_of(bound.lowest_speed()))
}

fn error(road: &Road) -> f64 {
    let estimate = road.rig.unit.estimator().read(2, instant(road.now)).unwrap();
    (m_of(estimate.position) - road.target.position).abs()
}

#[test]
fn it_narrows_the_bound_and_the_truth_stays_inside() {
    let mut road = silent(&rig::config(), true);
    let mut blind = silent(&rig::config(), false);
    for step in 0..400 {
        road.acceleration = [1.5, -3.0, 0.0, 2.0][step / 100];
        road.step();
        blind.step();
        let bound = road.rig.unit.bound(2, instant(road.now)).unwrap();
        let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
        assert!((low..=high).contains(&road.target.position), "{step}: {} in {low}..{high}", road.target.position);
        let (low, high) = (mps_of(bound.lowest_speed()), mps_of(bound.highest_speed()));
        assert!((low..=high).contains(&road.target.speed), "{step}: {} in {low}..{high}", road.target.speed);
    }
    assert!(width(&road).0 < 1.8 && width(&blind).0 > 60.0, "{:?} {:?}", width(&road), width(&blind));
    assert!(width(&road).1 < 1.6 && width(&blind).1 > 20.0, "{:?} {:?}", width(&road), width(&blind));
    assert_eq!(road.rig.unit.mode().code(), ModeCode::Holdover);
}

#[test]
fn in_a_silence_the_estimate_follows_what_is_seen() {
    let (mut road, mut blind) = (silent(&rig::config(), true), silent(&rig::config(), false));
    for road in [&mut road, &mut blind] {
        road.acceleration = -2.0;
        road.run(3.0);
    }
    assert!(error(&road) < 0.5 && error(&blind) > 4.0, "{} {}", error(&road), error(&blind));
}

#[test]
fn a_braking_that_is_not_what_was_said_is_answered_soon_though_nothing_is_heard() {
    // A speed in a view errs by up to 0.6 m/s, and the ego's own by a little: usually by a third, which is 0.25 m/s. After that it takes
    // three views, one every 50 ms.
    for (braking, within) in [(1.0, 0.40), (2.0, 0.30), (5.0, 0.20)] {
        let mut road = Road::steady(&Config { envelope: None, ..rig::config() }, 20.0, 22.0);
        road.senses.v2x = false;
        road.run(1.0);
        road.acceleration = -braking;
        let answered = (0..200).position(|_| {
            road.step();
            road.command < -0.05
        });
        let after = answered.expect("it brakes") as f64 * 0.01;
        assert!(after <= within, "{after} s behind {braking} m/s²");
    }
}

#[test]
fn views_that_are_slower_show_something_where_three_are_in_a_row() {
    // Views that are slower by this, each so long after the one before; and whether the vehicle brakes for them.
    for (views, brakes) in
        [(&[50, 50][..], false), (&[50, 50, 50], true), (&[50, 50, 600], false), (&[50, 600, 50], false)]
    {
        let mut road = Road::steady(&Config { envelope: None, ..rig::config() }, 20.0, 22.0);
        (road.senses.v2x, road.senses.range) = (false, false);
        for pause in views {
            road.run(f64::from(*pause) / 1_000.0);
            road.rig.range(road.now, road.gap(), road.target.speed - road.ego.speed - 0.4, 0).unwrap();
        }
        road.commands.clear();
        road.run(0.3);
        let hardest = road.commands.iter().fold(0.0f64, |hardest, command| hardest.min(*command));
        assert_eq!(hardest < -0.05, brakes, "{views:?}: {hardest} m/s²");
    }
}

#[test]
fn fresh_messages_are_left_alone() {
    let mut road = silent(&rig::config(), true);
    road.senses.v2x = true;
    // Within the sensor's accuracy of 0.2 m, but worse than what is heard.
    road.wrong = 0.15;
    for _ in 0..200 {
        road.step();
        assert!(error(&road) < 0.1, "{}", error(&road));
    }
}

#[test]
fn disagreement_beyond_both_bounds_is_a_fallback_that_is_left_when_they_agree() {
    for wrong in [-6.0, 8.0, 40.0] {
        let mut road = silent(&rig::config(), true);
        road.senses.v2x = true;
        assert_eq!(road.run(0.5).command.mode, ModeCode::Cooperative);
        road.wrong = wrong;
        let heard = road.run(0.3);
        let is_named = matches!(heard.answer.mode, Mode::Fallback { cause: FallbackCause::RangeDisagrees, .. });
        assert!(is_named, "{wrong}: {:?}", heard.answer.mode);
        road.run(2.0);
        assert_eq!(road.rig.unit.health().of(Cause::RangeDisagrees), 1, "however long it lasts");
        road.wrong = 0.0;
        assert_eq!(road.run(0.9).command.mode, ModeCode::Fallback);
        assert_eq!(road.run(0.2).command.mode, ModeCode::Cooperative);
    }
}

#[test]
fn what_is_no_longer_seen_contradicts_nothing() {
    let mut road = silent(&rig::config(), true);
    road.senses.v2x = true;
    // Somebody cuts in, and leaves again: the sensor then says nothing.
    road.wrong = -10.0;
    assert_eq!(road.run(0.5).command.mode, ModeCode::Fallback);
    road.senses.range = false;
    assert_eq!(road.run(1.1).command.mode, ModeCode::Cooperative);
}

#[test]
fn a_single_wrong_view_is_no_disagreement() {
    let mut road = silent(&rig::config(), true);
    road.senses.v2x = true;
    road.run(0.5);
    for _ in 0..20 {
        road.wrong = 30.0;
        road.run(0.1);
        road.wrong = 0.0;
        assert_eq!(road.run(0.1).command.mode, ModeCode::Cooperative);
    }
}

#[test]
fn a_view_without_the_own_motion_is_refused() {
    let mut road = Road::new(&rig::config(), 20.0, 22.0);
    let _ = road.rig.range(0, 22.0, 0.0, 0);
    assert_eq!(road.rig.range(10_000, 22.0, 0.0, 0), Err(Cause::Torn));
    road.run(0.5);
    assert_eq!(road.rig.range(road.now, 22.0, 0.0, 0), Ok(()));
    assert_eq!(road.rig.range(road.now + 200_000, 22.0, 0.0, 0), Err(Cause::Stale));
}

/// A unit that gives its target up after 1 s.
fn impatient(envelope: Option<Envelope>) -> Config {
    let mut config = Config { envelope, ..rig::config() };
    config.link.holdover = Duration::from_millis(1_000);
    config
}

#[test]
fn in_fallback_the_vehicle_goes_on_behind_what_it_sees() {
    let mut road = silent(&impatient(None), true);
    let heard = road.run(30.0);
    assert_eq!(heard.command.mode, ModeCode::Fallback);
    // The time gap of the cruise control, 1.8 s, and the standstill distance.
    assert!(
        (road.ego.speed - 20.0).abs() < 0.2 && (road.gap() - 38.0).abs() < 1.0,
        "{} {}",
        road.ego.speed,
        road.gap()
    );
}

#[test]
fn in_fallback_nothing_is_hit_that_the_sensor_sees_braking() {
    // Without the envelope for normal braking, with it for the worst.
    for (envelope, braking) in [(None, 3.5), (Some(Envelope::CAR), 3.5), (Some(Envelope::CAR), 8.0)] {
        for seconds in [1.5, 3.0, 12.0] {
            let mut road = silent(&impatient(envelope), true);
            assert_eq!(road.run(seconds).command.mode, ModeCode::Fallback);
            road.acceleration = -braking;
            let least = road.run_to_rest();
            assert!(least > 0.0, "{envelope:?} {braking} after {seconds}: {least}");
        }
    }
}

#[test]
fn behind_a_vehicle_that_says_nothing_the_envelope_goes_by_what_is_seen() {
    for predecessor in [Predecessor::Unknown, Predecessor::Station(holdover::wire::StationHash(99))] {
        let mut road = Road::new(&impatient(Some(Envelope::CAR)), 20.0, 40.0);
        road.senses.v2x = false;
        road.senses.range = true;
        road.predecessor = predecessor;
        road.power_up();
        assert_eq!(road.run(15.0).command.mode, ModeCode::Fallback);
        assert!(road.ego.speed > 15.0, "{}", road.ego.speed);
        // As hard as any road vehicle can.
        road.acceleration = -12.0;
        let least = road.run_to_rest();
        assert!(least > 0.0, "{predecessor:?}: {least}");
    }
}

#[test]
fn without_a_sensor_a_given_up_target_is_stopped_behind_at_the_near_end_of_its_bound() {
    let mut config = impatient(None);
    // So early that normal braking is enough to stop before the point where the target may stand.
    config.link.holdover = Duration::from_millis(260);
    config.law.time_gap = holdover::units::Seconds::from_millis(3_900);
    let mut road = Road::new(&config, 20.0, 80.0);
    road.power_up();
    road.run(1.01);
    road.senses.v2x = false;
    let track = road.rig.unit.peers().get(2).unwrap();
    let stop = m_of(track.certainty().bound().unwrap().nearest_stop(&track.reach())) - rig::LENGTH;
    // It goes on, but nobody says so.
    assert_eq!(road.run(40.0).command.mode, ModeCode::Fallback);
    assert!(road.ego.speed < 0.05, "{}", road.ego.speed);
    let left = stop - road.ego.position;
    // The standstill distance; the estimate itself is far ahead by then.
    assert!((1.0..3.0).contains(&left) && road.gap() > 500.0, "{left} {}", road.gap());
}

#[test]
fn what_was_left_far_behind_does_not_turn_up_ahead() {
    // Not engaged, the driver goes on alone for kilometres; the target stays behind and is silent.
    for way in [3_000.0, 4_060.0, 8_150.0] {
        let mut road = silent(&impatient(None), false);
        road.engaged = false;
        road.run(3.0);
        road.ego.position += way;
        road.run(0.5);
        road.engaged = true;
        road.commands.clear();
        road.run(1.0);
        assert!(road.commands.iter().all(|u| *u <= 0.0), "{way}: {:?}", road.commands);
    }
}
