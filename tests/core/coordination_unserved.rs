//! What the unit does for vehicles that it cannot know of, as the modem has no slot for them and says so, frames in and frames out: with
//! the envelope and without it.

use crate::rig::junction::{CROSSING, Driver, HALF, Junction};

use holdover::units::Distance;
use holdover::wire::Message;
use holdover::wire::unserved::Unserved;

/// Where the ego is after 30 s alone on its way, if its modem says that five times a second for so many seconds.
fn comes_to(envelope: bool, seconds: f64, unserved: Unserved) -> f64 {
    let mut junction = Junction::new(vec![Driver::new(1, 0, 50.0, 11.0, envelope)]);
    junction.run(30.0, |junction| {
        if junction.now % 200_000 == 0 && (junction.now as f64) < seconds * 1e6 {
            let _ = junction.drivers[0].rig.put(junction.now + 2_000, &Message::Unserved(unserved));
        }
    });
    junction.drivers[0].body.position
}

fn told(legs: u8) -> Unserved {
    Unserved { intersection: 5, legs, ahead: None, stations: 3 }
}

#[test]
fn who_does_not_know_who_comes_first_by_a_crossing_leg_waits_before_the_conflict_area() {
    for envelope in [false, true] {
        let waits = comes_to(envelope, 30.0, told(0b10));
        assert!((CROSSING - HALF - 5.0..CROSSING - HALF).contains(&waits), "{envelope}: {waits}");
    }
}

#[test]
fn what_the_modem_told_last_holds_for_three_of_its_cycles() {
    for envelope in [false, true] {
        // 15 s from 50 m at 11 m/s: it has long stood then, and sets off at 15.6 s.
        let goes = comes_to(envelope, 15.0, told(0b10));
        assert!((CROSSING + 60.0..CROSSING + 140.0).contains(&goes), "{envelope}: {goes}");
    }
}

#[test]
fn somebody_unknown_who_cannot_meet_the_ego_next_holds_nobody_up() {
    let free = Unserved { intersection: 5, legs: 0, ahead: None, stations: 0 };
    for envelope in [false, true] {
        let undisturbed = comes_to(envelope, 30.0, free);
        assert!(undisturbed > 350.0, "{undisturbed}");
        for unserved in [told(0b01), Unserved { intersection: 77, ..told(0b10) }] {
            assert_eq!(comes_to(envelope, 30.0, unserved), undisturbed, "{envelope} {unserved:?}");
        }
        // A leg that the map does not know may cross.
        assert!(comes_to(envelope, 30.0, told(0b1000)) < CROSSING - HALF);
    }
}

#[test]
fn somebody_unknown_ahead_on_the_own_leg_is_taken_to_stand_where_it_was() {
    for envelope in [false, true] {
        for rear in [CROSSING - 60.0, CROSSING + 2.0] {
            let ahead = Some(Distance::from_mm(((CROSSING - rear) * 1e3) as i32));
            let stands = comes_to(envelope, 30.0, Unserved { ahead, ..told(0) });
            assert!((rear - 5.0..rear).contains(&stands), "{envelope}: {stands} behind {rear}");
        }
    }
}
