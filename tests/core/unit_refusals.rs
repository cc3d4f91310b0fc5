//! Whatever the unit refuses is refused by its name, counted under it, and changes nothing else: a bad frame enters one
//! of two equal units, and the answers of both stay the same ever after.

use crate::traffic;
use crate::traffic::{
    AnyFrame, BEHIND, EGO, PEERS, Traffic, Unit, drop_result, extended, is_page, leads, pages, receive_all, resealed,
    settled, standard,
};
use holdover::Reception;
use holdover::controller::Mode;
use holdover::health::Cause;
use holdover::time::{Duration, Instant, Stamp};
use holdover::units::Acceleration;
use holdover::wire::bits::Payload;
use holdover::wire::catalogue::{BLOCK, find};
use holdover::wire::motion::WirePosition;
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::{Frame, Message, Said, StationHash};

fn counts(unit: &Unit) -> Vec<u32> {
    Cause::ALL.iter().map(|cause| unit.health().of(*cause)).collect()
}

/// A bad input is refused as `cause`, once, and the unit then answers as one that never got it.
fn is_refused(cause: Cause, bad: impl FnOnce(&mut Unit, &mut Traffic) -> Result<Reception, Cause>) {
    let (mut unit, mut traffic) = settled();
    let mut untouched = unit.clone();
    let before = counts(&unit);
    assert_eq!(bad(&mut unit, &mut traffic), Err(cause));
    for (other, (before, after)) in Cause::ALL.iter().zip(before.into_iter().zip(counts(&unit))) {
        assert_eq!(after - before, u32::from(*other == cause), "count of {}", other.name());
    }
    stay_the_same(&mut unit, &mut untouched, &mut traffic);
}

/// For 5 s the two answer the same, apart from the counts in the pages of health. The first 200 ms are without the
/// target and the one behind, because the bad frame may have cost the next good one of its identifier its trust.
fn stay_the_same(unit: &mut Unit, untouched: &mut Unit, traffic: &mut Traffic) {
    for period in 0..500 {
        (traffic.target, traffic.behind) = (period > 20, period > 20);
        let (now, frames) = traffic.next();
        for frame in &frames {
            drop_result(unit.receive(now, frame));
            drop_result(untouched.receive(now, frame));
        }
        let (ours, theirs) = (unit.tick(now), untouched.tick(now));
        assert_eq!(
            (ours.command, ours.mode, ours.estimate),
            (theirs.command, theirs.mode, theirs.estimate),
            "{period}"
        );
        let said = |frames: &[Frame]| frames.iter().filter(|frame| !is_page(frame)).copied().collect::<Vec<_>>();
        assert_eq!(said(&ours.frames), said(&theirs.frames), "{period}");
    }
}

/// All frames but the last are parts that are still to be completed.
fn last(unit: &mut Unit, at: Instant, frames: &[Frame]) -> Result<Reception, Cause> {
    let results = receive_all(unit, at, frames);
    let (last, parts) = results.split_last().expect("a message has frames");
    assert!(parts.iter().all(|part| *part == Ok(Reception::Pending)), "{parts:?}");
    *last
}

/// A motion of the vehicle behind, changed, from slot 1.
fn motion(
    unit: &mut Unit,
    traffic: &mut Traffic,
    change: impl FnOnce(&mut holdover::wire::motion::Motion, &Traffic),
) -> Result<Reception, Cause> {
    let now = traffic.now();
    let mut motion = traffic.motion(BEHIND, -500_000, now);
    change(&mut motion, traffic);
    let frames = traffic.peer(1, Said::Motion(motion));
    last(unit, now, &frames)
}

/// The same for the ego's own.
fn ego(unit: &mut Unit, traffic: &mut Traffic, after: Duration) -> Result<Reception, Cause> {
    let now = traffic.now();
    let motion = traffic.motion(EGO, 0, now.plus(after));
    let frames = traffic.frames(&Message::Ego(Said::Motion(motion)));
    last(unit, now, &frames)
}

/// A good frame of the vehicle behind that would be the next.
fn good(traffic: &mut Traffic) -> Frame {
    let now = traffic.now();
    let motion = traffic.motion(BEHIND, -500_000, now);
    traffic.peer(1, Said::Motion(motion))[0]
}

#[test]
fn a_frame_that_is_remote_or_not_8_bytes_long_is_refused() {
    for length in [0, 1, 7] {
        is_refused(Cause::Length, |unit, traffic| {
            let mut frame = AnyFrame::from(good(traffic));
            frame.data.truncate(length);
            unit.receive(traffic.now(), &frame)
        });
    }
    is_refused(Cause::Length, |unit, traffic| {
        unit.receive(traffic.now(), &AnyFrame { remote: true, ..good(traffic).into() })
    });
}

#[test]
fn a_frame_with_a_wrong_checksum_is_refused() {
    for bit in (0..64).step_by(9) {
        is_refused(Cause::Checksum, |unit, traffic| {
            let mut frame = good(traffic);
            frame.data[bit / 8] ^= 1 << (bit % 8);
            unit.receive(traffic.now(), &frame)
        });
    }
}

#[test]
fn a_frame_that_comes_twice_is_refused_the_second_time() {
    is_refused(Cause::Repeated, |unit, traffic| {
        let mut before = traffic.clone();
        before.period = 291; // when the one behind spoke last
        let (_, frames) = before.next();
        let spoken = frames.iter().find(|frame| frame.id.number() == 0x480 + 0x48).expect("it spoke");
        // Sent again with the counter that it had then: one before the one that is next.
        let counter = (good(&mut traffic.clone()).data[1] & 0x0F).checked_sub(1).unwrap_or(14);
        unit.receive(traffic.now(), &resealed(*spoken, Some(counter), |_| ()))
    });
}

#[test]
fn a_frame_after_too_many_that_are_missing_is_refused() {
    is_refused(Cause::CounterGap, |unit, traffic| {
        let frames: [Frame; 5] = std::array::from_fn(|_| good(traffic));
        unit.receive(traffic.now(), &frames[4])
    });
}

#[test]
fn a_frame_with_counter_15_is_refused() {
    is_refused(Cause::CounterRange, |unit, traffic| {
        let frame = resealed(good(traffic), Some(15), |_| ());
        unit.receive(traffic.now(), &frame)
    });
}

#[test]
fn the_first_frame_of_an_identifier_is_not_yet_trusted() {
    is_refused(Cause::NotYetTrusted, |unit, traffic| {
        let now = traffic.now();
        let motion = traffic.motion(StationHash(5), 0, now);
        let frame = traffic.peer(2, Said::Motion(motion))[0];
        unit.receive(now, &frame)
    });
}

#[test]
fn a_reserved_value_is_refused() {
    // The acceleration of MotionB, bits 29 to 39, as -1024; the part of driving parameters, bits 14 and 15, as 3.
    for (said, frame, start, length, raw) in
        [(None, 1, 29, 11, 0x400), (Some(Said::DrivingParameters(leads())), 0, 14, 2, 3)]
    {
        is_refused(Cause::Range, |unit, traffic| {
            let now = traffic.now();
            let motion = traffic.motion(BEHIND, -500_000, now);
            let frame = traffic.peer(1, said.unwrap_or(Said::Motion(motion)))[frame];
            let reserve = |data: &mut [u8; 8]| {
                *data = Payload::from_bytes(*data).with(start, length, raw).to_bytes();
            };
            unit.receive(now, &resealed(frame, None, reserve))
        });
    }
}

#[test]
fn parts_that_do_not_belong_together_are_refused() {
    is_refused(Cause::Torn, |unit, traffic| {
        let (now, first, second) = (traffic.now(), good(traffic), good(traffic));
        assert_eq!(unit.receive(now, &first), Ok(Reception::Pending));
        unit.receive(now, &second)
    });
}

#[test]
fn a_stamp_that_is_too_old_or_in_the_future_is_refused() {
    let stamped = |after: i64| {
        move |motion: &mut holdover::wire::motion::Motion, traffic: &Traffic| {
            motion.stamp = traffic.gnss(traffic.now().plus(Duration::from_micros(after))).stamp();
        }
    };
    is_refused(Cause::Stale, |unit, traffic| motion(unit, traffic, stamped(-10_000_100)));
    is_refused(Cause::Stale, |unit, traffic| motion(unit, traffic, stamped(-12_000_000)));
    is_refused(Cause::Future, |unit, traffic| motion(unit, traffic, stamped(5_100)));
    is_refused(Cause::Future, |unit, traffic| motion(unit, traffic, stamped(1_000_000)));
    is_refused(Cause::Stale, |unit, traffic| ego(unit, traffic, Duration::from_micros(-50_100)));
    is_refused(Cause::Future, |unit, traffic| ego(unit, traffic, Duration::from_micros(5_100)));
}

#[test]
fn a_stamp_that_is_held_already_is_refused() {
    is_refused(Cause::Duplicate, |unit, traffic| {
        motion(unit, traffic, |motion, traffic| {
            let spoken = Duration::from_millis(90); // the one behind spoke in period 291 of 300
            motion.stamp = traffic.gnss(traffic.now().minus(spoken)).stamp();
        })
    });
    is_refused(Cause::Duplicate, |unit, traffic| ego(unit, traffic, Duration::from_millis(-10)));
}

#[test]
fn a_sample_that_is_older_than_all_of_a_full_history_is_refused() {
    is_refused(Cause::OutOfOrder, |unit, traffic| {
        assert_eq!(unit.peers().get(1).map(|track| track.heard().len()), Some(traffic::SAMPLES));
        motion(unit, traffic, |motion, traffic| {
            motion.stamp = traffic.gnss(traffic.now().minus(Duration::from_millis(2_000))).stamp();
        })
    });
    is_refused(Cause::OutOfOrder, |unit, traffic| ego(unit, traffic, Duration::from_millis(-15)));
}

#[test]
fn a_slot_beyond_the_capacity_is_refused() {
    for slot in [PEERS as u8, 15] {
        is_refused(Cause::UnknownSlot, |unit, traffic| {
            let frame = traffic.peer(slot, Said::DrivingParameters(leads()))[0];
            unit.receive(traffic.now(), &frame)
        });
    }
}

#[test]
fn another_station_in_the_slot_of_one_that_is_heard_is_refused() {
    is_refused(Cause::StationConflict, |unit, traffic| {
        motion(unit, traffic, |motion, _| motion.station = StationHash(77))
    });
}

#[test]
fn another_station_that_is_refused_leaves_the_slot_to_the_one_that_is_silent() {
    type Change = fn(&mut holdover::wire::motion::Motion);
    let changes: [(Cause, Change); 3] = [
        (Cause::TooFar, |motion| motion.position = WirePosition::from_mm(9_000_000)),
        (Cause::Implausible, |motion| motion.acceleration = Acceleration::from_mm_per_s2(-15_000)),
        (Cause::Stale, |motion| motion.stamp = Stamp::from_raw(motion.stamp.raw().wrapping_sub(110_000))),
    ];
    for (cause, change) in changes {
        let (mut unit, mut traffic) = settled();
        traffic.target = false;
        let before = traffic.run(&mut unit, 250);
        assert!(matches!(before.mode, Mode::Holdover { .. }));
        let mut untouched = unit.clone();
        let now = traffic.now();
        let mut motion = traffic.motion(StationHash(77), 17_000, now);
        change(&mut motion);
        let frames = traffic.peer(0, Said::Motion(motion));
        assert_eq!(last(&mut unit, now, &frames), Err(cause));
        let track = unit.peers().get(0).expect("a slot");
        assert_eq!((track.station(), track.parameters().is_some()), (Some(traffic::TARGET), true), "{cause:?}");
        let (mut after, mut expected) = (unit.clone(), untouched.clone());
        let (after, expected) = (after.tick(now), expected.tick(now));
        assert_eq!((after.mode, after.estimate), (expected.mode, expected.estimate), "{cause:?}");
        assert!(matches!(after.mode, Mode::Holdover { .. }) && after.estimate.is_some(), "{cause:?}");
        stay_the_same(&mut unit, &mut untouched, &mut traffic);
    }
}

#[test]
fn a_peer_that_is_too_far_away_is_refused() {
    // The ego is 30 m along by now.
    for mm in [1_530_200, -1_470_200, 10_000_000] {
        is_refused(Cause::TooFar, |unit, traffic| {
            motion(unit, traffic, |motion, _| motion.position = WirePosition::from_mm(mm))
        });
    }
}

#[test]
fn a_motion_that_breaks_several_rules_is_refused_by_the_first_in_their_order() {
    type Change = fn(&mut holdover::wire::motion::Motion, &Traffic);
    let other: Change = |motion, _| motion.station = StationHash(77);
    let stale: Change = |motion, _| motion.stamp = Stamp::from_raw(motion.stamp.raw().wrapping_sub(110_000));
    let far: Change = |motion, _| motion.position = WirePosition::from_mm(9_000_000);
    let held: Change = |motion, traffic| {
        motion.stamp = traffic.gnss(traffic.now().minus(Duration::from_millis(90))).stamp();
    };
    let wild: Change = |motion, _| motion.acceleration = Acceleration::from_mm_per_s2(-15_000);
    let cases: [(Cause, &[Change]); 5] = [
        (Cause::Stale, &[other, stale, far, wild]),
        (Cause::StationConflict, &[other, far, wild]),
        (Cause::TooFar, &[held, far, wild]),
        (Cause::Duplicate, &[held, wild]),
        (Cause::Implausible, &[wild]),
    ];
    for (cause, changes) in cases {
        is_refused(cause, |unit, traffic| {
            motion(unit, traffic, |motion, traffic| changes.iter().for_each(|change| change(motion, traffic)))
        });
    }
}

#[test]
fn a_follow_up_without_its_sync_message_is_refused() {
    is_refused(Cause::SyncSequence, |unit, traffic| {
        let frame = traffic.frames(&Message::FollowUp(FollowUp { sequence: 3, micros: 0 }))[0];
        unit.receive(traffic.now(), &frame)
    });
}

#[test]
fn a_synchronisation_that_was_long_on_its_way_is_refused() {
    is_refused(Cause::SyncLate, |unit, traffic| {
        let now = traffic.now();
        let frames = traffic.time_base();
        let results = receive_all(unit, now.plus(Duration::from_micros(5_100)), &frames);
        assert_eq!(results[0], Ok(Reception::Taken));
        results[1]
    });
}

#[test]
fn a_synchronisation_that_is_ahead_is_refused() {
    is_refused(Cause::SyncEarly, |unit, traffic| {
        let before = Traffic { offset: traffic.offset.minus(Duration::from_micros(60_000)), ..traffic.clone() };
        let (now, sequence) = (traffic.now(), traffic.sequence);
        let ahead = before.gnss(now).as_micros();
        let sync = Sync { sequence, seconds: u32::try_from(ahead / 1_000_000).expect("before 2116") };
        let follow_up = FollowUp { sequence, micros: (ahead % 1_000_000) as u32 };
        let frames = [traffic.frames(&Message::Sync(sync)), traffic.frames(&Message::FollowUp(follow_up))].concat();
        let results = receive_all(unit, now, &frames);
        assert_eq!(results[0], Ok(Reception::Taken));
        results[1]
    });
}

#[test]
fn a_follow_up_of_another_sync_message_is_refused_and_does_not_spoil_the_right_one() {
    let (mut unit, mut traffic) = settled();
    let (now, time) = (traffic.now(), traffic.gnss(traffic.now()).as_micros());
    let (seconds, micros) = (u32::try_from(time / 1_000_000).expect("before 2116"), (time % 1_000_000) as u32);
    let sync = traffic.frames(&Message::Sync(Sync { sequence: 14, seconds }))[0];
    let wrong = traffic.frames(&Message::FollowUp(FollowUp { sequence: 15, micros: 7 }))[0];
    let right = traffic.frames(&Message::FollowUp(FollowUp { sequence: 14, micros }))[0];
    let results = receive_all(&mut unit, now, &[sync, wrong, right, right]);
    let taken = Ok(Reception::Taken);
    assert_eq!(results, [taken, Err(Cause::SyncSequence), taken, Err(Cause::Repeated)]);
}

#[test]
fn a_time_that_runs_backwards_is_counted_and_taken_as_the_last_one() {
    let (mut unit, mut traffic) = settled();
    let before = counts(&unit);
    let last = traffic.now().minus(traffic::PERIOD);
    let (again, back) = (unit.clone().tick(last), unit.tick(last.minus(Duration::from_millis(1_000))));
    assert_eq!((again.command, again.mode, again.estimate), (back.command, back.mode, back.estimate));
    assert_eq!(unit.health().of(Cause::ClockBackwards), before[Cause::ClockBackwards as usize] + 1);
    assert_eq!(traffic.step(&mut unit).mode.code(), again.mode.code());
}

#[test]
fn frames_of_others_are_ignored_and_change_nothing() {
    let (mut unit, mut traffic) = settled();
    let mut untouched = unit.clone();
    let own = [0x02, 0x0A, 0x0B, 0x10, 0x11, 0x12, 0x13, 0x14, 0x15, 0x18];
    let unused = (0..BLOCK).filter(|offset| find(*offset).is_none());
    let inside = own.into_iter().chain(unused).map(|offset| 0x480 + offset);
    for id in (0..0x480).chain(0x540..0x800).chain(inside).map(standard).chain([extended(0), extended(0x484)]) {
        for data in [vec![], vec![0; 8], vec![0xFF; 8]] {
            for remote in [false, true] {
                let frame = AnyFrame { id, data: data.clone(), remote };
                assert_eq!(unit.receive(traffic.now(), &frame), Ok(Reception::Foreign), "{frame:?}");
            }
        }
    }
    assert_eq!(counts(&unit), counts(&untouched));
    stay_the_same(&mut unit, &mut untouched, &mut traffic);
    assert_eq!(counts(&unit), counts(&untouched));
}

#[test]
fn every_count_is_told_on_the_bus_under_its_name() {
    let (mut unit, mut traffic) = settled();
    let wrong = Frame { id: holdover::wire::Identifiers::DEFAULT.at(4), data: [0xAA; 8].into() };
    (0..7).for_each(|_| drop_result(unit.receive(traffic.now(), &wrong)));
    assert!(unit.health().of(Cause::Checksum) >= 7);
    let mut told = std::collections::BTreeMap::new();
    // A page comes every ten periods; the first is the one that a listener does not trust yet.
    for _ in 0..10 * (Cause::ALL.len() + 1) {
        for page in pages(&traffic.step(&mut unit).frames) {
            assert_eq!(page.count, unit.health().of(page.cause));
            told.insert(page.cause.name(), page.count);
        }
    }
    assert_eq!(told.len(), Cause::ALL.len(), "{told:?}");
    assert_eq!(told["checksum"], unit.health().of(Cause::Checksum));
    assert_eq!(told["jump"], 0);
}
