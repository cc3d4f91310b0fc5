//! Who is in the zone of an intersection. A vehicle that stands far from the area and does not foresee its stay is not: no claim has to be
//! heard by it, however many there are, as long as it is heard itself. Once it is in the zone it claims as a newcomer.

use crate::rig::junction::{CROSSING, Driver, HALF, Junction, PERIOD};
use crate::rig::{LENGTH, config, gnss};
use holdover::Config;
use holdover::coordination::Movement;
use holdover::passes::KNOWN;
use holdover::wire::Message;
use holdover::wire::pass::{Pass, PassTime};

/// The time that has to pass on air before a claim may count, in steps of 10 ms: assumption A16.
const HEARD_BY_ALL: u16 = 450 + 6;

fn sees(station: u8, way: usize, at: f64, speed: f64) -> Driver {
    let mut driver = Driver::of(Config { range_sensor: true, ..config() }, station, way, at, speed, true);
    driver.sees_across = true;
    driver
}

/// What the unit has said of its passes in the last tick.
fn said(driver: &Driver) -> Option<Pass> {
    let mut all = driver.last.iter().flat_map(|last| &last.all);
    all.find_map(|message| if let Message::OwnPass(pass) = message { Some(*pass) } else { None })
}

/// When the ego has left the area, if so many vehicles stand on the crossing street. Each says whether it is in the zone, and is silent for
/// good from an instant on.
fn leaves_past(queue: usize, is_before_zone: bool, silent_from: i64) -> Option<i64> {
    let mut junction = Junction::new(vec![sees(3, 0, 60.0, 10.0)]);
    let mut left = None;
    junction.run(28.0, |junction| {
        let now = junction.now;
        let ego = &mut junction.drivers[0];
        if now % 200_000 == 0 && now < silent_from {
            for station in 0..queue as u32 {
                let pass = Pass {
                    tag: (now / 200_000 % 4) as u8,
                    station_id: 100 + station,
                    intersection: 5,
                    movement: Movement::straight(1),
                    left: None,
                    is_before_zone,
                    is_by_hand: false,
                    stamp: PassTime::down(gnss(now - PERIOD, 0)),
                    arrival: 0xF_0000 + station,
                    claims: [None; 2],
                };
                let _ = ego.rig.put(now, &Message::PeerPass(pass));
            }
        }
        if ego.body.position - LENGTH > CROSSING + HALF {
            left.get_or_insert(now);
        }
    });
    left
}

#[test]
fn those_who_wait_before_the_zone_hold_up_nobody_however_many_they_are() {
    let few = leaves_past(KNOWN, false, i64::MAX).expect("it knows them all");
    assert_eq!(leaves_past(KNOWN + 1, false, i64::MAX), None, "one too many in the zone, and nothing is firm");
    for queue in [KNOWN, KNOWN + 1, 2 * KNOWN] {
        let left = leaves_past(queue, true, i64::MAX).expect("nobody has to hear it");
        assert!(left <= few, "{queue}: {left} {few}");
    }
}

#[test]
fn one_before_the_zone_that_falls_silent_holds_up_no_claim_that_counts_before_it_could_come_in() {
    let free = leaves_past(0, true, i64::MAX).expect("nobody is there");
    // The ego's claim counts 4.56 s after its first message.
    let left = |silent_from| leaves_past(1, true, silent_from);
    assert_eq!(left(1_000_000), Some(free), "it could not claim before the ego's claim counts");
    assert_eq!(leaves_past(1, false, 1_000_000), None, "in the zone it has not heard the claim");
}

/// Two that stand before the zone on crossing streets. Both become free at once, and one of them does not hear and is not heard for so long
/// from so long before that. Whether both are in the area at once.
fn meet(silent_for: i64, before: i64) -> bool {
    const FREE: i64 = 12_000_000;
    let [mut one, mut other] = [sees(2, 0, CROSSING - HALF - 46.0, 0.0), sees(3, 1, CROSSING - HALF - 45.0, 0.0)];
    // They do not have one another in slots: only what they say of their passes is heard.
    (one.says_motion, other.says_motion) = (false, false);
    let mut junction = Junction::new(vec![one, other]);
    let (mut both, mut outside) = (false, 0);
    junction.run(60.0, |junction| {
        let now = junction.now;
        for driver in &mut junction.drivers {
            driver.target_speed = if now < FREE { 0.0 } else { 10.0 };
            outside += u32::from(said(driver).is_some_and(|pass| pass.is_before_zone));
        }
        let is_silent = (FREE - before..FREE - before + silent_for).contains(&now);
        (junction.drivers[0].speaks, junction.drivers[0].hears) = (!is_silent, !is_silent);
        both |= junction.drivers.iter().all(Driver::is_inside);
    });
    assert!(outside > 100, "both were before the zone");
    both
}

#[test]
fn a_silence_in_which_both_come_into_the_zone_lets_nobody_in_together() {
    for silent_for in [0, 4_000_000, 6_000_000, 8_000_000, 12_000_000, 20_000_000] {
        for before in [100_000, 1_000_000, 3_000_000, 6_000_000] {
            assert!(!meet(silent_for, before), "silent for {silent_for} µs from {before} µs before");
        }
    }
}

#[test]
fn a_vehicle_that_stands_far_back_is_before_the_zone_and_comes_into_it_as_a_newcomer() {
    // The first one stands in front of the second for 30 s, so far from the area.
    for (from_area, is_outside) in [(45.5, true), (60.0, true), (120.0, true), (38.5, false), (20.0, false)] {
        let rear = CROSSING - HALF - from_area + 6.0;
        let mut junction = Junction::new(vec![sees(2, 0, rear + LENGTH, 0.0), sees(3, 0, rear - 6.0, 0.0)]);
        let (mut outside, mut on_air, mut entered) = (0, None, None);
        junction.run(90.0, |junction| {
            let now = junction.now;
            for driver in &mut junction.drivers {
                driver.target_speed = if now < 30_000_000 { 0.0 } else { 10.0 };
            }
            let ego = &junction.drivers[1];
            if let Some(pass) = said(ego) {
                if pass.is_before_zone {
                    assert_eq!(pass.claims, [None; 2]);
                    (on_air, outside) = (None, outside + 1);
                } else {
                    let from: PassTime = *on_air.get_or_insert(pass.stamp);
                    for claim in pass.claims.into_iter().flatten().filter(|_| pass.intersection == 5) {
                        assert!(claim.at.0 >= from.0 + HEARD_BY_ALL, "{from:?} {claim:?}");
                    }
                }
            }
            if ego.is_inside() {
                entered.get_or_insert(now);
            }
        });
        assert_eq!(outside > 50, is_outside, "{from_area} m: said {outside} times");
        assert!(entered.is_some(), "it drives on");
    }
}
