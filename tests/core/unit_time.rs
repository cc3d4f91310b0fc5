//! Time as the unit sees it: its own clock, GNSS time and stamps that wrap enter; the same answers leave, wherever its
//! clock started, and a plain word when it does not know the time.

use crate::traffic;
use crate::traffic::{Traffic, Unit, pages, receive_all, settled};
use holdover::Config;
use holdover::health::Cause;
use holdover::time::{Duration, GnssTime, Instant, Stamp};
use holdover::units::Speed;
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::{Said, StationHash};

#[test]
fn where_the_unit_s_clock_started_does_not_matter() {
    let sent = |offset| {
        let mut unit = Unit::new(&Config::car(traffic::EGO)).expect("the configuration is sound");
        let mut traffic = Traffic { offset: Instant::from_micros(offset), ..Traffic::new() };
        traffic.delay = Duration::from_micros(33_300);
        let frames = |period| {
            traffic.target = !(600..900).contains(&period);
            traffic.step(&mut unit).frames
        };
        (0..1_500).map(frames).collect::<Vec<_>>()
    };
    let reference = sent(1_000_000);
    // From the first on, messages are from before the clock's start.
    for offset in [0, 1, 33_299, 33_300, 33_301, 1_000_001, 4_294_967_295, 123_456_789_012_345, 1 << 62] {
        assert_eq!(sent(offset), reference, "{offset}");
    }
}

#[test]
fn stamps_that_wrap_during_a_run_are_nothing_to_notice() {
    let (mut unit, mut traffic) = settled();
    let refused = unit.health().total();
    let mut wraps = 0;
    for _ in 0..3_500 {
        let before = traffic.gnss(traffic.now()).stamp().raw();
        let answer = traffic.step(&mut unit);
        wraps += u32::from(traffic.gnss(traffic.now()).stamp().raw() < before);
        let at = traffic.now().minus(traffic::PERIOD);
        let position = answer.estimate.expect("the target is estimated").reading.position;
        assert!((position.get().to_num::<f64>() - traffic.target_at(at)).abs() < 1e-3, "{at:?}");
    }
    assert_eq!(wraps, 3, "35 s see the stamps wrap every {} s", Stamp::PERIOD.as_millis() / 1000);
    assert_eq!(unit.health().total(), refused);
}

#[test]
fn without_synchronisation_the_unit_says_so_and_assumes_the_configured_delay() {
    let config = Config::car(traffic::EGO);
    let (mut unit, mut traffic) = settled();
    traffic.sync = false; // last in period 250, the end of which is 0.5 s ago
    let (mut told, mut lost) = (Vec::new(), None);
    for period in 300..900i64 {
        let since_sync = Duration::from_millis((period - 250) * 10);
        let answer = traffic.step(&mut unit);
        let known = since_sync <= config.link.sync_timeout;
        assert_eq!(unit.is_synchronised(traffic.now().minus(traffic::PERIOD)), known, "{since_sync:?}");
        told.extend(pages(&answer.frames).iter().map(|page| (known, page.synchronised)));
        let estimate = answer.estimate.expect("the target is estimated still");
        if !known && period % 10 == 0 {
            // A message was received just now; its stamp means nothing, so it is taken to be that old.
            assert_eq!(estimate.age, config.link.assumed_delay, "{since_sync:?}");
            lost = Some(period);
        } else if period % 10 == 0 {
            assert_eq!(estimate.age, Duration::ZERO);
        }
    }
    assert!(lost.is_some() && told.iter().any(|(known, _)| !known) && told.iter().all(|(known, told)| known == told));

    traffic.sync = true;
    traffic.run(&mut unit, 101);
    assert!(unit.is_synchronised(traffic.now()));
    assert_eq!(traffic.run(&mut unit, 10).estimate.expect("and again").age, Duration::ZERO);
}

#[test]
fn a_unit_that_never_was_synchronised_drives_by_what_it_hears() {
    let (mut unit, mut traffic) = (Unit::new(&Config::car(traffic::EGO)).expect("sound"), Traffic::new());
    traffic.sync = false;
    let answer = traffic.run(&mut unit, 300);
    assert_eq!(answer.mode, holdover::controller::Mode::Cooperative);
    assert_eq!(unit.health().of(Cause::Stale) + unit.health().of(Cause::Future), 0);
}

#[test]
fn a_message_delivered_late_by_the_bus_is_as_old_as_its_stamp_says() {
    let (mut unit, mut traffic) = settled();
    traffic.run(&mut unit, 10); // the next period has the target's message, and none of the time base
    let (sent, frames) = traffic.next();
    let received = sent.plus(Duration::from_millis(7));
    receive_all(&mut unit, received, &frames);
    let answer = unit.tick(received);
    assert_eq!(answer.estimate.expect("the target spoke in this period").age, Duration::from_millis(7));
}

/// A unit whose clock starts at 0 hears a vehicle at 15 m/s from the first instant on, each message so late; how far the truth is
/// outside the bound at the most, in metres.
fn outside_the_bound(late_us: i64, is_synchronised: bool) -> f64 {
    let mut unit = Unit::new(&Config::car(traffic::EGO)).expect("sound");
    let mut traffic = Traffic { offset: Instant::ZERO, ..Traffic::new() };
    let truth = |at_us: i64| 300.0 + 15.0 * at_us as f64 * 1e-6;
    let (mut worst, mut checked) = (f64::MIN, 0);
    for period in 0..400 {
        traffic.period = period;
        let (now, now_us) = (traffic.now(), period * 10_000);
        let mut frames = if is_synchronised && period % 10 == 0 { traffic.time_base() } else { Vec::new() };
        if period % 10 == 5 {
            let stamped_us = now_us - late_us;
            let motion = Motion {
                position: WirePosition::from_mm((truth(stamped_us) * 1e3).round() as i64),
                speed: Speed::from_mm_per_s(15_000),
                stamp: GnssTime::from_micros(traffic::EPOCH.as_micros().saturating_add_signed(stamped_us)).stamp(),
                ..traffic.motion(StationHash(7), 0, now)
            };
            frames.extend(traffic.peer(2, Said::Motion(motion)));
        }
        receive_all(&mut unit, now, &frames);
        let Some(bound) = unit.bound(2, now) else { continue };
        let metres = |position: holdover::units::Position| position.get().to_num::<f64>();
        worst = worst.max(metres(bound.lowest_position()) - truth(now_us));
        worst = worst.max(truth(now_us) - metres(bound.highest_position()));
        checked += 1;
    }
    assert!(checked > 300);
    worst
}

#[test]
fn what_was_sent_before_the_clock_s_start_is_as_old_as_it_is() {
    for millis in [0, 40, 500, 1_000, 1_999] {
        for is_synchronised in [false, true] {
            let outside = outside_the_bound(1_000 * millis, is_synchronised);
            assert!(outside <= 0.0, "{millis} ms, {is_synchronised}: {outside} m");
        }
    }
}
