//! A peer's clock that is off beyond what is assumed of it: that is found and named, and the truth is inside the bound from then on;
//! who is only late is not taken for one whose clock is off.

use crate::rig;
use crate::rig::random::Random;
use crate::rig::{Rig, TARGET, instant, m_of, mps_of};
use holdover::health::Cause;
use holdover::wire::Said;

/// Five messages, or 5 s, are documented; they are counted from the first message on, which comes after its way of up to 20 ms, to the
/// first one after them, a period later.
const PERIOD: f64 = 0.1 + 0.02;

/// A vehicle at 15 m/s with its clock so far ahead, in microseconds, and so long under way; the seconds until the truth is inside the
/// bound for good, the motions taken in the last 20 of 40 s, and how often its clock was named.
fn heard(ahead: i64, mut delay: impl FnMut(&mut Random) -> i64) -> (f64, u32, u32) {
    let mut random = Random::new(7);
    let mut rig = Rig::new(&rig::config());
    rig.power_up(true, 0);
    for at in [-60_000, -50_000, -40_000] {
        let _ = rig.target(at, Said::DrivingParameters(rig::parameters(2.5, 8.0)));
    }
    let mut under_way = Vec::new();
    let (mut outside, mut taken) = (0.0, 0);
    for n in 0..4_000i64 {
        let now = n * 10_000;
        if n % 50 == 0 {
            rig.synchronise(now, 0);
        }
        let truth = 500.0 + 15.0 * now as f64 * 1e-6;
        if n % 10 == 0 {
            let motion = rig.motion(TARGET, now + ahead, truth, 15.0, 0.0, 0.0, Some((0.3, 0.1)));
            under_way.push((now + delay(&mut random), motion));
        }
        under_way.sort_by_key(|(arrives, _)| *arrives);
        while under_way.first().is_some_and(|(arrives, _)| *arrives <= now) {
            let (_, motion) = under_way.remove(0);
            let verdict = rig.target(now, Said::Motion(motion));
            taken += u32::from(n > 2_000 && verdict.is_ok());
        }
        let Some(bound) = rig.unit.bound(2, instant(now)) else { continue };
        let is_inside = m_of(bound.lowest_position()) <= truth
            && truth <= m_of(bound.highest_position())
            && mps_of(bound.lowest_speed()) <= 15.0
            && 15.0 <= mps_of(bound.highest_speed());
        if !is_inside {
            outside = now as f64 * 1e-6;
        }
    }
    (outside, taken, rig.unit.health().of(Cause::PeerClock))
}

#[test]
fn who_is_ahead_is_heard_after_five_messages_and_the_truth_is_inside_its_bound() {
    for (ahead, delay) in [(20_000, 5_000), (60_000, 1_000), (150_000, 80_000)] {
        let (outside, taken, named) = heard(ahead, |_| delay);
        assert!(outside <= 0.5 + PERIOD, "{ahead}: {outside} s");
        assert!(taken > 190, "{ahead}: {taken}");
        assert!((7..=9).contains(&named), "{ahead}: {named}");
    }
    // Under way for any time up to 80 ms, some are ahead and some are not.
    let (outside, taken, named) = heard(30_000, |random| random.between(0.0, 80_000.0) as i64);
    assert!(outside <= 5.0 + PERIOD && taken > 190 && named > 5, "{outside} {taken} {named}");
}

#[test]
fn who_is_behind_is_named_after_a_window_and_the_truth_is_inside_its_bound() {
    for (behind, delay) in [(300_000, 5_000), (150_000, 20_000), (1_000_000, 0)] {
        let (outside, taken, named) = heard(-behind, |_| delay);
        assert!(outside <= 5.0 + PERIOD, "{behind}: {outside} s");
        assert!(taken > 190 && (6..=8).contains(&named), "{behind}: {taken} {named}");
    }
}

#[test]
fn who_is_only_late_by_turns_is_not_taken_for_behind() {
    for spread in [0.0, 50_000.0, 200_000.0] {
        let (outside, taken, named) = heard(0, |random| 20_000 + random.between(0.0, spread) as i64);
        assert!(outside == 0.0 && taken > 100 && named == 0, "{spread}: {outside} {taken} {named}");
    }
}

/// The time is lost for a while. A sample from then says little of when it was true, also when the time is known again.
#[test]
fn after_a_time_without_gnss_the_truth_is_inside_though_all_messages_were_slow() {
    let mut rig = Rig::new(&rig::config());
    let truth = |at: i64| 1_000.0 + 15.0 * at as f64 / 1e6;
    let mut checked = 0;
    for tick in 0..3_000i64 {
        let now = tick * 10_000;
        let is_timed = !(4_600_000..14_000_000).contains(&now);
        if is_timed && now % 500_000 == 0 {
            rig.synchronise(now, 0);
        }
        let _ = rig.ego(now, 950.0 + 15.0 * now as f64 / 1e6, 15.0, 0.0, 0.0);
        // The unit knows no time from 9.5 s on. The clock seems to be behind from the first message after that on.
        let delay = match now {
            ..7_000_000 => 20_000,
            7_000_000..9_500_000 | 14_000_000.. => 150_000,
            _ => 1_850_000,
        };
        if now % 100_000 == 0 && now > 2_000_000 {
            let then = now - delay;
            let motion = rig.motion(TARGET, then, truth(then), 15.0, 0.0, 0.0, Some((0.05, 0.02)));
            let _ = rig.target(now, Said::Motion(motion));
        }
        rig.tick(now);
        let track = rig.unit.peers().get(2).expect("a slot");
        if let Some(bound) = track.certainty().bound().filter(|_| now > 10_000_000) {
            let bound = bound.after(instant(now), &track.reach());
            let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
            assert!(low <= truth(now) && truth(now) <= high, "{now}: {low} <= {} <= {high}", truth(now));
            checked += 1;
        }
    }
    assert!(checked > 1_000, "{checked}");
}
