//! Coordination in the whole unit, frames in and frames out: who comes first goes first, every leg on one virtual lane.

use crate::rig;
use crate::rig::junction::{CROSSING, Driver, HALF, Junction};
use crate::rig::plant;
use holdover::health::Cause;
use holdover::wire::Movement;
use holdover::wire::route::Route;
use holdover::wire::{Message, Predecessor, Said, Slot, StationHash};

/// The earlier one is station 2, on leg 1; the later one station 1, on leg 0, and `behind` metres further from the crossing.
fn two(behind: f64, envelope: bool) -> Junction {
    let first = Driver::new(2, 1, 40.0, 11.0, envelope);
    let second = Driver::new(1, 0, 40.0 - behind, 11.0, envelope);
    Junction::new(vec![second, first])
}

/// Lets the first one register before the second one is heard.
fn settled(mut junction: Junction) -> Junction {
    let position = junction.drivers[0].body.position;
    junction.drivers[0].engaged = false;
    junction.drivers[0].hears = false;
    junction.run(0.3, |junction| junction.drivers[0].body.position = position);
    let fresh = Driver::new(1, 0, position, 11.0, junction.drivers[0].rig.unit.config().envelope.is_some());
    let now = junction.now;
    junction.drivers[0] = fresh;
    junction.drivers[0].rig.power_up(true, 0);
    junction.drivers[0].rig.synchronise(now - 1, 0);
    junction
}

#[test]
fn a_vehicle_on_another_leg_is_where_it_is_from_the_crossing_point() {
    let mut junction = settled(two(15.0, false));
    junction.run(5.0, |_| {});
    let mut worst: f64 = 0.0;
    junction.run(6.0, |junction| {
        let truth = junction.drivers[1].body.position;
        // The bodies have moved on by one period since the tick.
        let estimate = junction.drivers[0].estimate().expect("the first one is followed");
        worst = worst.max((estimate + junction.drivers[1].body.speed * 0.01 - truth).abs());
    });
    assert!(worst < 0.05, "{worst}");
}

#[test]
fn who_comes_first_goes_first_and_both_say_so() {
    let mut junction = settled(two(3.0, false));
    let (mut claims, mut said_follow) = (Vec::new(), Vec::new());
    junction.run(5.0, |junction| {
        for message in &junction.drivers[0].last.as_ref().unwrap().all {
            match message {
                Message::Own(Said::Route(route)) => {
                    claims.push((route.intersection, route.movement.leg, route.predecessor))
                }
                Message::Own(Said::DrivingParameters(parameters)) => said_follow.push(parameters.predecessor),
                _ => {}
            }
        }
    });
    let first = Predecessor::Station(StationHash(2));
    assert_eq!((junction.drivers[0].follows(), junction.drivers[1].follows()), (Some(2), None));
    assert_eq!(claims.last(), Some(&(5, 0, first)));
    assert_eq!(said_follow.last(), Some(&first));
}

#[test]
fn neither_stops_nor_meets_the_other_in_the_conflict_area_and_no_command_jumps() {
    for behind in [0.5, 4.0, 9.0, 15.0, 25.0] {
        let mut junction = settled(two(behind, false));
        let (mut slowest, mut jump, mut both): (f64, f64, bool) = (f64::MAX, 0.0, false);
        let mut last = [0.0, 0.0];
        junction.run(25.0, |junction| {
            both |= junction.drivers.iter().all(Driver::is_inside);
            for (driver, last) in junction.drivers.iter().zip(&mut last) {
                slowest = slowest.min(driver.body.speed);
                jump = jump.max((driver.command() - *last).abs());
                *last = driver.command();
            }
        });
        assert!(!both && slowest > 1.0, "{behind} m behind: slowest {slowest}");
        // 5 m/s³ over 10 ms, and the command's resolution.
        assert!(jump < 0.05 + 0.021, "{behind} m behind: a jump of {jump}");
        assert!(junction.drivers[0].follows().is_none(), "the one that has left is not followed any more");
        assert!(junction.drivers[0].body.speed > 10.0 && junction.drivers[0].body.position > 220.0);
    }
}

#[test]
fn the_next_intersection_is_told_of_when_the_rear_has_left_the_first() {
    let mut junction = Junction::new(vec![Driver::new(1, 0, 150.0, 11.0, false)]);
    junction.run(10.0, |junction| {
        let front = junction.drivers[0].body.position;
        for message in &junction.drivers[0].last.as_ref().unwrap().all {
            let Message::Own(Said::Route(route)) = message else { continue };
            let distance = f64::from(route.distance.to_mm()) * 1e-3;
            // A review comes every 100 ms.
            if front < CROSSING + HALF + 4.7 {
                assert_eq!(route.intersection, 5);
            } else if front > CROSSING + HALF + 4.9 + 1.2 {
                assert_eq!(route.intersection, 6);
            }
            let crossing = if route.intersection == 5 { 200.0 } else { 390.0 };
            assert!((crossing - front - distance).abs() < 0.13, "{front} {distance}");
        }
    });
    assert!(junction.drivers[0].body.position > 240.0);
}

#[test]
fn beyond_the_last_intersection_nobody_who_comes_later_is_followed() {
    let mut junction = settled(two(30.0, false));
    let mut beyond = 0;
    junction.run(25.0, |junction| {
        let driver = &junction.drivers[1];
        if driver.body.position > CROSSING + HALF + 4.8 + 1.2 {
            beyond += 1;
            assert_eq!((driver.follows(), driver.rig.unit.coordination().crossing()), (None, None));
            assert!(driver.body.speed > 10.9);
            for message in &driver.last.as_ref().unwrap().all {
                let Message::Own(Said::Route(route)) = message else { continue };
                assert_eq!((route.intersection, route.predecessor), (5, Predecessor::None));
            }
        }
    });
    assert!(beyond > 500 && junction.drivers[0].body.position > 230.0);
}

#[test]
fn who_is_far_ahead_is_followed_only_when_it_is_in_the_way_and_no_command_jumps() {
    let mut junction =
        settled(Junction::new(vec![Driver::new(1, 0, 0.0, 11.0, false), Driver::new(2, 1, 90.0, 6.0, false)]));
    let (mut fastest, mut jump, mut last): (f64, f64, f64) = (0.0, 0.0, 0.0);
    let mut see = |junction: &mut Junction| {
        let ego = &junction.drivers[0];
        fastest = fastest.max(ego.body.speed);
        jump = jump.max((ego.command() - last).abs());
        last = ego.command();
    };
    junction.run(7.0, &mut see);
    assert_eq!(junction.drivers[0].follows(), None);
    let claim = junction.drivers[0].rig.unit.coordination().claim();
    assert_eq!(claim, Predecessor::Station(StationHash(2)), "but it is ahead in the order");
    junction.run(7.0, &mut see);
    assert_eq!(junction.drivers[0].follows(), Some(2));
    // Nobody catches up faster than it wants to drive; 5 m/s³ over 10 ms, and the command's resolution.
    assert!(fastest < 11.05, "{fastest}");
    assert!(jump < 0.05 + 0.021, "{jump}");
}

#[test]
fn a_vehicle_that_only_says_where_on_the_globe_it_is_goes_first() {
    let mut junction = two(-10.0, false);
    junction.drivers[1].says_route = false;
    junction.run(6.0, |_| {});
    // The later one by place is the one that says nothing of its arrival.
    assert_eq!(junction.drivers[0].follows(), Some(2));
    let estimate = junction.drivers[0].estimate().unwrap();
    assert!((estimate - junction.drivers[1].body.position).abs() < 0.2);
}

#[test]
fn with_the_envelope_nobody_enters_before_it_is_certain_that_the_area_is_left() {
    for silent_at in [60.0, 110.0, 150.0, 180.0, 195.0] {
        let mut junction = settled(two(6.0, true));
        let mut entered = false;
        junction.run(40.0, |junction| {
            let [ego, other] = &mut junction.drivers[..] else { panic!("two") };
            other.speaks &= other.body.position < silent_at;
            // After that the one ahead may brake at its hardest at once, and stand in the area for ever.
            entered |= !other.speaks && ego.body.position > CROSSING - HALF;
        });
        assert!(!entered, "silent at {silent_at} m: entered");
        assert!(junction.drivers[0].body.speed < 0.05);
    }
}

#[test]
fn with_the_envelope_nobody_enters_while_one_that_is_later_in_the_order_stands_in_the_area() {
    let mut junction = settled(two(6.0, true));
    junction.run(2.0, |_| {});
    // The later one stands in the area, however it came there; the earlier one does not run into it.
    let mut entered = false;
    junction.run(30.0, |junction| {
        junction.drivers[0].body = plant::Plant { position: CROSSING, speed: 0.0, acceleration: 0.0, lag: 0.3 };
        entered |= junction.drivers[1].body.position > CROSSING - HALF;
    });
    assert!(!entered && junction.drivers[1].body.speed < 0.05, "{}", junction.drivers[1].body.position);
}

#[test]
fn with_the_envelope_who_is_heard_to_leave_is_not_waited_for() {
    let mut junction = settled(two(6.0, true));
    junction.run(40.0, |_| {});
    assert!(junction.drivers[0].body.position > 300.0, "{}", junction.drivers[0].body.position);
}

#[test]
fn with_the_envelope_a_silent_one_on_the_same_leg_is_not_run_into_where_it_is_estimated_beyond_one_that_is_heard() {
    // The front one is slow, the middle one knows nothing of it and says so; then it is silent and brakes to a stand.
    let [ego, middle, front] = [(1, 20.0, 11.0), (2, 50.0, 11.0), (3, 90.0, 2.0)].map(|(station, at, speed)| {
        let mut driver = Driver::new(station, 0, at, speed, station == 1);
        driver.hears = station == 1;
        driver
    });
    let mut junction = Junction::new(vec![ego, middle, front]);
    junction.run(1.0, |_| {});
    junction.drivers[1].speaks = false;
    let plant::Plant { mut position, mut speed, .. } = junction.drivers[1].body;
    let (mut gap, mut is_passed): (f64, bool) = (f64::MAX, false);
    junction.run(12.0, |junction| {
        speed = (speed - 0.07).max(0.0);
        position += speed * 0.01;
        let lag = junction.drivers[1].body.lag;
        junction.drivers[1].body = plant::Plant { position, speed, acceleration: 0.0, lag };
        gap = gap.min(position - 4.8 - junction.drivers[0].body.position);
        let unit = &junction.drivers[0].rig.unit;
        let nearest = unit.coordination().choice().lane.and_then(|slot| unit.peers().get(slot.into())?.station());
        is_passed |= nearest == Some(StationHash(3));
    });
    assert!(is_passed, "the estimate of the middle one has passed the front one");
    assert!(gap > 0.0, "{gap}");
}

#[test]
fn who_has_moved_on_to_another_intersection_is_not_followed_for_a_tick_longer() {
    for until_s in [5.0, 5.03, 5.07] {
        let mut junction = settled(two(15.0, false));
        junction.run(until_s, |_| {});
        assert_eq!(junction.drivers[0].follows(), Some(2));
        junction.drivers[1].speaks = false;
        let now = junction.now;
        let newest = *junction.drivers[0].rig.unit.peers().get(1).unwrap().newest().unwrap();
        let route = Route {
            tag: 0,
            intersection: 6,
            movement: Movement::straight(1),
            distance: rig::metres(300.0),
            stamp: newest.stamp,
            arrival: 1,
            predecessor: Predecessor::None,
        };
        let slot = holdover::wire::Slot(1);
        junction.drivers[0].rig.put(now, &Message::Peer(slot, Said::Route(route))).unwrap();
        junction.run(0.01, |_| {});
        assert_eq!(junction.drivers[0].follows(), None, "{until_s}");
    }
}

#[test]
fn when_an_axis_moves_everything_held_of_its_peer_moves_with_it() {
    let mut junction = settled(two(15.0, false));
    junction.run(2.0, |_| {});
    // From now on the peer drives at the same speed towards a crossing point 30 m farther away: it is on another street.
    junction.drivers[1].speaks = false;
    let now = junction.now;
    let held = |junction: &Junction| {
        let unit = &junction.drivers[0].rig.unit;
        let at = rig::instant(now);
        let bound = unit.bound(1, at).unwrap();
        let reading = unit.estimator().read(1, at).unwrap();
        let sample = *unit.peers().get(1).unwrap().newest().unwrap();
        [reading.position, bound.lowest_position(), bound.highest_position(), sample.position].map(rig::m_of)
    };
    let before = held(&junction);
    let newest = *junction.drivers[0].rig.unit.peers().get(1).unwrap().newest().unwrap();
    let crossing = junction.drivers[0].axis + CROSSING;
    let distance = crossing - rig::m_of(newest.position) + 30.0;
    let route = Route {
        tag: 0,
        intersection: 5,
        movement: Movement::straight(1),
        distance: rig::metres((distance * 1e3).round() / 1e3),
        stamp: newest.stamp,
        arrival: 1,
        predecessor: Predecessor::None,
    };
    let slot = holdover::wire::Slot(1);
    junction.drivers[0].rig.put(now, &Message::Peer(slot, Said::Route(route))).unwrap();
    for (before, after) in before.into_iter().zip(held(&junction)) {
        assert!((after - before + 30.0).abs() < 0.002 + 0.013, "{before} {after}");
    }
    assert_eq!(junction.drivers[0].rig.unit.health().of(Cause::Jump), 0);
}

#[test]
fn a_place_beside_the_path_is_refused_and_changes_nothing() {
    let mut junction = Junction::new(vec![Driver::new(1, 0, 50.0, 11.0, false)]);
    junction.run(1.0, |_| {});
    let before = junction.drivers[0].rig.unit.coordination().clone();
    let now = junction.now - rig::junction::PERIOD;
    let mut geo = junction.drivers[0].geo(now);
    geo.longitude = 1_101;
    let verdict = junction.drivers[0].rig.put(now, &Message::Ego(Said::Geo(geo)));
    assert_eq!(verdict, Err(Cause::OffRoute));
    assert_eq!(format!("{before:?}"), format!("{:?}", junction.drivers[0].rig.unit.coordination()));
}

#[test]
fn another_station_in_a_live_slot_does_not_move_the_axis() {
    let mut junction = settled(two(15.0, false));
    junction.run(3.0, |_| {});
    let now = junction.now;
    let motion = junction.drivers[0].rig.motion(StationHash(77), now, 9_000.0, 5.0, 0.0, 0.0, Some((0.05, 0.02)));
    let before = junction.drivers[0].rig.unit.coordination().clone();
    let slot = holdover::wire::Slot(1);
    let verdict = junction.drivers[0].rig.put(now, &Message::Peer(slot, Said::Motion(motion)));
    assert_eq!(verdict, Err(Cause::StationConflict));
    assert_eq!(format!("{before:?}"), format!("{:?}", junction.drivers[0].rig.unit.coordination()));
}

/// The first one hears in that slot of a station that is so many metres before the crossing; what became of its route and
/// of its motion.
fn says(junction: &mut Junction, slot: u8, station: u8, metres: f64) -> [Result<(), Cause>; 2] {
    let (now, slot) = (junction.now, Slot(slot));
    let rig = &mut junction.drivers[0].rig;
    let motion = rig.motion(StationHash(station), now, 5_000.0 - metres, 5.0, 0.0, 0.0, Some((0.05, 0.02)));
    let route = Route {
        tag: motion.tag,
        intersection: 5,
        movement: Movement::straight(1),
        distance: rig::metres(metres),
        stamp: motion.stamp,
        arrival: 1,
        predecessor: Predecessor::None,
    };
    [Said::Route(route), Said::Motion(motion)].map(|said| rig.put(now, &Message::Peer(slot, said)))
}

#[test]
fn a_station_that_was_refused_in_a_free_slot_is_known_there_after_a_silence_in_its_own() {
    let mut junction = settled(two(15.0, false));
    junction.run(2.0, |_| {});
    for metres in [90.0, 89.5, 89.0] {
        let _ = says(&mut junction, 2, 77, metres);
        junction.run(0.1, |_| {});
    }
    let slot_of = |junction: &Junction| junction.drivers[0].rig.unit.peers().named(StationHash(77)).next();
    assert_eq!(slot_of(&junction), Some(2));
    let _ = says(&mut junction, 3, 77, 88.5); // the first frame of an identifier is not trusted
    assert_eq!(says(&mut junction, 3, 77, 88.5), [Ok(()), Err(Cause::StationConflict)]);
    junction.run(2.0, |_| {});
    for metres in [78.0, 77.5] {
        says(&mut junction, 3, 77, metres)[1].unwrap();
        junction.run(0.1, |_| {});
    }
    assert_eq!(slot_of(&junction), Some(3));
}

#[test]
fn a_station_that_is_heard_in_its_slot_does_not_touch_what_is_held_of_one_that_was_in_another() {
    let mut junction = settled(two(15.0, false));
    junction.run(2.0, |_| {});
    for metres in [90.0, 89.5, 89.0] {
        says(&mut junction, 2, 77, metres)[0].expect("a route is taken note of");
        junction.run(0.1, |_| {});
    }
    junction.run(2.5, |_| {});
    let held = |junction: &Junction| {
        let unit = &junction.drivers[0].rig.unit;
        let station = unit.peers().get(2).and_then(|track| track.station());
        (station, unit.coordination().approach(2).copied())
    };
    let before = held(&junction);
    assert!(before.0 == Some(StationHash(77)) && before.1.is_some());
    // The one in slot 1 speaks in slot 2.
    let here = CROSSING - junction.drivers[1].body.position;
    assert_eq!(says(&mut junction, 2, 2, here), [Ok(()), Err(Cause::StationConflict)]);
    assert_eq!(held(&junction), before);
}
