//! When the own messages are sent: every period, and a little later where a tick has much else to do.

use crate::rig;
use crate::rig::TARGET;
use crate::rig::road::Road;
use holdover::wire::{Message, Said};

/// Follows at 20 m/s; the own messages are due in the next tick.
fn following() -> Road {
    let mut road = Road::new(&rig::config(), 20.0, 30.0);
    road.power_up();
    road.run(1.0);
    road
}

/// The times of the next so many ticks in which the own motion is sent, in ms from now on.
fn sent(road: &mut Road, ticks: usize) -> Vec<i64> {
    let begun = road.now;
    let mut sent = Vec::new();
    for _ in 0..ticks {
        let at = (road.now - begun) / 1_000;
        let heard = road.step();
        if heard.all.iter().any(|message| matches!(message, Message::Own(Said::Motion(_)))) {
            sent.push(at);
        }
    }
    sent
}

#[test]
fn the_first_news_after_a_silence_has_the_tick_to_itself() {
    for (age_ms, expected) in [(290, [0, 100, 200]), (1_000, [10, 100, 200])] {
        let mut road = following();
        assert_eq!(sent(&mut road, 300).len(), 30);
        road.senses.v2x = false;
        assert_eq!(sent(&mut road, 150)[..3], [0, 100, 200], "a silence changes nothing");
        let (then, now) = (road.now - 1_000 * age_ms, road.now);
        let place = road.target.position - road.target.speed * 1e-3 * age_ms as f64;
        let motion = road.rig.motion(TARGET, then, place, road.target.speed, 0.0, 0.0, Some((0.05, 0.02)));
        road.rig.target(now, Said::Motion(motion)).expect("a motion of the target");
        assert_eq!(sent(&mut road, 21), expected, "a sample of {age_ms} ms ago");
    }
}

#[test]
fn after_a_pause_they_are_sent_in_the_third_tick() {
    for (missed, expected) in [(11, [20, 80, 180]), (30, [20, 120, 220]), (100, [20, 120, 220])] {
        let mut road = following();
        road.step();
        (0..missed).for_each(|_| road.miss());
        assert_eq!(sent(&mut road, 23), expected, "{missed} ticks missed");
    }
}
