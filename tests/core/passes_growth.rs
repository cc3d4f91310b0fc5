//! A vehicle that is committed to two firm windows grows a third time. The second one is in use, so it keeps the time from which it counts.

use holdover::passes::{Claim, Known, Order, Outlook, Own, Rules, Slack, Window};
use holdover::time::{Duration, GnssTime};

const RULES: Rules = Rules {
    silence: Duration::from_micros(40),
    clocks: Duration::from_micros(2),
    clearance: Duration::from_micros(3),
    forgotten: Duration::from_micros(300),
    step: Duration::from_micros(1),
};

fn time(micros: u64) -> GnssTime {
    GnssTime::from_micros(micros)
}

fn window(entry: u64, exit: u64) -> Window {
    Window { entry: time(entry), exit: time(exit) }
}

fn outlook(stay: Window, is_committed: bool) -> Outlook {
    let slack = |micros| Slack { before: Duration::from_micros(micros), after: Duration::from_micros(micros) };
    Outlook { stay, slack: slack(8), least: slack(4), is_committed }
}

fn claims(own: &Own) -> Vec<Claim> {
    own.claims().collect()
}

#[test]
fn a_window_that_is_in_use_keeps_its_time() {
    // P, station 5, has been on air for long, and claims at 1,000.
    let mut p = Own::NOTHING;
    p.say(&RULES, time(900), false);
    p.say(&RULES, time(990), false);
    p.plan(&RULES, time(1_000), 5, Some(&outlook(window(1_100, 1_150), false)), [].into_iter());
    p.say(&RULES, time(1_001), false);
    let first_of_p = claims(&p);
    // R is behind P in the order. It has not heard P for a while, and claims at 1,005 what conflicts with P's claim. That is not firm.
    let r = [Claim { at: time(1_005), window: window(1_060, 1_090), station: 9 }];
    let of_r = |heard| (Known { heard: time(heard), claims: &r }, Order::Behind);
    // P will be a little late, and claims the time that is missing.
    p.plan(&RULES, time(1_010), 5, Some(&outlook(window(1_110, 1_160), false)), [of_r(1_006)].into_iter());
    p.say(&RULES, time(1_011), false);
    // R is heard once more, without having heard P. Everything of P's is firm: it commits.
    let known_to_p = || [of_r(1_012)].into_iter();
    let stay_of_p = window(1_110, 1_168);
    assert!(p.covers(&RULES, time(1_013), &stay_of_p, known_to_p().map(|(known, _)| known)), "P may go in");
    // Q, station 7, has not heard P since 1,001, and claims at 1,015 what is free by that.
    let mut q = Own::NOTHING;
    q.say(&RULES, time(900), false);
    q.say(&RULES, time(1_014), false);
    let of_p = [(Known { heard: time(1_001), claims: &first_of_p }, Order::Unknown)];
    q.plan(&RULES, time(1_015), 7, Some(&outlook(window(1_171, 1_200), false)), of_p.into_iter());
    let stay_of_q = claims(&q)[0].window;
    assert!(RULES.conflict(&stay_of_q, &stay_of_p), "the stays conflict");
    // P, which is committed, will be a little later still. Q hears that.
    p.plan(&RULES, time(1_020), 5, Some(&outlook(window(1_113, 1_165), true)), known_to_p());
    p.say(&RULES, time(1_021), false);
    let said = claims(&p);
    let now = [Known { heard: time(1_021), claims: &said }];
    assert!(!q.covers(&RULES, time(1_022), &stay_of_q, now.iter().copied()), "P is in the area until {stay_of_p:?}");
}
