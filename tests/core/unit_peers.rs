//! What the unit makes of its peers' messages, seen from outside: frames enter, and tracks, links and estimates change by
//! rule.

use crate::traffic;
use crate::traffic::{TARGET, Traffic, Unit, pages, receive_all, settled};
use holdover::peers::LOSS_ONE;
use holdover::time::Duration;
use holdover::units::Speed;
use holdover::wire::{Said, StationHash};

fn stamps(unit: &Unit, slot: usize) -> Vec<u64> {
    unit.peers().get(slot).expect("a slot").heard().map(|heard| heard.at.as_micros()).collect()
}

#[test]
fn a_sample_out_of_order_fills_the_history_and_is_no_news() {
    let (mut unit, mut traffic) = settled();
    let mut untouched = unit.clone();
    let now = traffic.now();
    // The target spoke 100 ms ago; this is from 150 ms ago, and would be 20 m further on if anybody believed it.
    let late = traffic.motion(TARGET, 50_000, now.minus(Duration::from_millis(150)));
    let frames = traffic.peer(0, Said::Motion(late));
    assert!(receive_all(&mut unit, now, &frames).iter().all(Result::is_ok));

    let (before, after) = (stamps(&untouched, 0), stamps(&unit, 0));
    assert_eq!(after.len(), before.len(), "a full history drops its oldest");
    assert!(after.is_sorted() && after.contains(&now.minus(Duration::from_millis(150)).as_micros()), "{after:?}");
    assert_eq!(after.last(), before.last());
    for _ in 0..10 {
        traffic.target = false;
        let (now, frames) = traffic.next();
        receive_all(&mut unit, now, &frames);
        receive_all(&mut untouched, now, &frames);
        assert_eq!(unit.tick(now).estimate, untouched.tick(now).estimate);
    }
}

#[test]
fn a_slot_is_given_to_another_station_only_after_a_silence() {
    let (mut unit, mut traffic) = settled();
    traffic.behind = false;
    let mut taken_over = None;
    for period in 0..300 {
        traffic.step(&mut unit);
        let now = traffic.now();
        let other = traffic.motion(StationHash(7), -100_000, now);
        let frames = traffic.peer(1, Said::Motion(other));
        let results = receive_all(&mut unit, now, &frames);
        if results.last().is_some_and(Result::is_ok) && taken_over.is_none() {
            taken_over = Some(period);
            let track = unit.peers().get(1).expect("a slot");
            assert_eq!((track.station(), track.heard().len()), (Some(StationHash(7)), 1));
            assert_eq!((track.parameters(), track.knots()), (None, None), "what the other one said is forgotten");
        }
    }
    // The one behind spoke last in period 291 of the first 300; 2 s later is period 191 from here, checked after its tick.
    assert_eq!(taken_over, Some(190));
    assert_eq!(unit.peers().named(traffic::BEHIND).next(), None);
}

#[test]
fn a_station_moves_to_another_slot_only_after_a_silence_in_its_own_and_is_then_known_by_that_one_alone() {
    let (mut unit, mut traffic) = settled();
    traffic.target = false;
    let mut moved = None;
    for period in 0..300 {
        let answer = traffic.step(&mut unit);
        let now = traffic.now();
        // In slot 2, where it can be by what it said in slot 0.
        let motion = traffic.motion(TARGET, 17_000, now);
        let frames = traffic.peer(2, Said::Motion(motion));
        let taken = receive_all(&mut unit, now, &frames).iter().all(Result::is_ok);
        assert_eq!(unit.peers().named(TARGET).next(), Some(if taken { 2 } else { 0 }));
        let slots = unit.peers().iter().filter(|track| track.station() == Some(TARGET)).count();
        assert_eq!(slots, 1, "in period {period}");
        match moved {
            None if taken => moved = Some(period),
            None => {}
            Some(at) if period > at + 10 => {
                let estimate = answer.estimate.expect("it is followed in its new slot");
                assert!(estimate.age <= Duration::from_millis(20), "{:?}", estimate.age);
            }
            Some(_) => {}
        }
    }
    // It spoke last in period 290 of the first 300; 2 s later is period 190 from here, checked after its tick.
    assert_eq!(moved, Some(189));
}

#[test]
fn a_link_goes_off_after_a_period_and_the_tolerance_and_on_with_the_next_message() {
    let (mut unit, mut traffic) = settled();
    traffic.target = false;
    let mut last = 0;
    for period in 1..=60 {
        let answer = traffic.step(&mut unit);
        let estimate = answer.estimate.expect("the target is estimated");
        // It spoke last in period 290, so in this one it has been silent for 90 ms and 10 ms more in each.
        let silence = 90 + 10 * period;
        assert_eq!(estimate.link_on, silence <= 250, "{silence} ms");
        assert_eq!(estimate.age, Duration::from_millis(silence));
        if let [page] = pages(&answer.frames)[..] {
            assert_eq!(page.links_on, if silence <= 250 { 2 } else { 1 }, "{silence} ms");
            last = silence;
        }
    }
    assert!(last > 500, "the number of links is told");
    traffic.target = true;
    assert!(traffic.run(&mut unit, 10).estimate.expect("still there").link_on);
}

#[test]
fn delay_and_loss_are_measured_per_peer() {
    let (mut unit, mut traffic) = (Unit::new(&holdover::Config::car(traffic::EGO)).expect("sound"), Traffic::new());
    traffic.delay = Duration::from_millis(40);
    for period in 0..3_000 {
        traffic.target = period / 10 % 4 != 3; // every fourth message is lost
        traffic.step(&mut unit);
    }
    let link = |slot| *unit.peers().get(slot).expect("a slot").link();
    for slot in [0, 1] {
        let (delay, period) = (link(slot).delay(), link(slot).period());
        assert!(delay.minus(Duration::from_millis(40)).as_micros().abs() <= 50, "{delay:?}");
        assert!(period.minus(Duration::from_millis(100)).as_micros().abs() <= 100, "{period:?}");
    }
    assert_eq!(link(1).loss(), 0);
    let loss = f64::from(link(0).loss()) / f64::from(LOSS_ONE);
    assert!((0.1..0.27).contains(&loss), "{loss}");
}

#[test]
fn an_estimate_is_where_the_peer_is_now_not_where_it_was_when_it_spoke() {
    for delay in [0, 40, 250, 700] {
        let (mut unit, mut traffic) = settled();
        traffic.delay = Duration::from_millis(delay);
        for _ in 0..300 {
            let answer = traffic.step(&mut unit);
            let now = traffic.now().minus(traffic::PERIOD);
            let reading = answer.estimate.expect("the target is estimated").reading;
            let error: f64 = reading.position.get().to_num::<f64>() - traffic.target_at(now);
            assert!(error.abs() < 1e-3, "{delay} ms: {error} m");
            assert!(reading.speed.minus(Speed::from_mm_per_s(10_000)).magnitude() < Speed::from_mm_per_s(1));
        }
    }
}
