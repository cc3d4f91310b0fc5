//! The driver's pedals and the actuators: the brake hands back at once and for good, the accelerator for as long as it is pressed, and
//! actuators that take no commands make the unit stand by; each is said in `Health`, and so are actuators that acknowledge no command. At
//! standstill the command asks to hold.

use crate::rig;
use crate::rig::Rig;
use crate::rig::road::Road;
use holdover::health::Cause;
use holdover::model::Body;
use holdover::units::Speed;
use holdover::wire::actuators::{ActuatorState, Control};
use holdover::wire::command::{Command, ModeCode};
use holdover::wire::{Message, Predecessor};

const DRIVES: ActuatorState =
    ActuatorState { control: Control::Driving, accelerator: false, brake: false, holding: false, tick: 0 };

/// Following at 15 m/s, and the actuators have been heard.
fn road() -> Road {
    let mut road = Road::new(&rig::config(), 15.0, 20.0);
    for _ in 0..3 {
        say(&mut road, DRIVES);
    }
    road.power_up();
    road.run(2.0);
    road
}

fn say(road: &mut Road, state: ActuatorState) {
    let _ = road.rig.put(road.now, &Message::Actuators(state));
}

/// The mode of the next answer, and the detail that `Health` tells within the next 100 ms.
fn told(road: &mut Road) -> (ModeCode, u8) {
    let mode = road.step().command.mode;
    let mut detail = None;
    for _ in 0..10 {
        for message in road.step().all {
            if let Message::Status(status) = message {
                detail = Some(status.detail);
            }
        }
    }
    (mode, detail.expect("it is told every 100 ms"))
}

#[test]
fn the_brake_hands_back_at_once_until_the_request_was_off() {
    let mut road = road();
    assert_eq!(told(&mut road), (ModeCode::Cooperative, 0));
    say(&mut road, ActuatorState { brake: true, ..DRIVES });
    assert_eq!(told(&mut road), (ModeCode::Standby, 8));
    say(&mut road, DRIVES);
    assert_eq!(told(&mut road), (ModeCode::Standby, 8), "releasing the pedal is no request");
    assert_eq!(road.rig.unit.health().of(Cause::DriverOverride), 1);
    road.engaged = false;
    road.run(0.2);
    assert_eq!(told(&mut road), (ModeCode::Standby, 0));
    road.engaged = true;
    road.run(0.2);
    assert_eq!(told(&mut road), (ModeCode::Cooperative, 0));
}

#[test]
fn the_accelerator_hands_back_for_as_long_as_it_is_pressed() {
    let mut road = road();
    for times in 1..4 {
        say(&mut road, ActuatorState { accelerator: true, ..DRIVES });
        assert_eq!(told(&mut road), (ModeCode::Standby, 9));
        say(&mut road, DRIVES);
        assert_eq!(told(&mut road), (ModeCode::Cooperative, 0));
        assert_eq!(road.rig.unit.health().of(Cause::DriverOverride), times);
    }
}

#[test]
fn a_pedal_that_nobody_reports_any_more_holds_until_the_driver_asks_anew() {
    for pressed in [ActuatorState { brake: true, ..DRIVES }, ActuatorState { accelerator: true, ..DRIVES }] {
        let mut road = road();
        say(&mut road, pressed);
        road.run(20.0);
        assert_eq!(told(&mut road).0, ModeCode::Standby, "silence is no release");
        road.engaged = false;
        road.run(0.2);
        road.engaged = true;
        road.run(0.2);
        assert_eq!(told(&mut road), (ModeCode::Cooperative, 0));
        // While the message comes, a pedal that is pressed still hands back.
        say(&mut road, pressed);
        road.engaged = false;
        road.run(0.1);
        say(&mut road, pressed);
        road.engaged = true;
        road.run(0.1);
        assert_eq!(told(&mut road).0, ModeCode::Standby);
    }
}

#[test]
fn a_failure_that_nobody_reports_any_more_holds() {
    let mut road = road();
    say(&mut road, ActuatorState { control: Control::Failed, ..DRIVES });
    road.engaged = false;
    road.run(1.0);
    road.engaged = true;
    road.run(0.2);
    assert_eq!(told(&mut road), (ModeCode::Standby, 10));
}

#[test]
fn actuators_that_take_no_commands_make_the_unit_stand_by() {
    for control in [Control::Off, Control::Failed] {
        let mut road = road();
        say(&mut road, ActuatorState { control, ..DRIVES });
        assert_eq!(told(&mut road), (ModeCode::Standby, 10), "{control:?}");
        say(&mut road, ActuatorState { control: Control::Ready, ..DRIVES });
        assert_eq!(told(&mut road), (ModeCode::Cooperative, 0), "{control:?}");
        assert_eq!(road.rig.unit.health().of(Cause::DriverOverride), 0, "nobody pressed a pedal");
    }
}

#[test]
fn pedals_of_a_driver_who_drives_are_no_override() {
    let mut road = road();
    road.engaged = false;
    road.run(0.3);
    say(&mut road, ActuatorState { brake: true, ..DRIVES });
    road.run(0.1);
    say(&mut road, DRIVES);
    road.engaged = true;
    road.run(0.3);
    assert_eq!(told(&mut road), (ModeCode::Cooperative, 0));
    assert_eq!(road.rig.unit.health().of(Cause::DriverOverride), 0);
}

#[test]
fn the_command_asks_to_hold_a_vehicle_that_stands_and_is_to_go_on_standing() {
    let mut road = road();
    assert!(!road.step().command.hold);
    road.acceleration = -4.0;
    road.run_to_rest();
    assert!(road.run(1.0).command.hold, "behind a vehicle that stands");
    road.engaged = false;
    assert!(!road.run(0.3).command.hold, "not in Standby");
}

#[test]
fn who_wants_to_stand_behind_one_that_stands_asks_to_hold_at_any_distance() {
    for gap in [2.0, 2.01, 3.0, 10.0, 60.0] {
        let mut road = Road::new(&rig::config(), 0.0, gap);
        road.rig.wanted = 0.0;
        road.power_up();
        let heard = road.run(2.0);
        assert!(heard.command.hold && rig::mps2_of(heard.command.acceleration) <= 0.0, "{gap} m: {:?}", heard.command);
    }
}

/// Its brakes are held by another than the unit, which is not told of it, and the vehicle wants to move off.
#[test]
fn a_vehicle_that_is_held_while_it_is_to_move_off_is_not_pushed_harder_and_harder() {
    let mut rig = Rig::new(&rig::config());
    rig.power_up(true, 0);
    for tick in 0..500 {
        let now = tick * 10_000;
        if tick % 10 == 0 {
            let _ = rig.request(now, true, Predecessor::None);
        }
        let _ = rig.ego(now, 1_000.0, 0.0, 0.0, 0.0);
        if tick % 50 == 0 {
            rig.synchronise(now, 0);
        }
        // The tick comes 8 ms after the measurement.
        let Command { acceleration, effort, .. } = rig.tick(now + 8_000).answer.command;
        assert_eq!(effort, Body::CAR.effort(acceleration, Speed::ZERO), "tick {tick}, for {acceleration:?}");
        assert!(tick < 100 || acceleration > rig::mps2(0.3), "it wants to move off: {acceleration:?}");
    }
}

#[test]
fn the_time_in_the_command_counts_milliseconds() {
    let mut road = road();
    let first = road.step().command.time_ms;
    for period in 1..300u16 {
        assert_eq!(road.step().command.time_ms, (first + 10 * period) % 1024);
    }
}

/// Drives for so long; the actuators say this of each command every 20 ms.
fn acknowledge(road: &mut Road, seconds: f64, says: impl Fn(u8) -> ActuatorState) {
    for _ in 0..(seconds / 0.02).round() as usize {
        road.step();
        let command = road.step().command;
        say(road, says(command.tick));
    }
}

#[test]
fn actuators_that_do_what_they_are_told_are_not_named() {
    let mut road = road();
    // A command of 50 ms ago is the oldest that is in force.
    acknowledge(&mut road, 5.0, |tick| ActuatorState { tick: tick.wrapping_sub(5) % 64, ..DRIVES });
    assert_eq!(road.rig.unit.health().of(Cause::CommandUnheeded), 0);
}

#[test]
fn actuators_that_acknowledge_no_command_in_force_are_named_once_each_time() {
    for unheeding in [
        |tick: u8| ActuatorState { tick: tick.wrapping_sub(6) % 64, ..DRIVES },
        |tick| ActuatorState { control: Control::Ready, tick, ..DRIVES },
    ] {
        let mut road = road();
        for times in 1..4 {
            acknowledge(&mut road, 1.0, |tick| ActuatorState { tick, ..DRIVES });
            acknowledge(&mut road, 0.16, unheeding);
            assert_eq!(road.rig.unit.health().of(Cause::CommandUnheeded), times - 1, "not before 200 ms");
            acknowledge(&mut road, 1.0, unheeding);
            assert_eq!(road.rig.unit.health().of(Cause::CommandUnheeded), times);
            assert_eq!(told(&mut road).0, ModeCode::Cooperative, "it drives on");
        }
    }
}

#[test]
fn a_number_that_stands_still_is_named_whenever_it_has_come_round() {
    let mut road = road();
    acknowledge(&mut road, 6.4, |_| ActuatorState { tick: 7, ..DRIVES });
    assert_eq!(road.rig.unit.health().of(Cause::CommandUnheeded), 10, "every 64 periods");
}

#[test]
fn while_the_unit_is_not_asked_to_drive_no_acknowledgement_is_expected() {
    let mut road = road();
    road.engaged = false;
    road.run(0.2);
    acknowledge(&mut road, 2.0, |_| ActuatorState { control: Control::Ready, ..DRIVES });
    assert_eq!(road.rig.unit.health().of(Cause::CommandUnheeded), 0);
    road.engaged = true;
    road.run(0.2);
    acknowledge(&mut road, 2.0, |tick| ActuatorState { tick, ..DRIVES });
    assert_eq!(road.rig.unit.health().of(Cause::CommandUnheeded), 0);
}
