//! Passes and drivers: a person who drives keeps no pass, and the others know it.

use crate::rig::config;
use crate::rig::junction::{CROSSING, Driver, HALF, Junction};
use holdover::Config;
use holdover::wire::Message;
use holdover::wire::actuators::{ActuatorState, Control};
use holdover::wire::pass::{Claimed, Pass};

/// What it has said of its passes, if it has just said it.
fn said(driver: &Driver) -> Option<Pass> {
    let pass = |message: &Message| if let Message::OwnPass(pass) = message { Some(*pass) } else { None };
    driver.last.as_ref()?.all.iter().find_map(pass)
}

/// A vehicle with a range sensor and with passes, at 10 m/s.
fn driver(station: u8, way: usize, at: f64) -> Driver {
    let mut driver = Driver::of(Config { range_sensor: true, ..config() }, station, way, at, 10.0, true);
    driver.sees_across = true;
    driver
}

/// The braking or acceleration with which a body comes to this place at this speed.
fn towards(body: &crate::rig::plant::Plant, place: f64, speed: f64) -> f64 {
    (speed * speed - body.speed * body.speed) / (2.0 * (place - body.position)).max(0.1)
}

/// Whether the two were in the area at once, and where they are at the end. A person takes the vehicle over that goes first, at this time,
/// and comes to the area at this speed: after the window that the unit had claimed.
fn taken_over(at: f64, speed: f64) -> (bool, [f64; 2]) {
    // Both come at once, so the smaller station is ahead in the order, and the ego behind it.
    let mut junction = Junction::new(vec![driver(3, 0, 40.0), driver(2, 1, 40.0)]);
    let mut both = false;
    junction.run(45.0, |junction| {
        let [ego, other] = &mut junction.drivers[..] else { panic!("two") };
        if junction.now as f64 * 1e-6 > at {
            other.engaged = false;
            let is_before = other.body.position < CROSSING - HALF - 1.0;
            other.by_hand = Some(if is_before { towards(&other.body, CROSSING - HALF, speed).max(-5.0) } else { 1.0 });
        }
        both |= ego.is_inside() && other.is_inside();
    });
    (both, [0, 1].map(|index| junction.drivers[index].body.position))
}

#[test]
fn who_waits_for_a_vehicle_that_a_person_has_taken_over_waits_until_that_has_crossed_and_no_longer() {
    for at in [11.0, 12.0, 13.0, 14.0, 14.25, 14.5, 14.75] {
        for speed in [2.0, 5.0] {
            let (both, places) = taken_over(at, speed);
            assert!(!both, "at {at} s, {speed} m/s");
            assert!(places.iter().all(|place| *place > CROSSING + HALF + 5.0), "at {at} s, {speed} m/s: {places:?}");
        }
    }
}

#[test]
fn no_claim_waits_for_a_vehicle_that_a_person_drives_after_the_ego() {
    // The ego is ahead in the order. The other one is in the zone, and had claims.
    let mut junction = Junction::new(vec![driver(2, 0, 40.0), driver(3, 1, 40.0)]);
    let mut slowest = f64::MAX;
    junction.run(25.0, |junction| {
        let [ego, other] = &mut junction.drivers[..] else { panic!("two") };
        if junction.now > 2_000_000 {
            other.engaged = false;
            other.by_hand = Some(-2.0);
        }
        slowest = slowest.min(ego.body.speed);
    });
    let at = junction.drivers[0].body.position;
    assert!(at > CROSSING + HALF && slowest > 8.0, "at {at:.1} m, {slowest:.1} m/s");
}

#[test]
fn who_is_driven_by_hand_claims_nothing_more_until_the_unit_drives_again_as_a_newcomer() {
    let mut junction = Junction::new(vec![driver(2, 0, 20.0)]);
    let (mut before, mut after) = (None, None);
    junction.run(32.0, |junction| {
        let (now, driver) = (junction.now, &mut junction.drivers[0]);
        // The person stops 100 m before the area, while the windows that the unit has claimed come and go.
        let is_by_hand = (6_000_000..25_000_000).contains(&now);
        driver.engaged = !is_by_hand;
        driver.by_hand = is_by_hand.then_some(-2.0);
        let Some(pass) = said(driver) else { return };
        match now {
            // A request is 0.1 s old at most.
            ..6_000_000 => before = pass.claims[0],
            6_200_000..25_000_000 => {
                assert!(pass.is_by_hand && pass.claims[1].is_none(), "{pass:?}");
                assert!(pass.claims[0].is_none_or(|claim| Some(claim) == before), "{pass:?}, before {before:?}");
                // By 10 ms, as long as it has been over; every 0.1 s the unit looks whether it is.
                let over =
                    before.map(|claim| pass.stamp.0.wrapping_sub(claim.entry.0.wrapping_add(claim.length)) as i16);
                let is_over = over.expect("it had claimed") > 0;
                if over.is_some_and(|over| !(-10..10).contains(&over)) {
                    assert_eq!(
                        (pass.claims[0].is_none(), pass.is_before_zone),
                        (is_over, is_over),
                        "at {now}: {pass:?}"
                    );
                }
            }
            25_200_000.. => {
                assert!(!pass.is_by_hand);
                let counts = |claim: Claimed| (now, claim.at.0.wrapping_sub(pass.stamp.0));
                after = after.or_else(|| pass.claims[0].map(counts));
            }
            _ => {}
        }
    });
    let (at, counts) = after.expect("it claims again");
    // 4.56 s from its first message on, in steps of 10 ms.
    assert!(before.is_some() && at < 27_000_000 && (440..=456).contains(&counts), "at {at}: {counts}");
}

#[test]
fn however_short_a_person_drives_no_claim_counts_before_a_message_that_was_without_it() {
    for begins in (6_000_000..6_200_000).step_by(10_000) {
        for lasts in [10_000, 30_000, 90_000, 110_000, 250_000, 700_000] {
            let mut junction = Junction::new(vec![driver(2, 0, 20.0)]);
            let (mut last, mut by_hand) = (None::<Pass>, 0);
            junction.run(12.0, |junction| {
                let (now, driver) = (junction.now, &mut junction.drivers[0]);
                let accelerator = (begins..begins + lasts).contains(&now);
                driver.by_hand = accelerator.then_some(0.5);
                if now % 10_000 == 0 {
                    let state =
                        ActuatorState { control: Control::Driving, accelerator, brake: false, holding: false, tick: 0 };
                    let _ = driver.rig.put(now, &Message::Actuators(state));
                }
                let Some(pass) = said(driver) else { return };
                let said = last.iter().flat_map(|last| last.claims).flatten();
                let had = |claim: &Claimed| {
                    let counted = said.clone().filter(|one| one.at.0 <= claim.at.0);
                    counted.clone().map(|one| one.entry.0).min().is_some_and(|entry| entry <= claim.entry.0)
                        && counted.map(|one| one.entry.0 + one.length).max() >= Some(claim.entry.0 + claim.length)
                };
                for claim in pass.claims.iter().flatten().filter(|claim| !had(claim)) {
                    let stamp = last.map_or(0, |last| last.stamp.0);
                    assert!(claim.at.0 > stamp, "{begins} us, for {lasts} us: {pass:?} after {last:?}");
                }
                last = Some(pass);
                by_hand += u32::from(pass.is_by_hand);
            });
            assert!(by_hand > 0 || lasts < 250_000, "{begins} us, for {lasts} us");
        }
    }
}

/// A unit speaks again at this time, 4 s after its own motion was measured last. A person drives when it does, or not.
fn speaks_again(at: i64, by_hand: bool) {
    let mut junction = Junction::new(vec![driver(2, 0, 20.0)]);
    let (mut had, mut first, mut claims) = (false, None, 0);
    junction.run(16.0, |junction| {
        let (now, driver) = (junction.now, &mut junction.drivers[0]);
        driver.is_measured = !(at - 4_000_000..at).contains(&now);
        driver.engaged = !(by_hand && (at - 500_000..at + 500_000).contains(&now));
        driver.by_hand = (6_000_000..11_000_000).contains(&now).then_some(0.0);
        let Some(pass) = said(driver) else { return };
        had |= now < 6_000_000 && pass.claims[0].is_some();
        if now > 9_000_000 {
            let first = *first.get_or_insert(pass.stamp.0);
            claims += pass.claims.iter().flatten().count();
            let is_new = |claim: &Claimed| claim.at.0.wrapping_sub(first) >= 440;
            let all_new = pass.claims.iter().flatten().all(is_new);
            assert!(all_new, "again at {at}, now {now}, by hand {by_hand}, first at {first}: {pass:?}");
        }
    });
    assert!(had && claims > 0, "{claims}");
}

#[test]
fn who_was_silent_claims_as_a_newcomer_also_if_a_person_drives_when_it_speaks_again() {
    for at in (9_900_000..10_100_000).step_by(10_000) {
        [false, true].into_iter().for_each(|by_hand| speaks_again(at, by_hand));
    }
}

#[test]
fn a_vehicle_that_is_handed_back_too_near_to_stop_keeps_no_pass_before_it_has_left_the_area() {
    let mut junction = Junction::new(vec![driver(2, 0, 100.0)]);
    let (mut near, mut beyond) = (0, 0);
    junction.run(25.0, |junction| {
        let driver = &mut junction.drivers[0];
        driver.engaged = driver.body.position > CROSSING - HALF - 3.0;
        driver.by_hand = (driver.body.position < CROSSING - HALF).then_some(0.0);
        let Some(pass) = said(driver) else { return };
        if pass.intersection == 5 {
            near += u32::from(driver.engaged);
            assert!(pass.is_by_hand, "at {:.1} m: {pass:?}", driver.body.position);
        } else if driver.body.position > CROSSING + HALF + 10.0 {
            beyond += 1;
            assert!(!pass.is_by_hand, "at {:.1} m: {pass:?}", driver.body.position);
        }
    });
    assert!(near > 0 && beyond > 0, "{near} {beyond}");
}
