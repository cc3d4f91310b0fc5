//! Driving without messages to drive by: no faster than the driver wants, by what the sensor sees. The
//! world is float64 and knows the unit by its frames alone.

mod rig;

use holdover::Config;
use holdover::config::Envelope;
use holdover::time::Duration;
use holdover::wire::Predecessor;
use holdover::wire::command::ModeCode;
use rig::road::Road;

/// A unit that gives its target up after 1 s.
fn impatient(envelope: Option<Envelope>) -> Config {
    let mut config = Config { envelope, ..rig::config() };
    config.link.holdover = Duration::from_millis(1_000);
    config
}

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
