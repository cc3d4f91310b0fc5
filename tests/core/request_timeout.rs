//! The driver's request has a timeout: when it stops coming, the unit hands back. It slows down by a growing braking, keeps its
//! distance, names the cause, and drives on when the request is back.

use crate::rig;
use crate::rig::road::{ALL_BUT_RANGE, Road, Senses};
use holdover::Config;
use holdover::config::Envelope;
use holdover::controller::{FallbackCause, Mode};
use holdover::health::Cause;

fn hands_back(mode: Mode) -> bool {
    matches!(mode, Mode::Fallback { cause: FallbackCause::RequestLost, .. })
}

fn road(config: &Config, gap: f64) -> Road {
    let mut road = Road::new(config, 15.0, gap);
    road.power_up();
    road.run(3.0);
    road
}

const NO_DESK: Senses = Senses { desk: false, ..ALL_BUT_RANGE };

#[test]
fn a_request_holds_for_its_timeout_and_no_longer() {
    let mut road = road(&rig::config(), 20.0);
    // The last request came at a whole tenth of a second.
    while road.now % 100_000 != 10_000 {
        road.step();
    }
    road.senses = NO_DESK;
    let last = road.now - 10_000;
    while road.now - last <= 300_000 {
        let mode = road.step().answer.mode;
        assert!(!hands_back(mode), "{mode:?} after {} µs", road.now - last);
    }
    assert!(hands_back(road.step().answer.mode));
    assert_eq!(road.rig.unit.health().of(Cause::RequestLost), 1);
}

#[test]
fn without_a_request_the_unit_stops_gently_and_hits_nobody() {
    for (braking, envelope) in [(0.0, false), (-2.0, false), (-4.0, false), (-8.0, true)] {
        let mut config = rig::config();
        config.envelope = envelope.then_some(Envelope::CAR);
        let mut road = road(&config, 25.0);
        road.senses = NO_DESK;
        road.acceleration = braking;
        let mut least = road.gap();
        let mut seconds = 0.0;
        while road.ego.speed > 0.0 && seconds < 60.0 {
            road.step();
            seconds += 0.01;
            least = least.min(road.gap());
        }
        assert!(road.ego.speed == 0.0, "it drives on at {} m/s", road.ego.speed);
        assert!(least > 0.0, "it hits what brakes with {braking} m/s²");
        if braking == 0.0 {
            let (hardest, _) = road.steepest();
            assert!(hardest > -5.1, "the braking grows by {hardest} m/s³");
            assert!(seconds > 4.0, "it stops within {seconds} s");
        }
    }
}

#[test]
fn the_unit_drives_on_when_the_request_is_back() {
    let mut road = road(&rig::config(), 20.0);
    road.senses = NO_DESK;
    assert!(hands_back(road.run(1.0).answer.mode));
    road.senses = ALL_BUT_RANGE;
    assert_eq!(road.run(0.3).answer.mode, Mode::Cooperative);
    road.senses = NO_DESK;
    road.run(1.0);
    assert_eq!(road.rig.unit.health().of(Cause::RequestLost), 2, "each loss counts once");
}
