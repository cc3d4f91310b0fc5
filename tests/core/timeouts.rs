//! Every timeout that the DBC tells of what the unit receives is the time after which the unit reacts, with the default configuration.
//! Two units hear the same, but for one message, which one of them stops hearing: the first answer that differs is the reaction.

use crate::rig;
use crate::rig::road::{Road, Senses};
use holdover::controller::Mode;
use holdover::wire::Predecessor;
use holdover::wire::catalogue::{CATALOGUE, Node};

/// When the unit's answer first differs if something is not heard from a moment on; in milliseconds since the last time that it was.
fn reaction(
    silent: Senses,
    lasts_ms: i64,
    predecessor: Predecessor,
    differs: impl Fn(&Road, &Road, Mode, Mode) -> bool,
) -> i64 {
    let mut roads = [(); 2].map(|()| {
        let mut road = Road::new(&rig::config(), 15.0, 30.0);
        road.predecessor = predecessor;
        road.senses.range = true;
        road.power_up();
        road.run(3.0);
        // Everything was sent in the period that has just passed.
        while road.now % 500_000 != 10_000 {
            road.step();
        }
        road
    });
    let start = roads[0].now - 10_000;
    roads[1].senses = silent;
    for _ in 0..(lasts_ms / 10 + 200) {
        let at = roads[0].now;
        let modes = [0, 1].map(|index| roads[index].step().answer.mode);
        if differs(&roads[0], &roads[1], modes[0], modes[1]) {
            return (at - start) / 1000;
        }
    }
    i64::MAX
}

const ALL: Senses = Senses { ego: true, v2x: true, range: true, clock: true, desk: true };

/// The reactions: what is not heard, and how long it takes.
fn reaction_to(message: &str, timeout_ms: i64) -> Option<i64> {
    let target = Predecessor::Station(rig::TARGET);
    let by_mode = |_: &Road, _: &Road, one: Mode, other: Mode| one.code() != other.code();
    match message {
        "TimeSync" | "TimeFollowUp" => {
            let knows = |road: &Road| road.rig.unit.is_synchronised(rig::instant(road.now - 10_000));
            let differs = |one: &Road, other: &Road, _: Mode, _: Mode| knows(one) != knows(other);
            Some(reaction(Senses { clock: false, ..ALL }, timeout_ms, target, differs))
        }
        "EgoMotionA" | "EgoMotionB" => Some(reaction(Senses { ego: false, ..ALL }, timeout_ms, target, by_mode)),
        "DriverRequest" => Some(reaction(Senses { desk: false, ..ALL }, timeout_ms, target, by_mode)),
        // Nobody is named, so that the unit drives by what the sensor sees.
        "RangeSensor" => {
            let differs = |one: &Road, other: &Road, _: Mode, _: Mode| one.command != other.command;
            Some(reaction(Senses { range: false, ..ALL }, timeout_ms, Predecessor::Unknown, differs))
        }
        "Peer{slot}MotionA" | "Peer{slot}MotionB" => {
            Some(reaction(Senses { v2x: false, ..ALL }, timeout_ms, target, by_mode))
        }
        // Only on a route: tests/core/coordination_unserved.rs.
        "PeersUnserved" => None,
        other => panic!("{other} has a timeout, and nothing here shows it"),
    }
}

#[test]
fn the_unit_reacts_after_the_timeout_that_the_dbc_tells_and_not_before() {
    let received = CATALOGUE.iter().filter(|line| line.sender != Node::Unit && line.timeout_ms > 0);
    let mut shown = 0;
    for line in received {
        let timeout_ms = i64::from(line.timeout_ms);
        let Some(reaction_ms) = reaction_to(line.name, timeout_ms) else { continue };
        // What is as old as the timeout still counts; the next tick reacts.
        assert!(
            (timeout_ms..=timeout_ms + 10).contains(&reaction_ms),
            "{}: {reaction_ms} ms, not {timeout_ms}",
            line.name
        );
        shown += 1;
    }
    assert_eq!(shown, 8);
}
