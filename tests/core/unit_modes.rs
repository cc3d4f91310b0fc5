//! The unit's modes as they are reached from outside, and that it answers whatever it is or is not told, whenever it is
//! asked.

use crate::traffic;
use crate::traffic::{EGO, PERIOD, TARGET, Traffic, Unit, pages, request, settled};
use holdover::Config;
use holdover::controller::{FallbackCause, FaultCause, Mode};
use holdover::time::{Duration, Instant};
use holdover::units::Acceleration;
use holdover::wire::command::{Effort, ModeCode};
use holdover::wire::driver_request::DriverRequest;
use holdover::wire::{Predecessor, StationHash};

fn unit() -> Unit {
    Unit::new(&Config::car(EGO)).expect("the configuration is sound")
}

#[test]
fn not_engaged_the_unit_stands_by_and_keeps_up_with_what_is_demanded() {
    let (mut unit, mut traffic) = settled();
    traffic.request = DriverRequest { engaged: false, ..request(Predecessor::Station(TARGET)) };
    let answer = traffic.run(&mut unit, 11);
    assert_eq!((answer.mode, answer.command.mode), (Mode::Standby, ModeCode::Standby));
    assert_eq!(answer.command.acceleration, Acceleration::ZERO, "the ego says that nothing is demanded of it");
}

#[test]
fn with_the_link_on_or_leading_it_cooperates() {
    let (mut unit, mut traffic) = settled();
    assert_eq!(traffic.step(&mut unit).mode, Mode::Cooperative);
    traffic.request = request(Predecessor::None);
    traffic.target = false;
    assert_eq!(traffic.run(&mut unit, 100).mode, Mode::Cooperative);
}

#[test]
fn with_the_link_off_it_holds_over_and_falls_back_when_that_has_lasted_too_long() {
    let (mut unit, mut traffic) = settled();
    traffic.target = false;
    let mut modes = vec![];
    for _ in 0..1_600 {
        let answer = traffic.step(&mut unit);
        if modes.last() != Some(&answer.mode) {
            modes.push(answer.mode);
        }
    }
    // It spoke last 0.1 s before; the link is off after 0.25 s, and the holdover ends after 15 s.
    let spoke = traffic.offset.plus(Duration::from_millis(2_900));
    let since = spoke.plus(Duration::from_millis(260));
    let lost = spoke.plus(Duration::from_millis(15_010));
    let fallback = Mode::Fallback { since: lost, cause: FallbackCause::Silent, heard_since: None };
    assert_eq!(modes, [Mode::Cooperative, Mode::Holdover { since }, fallback]);
}

#[test]
fn in_a_fallback_the_braking_grows_with_time_and_no_further_than_normal() {
    let (mut unit, mut traffic) = settled();
    traffic.request = request(Predecessor::Unknown);
    let mut last = traffic.run(&mut unit, 11).command.acceleration;
    for period in 0..1_200 {
        let answer = traffic.step(&mut unit);
        assert!(matches!(answer.mode, Mode::Fallback { cause: FallbackCause::NotAssociated, .. }), "{period}");
        assert!(answer.command.acceleration <= last || last > Acceleration::ZERO, "{period}");
        last = answer.command.acceleration;
    }
    assert_eq!(last, unit.config().limits.braking.negated());
}

#[test]
fn a_target_that_nobody_ever_heard_is_a_fallback() {
    let (mut unit, mut traffic) = settled();
    traffic.request = request(Predecessor::Station(StationHash(200)));
    let mode = traffic.run(&mut unit, 11).mode;
    assert!(matches!(mode, Mode::Fallback { cause: FallbackCause::NeverHeard, .. }), "{mode:?}");
}

#[test]
fn without_the_ego_s_own_motion_it_brakes_as_hard_as_is_normal() {
    let (mut unit, mut traffic) = settled();
    traffic.ego = false;
    let mut answer = traffic.run(&mut unit, 6); // the ego spoke last 60 ms ago, one period too long
    assert!(matches!(answer.mode, Mode::Fault { cause: FaultCause::EgoStale, .. }), "{:?}", answer.mode);
    for _ in 0..200 {
        answer = traffic.step(&mut unit);
    }
    assert_eq!(answer.command.acceleration, unit.config().limits.braking.negated());
    assert!(matches!(answer.command.effort, Effort::BrakeTorque(torque) if torque > 0));

    let mut unit = self::unit();
    let mut traffic = Traffic { ego: false, ..Traffic::new() };
    let mode = traffic.run(&mut unit, 50).mode;
    assert!(matches!(mode, Mode::Fault { cause: FaultCause::EgoMissing, .. }), "{mode:?}");
}

#[test]
fn the_mode_and_its_cause_are_told_on_the_bus() {
    let (mut unit, mut traffic) = settled();
    traffic.ego = false;
    let frames: Vec<_> = (0..30).flat_map(|_| traffic.step(&mut unit).frames).collect();
    let page = *pages(&frames).last().expect("ten pages a second");
    assert_eq!((page.mode, page.detail), (ModeCode::Fault, FaultCause::EgoStale as u8));
}

#[test]
fn a_unit_that_hears_nothing_answers_every_tick() {
    let mut unit = unit();
    for tick in 0..1_000 {
        let answer = unit.tick(Instant::ZERO.plus(PERIOD.times(tick)));
        assert_eq!((answer.mode, answer.command.acceleration), (Mode::Standby, Acceleration::ZERO));
        assert_eq!((answer.estimate, answer.frames.is_empty()), (None, false), "the command is always sent");
    }
}

#[test]
fn a_pause_of_any_length_is_answered_and_overcome() {
    for seconds in [1, 3, 5, 10, 13, 60, 3_600, 1_000_000] {
        let (mut unit, mut traffic) = settled();
        let before = traffic.step(&mut unit).command.acceleration;
        traffic.period += seconds * 100;
        let answer = unit.tick(traffic.now());
        assert!(
            matches!(answer.mode, Mode::Fault { cause: FaultCause::EgoStale, .. }),
            "{seconds} s: {:?}",
            answer.mode
        );
        assert!(answer.command.acceleration < before, "{seconds} s");
        assert!(!answer.frames.is_empty());
        // Counters on the bus have stood still all the while, so everybody is trusted at once.
        let after = traffic.run(&mut unit, 120);
        assert_eq!(after.mode, Mode::Cooperative, "{seconds} s");
        // After an hour it has driven once round the range of a position on the wire, which nobody can know.
        let at = traffic.now().minus(PERIOD);
        let position: f64 = after.estimate.expect("the target speaks again").reading.position.get().to_num();
        let turns = (position - traffic.target_at(at)) / 33_554.432;
        assert!((turns - turns.round()).abs() * 33_554.432 < 1e-3, "{seconds} s: {turns}");
    }
}

#[test]
fn ticks_at_irregular_times_read_the_estimate_at_those_times() {
    let (mut unit, mut traffic) = settled();
    let mut odd = 12_345u64;
    for _ in 0..500 {
        let (now, frames) = traffic.next();
        traffic::receive_all(&mut unit, now, &frames);
        let mut at = now;
        for _ in 0..3 {
            odd = odd.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            at = at.plus(Duration::from_micros((odd >> 33) as i64 % 3_300));
            let reading = unit.tick(at).estimate.expect("the target is estimated").reading;
            let error = reading.position.get().to_num::<f64>() - traffic.target_at(at);
            assert!(error.abs() < 1e-3, "{at:?}: {error} m");
        }
    }
}

#[test]
fn a_unit_for_eight_peers_and_400_steps_fits_64_kib() {
    let size = size_of::<holdover::OnboardUnit<8, 8, 400>>();
    assert!(size <= 64 * 1024, "{size} bytes");
}
