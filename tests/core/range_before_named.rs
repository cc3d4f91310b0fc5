//! What the sensor saw to be free before the driver named a vehicle says nothing of that vehicle: it was not on the ego's path yet.

use crate::rig::road::Road;
use crate::rig::{LENGTH, TARGET, config, instant, m_of};
use holdover::Config;
use holdover::config::Envelope;
use holdover::wire::Predecessor;

/// The ego drives alone at 12 m/s. A vehicle beside its path is heard, falls silent and slows down. It comes onto the path 22 m ahead,
/// and the driver names it then. The sensor sees 45 m of free path until just before; its last word, which is 40 ms old, comes just after.
fn named_after(says_nobody: bool) -> (Road, bool) {
    let mut road = Road::new(&Config { range_sensor: true, envelope: Some(Envelope::CAR), ..config() }, 12.0, 30.0);
    road.predecessor = Predecessor::None;
    road.rig.wanted = 12.0;
    road.power_up();
    road.run(1.0);
    road.senses.v2x = false;
    let mut is_inside = true;
    let mut named = None;
    for step in 0..1_500 {
        road.acceleration = if road.target.speed > 9.0 { -1.0 } else { 0.0 };
        if named.is_none() && road.gap() < 22.0 && road.now % 100_000 == 0 {
            road.predecessor = Predecessor::Station(TARGET);
            named = Some(road.now);
        }
        if named.is_some() {
            road.acceleration = -4.0;
        }
        if says_nobody && named.is_none() && step % 2 == 0 {
            let _ = road.rig.nobody(road.now, 45.0, 0);
        }
        road.step();
        if says_nobody && named == Some(road.now - 10_000) {
            // Of 30 ms before the naming.
            let _ = road.rig.nobody(road.now, 45.0, 40);
        }
        let bound = road.rig.unit.bound(2, instant(road.now)).unwrap();
        let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
        is_inside &= (low..=high).contains(&road.target.position);
        if road.gap() < -LENGTH {
            break;
        }
    }
    assert!(named.is_some());
    (road, is_inside)
}

#[test]
fn what_was_free_before_a_vehicle_was_named_says_nothing_of_that_vehicle() {
    for says_nobody in [false, true] {
        let (road, is_inside) = named_after(says_nobody);
        assert!(is_inside && road.gap() > 0.0, "{says_nobody}: {is_inside}, {:.1} m", road.gap());
    }
}
