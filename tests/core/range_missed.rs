//! A range sensor that misses the vehicle ahead in a single view, and sees one beyond it, does not take that one off the
//! gate's mind.

use crate::rig;
use crate::rig::road::Road;
use crate::rig::{instant, m_of};
use holdover::config::Envelope;

/// Following at 20 m/s, everything heard up to now; then a silence of the radio, and the sensor sees.
fn silent() -> Road {
    let mut config = rig::config();
    config.envelope = Some(Envelope::CAR);
    let mut road = Road::new(&config, 20.0, 22.0);
    road.rig.wanted = 25.0;
    road.power_up();
    road.run(1.01);
    road.senses.v2x = false;
    road.senses.range = true;
    road
}

/// One view that is off by so much.
fn one_view(road: &mut Road, wrong: f64) {
    while road.now % 50_000 != 0 {
        road.step();
    }
    road.wrong = wrong;
    road.step();
    road.wrong = 0.0;
}

#[test]
fn after_a_cut_in_one_missed_view_does_not_make_the_target_vanish() {
    for blind_after in [0.0, 0.5] {
        let mut road = silent();
        road.run(1.0);
        // Somebody cuts in, and leaves again.
        road.wrong = -8.0;
        road.run(0.3);
        one_view(&mut road, 60.0);
        if blind_after > 0.0 {
            road.run(blind_after);
        }
        road.senses.range = false;
        road.acceleration = -8.0;
        let least = road.run_to_rest();
        assert!(least > 0.0, "blind after {blind_after}: {least}");
    }
}

#[test]
fn one_missed_view_does_not_move_what_is_certain_of_a_silent_target() {
    let mut road = silent();
    road.run(4.0);
    one_view(&mut road, 15.0);
    let bound = road.rig.unit.bound(2, instant(road.now)).unwrap();
    let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
    let inside = (low..=high).contains(&road.target.position);
    road.senses.range = false;
    road.acceleration = -8.0;
    let least = road.run_to_rest();
    assert!(inside && least > 0.0, "{inside} {least}");
}
