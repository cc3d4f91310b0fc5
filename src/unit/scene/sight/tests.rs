//! What is remembered of views.

use super::*;

fn at(millis: i64) -> Instant {
    Instant::ZERO.plus(Duration::from_millis(millis))
}

fn sight(millis: i64, metres: i64, mm_per_s: i32) -> Sight {
    let (rear, speed) = (Position::from_mm(metres * 1_000), Speed::from_mm_per_s(mm_per_s));
    Sight::new(at(millis), rear, speed, &Uncertainty::default())
}

/// The rears, in metres, of what is remembered.
fn remembered(ranging: &Ranging, millis: i64) -> Vec<i64> {
    let mut rears: Vec<_> = ranging.remembered(at(millis)).map(|sight| sight.rear.to_mm() / 1_000).collect();
    rears.sort_unstable();
    rears
}

#[test]
fn a_vehicle_that_a_nearer_one_hides_is_remembered_until_a_view_shows_that_it_is_gone() {
    let mut ranging = Ranging::new();
    for view in [sight(0, 60, 11_000), sight(20, 20, 30_000), sight(40, 21, 30_000)] {
        ranging.see(view);
    }
    assert_eq!(remembered(&ranging, 900), [21, 60]);
    assert_eq!(remembered(&ranging, 1_030), [21], "one that drove is remembered for a second");
    ranging.see(sight(100, 90, 11_000));
    assert_eq!(remembered(&ranging, 110), [90], "nobody is nearer than what is seen");
}

#[test]
fn one_that_stands_is_remembered_behind_one_that_crawled_and_drove_off() {
    let mut ranging = Ranging::new();
    ranging.see(sight(0, 60, 0));
    for (millis, metres, speed) in [(1_000, 20, 500), (2_000, 21, 500), (3_000, 30, 8_000)] {
        ranging.see(sight(millis, metres, speed));
    }
    assert_eq!(remembered(&ranging, 9_900), [60]);
    assert!(remembered(&ranging, 10_100).is_empty());
}

#[test]
fn who_would_be_nearer_than_where_nobody_is_has_gone_and_who_may_be_farther_is_remembered() {
    let mut ranging = Ranging::new();
    ranging.see(sight(0, 60, 0));
    ranging.see(sight(20, 20, 0));
    ranging.see_crossing(sight(40, 30, 0));
    ranging.see_nobody(&sight(60, 40, 0));
    assert_eq!((remembered(&ranging, 80), ranging.crossing(at(80))), (vec![60], None));
    ranging.see_nobody(&sight(80, 60, 0));
    assert_eq!(remembered(&ranging, 100), [60]);
    ranging.see_nobody(&sight(100, 61, 0));
    assert!(remembered(&ranging, 120).is_empty());
}

#[test]
fn what_was_seen_since_then_has_not_gone() {
    let mut ranging = Ranging::new();
    ranging.see(sight(80, 20, 0));
    ranging.see_nobody(&sight(60, 40, 0));
    assert_eq!(remembered(&ranging, 100), [20]);
}

#[test]
fn a_sensor_is_relied_on_for_a_quarter_of_a_second_after_a_view_and_no_farther_than_it_sees() {
    let place = Position::from_mm(40_000);
    let mut ranging = Ranging::new();
    assert!(!ranging.sees_up_to(place, at(0)));
    ranging.note_seen(at(100));
    ranging.note_seen(at(60));
    assert!(ranging.sees_up_to(place, at(350)) && !ranging.sees_up_to(place, at(351)));
    ranging.see_nobody(&sight(400, 39, 0));
    assert!(!ranging.sees_up_to(place, at(400)));
    ranging.see_nobody(&sight(420, 41, 0));
    assert!(ranging.sees_up_to(place, at(670)) && !ranging.sees_up_to(place, at(671)));
}

#[test]
fn only_the_last_view_shows_that_a_place_is_free() {
    let place = Position::from_mm(40_000);
    let mut ranging = Ranging::new();
    assert!(!ranging.is_free_up_to(place, at(0)));
    ranging.see_nobody(&sight(100, 41, 0));
    assert!(ranging.is_free_up_to(place, at(350)) && !ranging.is_free_up_to(place, at(351)));
    // One that crosses, and was heard, is not kept.
    ranging.note_seen(at(200));
    assert!(!ranging.is_free_up_to(place, at(200)));
    ranging.see_nobody(&sight(300, 41, 0));
    assert!(ranging.is_free_up_to(place, at(300)));
    ranging.note_seen(at(400));
    ranging.see(sight(400, 50, 0));
    assert!(!ranging.is_free_up_to(place, at(400)), "it is not known what is beside the path");
    ranging.see_nobody(&sight(500, 39, 0));
    assert!(!ranging.is_free_up_to(place, at(500)));
}

#[test]
fn one_that_crosses_is_no_view_of_the_vehicle_ahead() {
    let mut ranging = Ranging::new();
    ranging.see_crossing(sight(50, 10, 0));
    assert_eq!(ranging.unseen(at(100)), None);
    ranging.see(sight(100, 20, 10_000));
    ranging.see_crossing(sight(150, 10, 0));
    assert_eq!(ranging.unseen(at(250)), Some(Duration::from_millis(150)));
    // Nobody is there up to beyond where it can be.
    ranging.see_nobody(&sight(300, 90, 0));
    assert_eq!(ranging.unseen(at(300)), None);
}

#[test]
fn a_view_that_comes_late_does_not_undo_a_newer_one() {
    let mut ranging = Ranging::new();
    ranging.see(sight(60, 15, 5_000));
    ranging.see(sight(5, 80, 15_000));
    assert_eq!(remembered(&ranging, 70), [15]);
}

#[test]
fn a_view_goes_on_with_the_last_one_only_where_and_as_fast_as_that_one_may_be_by_now() {
    let mut ranging = Ranging::new();
    assert!(!ranging.goes_on(&sight(20, 30, 10_000)), "nobody was seen");
    let on_leg = |speed| Sight { is_on_leg: true, ..sight(0, 30, speed) };
    ranging.see(sight(0, 30, 10_000));
    assert!(!ranging.goes_on(&sight(20, 30, 10_000)), "it was not ahead on the leg");
    ranging.see(on_leg(10_000));
    let goes_on = |ranging: &Ranging, millis, mm: i32, mm_per_s| {
        let (rear, speed) = (Position::from_mm(mm.into()), Speed::from_mm_per_s(mm_per_s));
        ranging.goes_on(&Sight::new(at(millis), rear, speed, &Uncertainty::default()))
    };
    assert!(goes_on(&ranging, 20, 30_200, 10_000) && goes_on(&ranging, 1_000, 40_000, 10_000));
    assert!(!goes_on(&ranging, 1_001, 40_010, 10_000), "too late");
    assert!(!goes_on(&ranging, -20, 29_800, 10_000), "from before");
    for (mm, expected) in [(29_199, false), (29_200, true), (31_200, true), (31_201, false)] {
        assert_eq!(goes_on(&ranging, 20, mm, 10_000), expected, "{mm} mm");
    }
    for (mm_per_s, expected) in [(0, false), (8_499, false), (8_500, true), (11_500, true), (11_501, false)] {
        assert_eq!(goes_on(&ranging, 20, 30_200, mm_per_s), expected, "{mm_per_s} mm/s");
    }
}
