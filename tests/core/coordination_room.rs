//! How a unit without the envelope keeps able to stop at intersections, by what it estimates, frames in and frames out: behind the one
//! ahead, however fast it comes, and before a conflict area that it could not leave again.

use crate::rig;
use crate::rig::junction::{CROSSING, Driver, HALF, Junction};
use crate::rig::plant::Plant;
use holdover::time::Duration;

const LENGTH: f64 = 4.8;

fn stand(driver: &mut Driver, position: f64) {
    driver.body = Plant { position, speed: 0.0, acceleration: 0.0, ..driver.body };
}

#[test]
fn who_comes_fast_stops_behind_one_that_stands() {
    for speed in [11.0, 14.0, 17.0, 20.0] {
        let mut junction =
            Junction::new(vec![Driver::new(1, 0, 5.0, speed, false), Driver::new(2, 0, 300.0, 0.0, false)]);
        let mut gap = f64::MAX;
        junction.run(60.0, |junction| {
            stand(&mut junction.drivers[1], 300.0);
            gap = gap.min(300.0 - LENGTH - junction.drivers[0].body.position);
        });
        // 2 m, and 8 m beside in a queue; who comes faster than in a town needs some of that.
        let least = if speed < 15.0 { 9.5 } else { 4.0 };
        assert!((least..11.0).contains(&gap), "{speed} m/s: {gap}");
    }
}

#[test]
fn who_falls_silent_in_a_queue_and_stops_after_all_is_seen_by_the_range_sensor() {
    let mut junction = Junction::new(vec![Driver::new(1, 0, 53.0, 8.0, false), Driver::new(2, 0, 60.0, 8.0, false)]);
    junction.drivers[0].sees = true;
    let mut gap = f64::MAX;
    let mut stands = None;
    junction.run(12.0, |junction| {
        let seconds = junction.now as f64 * 1e-6;
        let [ego, ahead] = &mut junction.drivers[..] else { panic!("two") };
        if seconds < 4.0 {
            stand(ego, 53.0);
            stand(ahead, 60.0);
        } else if seconds > 5.5 {
            // It has just begun to move, and falls silent and stops for somebody whom the ego has not heard of.
            let at = *stands.get_or_insert(ahead.body.position);
            stand(ahead, at);
            ahead.speaks = seconds > 9.5;
        }
        gap = gap.min(ahead.body.position - LENGTH - ego.body.position);
    });
    let began = stands.unwrap();
    assert!((60.2..63.0).contains(&began), "{began}");
    assert!(gap > 0.5, "{gap}");
}

#[test]
fn nobody_enters_a_conflict_area_that_it_could_not_leave_and_who_waits_for_that_lets_the_others_go() {
    let blocked = CROSSING + HALF + LENGTH + 3.0;
    let mut drivers = vec![Driver::new(1, 0, 100.0, 8.0, false), Driver::new(2, 0, 140.0, 8.0, false)];
    // Comes later than the ego, by the other street.
    drivers.push(Driver::new(3, 1, 40.0, 8.0, false));
    let mut junction = Junction::new(drivers);
    let mut inside = f64::MIN;
    junction.run(60.0, |junction| {
        let [ego, ahead, _] = &mut junction.drivers[..] else { panic!("three") };
        if ahead.body.position > blocked {
            stand(ahead, blocked);
        }
        inside = inside.max(ego.body.position - (CROSSING - HALF));
    });
    assert!(junction.drivers[1].body.position > blocked - 0.1, "{}", junction.drivers[1].body.position);
    assert!(junction.drivers[2].body.position > 260.0, "{}", junction.drivers[2].body.position);
    junction.run(30.0, |_| {});
    assert!(inside < 0.0, "{inside} m inside");
    assert!(junction.drivers[0].body.position > 260.0, "{}", junction.drivers[0].body.position);
}

#[test]
fn who_stands_before_a_conflict_area_enters_it_when_everyone_ahead_in_the_order_has_left_it() {
    for (speed, stands) in [(10.0, 0.3), (14.0, 0.3), (17.0, 0.3), (20.0, 0.3)] {
        let line = CROSSING - HALF - stands;
        let other = Driver::new(1, 1, 60.0, speed, false);
        let mut junction = Junction::new(vec![Driver::new(2, 0, 120.0, 8.0, false), other]);
        let mut overlap = false;
        junction.run(40.0, |junction| {
            let [ego, other] = &mut junction.drivers[..] else { panic!("two") };
            if other.body.position < CROSSING - 40.0 {
                stand(ego, line);
            }
            overlap |= ego.body.position > CROSSING - HALF && other.body.position - LENGTH < CROSSING + HALF;
        });
        assert!(!overlap, "{speed} m/s, {stands} m before it");
        assert!(junction.drivers.iter().all(|driver| driver.body.position > 250.0));
    }
}

/// The ego follows a vehicle that passes first and comes at speed. The law makes up for the higher speed of the vehicle ahead, so the ego
/// accelerates, and is at the area earlier than its present speed says.
#[test]
fn who_accelerates_behind_a_faster_one_in_the_order_enters_the_area_when_that_one_has_left_it() {
    // Both look ahead for 3 s.
    let mut config = rig::config();
    config.prediction.step = Duration::from_millis(50);
    config.prediction.horizon = Duration::from_millis(3_000);
    for speed in [3.2, 3.6, 4.0, 4.5] {
        for before in [7.0, 8.0, 9.0, 10.0] {
            for away in [0.0, 3.0, 6.0, 9.0, 12.0, 15.0, 18.0] {
                let at = CROSSING - HALF - before;
                let other = Driver::of(config, 1, 1, 60.0, 10.7, false);
                let ego = Driver { target_speed: 11.0, ..Driver::of(config, 2, 0, 120.0, 8.0, false) };
                let mut junction = Junction::new(vec![ego, other]);
                let overlap = overlaps(&mut junction, 30.0, |_, drivers| {
                    let [ego, other] = drivers else { panic!("two") };
                    if other.body.position < CROSSING - away {
                        ego.body = Plant { position: at, speed, acceleration: 2.0, ..ego.body };
                    }
                });
                let case = format!("{speed} m/s, {before} m before the area, the other {away} m before the crossing");
                assert!(!overlap, "{case}");
                assert!(junction.drivers.iter().all(|driver| driver.body.position > 250.0), "{case}");
            }
        }
    }
}

/// Whether two vehicles, 0 on street 0 and 1 on street 1, were in the conflict area at once, in so many seconds.
fn overlaps(junction: &mut Junction, seconds: f64, mut each: impl FnMut(f64, &mut [Driver])) -> bool {
    let mut overlaps = false;
    junction.run(seconds, |junction| {
        each(junction.now as f64 * 1e-6, &mut junction.drivers);
        overlaps |= junction.drivers.iter().all(Driver::is_inside);
    });
    overlaps
}

#[test]
fn one_ahead_in_the_order_that_is_heard_late_is_waited_for_while_the_ego_can_stop() {
    for speed in [0.8, 1.5, 3.2, 5.0, 8.0] {
        // From 2 m farther from the area than it takes to stop at 3 m/s^2, with lag and ramp, on.
        let stops_within = speed * 0.9 + speed * speed / 6.0 + 2.0;
        for spare in [0.0, 4.0, 8.0, 12.0] {
            for other_at in [80.0, 95.0, 110.0, 125.0, 140.0, 160.0] {
                let ego_at = CROSSING - HALF - stops_within - spare;
                let ego = Driver { target_speed: 11.0, ..Driver::new(2, 0, ego_at, speed, false) };
                let mut junction = Junction::new(vec![ego, Driver::new(1, 1, other_at, 10.0, false)]);
                let overlaps = overlaps(&mut junction, 30.0, |seconds, drivers| {
                    let [ego, other] = drivers else { panic!("two") };
                    other.speaks = seconds > 3.0;
                    if seconds < 3.0 {
                        ego.body = Plant { position: ego_at, speed, acceleration: 0.0, ..ego.body };
                        other.body = Plant { position: other_at, speed: 10.0, acceleration: 0.0, ..other.body };
                    }
                });
                assert!(!overlaps, "{speed} m/s, {spare} m to spare, the other from {other_at} m");
                let at: Vec<f64> = junction.drivers.iter().map(|driver| driver.body.position).collect();
                assert!(
                    at.iter().all(|at| *at > 210.0),
                    "{speed} m/s, {spare} m to spare, the other from {other_at} m: {at:?}"
                );
            }
        }
    }
}

#[test]
fn one_that_is_in_the_area_already_is_waited_for_though_it_is_behind_in_the_order() {
    for inside in [CROSSING - HALF + 0.5, CROSSING, CROSSING + HALF] {
        // Both set out at once, so the smaller station is first.
        let mut junction =
            Junction::new(vec![Driver::new(1, 0, 110.0, 9.0, false), Driver::new(2, 1, inside, 9.0, false)]);
        let overlaps = overlaps(&mut junction, 40.0, |seconds, drivers| {
            if seconds < 20.0 {
                stand(&mut drivers[1], inside);
            }
        });
        assert!(!overlaps, "at {inside} m");
        let at: Vec<f64> = junction.drivers.iter().map(|driver| driver.body.position).collect();
        assert!(at.iter().all(|at| *at > 210.0), "from {inside} m: {at:?}");
    }
}
