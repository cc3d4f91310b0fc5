//! A claim of a vehicle that is ahead in the order cuts the ego's own, whenever it is heard. Who is in the area by a pass still says that it
//! is in there.

use crate::rig::config;
use crate::rig::gnss;
use crate::rig::junction::{CROSSING, Driver, Junction, PERIOD};
use holdover::Config;
use holdover::time::{Duration, GnssTime};
use holdover::wire::pass::{Claimed, Pass, PassTime};
use holdover::wire::{Message, Movement};

/// A vehicle that arrived before the ego is heard for the first time and for the last time, with a claim for these seconds from then on.
pub fn other(now: i64, from: f64, to: f64) -> Pass {
    let at = |seconds: f64| GnssTime::from_micros(gnss(now, 0).as_micros().wrapping_add_signed((seconds * 1e6) as i64));
    let claimed =
        Claimed { at: PassTime::down(at(-1.0)), entry: PassTime::down(at(from)), length: ((to - from) * 100.0) as u16 };
    Pass {
        tag: 1,
        station_id: 100,
        intersection: 5,
        movement: Movement::straight(1),
        left: None,
        is_before_zone: false,
        is_by_hand: false,
        stamp: PassTime::down(gnss(now - PERIOD, 0)),
        arrival: 0,
        claims: [Some(claimed), None],
    }
}

/// Whether the ego is in the area at all; and whether it is so at some time for which it has not said so since before that vehicle is heard.
fn is_inside(start: f64, heard: i64, from: f64, to: f64) -> (bool, bool) {
    let mut ego = Driver::of(Config { range_sensor: true, ..config() }, 3, 0, start, 10.0, true);
    ego.sees_across = true;
    let (mut junction, mut said, mut is_in, mut is_bare) = (Junction::new(vec![ego]), None, false, false);
    junction.run(25.0, |junction| {
        let now = junction.now;
        let ego = &mut junction.drivers[0];
        // The unit trusts an identifier from its second frame on.
        if now == 1_000_000 || now == 2_000_000 {
            let first = Pass { left: Some(5), station_id: 99, claims: [None; 2], tag: 0, ..other(now, from, to) };
            let _ = ego.rig.put(now, &Message::PeerPass(first));
        }
        if now == heard {
            let _ = ego.rig.put(now, &Message::PeerPass(other(now, from, to)));
        }
        let gnss = gnss(now - PERIOD, 0);
        let all = ego.last.iter().flat_map(|last| &last.all);
        said = all
            .filter_map(|one| if let Message::OwnPass(pass) = one { Some(*pass) } else { None })
            .next_back()
            .or(said);
        let covers = |claimed: &Claimed| {
            let entry = claimed.entry.near(gnss);
            claimed.at.near(gnss) < crate::rig::gnss(heard, 0)
                && (entry..entry.plus(Duration::from_millis(10 * i64::from(claimed.length)))).contains(&gnss)
        };
        is_in |= ego.is_inside();
        is_bare |= ego.is_inside() && !said.iter().flat_map(|said| said.claims.iter().flatten()).any(covers);
    });
    (is_in, is_bare)
}

#[test]
fn who_is_in_the_area_has_claimed_it_since_before_another_claim_was_heard() {
    // Passes are planned every tenth tick, and the ego drives a decimetre in each: the last tick in which it can stop comes at every place
    // among those that plan.
    let (mut entered, mut runs) = (0, 0);
    for decimetres in 0..10 {
        let start = CROSSING - 150.0 + 0.1 * f64::from(decimetres);
        for (from, to) in [(-1.0, 10.0), (-1.0, 2.0)] {
            for heard in (12_200_000..13_500_000).step_by(50_000) {
                let (is_in, is_bare) = is_inside(start, heard, from, to);
                assert!(!is_bare, "from {start} m, {from} to {to} s, heard at {heard} us");
                entered += u32::from(is_in);
                runs += 1;
            }
        }
    }
    assert!((runs / 4..runs * 3 / 4).contains(&entered), "of {runs} {entered} go in, and the others wait");
}
