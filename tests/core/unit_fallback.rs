//! Driving without messages to drive by: no faster than the driver wants, by what the sensor sees or has seen standing, and
//! past a contradiction without a stop. The world is float64 and knows the unit by its frames alone.

use crate::rig;
use crate::rig::plant::Body;
use crate::rig::road::Road;
use holdover::Config;
use holdover::config::Envelope;
use holdover::time::Duration;
use holdover::wire::Predecessor;
use holdover::wire::command::ModeCode;

/// A unit that gives its target up after 1 s.
fn impatient(envelope: Option<Envelope>) -> Config {
    let mut config = Config { envelope, ..rig::config() };
    config.link.holdover = Duration::from_millis(1_000);
    config
}

const GATE: Option<Envelope> = Some(Envelope::CAR);

/// The fastest that the ego gets in so many seconds.
fn fastest(road: &mut Road, seconds: f64) -> f64 {
    (0..(seconds * 100.0) as u64).fold(0.0, |fastest, _| {
        road.step();
        f64::max(fastest, road.ego.speed)
    })
}

#[test]
fn in_a_fallback_nobody_is_followed_faster_than_the_driver_wants() {
    // Behind a car that is seen, and behind targets that are silent, nearer and farther than 1.5 km.
    for (gap, speed, is_seen) in [(60.0, 20.0_f64, true), (700.0, 13.4, false), (1_490.0, 50.0, false)] {
        let mut road = Road::new(&impatient(None), speed.min(13.4), gap);
        road.target.speed = speed;
        road.rig.wanted = 13.4;
        if is_seen {
            road.predecessor = Predecessor::Unknown;
        }
        road.senses.v2x = !is_seen;
        road.power_up();
        road.run(1.01);
        (road.senses.v2x, road.senses.range) = (false, is_seen);
        // Until the fallback the law may catch up with a fifth more.
        road.run(25.0);
        let fastest = fastest(&mut road, 15.0);
        assert_eq!(road.step().command.mode, ModeCode::Fallback);
        // A millimetre per second is the own speed's rounding on the wire; the free road is approached from below.
        assert!((13.0..13.41).contains(&fastest), "{gap} m, {speed} m/s: {fastest}");
    }
}

#[test]
fn in_a_fallback_the_wish_may_change() {
    let mut road = Road::new(&impatient(None), 13.4, 60.0);
    road.predecessor = Predecessor::Unknown;
    (road.senses.v2x, road.senses.range) = (false, true);
    road.power_up();
    for (wanted, at_last) in [(13.4, 13.4), (8.0, 8.0), (30.0, 13.4)] {
        road.rig.wanted = wanted;
        road.run(40.0);
        assert!((road.ego.speed - at_last).abs() < 0.25, "wants {wanted}: {}", road.ego.speed);
        // The sensor's range is 262 m; the one ahead is brought back into it.
        road.target.position = road.ego.position + rig::LENGTH + 100.0;
    }
}

#[test]
fn caution_begins_gently_however_long_the_fallback_has_lasted() {
    let mut road = Road::new(&impatient(None), 20.0, 38.0);
    road.predecessor = Predecessor::Unknown;
    (road.senses.v2x, road.senses.range) = (false, true);
    road.power_up();
    assert_eq!(road.run(40.0).command.mode, ModeCode::Fallback);
    road.senses.range = false;
    road.commands.clear();
    road.run(2.0);
    // 0.5 m/s² more every second, after the 0.2 s that a view lasts.
    let hardest = road.commands.iter().copied().fold(0.0, f64::min);
    assert!((-0.95..-0.8).contains(&hardest), "{hardest}");
}

/// A leader at this speed that wants to keep it, with a stranger standing so far ahead that its sensor sees.
fn before_a_stranger(speed: f64, gap: f64) -> Road {
    let mut road = Road::new(&impatient(GATE), speed, gap);
    road.rig.wanted = speed;
    road.target.speed = 0.0;
    road.predecessor = Predecessor::None;
    (road.senses.v2x, road.senses.range) = (false, true);
    road
}

#[test]
fn a_sensor_that_drops_out_before_a_standing_stranger_leads_to_no_hit() {
    for (speed, seen_from) in [(8.0, 60.0), (20.0, 120.0), (30.0, 240.0)] {
        for from in [0.15, 0.3, 0.45, 0.6, 0.75, 0.9] {
            for blind in [0.3, 0.6, 1.0, 9.0] {
                let mut road = before_a_stranger(speed, seen_from + 4.0 * speed);
                let (mut least, mut hit) = (f64::MAX, 0.0);
                let mut since = 0;
                for _ in 0..3_000 {
                    let gap = road.gap();
                    if gap < from * seen_from && since == 0 {
                        since = road.now;
                    }
                    let is_out = since > 0 && road.now < since + (blind * 1e6) as i64;
                    road.senses.range = gap < seen_from && !is_out;
                    road.step();
                    least = f64::min(least, road.gap());
                    if road.gap() < 0.0 {
                        hit = road.ego.speed;
                        break;
                    }
                }
                assert!(least > 0.0, "{speed} m/s, blind for {blind} s from {from}: hit at {hit}");
            }
        }
    }
}

#[test]
fn a_stranger_that_brakes_as_hard_as_it_can_while_the_sensor_is_out_for_a_second_is_not_hit() {
    for speed in [10.0, 20.0, 30.0] {
        for late in [0.0, 0.3, 0.6] {
            let mut road = before_a_stranger(speed, 2.0 + 1.8 * speed);
            road.target.speed = speed;
            road.run(3.0);
            // Views come every 50 ms.
            road.senses.range = false;
            road.run(late + 0.001);
            road.acceleration = -12.0;
            road.run(0.95 - late);
            road.senses.range = true;
            let least = road.run_to_rest();
            assert!(least > 0.0, "{speed} m/s, brakes {late} s after the last view: {least}");
        }
    }
}

#[test]
fn what_was_seen_standing_holds_nobody_for_longer_than_ten_seconds() {
    let mut road = before_a_stranger(15.0, 100.0);
    road.run(20.0);
    assert!(road.ego.speed == 0.0 && road.gap() > 0.0, "{} {}", road.ego.speed, road.gap());
    // It is gone, and nobody sees anything.
    road.target.position += 10_000.0;
    road.senses.range = false;
    road.run(9.9);
    assert!(road.ego.speed < 0.1, "{}", road.ego.speed);
    road.run(10.0);
    assert!(road.ego.speed > 5.0, "{}", road.ego.speed);
}

#[test]
fn a_view_of_somebody_farther_ahead_releases_what_was_seen_standing() {
    let mut road = before_a_stranger(15.0, 100.0);
    road.run(20.0);
    assert!(road.ego.speed == 0.0);
    road.target = Body { position: road.target.position + 120.0, speed: 15.0 };
    road.run(3.0);
    assert!(road.ego.speed > 1.0, "{}", road.ego.speed);
}

#[test]
fn what_was_seen_standing_beyond_one_that_cuts_in_is_not_forgotten() {
    // The stranger stands 100 m ahead; somebody at 25 m/s cuts in, hides it, and swerves out 5 m before it.
    for hidden_from in [95.0, 70.0, 50.0] {
        let mut road = before_a_stranger(20.0, 160.0);
        let mut cuts_in: Option<Body> = None;
        let mut least = f64::MAX;
        for _ in 0..2_000 {
            let standing = road.gap();
            if standing < hidden_from && cuts_in.is_none() {
                cuts_in = Some(Body { position: road.ego.position + 20.0, speed: 25.0 });
            }
            let hides = cuts_in.filter(|other| other.position < road.target.position - rig::LENGTH - 5.0);
            road.senses.range = hides.is_none();
            if let (Some(other), 0) = (hides, road.now % 50_000) {
                let _ = road.rig.ego(road.now, road.ego.position, road.ego.speed, road.ego.acceleration, road.command);
                let _ = road.rig.range(road.now, other.position - road.ego.position, 25.0 - road.ego.speed, 0);
            }
            cuts_in = cuts_in.map(|other| other.after(0.0, 0.01));
            road.step();
            least = f64::min(least, road.gap());
        }
        assert!(least > 0.0, "hidden from {hidden_from}: {least}");
    }
}

#[test]
fn what_the_driver_has_passed_by_does_not_stop_the_unit() {
    let mut road = before_a_stranger(15.0, 60.0);
    road.engaged = false;
    while road.gap() > -10.0 {
        road.senses.range = road.gap() > 0.5;
        road.step();
    }
    road.engaged = true;
    road.commands.clear();
    road.run(3.0);
    assert!(road.commands.iter().all(|u| *u > -0.5), "{:?}", road.commands);
}

/// Two minutes behind a target that never stops, whose word and the sensor's differ: the slowest, the least gap, and the
/// shares of ticks in Fault and in Fallback.
fn contradicted(envelope: Option<Envelope>, wrong: f64, slow_clock: f64) -> (f64, f64, f64, f64) {
    let mut road = Road::new(&Config { envelope, ..rig::config() }, 20.0, 22.0);
    road.power_up();
    road.senses.range = true;
    road.wrong = wrong;
    let (mut slowest, mut least, mut faults, mut fallbacks) = (f64::MAX, f64::MAX, 0.0, 0.0);
    for step in 0..12_000 {
        road.acceleration = [0.0, -1.5, 0.0, 1.5, 0.5, -0.5][step / 400 % 6];
        road.lie = (-slow_clock * road.target.speed, -slow_clock * road.acceleration);
        let heard = road.step();
        slowest = f64::min(slowest, road.ego.speed);
        least = f64::min(least, road.gap());
        faults += f64::from(u8::from(heard.command.mode == ModeCode::Fault)) / 12_000.0;
        fallbacks += f64::from(u8::from(heard.command.mode == ModeCode::Fallback)) / 12_000.0;
    }
    (slowest, least, faults, fallbacks)
}

#[test]
fn a_contradiction_is_driven_through_by_what_is_seen() {
    for envelope in [None, GATE] {
        for (wrong, slow_clock) in [(0.5, 0.0), (-0.5, 0.0), (3.0, 0.0), (-3.0, 0.0), (0.0, 0.1), (0.0, -0.1)] {
            let (slowest, least, faults, fallbacks) = contradicted(envelope, wrong, slow_clock);
            let what = format!(
                "{wrong} m, {slow_clock} s, gate {}: slowest {slowest}, gap {least}, fault {faults}, fallback {fallbacks}",
                envelope.is_some()
            );
            println!("{what}");
            // The target's own slowest is 14 m/s.
            assert!(faults == 0.0 && slowest > 11.0 && least > 0.0, "{what}");
        }
    }
}

#[test]
fn behind_a_lie_the_seen_one_is_followed_and_not_hit() {
    // It says that it is much nearer or farther, and brakes as hard as any vehicle.
    for lie in [-25.0, -15.0, 15.0, 60.0] {
        let mut road = Road::new(&Config { envelope: GATE, ..rig::config() }, 20.0, 42.0);
        road.power_up();
        road.run(1.0);
        road.senses.range = true;
        road.lie = (lie, 0.0);
        road.run(30.0);
        assert!(road.ego.speed > 15.0, "{lie}: {}", road.ego.speed);
        road.acceleration = -12.0;
        let least = road.run_to_rest();
        assert!(least > 0.0, "{lie}: {least}");
    }
}

#[test]
fn one_that_cuts_in_where_a_silent_target_may_be_is_not_taken_for_it() {
    for silent_for in [2.0, 3.0] {
        let mut config = Config { envelope: GATE, ..rig::config() };
        config.law.time_gap = holdover::units::Seconds::from_millis(600);
        let mut road = Road::new(&config, 30.0, 60.0);
        road.rig.wanted = 30.0;
        road.power_up();
        road.run(1.0);
        road.senses.v2x = false;
        road.run(silent_for);
        // The target goes on beyond; another one cuts in, and says nothing.
        road.target = Body { position: road.ego.position + rig::LENGTH + 40.0, speed: road.ego.speed };
        road.senses.range = true;
        assert_eq!(road.run(11.0).command.mode, ModeCode::Holdover);
        let gap = road.gap();
        road.acceleration = -12.0;
        let least = road.run_to_rest();
        assert!(least > 0.0, "silent for {silent_for} s, {gap} m apart: {least}");
    }
}

#[test]
fn a_target_that_is_gone_holds_nobody_where_the_sensor_sees_that_nobody_is() {
    for (envelope, silent_for) in [(None, 1.5), (GATE, 1.5), (None, 20.0), (GATE, 20.0)] {
        let mut road = Road::new(&impatient(envelope), 15.0, 150.0);
        road.power_up();
        road.run(1.0);
        // It stops, falls silent, and leaves unheard.
        for _ in 0..2_000 {
            road.acceleration = if road.target.speed > 0.0 { -3.0 } else { 0.0 };
            road.step();
        }
        assert!(road.ego.speed == 0.0 && road.gap() < 10.0, "{} {}", road.ego.speed, road.gap());
        road.senses.v2x = false;
        road.run(silent_for);
        let stood = road.target.position;
        assert!(road.ego.speed == 0.0);
        // Another one drives, seen 40 m ahead.
        road.target = Body { position: stood + 40.0, speed: 12.0 };
        road.acceleration = 0.0;
        road.senses.range = true;
        road.run(10.0);
        let what = format!("{:?} after {silent_for} s", envelope.is_some());
        assert!(road.ego.position > stood + 20.0 && road.ego.speed > 5.0, "{what}: {} of {stood}", road.ego.position);
        assert!(road.gap() > 0.0);
        // When that one is lost from view too, nobody stands for a place that was left behind long ago.
        road.senses.range = false;
        road.commands.clear();
        road.run(1.5);
        assert!(road.commands.iter().all(|u| *u > -1.0), "{what}: {:?}", road.commands);
    }
}
