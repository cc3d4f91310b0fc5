//! The braking of a hand-back only grows, whatever becomes of the target meanwhile, and no pedal or pause leaves the unit stuck.

use crate::rig;
use crate::rig::road::{ALL_BUT_RANGE, Road, Senses};
use holdover::config::Envelope;
use holdover::controller::Mode;
use holdover::health::Cause;
use holdover::wire::Message;
use holdover::wire::actuators::{ActuatorState, Control};

const NO_DESK: Senses = Senses { desk: false, ..ALL_BUT_RANGE };
const ALONE: Senses = Senses { desk: false, v2x: false, range: true, ..ALL_BUT_RANGE };
const DRIVES: ActuatorState =
    ActuatorState { control: Control::Driving, accelerator: false, brake: false, holding: false, tick: 0 };

fn road(speed: f64, gap: f64, envelope: bool) -> Road {
    let mut config = rig::config();
    config.envelope = envelope.then_some(Envelope::CAR);
    let mut road = Road::new(&config, speed, gap);
    road.power_up();
    road.run(3.0);
    road
}

#[test]
fn the_braking_does_not_ease_when_the_target_has_been_silent_for_too_long() {
    let mut road = road(30.0, 40.0, false);
    road.senses = Senses { v2x: false, range: true, ..ALL_BUT_RANGE };
    road.run(12.0);
    road.senses = ALONE;
    road.run(1.0);
    // It may brake harder than that for the vehicle ahead, and ease from there, but never brakes less than has grown.
    let mut seconds = 0.7;
    while road.ego.speed > 1.0 {
        road.step();
        seconds += 0.01;
        let grown = (0.5 * (seconds - 0.2f64)).min(4.0);
        assert!(road.command < 0.05 - grown, "{} m/s² after {seconds} s at {} m/s", road.command, road.ego.speed);
    }
}

fn say(road: &mut Road, state: ActuatorState) {
    let _ = road.rig.put(road.now, &Message::Actuators(state));
}

#[test]
fn a_unit_whose_brake_was_pressed_while_the_request_was_lost_drives_again_when_it_is_asked_anew() {
    let mut road = road(15.0, 25.0, false);
    for _ in 0..3 {
        say(&mut road, DRIVES);
    }
    road.senses = NO_DESK;
    road.run(1.0);
    say(&mut road, ActuatorState { brake: true, ..DRIVES });
    assert_eq!(road.run(0.5).answer.mode, Mode::Standby);
    say(&mut road, DRIVES);
    road.senses = ALL_BUT_RANGE;
    assert_eq!(road.run(0.5).answer.mode, Mode::Standby);
    road.engaged = false;
    road.run(0.3);
    road.engaged = true;
    assert_eq!(road.run(0.5).answer.mode, Mode::Cooperative);
}

#[test]
fn requests_that_come_every_now_and_then_do_not_make_the_braking_hard() {
    let mut road = road(15.0, 25.0, true);
    road.commands.clear();
    let mut least = road.gap();
    for round in 0..40 {
        road.senses = if round % 2 == 0 { NO_DESK } else { ALL_BUT_RANGE };
        for _ in 0..60 {
            road.step();
            least = least.min(road.gap());
        }
    }
    let (down, up) = road.steepest();
    assert!(least > 0.0 && down > -5.3 && up < 5.3, "{least} {down} {up}");
    assert!(road.rig.unit.health().of(Cause::RequestLost) <= 20);
}

#[test]
fn nobody_is_hit_whatever_the_senses_are_during_a_hand_back() {
    for silent in 0..8u32 {
        for (braking, speed) in [(-3.0, 15.0), (-8.0, 15.0), (-1.0, 30.0), (-8.0, 30.0)] {
            for lost_after in [0, 100, 700] {
                let mut road = road(speed, speed * 1.7, true);
                let senses = |desk| Senses {
                    desk,
                    v2x: silent & 1 == 0,
                    range: silent & 2 != 0,
                    clock: silent & 4 == 0,
                    ego: true,
                };
                road.senses = senses(true);
                let mut least = road.gap();
                for period in 0..2_500 {
                    if period == lost_after {
                        road.senses = senses(false);
                        road.acceleration = braking;
                    }
                    road.step();
                    least = least.min(road.gap());
                }
                assert!(least > 0.0, "{silent} {braking} {speed} {lost_after}: {least}");
                assert!(road.ego.speed == 0.0, "{silent} {braking} {speed} {lost_after}");
            }
        }
    }
}
