//! A station that has got farther away than the unit reaches: its messages are refused and not driven by, but they release who
//! waits where it was heard last.

use crate::rig;
use crate::rig::m_of;
use crate::rig::road::Road;
use holdover::config::Envelope;
use holdover::controller::Mode;
use holdover::health::Cause;

/// An ego that stands at the near end of a target that went silent two minutes ago, at 15 m/s.
fn left_behind(envelope: Option<Envelope>) -> Road {
    let mut config = rig::config();
    config.envelope = envelope;
    let mut road = Road::new(&config, 15.0, 25.0);
    road.power_up();
    road.run(10.0);
    road.senses.v2x = false;
    road.run(140.0);
    assert!(road.gap() > 1_510.0 && road.ego.speed == 0.0, "{} {}", road.gap(), road.ego.speed);
    road
}

#[test]
fn who_stands_where_a_silent_target_was_drives_on_when_that_is_heard_from_too_far_away() {
    for envelope in [None, Some(Envelope::CAR)] {
        let mut road = left_behind(envelope);
        let before = road.rig.unit.health().of(Cause::TooFar);
        road.senses.v2x = true;
        let mode = road.run(20.0).answer.mode;
        assert!(road.rig.unit.health().of(Cause::TooFar) > before + 100);
        // It is not followed: it is as silent as before.
        assert!(matches!(mode, Mode::Fallback { .. }), "{mode:?}");
        assert!(road.ego.speed > 5.0, "{envelope:?}: {}", road.ego.speed);
        let (near, truth) = (road.rig.unit.bound(2, rig::instant(road.now)).unwrap(), road.target.position);
        assert!(m_of(near.lowest_position()) <= truth && truth <= m_of(near.highest_position()));
        assert!(truth - m_of(near.lowest_position()) < 5.0);
    }
}

#[test]
fn a_lie_from_too_far_away_releases_nobody() {
    let mut road = left_behind(None);
    road.senses.v2x = true;
    // Where no vehicle can have got in two minutes.
    road.lie = (9_000.0, 0.0);
    road.run(20.0);
    assert!(road.ego.speed == 0.0, "{}", road.ego.speed);
}
