//! Who is in the zone of an intersection. A vehicle that stands far from the area and does not foresee its stay is not: no claim has to be
//! heard by it, however many there are, and it claims as a newcomer once it is in the zone.

use crate::rig::junction::{CROSSING, Driver, HALF, Junction, PERIOD};
use crate::rig::{LENGTH, config, gnss};
use holdover::Config;
use holdover::coordination::Movement;
use holdover::passes::KNOWN;
use holdover::wire::Message;
use holdover::wire::pass::{Pass, PassTime};

/// The time that has to pass on air before a claim may count: assumption A16.
const SILENCE_US: i64 = 4_500_000;

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

/// When the ego has left the area, if so many vehicles more than it can know stand on the crossing street, and each says whether it is in
/// the zone.
fn leaves_past(queue: usize, is_before_zone: bool) -> Option<i64> {
    let mut ego = Junction::new(vec![sees(3, 0, 60.0, 10.0)]);
    let mut left = None;
    ego.run(60.0, |junction| {
        let now = junction.now;
        let ego = &mut junction.drivers[0];
        if now % 200_000 == 0 {
            for station in 0..queue as u32 {
                let stamp = PassTime::down(gnss(now - PERIOD, 0));
                let (movement, arrival) = (Movement::straight(1), 0xF_0000 + station);
                let pass = Pass {
                    tag: (now / 200_000 % 4) as u8,
                    station_id: 100 + station,
                    intersection: 5,
                    movement,
                    left: None,
                    is_before_zone,
                    stamp,
                    arrival,
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
fn those_who_wait_outside_the_zone_hold_up_nobody_however_many_they_are() {
    let few = leaves_past(KNOWN, false).expect("it knows them all");
    assert_eq!(leaves_past(KNOWN + 1, false), None, "one too many in the zone, and nothing is firm");
    for queue in [KNOWN, KNOWN + 1, 2 * KNOWN] {
        let left = leaves_past(queue, true).expect("nobody has to hear it");
        assert!(left <= few, "{queue}: {left} {few}");
    }
}

#[test]
fn a_vehicle_that_stands_far_back_is_not_in_the_zone_and_comes_into_it_as_a_newcomer() {
    // The first one stands in front of the second for 30 s, so far from the area.
    for (from_area, is_outside) in [(45.5, true), (60.0, true), (120.0, true), (38.5, false), (20.0, false)] {
        let rear = CROSSING - HALF - from_area + 6.0;
        let (mut junction, mut outside) =
            (Junction::new(vec![sees(2, 0, rear + LENGTH, 0.0), sees(3, 0, rear - 8.0, 0.0)]), 0);
        for driver in &mut junction.drivers {
            driver.target_speed = 10.0;
        }
        let (mut on_air, mut entered) = (None, None);
        junction.run(90.0, |junction| {
            let now = junction.now;
            junction.drivers[0].target_speed = if now < 30_000_000 { 0.0 } else { 10.0 };
            let ego = &junction.drivers[1];
            if let Some(pass) = said(ego) {
                if pass.is_before_zone {
                    assert_eq!(pass.claims, [None; 2]);
                    (on_air, outside) = (None, outside + 1);
                } else {
                    on_air.get_or_insert(now);
                }
            }
            if ego.is_inside() {
                entered.get_or_insert(now);
            }
        });
        assert_eq!(outside > 50, is_outside, "{from_area} m: said {outside} times");
        let (on_air, entered) = (on_air.expect("it drives on"), entered.expect("it drives on"));
        assert!(
            entered - on_air > SILENCE_US,
            "{from_area} m: in the area {} s after it came on air",
            (entered - on_air) as f64 * 1e-6
        );
    }
}
