//! What a vehicle claims, on made-up outlooks.

use super::*;
use crate::passes::tests::{RULES, claim, time, window};

const SLACK: Slack = Slack { before: Duration::from_micros(8), after: Duration::from_micros(8) };
const LEAST: Slack = Slack { before: Duration::from_micros(4), after: Duration::from_micros(4) };

fn outlook(stay: Window) -> Outlook {
    Outlook { stay, slack: SLACK, least: LEAST, is_committed: false }
}

/// One that has been on the air for long enough, with its last message at 990.
fn own() -> Own {
    Own { on_air: Held::Value(time(900)), said: Held::Value(time(990)), ..Own::NOTHING }
}

/// Plans at 1,000 as station 5.
fn plan(own: &mut Own, outlook: &Outlook, others: &[(u64, &[Claim], Order)]) {
    let others = others.iter().map(|(heard, claims, order)| (Known { heard: time(*heard), claims }, *order));
    own.plan(&RULES, time(1_000), 5, Some(outlook), others);
}

fn windows(own: &Own) -> Vec<Window> {
    own.claims().map(|claim| claim.window).collect()
}

#[test]
fn the_stay_is_claimed_with_slack_and_the_claim_is_kept_while_enough_of_it_is_left() {
    let mut own = own();
    plan(&mut own, &outlook(window(1_100, 1_150)), &[]);
    assert_eq!(windows(&own), [window(1_092, 1_158)]);
    for stay in [window(1_104, 1_154), window(1_096, 1_146)] {
        plan(&mut own, &outlook(stay), &[]);
        assert_eq!(windows(&own), [window(1_092, 1_158)], "{stay:?}");
    }
}

#[test]
fn who_will_be_late_claims_a_second_window_that_joins_the_first() {
    let mut own = own();
    plan(&mut own, &outlook(window(1_100, 1_150)), &[]);
    plan(&mut own, &outlook(window(1_105, 1_155)), &[]);
    assert_eq!(windows(&own), [window(1_092, 1_158), window(1_158, 1_163)]);
    assert!(own.is_claimed(&window(1_100, 1_163)));
    assert_eq!(own.reaches(time(1_100)), Some(time(1_163)));
}

#[test]
fn a_window_that_covers_the_stay_and_is_not_firm_yet_is_not_claimed_anew() {
    let mut own = own();
    plan(&mut own, &outlook(window(1_100, 1_150)), &[]);
    own.pieces[1] = Held::Value(claim(995, window(1_158, 1_163), 5));
    let unheard = [(990, &[][..], Order::Behind)];
    plan(&mut own, &outlook(window(1_105, 1_161)), &unheard);
    assert_eq!(own.pieces[1], Held::Value(claim(995, window(1_158, 1_163), 5)));
    plan(&mut own, &outlook(window(1_105, 1_164)), &unheard);
    assert_eq!(own.claims().map(|claim| claim.at).max(), Some(time(1_000)));
}

#[test]
fn who_foresees_nothing_gives_everything_back() {
    let mut own = own();
    plan(&mut own, &outlook(window(1_100, 1_150)), &[]);
    own.plan(&RULES, time(1_000), 5, None, [].into_iter());
    assert_eq!(windows(&own), []);
}

#[test]
fn who_stays_out_of_the_zone_says_no_claim_and_claims_as_a_newcomer_after_that() {
    let mut own = own();
    plan(&mut own, &outlook(window(1_100, 1_150)), &[]);
    own.stay_out();
    assert!(own.is_before_zone() && own.say(&RULES, time(999), false) == [None; PIECES]);
    plan(&mut own, &outlook(window(1_200, 1_250)), &[]);
    assert!(!own.is_before_zone());
    let at = own.claims().map(|claim| claim.at).max();
    assert_eq!(at, Some(RULES.claims_from(time(1_000), time(1_000), None)), "not on air by what it said before");
    assert!(at > Some(time(1_000)));
}

#[test]
fn a_claim_is_cut_by_who_is_ahead_in_the_order_and_not_by_who_is_behind() {
    // The other one claimed first, so that without an order it has priority.
    let other = [claim(10, window(1_060, 1_095), 6)];
    for (order, expected) in [(Order::Behind, 1_092), (Order::Ahead, 1_100), (Order::Unknown, 1_100)] {
        let mut own = own();
        plan(&mut own, &outlook(window(1_104, 1_150)), &[]);
        own.pieces[0] = Held::Value(claim(1_000, window(1_092, 1_158), 5));
        plan(&mut own, &outlook(window(1_104, 1_150)), &[(995, &other, order)]);
        assert_eq!(windows(&own)[0].entry, time(expected), "{order:?}");
    }
}

#[test]
fn who_cannot_have_its_stay_claims_the_next_time_that_is_free() {
    let mut own = own();
    let taken = [claim(10, window(1_090, 1_140), 6)];
    plan(&mut own, &outlook(window(1_100, 1_150)), &[(995, &taken, Order::Ahead)]);
    // 2 for the clocks, 3 for the clearance.
    assert_eq!(windows(&own), [window(1_145, 1_211)]);
}

#[test]
fn who_cannot_stop_any_more_gives_nothing_up() {
    let mut own = own();
    plan(&mut own, &outlook(window(1_010, 1_060)), &[]);
    let taken = [claim(10, window(1_020, 1_040), 6)];
    let committed = Outlook { is_committed: true, ..outlook(window(1_010, 1_060)) };
    plan(&mut own, &committed, &[(995, &taken, Order::Ahead)]);
    assert_eq!(windows(&own), [window(1_002, 1_068)]);
}

#[test]
fn a_stay_is_covered_once_all_that_are_known_have_been_heard_since_the_claim() {
    let mut own = own();
    plan(&mut own, &outlook(window(1_100, 1_150)), &[]);
    let stay = window(1_100, 1_150);
    for (heard, expected) in [(999, false), (1_000, true)] {
        let known = || [Known { heard: time(heard), claims: &[] }].into_iter();
        assert_eq!(own.covers(&RULES, time(1_001), &stay, known()), expected, "{heard}");
        let reached = own.firmly_reaches(&RULES, time(1_001), stay.entry, known());
        assert_eq!(reached, expected.then_some(time(1_158)), "{heard}");
    }
    assert!(!own.covers(&RULES, time(1_001), &window(1_100, 1_159), [].into_iter()), "it was not claimed");
}

#[test]
fn a_longer_vehicle_claims_more_after_its_stay_in_whole_steps() {
    for (mm, after_ms) in
        [(0, 800), (2_000, 800), (4_800, 800), (6_000, 890), (12_000, 1_340), (18_750, 1_840), (40_950, 3_510)]
    {
        let slack = Slack::of(Distance::from_mm(mm));
        assert_eq!((slack.before.as_millis(), slack.after.as_millis()), (600, after_ms), "{mm} mm");
    }
}
