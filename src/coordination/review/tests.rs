//! What a review finds: whom the ego claims, follows and yields to.

use super::*;
use crate::coordination::tests::{ITINERARY, at, entry};
use crate::units::Position;
use crate::wire::Predecessor;

/// The ego, which arrived at 20.
fn arrived() -> Coordination<8> {
    let mut coordination: Coordination<8> = Coordination::idle();
    coordination.set_out(&ITINERARY, Distance::ZERO).unwrap();
    coordination.locate(Position::ZERO, Position::ZERO);
    coordination.advance(Position::ZERO, Distance::from_mm(4_800), at(0), Arrival(20));
    coordination
}

/// The ego is station 9 and arrived at 20. After `times` reviews of the same others, 100 ms apart: the arrival that it tells then, and
/// its claim.
fn reviewed(times: u64, others: &[Present]) -> (u32, Predecessor) {
    let mut coordination = arrived();
    for tick in 1..=times {
        let present: Vec<_> = others.iter().map(|other| Present { heard: at(tick), ..*other }).collect();
        coordination.review(at(tick), StationHash(9), &present, true);
    }
    (coordination.registration().unwrap().arrival.0, coordination.claim())
}

fn there(index: usize, entry: Entry, lane: Option<Side>) -> Present {
    let conflicts = lane.is_none();
    let (way, heard) = (Distance::ZERO, at(0));
    Present { index, entry, heard, has_left: false, is_far_behind: false, conflicts, way, is_announced: true, lane }
}

#[test]
fn whoever_is_ahead_on_the_same_leg_takes_the_ego_along_until_it_has_left() {
    let ahead = there(0, entry(1, 30, None), Some(Side::Ahead));
    assert_eq!(reviewed(1, &[ahead]), (31, Predecessor::Station(StationHash(1))));
    let further = there(1, entry(2, 40, Some(1)), Some(Side::Ahead));
    assert_eq!(reviewed(1, &[further, ahead]), (41, Predecessor::Station(StationHash(2))));
    assert_eq!(reviewed(1, &[Present { has_left: true, ..ahead }]), (20, Predecessor::None));
    // Of two stations with the same arrival, the one with the smaller number is first. On the leg it must not be behind. Otherwise each
    // would wait for the other, one by the order and one on the leg, as soon as a third station told that arrival too.
    let together = |station| there(0, entry(station, 20, None), Some(Side::Ahead));
    assert_eq!(reviewed(1, &[together(12)]), (21, Predecessor::Station(StationHash(12))));
    assert_eq!(reviewed(1, &[together(3)]), (20, Predecessor::Station(StationHash(3))));
}

#[test]
fn whoever_is_behind_on_the_same_leg_is_neither_followed_nor_given_way() {
    let (earlier, careless) = (entry(1, 10, None), entry(2, 30, None));
    for other in [earlier, careless] {
        assert_eq!(reviewed(50, &[there(0, other, Some(Side::Behind))]), (20, Predecessor::None));
    }
}

#[test]
fn one_that_overlooks_the_ego_is_given_way_after_a_second_unless_it_is_far_behind() {
    let careless = there(0, entry(1, 30, None), None);
    assert_eq!(reviewed(10, &[careless]), (20, Predecessor::None));
    assert_eq!(reviewed(11, &[careless]), (31, Predecessor::Station(StationHash(1))));
    assert_eq!(reviewed(50, &[Present { is_far_behind: true, ..careless }]), (20, Predecessor::None));
}

#[test]
fn one_whose_way_does_not_conflict_is_neither_claimed_nor_followed_nor_given_way() {
    let (earlier, careless) = (entry(1, 10, None), entry(2, 30, None));
    let crosses = |entry| there(0, entry, None);
    let beside = |entry| Present { conflicts: false, ..crosses(entry) };
    assert_eq!(reviewed(50, &[crosses(earlier)]), (20, Predecessor::Station(StationHash(1))));
    assert_eq!(reviewed(50, &[beside(earlier)]), (20, Predecessor::None));
    assert_eq!(reviewed(50, &[beside(careless)]), (20, Predecessor::None));
}

#[test]
fn a_stranger_is_unclear_only_while_everybody_that_is_heard_has_a_slot() {
    // The other claims one that the ego does not know, for longer than a silence lasts.
    let other = there(0, entry(1, 30, Some(77)), None);
    let arrival = |are_all| {
        let mut coordination = arrived();
        for tick in 1..=100 {
            let present = [Present { heard: at(tick), ..other }];
            coordination.review(at(tick), StationHash(9), &present, are_all);
        }
        coordination.registration().unwrap().arrival.0
    };
    assert_eq!([true, false].map(arrival), [31, 20]);
}

#[test]
fn of_several_with_one_name_the_nearest_ahead_that_has_not_left_goes_first() {
    let first = |others: &[Present]| {
        let mut coordination = arrived();
        coordination.review(at(1), StationHash(9), others, true);
        let choice = *coordination.choice();
        (0..8).filter(|index| choice.first.contains(*index)).collect::<Vec<_>>()
    };
    let one = |index, station, metres: i32| Present {
        way: Distance::from_mm(metres * 1_000),
        ..there(index, entry(station, 10, None), None)
    };
    assert_eq!(first(&[one(0, 1, 30), one(1, 1, 12), one(2, 2, 40)]), [1, 2]);
    assert_eq!(first(&[one(0, 1, 30), one(1, 1, -12)]), [0]);
    assert_eq!(first(&[one(0, 1, -30), one(1, 1, -12), one(3, 1, -40)]), [1]);
    assert_eq!(first(&[one(0, 1, 30), Present { has_left: true, ..one(1, 1, 12) }]), [0]);
    // One that arrived after the ego hides nobody either.
    assert_eq!(first(&[one(0, 1, 30), there(1, entry(1, 40, None), None)]), [0]);
}
