//! Peers that do not tell the truth: each kind is detected, named, counted and not used, and believed again by rule. Late and
//! reordered messages of a peer that does tell it are none of these.

use crate::rig;
use crate::rig::plant::Body;
use crate::rig::{Rig, TARGET, instant, m_of};
use holdover::health::Cause;
use holdover::parameters::RECOVERY_SAMPLES;
use holdover::wire::{Said, StationHash};

/// A target that is heard every 100 ms and may lie.
struct Target {
    rig: Rig,
    body: Body,
    now: i64,
}

/// What one sample says otherwise than the truth.
#[derive(Clone, Copy, Default)]
struct Lie {
    position: f64,
    speed: f64,
    acceleration: Option<f64>,
}

const ACCURACY: Option<(f64, f64)> = Some((0.5, 0.2));

impl Target {
    /// At 15 m/s, heard and believed for 2 s.
    fn believed() -> Self {
        let mut rig = Rig::new(&rig::config());
        rig.power_up(true, 0);
        for at in [-60_000, -40_000] {
            let _ = rig.target(at, Said::DrivingParameters(rig::parameters(2.0, 8.0)));
        }
        let mut target = Self { rig, body: Body { position: 500.0, speed: 15.0 }, now: 0 };
        let _ = target.says(Lie::default()); // not trusted yet
        for _ in 0..20 {
            assert_eq!(target.says(Lie::default()), Ok(()));
        }
        target
    }

    fn says(&mut self, lie: Lie) -> Result<(), Cause> {
        self.moves(0.0, 0.1, lie)
    }

    fn moves(&mut self, a: f64, time: f64, lie: Lie) -> Result<(), Cause> {
        self.body = self.body.after(a, time);
        self.now += (time * 1e6).round() as i64;
        if self.now % 500_000 == 0 {
            self.rig.synchronise(self.now, 0);
        }
        let (position, speed) = (self.body.position + lie.position, self.body.speed + lie.speed);
        let said = lie.acceleration.unwrap_or(a);
        let motion = self.rig.motion(TARGET, self.now, position, speed, said, said, ACCURACY);
        self.rig.target(self.now, Said::Motion(motion))
    }

    fn newest(&self) -> f64 {
        m_of(self.rig.unit.peers().get(2).unwrap().newest().unwrap().position)
    }

    fn estimate(&mut self) -> f64 {
        self.rig.tick(self.now);
        m_of(self.rig.unit.estimator().read(2, instant(self.now)).unwrap().position)
    }

    fn count(&self, cause: Cause) -> u32 {
        self.rig.unit.health().of(cause)
    }
}

#[test]
fn a_jump_is_named_counted_and_not_used() {
    for (jump, is_caught) in [(-40.0, true), (-5.0, true), (5.0, true), (40.0, true), (0.4, false), (-0.4, false)] {
        let mut target = Target::believed();
        target.estimate();
        let before = target.newest();
        let taken = target.says(Lie { position: jump, ..Lie::default() });
        if is_caught {
            assert_eq!(taken, Err(Cause::Jump), "{jump}");
            assert_eq!((target.count(Cause::Jump), target.newest()), (1, before), "{jump}");
            let estimate = target.estimate();
            assert!((estimate - target.body.position).abs() < 0.1, "{jump}: {estimate}");
        } else {
            assert_eq!(taken, Ok(()), "{jump}");
        }
        // The next honest sample is believed at once.
        assert_eq!(target.says(Lie::default()), Ok(()));
    }
}

#[test]
fn one_constant_speed_while_the_position_moves_four_times_as_fast_is_never_believed_for_long() {
    // As recorded in the field: 161 messages.
    let mut target = Target::believed();
    target.body.speed = 60.0;
    let (mut taken, mut named) = (0, 0);
    for _ in 0..161 {
        match target.says(Lie { speed: -45.0, ..Lie::default() }) {
            Ok(()) => taken += 1,
            Err(Cause::Jump | Cause::Implausible | Cause::Stuck) => named += 1,
            Err(other) => panic!("{other:?}"),
        }
    }
    assert!(named > 150 && taken <= 11, "{named} named, {taken} taken");
    let counted: u32 = [Cause::Jump, Cause::Implausible].map(|cause| target.count(cause)).iter().sum();
    assert_eq!(counted, named);
    // When it tells the truth again it is believed again.
    let mut refused = 0;
    while target.says(Lie::default()).is_err() {
        refused += 1;
    }
    assert_eq!(refused, RECOVERY_SAMPLES - 1);
}

#[test]
fn the_same_is_found_of_one_that_publishes_no_accuracies_and_no_limits() {
    for speed in [3.5, 8.0, 15.0] {
        let mut rig = Rig::new(&rig::config());
        rig.power_up(true, 0);
        let mut taken = 0;
        for n in 0..161 {
            let at = n * 100_000;
            rig.synchronise(at, 0);
            let motion = rig.motion(TARGET, at, 4.0 * speed * at as f64 * 1e-6, speed, 0.0, 0.0, None);
            taken += i32::from(rig.target(at, Said::Motion(motion)).is_ok());
        }
        // Ten until the positions have drifted out of ±5 m, and after each of two recoveries, which take 5 and 10.
        assert!(taken <= 33, "{speed}: {taken}");
    }
}

#[test]
fn each_recovery_takes_twice_as_many_samples_as_the_last_until_it_is_forgiven() {
    let mut target = Target::believed();
    let correct = |target: &mut Target| {
        // Too far to be in reach when the bound has grown for as long as it takes.
        target.body.position += 600.0;
        (1..).find(|_| target.says(Lie::default()).is_ok()).unwrap()
    };
    for expected in [5, 10, 20, 40, 80, 160, 160] {
        assert_eq!(correct(&mut target), expected);
    }
    // The strikes stop at five; 99 samples do not forgive one, 100 do.
    for _ in 0..99 {
        assert_eq!(target.says(Lie::default()), Ok(()));
    }
    assert_eq!(correct(&mut target), 160);
    for expected in [80, 80, 80] {
        for _ in 0..100 {
            assert_eq!(target.says(Lie::default()), Ok(()));
        }
        assert_eq!(correct(&mut target), expected);
    }
    for _ in 0..600 {
        assert_eq!(target.says(Lie::default()), Ok(()));
    }
    assert_eq!(correct(&mut target), 5);
}

#[test]
fn a_speed_that_does_not_fit_the_positions_is_implausible() {
    let mut target = Target::believed();
    assert_eq!(target.says(Lie { speed: 5.0, ..Lie::default() }), Err(Cause::Implausible));
    assert_eq!(target.says(Lie { speed: -5.0, ..Lie::default() }), Err(Cause::Implausible));
    assert_eq!(target.count(Cause::Implausible), 2);
    assert_eq!(target.says(Lie::default()), Ok(()));
}

#[test]
fn values_that_do_not_change_though_they_have_to_are_stuck() {
    let mut target = Target::believed();
    let stuck = target.body;
    let mut verdicts = Vec::new();
    for _ in 0..8 {
        target.now += 100_000;
        let motion = target.rig.motion(TARGET, target.now, stuck.position, stuck.speed, 0.0, 0.0, ACCURACY);
        verdicts.push(target.rig.target(target.now, Said::Motion(motion)));
    }
    // At 15 m/s, with errors of up to 1.5 m, only the first two can be.
    assert_eq!(verdicts[..2], [Ok(()); 2]);
    assert_eq!(verdicts[2..], [Err(Cause::Stuck); 6]);
    assert_eq!(target.count(Cause::Stuck), 6);
    // One that really stands says so with its speed.
    let mut target = Target::believed();
    while target.body.speed > 0.0 {
        assert_eq!(target.moves(-8.0, 0.1, Lie::default()), Ok(()));
    }
    for _ in 0..50 {
        assert_eq!(target.says(Lie::default()), Ok(()));
    }
}

#[test]
fn an_acceleration_that_no_vehicle_has_is_implausible() {
    for (acceleration, is_caught) in [(13.1, true), (-13.1, true), (-20.0, true), (12.9, false), (-12.9, false)] {
        let mut target = Target::believed();
        let taken = target.says(Lie { acceleration: Some(acceleration), ..Lie::default() });
        assert_eq!(taken == Err(Cause::Implausible), is_caught, "{acceleration}: {taken:?}");
    }
}

#[test]
fn braking_harder_than_it_says_it_can_is_noticed_when_it_has_shown_in_speed() {
    let mut target = Target::believed();
    let mut verdicts = Vec::new();
    for _ in 0..6 {
        verdicts.push(target.moves(-11.0, 0.1, Lie::default()));
    }
    assert!(verdicts.iter().any(|verdict| matches!(verdict, Err(Cause::Implausible | Cause::Jump))), "{verdicts:?}");
}

#[test]
fn a_second_station_in_the_slot_is_a_conflict_until_the_first_has_been_silent_for_long_enough() {
    let mut target = Target::believed();
    let other = |target: &mut Target, after: i64| {
        target.now += after;
        target.rig.synchronise(target.now, 0);
        let motion = target.rig.motion(StationHash(66), target.now, 900.0, 10.0, 0.0, 0.0, ACCURACY);
        target.rig.target(target.now, Said::Motion(motion))
    };
    assert_eq!(other(&mut target, 50_000), Err(Cause::StationConflict));
    assert_eq!(target.count(Cause::StationConflict), 1);
    target.body = target.body.after(0.0, 0.05);
    assert_eq!(target.says(Lie::default()), Ok(()));
    assert_eq!(other(&mut target, 1_900_000), Err(Cause::StationConflict));
    assert_eq!(other(&mut target, 200_000), Ok(()));
    let track = target.rig.unit.peers().get(2).unwrap();
    assert_eq!((track.station(), track.parameters()), (Some(StationHash(66)), None));
    assert_eq!(target.newest(), 900.0);
}

#[test]
fn five_samples_that_agree_with_one_another_are_believed_against_what_was_certain() {
    // A receiver's position is corrected by 30 m.
    let mut target = Target::believed();
    target.body.position += 30.0;
    for n in 1..RECOVERY_SAMPLES {
        assert_eq!(target.says(Lie::default()), Err(Cause::Jump), "{n}");
    }
    assert_eq!(target.says(Lie::default()), Ok(()));
    assert_eq!(target.newest(), target.body.position);
    assert_eq!(target.rig.unit.peers().get(2).unwrap().heard().len(), 1);
    assert_eq!(target.says(Lie::default()), Ok(()));
}

#[test]
fn samples_that_do_not_agree_with_one_another_are_not_believed_however_many() {
    let mut target = Target::believed();
    for n in 0..40 {
        let position = [30.0, -50.0, 90.0][n % 3];
        assert_eq!(target.says(Lie { position, ..Lie::default() }), Err(Cause::Jump), "{n}");
    }
}

#[test]
fn one_honest_sample_takes_the_evidence_of_the_liar_away() {
    let mut target = Target::believed();
    for _ in 0..5 {
        for _ in 1..RECOVERY_SAMPLES {
            assert_eq!(target.says(Lie { position: 30.0, ..Lie::default() }), Err(Cause::Jump));
        }
        assert_eq!(target.says(Lie::default()), Ok(()));
    }
}

#[test]
fn an_old_sample_that_comes_late_changes_neither_the_bound_nor_the_estimate() {
    for position in [0.0, 300.0, -300.0] {
        let mut target = Target::believed();
        let at = instant(target.now);
        target.estimate();
        let before = (target.rig.unit.bound(2, at), target.newest(), target.estimate());
        // Stamped between two that came, and as wrong as you like.
        let motion = target.rig.motion(TARGET, target.now - 150_000, 500.0 + position, 3.0, 5.0, 5.0, ACCURACY);
        let taken = target.rig.target(target.now, Said::Motion(motion));
        assert_eq!(taken, Ok(()));
        assert_eq!((target.rig.unit.bound(2, at), target.newest(), target.estimate()), before);
        assert_eq!(target.says(Lie::default()), Ok(()));
    }
}

#[test]
fn copies_of_a_refused_sample_are_no_evidence() {
    // Copies of one, and ones that say the same a moment later each.
    for apart in [0, 1, 100, 1_000, 9_900] {
        let mut target = Target::believed();
        let mut verdicts = Vec::new();
        for n in 0..5 * i64::from(RECOVERY_SAMPLES) {
            let at = target.now + 5_000 + (n * apart).min(40_000);
            let (ahead, speed) = (target.body.position + 200.0, target.body.speed);
            let motion = target.rig.motion(TARGET, at, ahead, speed, 0.0, 0.0, ACCURACY);
            verdicts.push(target.rig.target(at, Said::Motion(motion)));
        }
        assert_eq!(verdicts[0], Err(Cause::Jump));
        let named = |verdict: &Result<(), Cause>| matches!(verdict, Err(Cause::Jump | Cause::Duplicate));
        assert!(verdicts.iter().all(named), "{apart}: {verdicts:?}");
        if apart == 0 {
            assert!(verdicts[1..].iter().all(|verdict| *verdict == Err(Cause::Duplicate)));
        }
        // Nothing honest is refused after it.
        for n in 0..20 {
            assert_eq!(target.says(Lie::default()), Ok(()), "{apart} {n}");
        }
        let estimate = target.estimate();
        assert!((estimate - target.body.position).abs() < 0.1, "{apart}: {estimate}");
    }
}

#[test]
fn who_was_forged_for_long_enough_to_be_believed_is_believed_again_after_a_second() {
    let mut target = Target::believed();
    let forged = (1..).find(|_| target.says(Lie { position: 200.0, ..Lie::default() }).is_ok()).unwrap();
    assert_eq!(forged, RECOVERY_SAMPLES);
    let refused = (0..).find(|_| target.says(Lie::default()).is_ok()).unwrap();
    assert_eq!(refused, 2 * RECOVERY_SAMPLES - 1);
}

#[test]
fn a_stamp_that_stands_still_is_never_news_however_often_it_comes_round() {
    let mut target = Target::believed();
    let (frozen, body) = (target.now, target.body);
    for n in 1..700 {
        let now = frozen + n * 100_000;
        if n % 5 == 0 {
            target.rig.synchronise(now, 0);
        }
        let place = body.position + 1.5 * n as f64;
        let motion = target.rig.motion(TARGET, frozen, place, body.speed, 0.0, 0.0, ACCURACY);
        let taken = target.rig.target(now, Said::Motion(motion));
        assert!(matches!(taken, Err(Cause::Duplicate | Cause::Stale | Cause::Future)), "{n}: {taken:?}");
    }
}

#[test]
fn an_own_stamp_that_stands_still_is_never_news_however_often_it_comes_round() {
    let mut rig = Rig::new(&rig::config());
    rig.power_up(true, 0);
    for at in [0, 10_000] {
        let _ = rig.ego(at, 0.0, 10.0, 0.0, 0.0);
    }
    for n in 2..6_000 {
        let now = n * 10_000;
        if n % 50 == 0 {
            rig.synchronise(now, 0);
        }
        let motion = rig.motion(rig::EGO, 10_000, 0.1 * n as f64, 10.0, 0.0, 0.0, ACCURACY);
        let taken = rig.put(now, &holdover::wire::Message::Ego(Said::Motion(motion)));
        assert!(matches!(taken, Err(Cause::Duplicate | Cause::Stale | Cause::Future)), "{n}: {taken:?}");
    }
}
