//! Facts about tracks: which samples are admitted, and by which rule the others are not.

use super::*;
use crate::config::{Config, Link as Limits};
use crate::model::bound::{Bound, Uncertainty};
use crate::time::GnssTime;
use crate::units::{Acceleration, Position, Speed};
use crate::wire::horizon::{KNOTS, Knot, Knots};

const LIMITS: Limits = Config::car(StationHash(0)).link;
/// Every sample is believed here. Plausibility has its own tests.
const UNCERTAINTY: Uncertainty = Uncertainty {
    position: crate::units::Distance::from_mm(1_000_000),
    speed: Speed::from_mm_per_s(60_000),
    earlier: Duration::ZERO,
    later: Duration::ZERO,
};

fn at(millis: u64) -> Instant {
    Instant::from_micros(100_000_000 + millis * 1000)
}

/// Admits a sample by all rules of a track.
fn admit<const N: usize>(track: &mut Track<N>, sample: Sample) -> Result<Admission, Cause> {
    timely(sample.at, sample.received, LIMITS.stale, LIMITS.future)?;
    let judgement = track.judge(&sample, &UNCERTAINTY, LIMITS.period);
    match judgement.verdict {
        Ok(belief) => Ok(track.admit(&sample, &judgement.certainty, belief)),
        Err(cause) => {
            track.note(&judgement.certainty);
            Err(cause)
        }
    }
}

/// A sample of station 1 that was true at `true_at` and received at `received`.
fn sample(true_at: u64, received: u64) -> Sample {
    Sample {
        is_timed: true,
        at: at(true_at),
        received: at(received),
        stamp: GnssTime::from_micros(true_at * 1000).stamp(),
        position: Position::from_mm(10 * true_at as i64),
        speed: Speed::from_mm_per_s(10_000),
        acceleration: Acceleration::ZERO,
        demand: Acceleration::ZERO,
        position_accuracy: None,
        speed_accuracy: None,
        station: StationHash(1),
        tag: 0,
    }
}

fn track<const N: usize>(true_at: [u64; N]) -> Track<4> {
    let mut track = Track::new(LIMITS.period);
    for millis in true_at {
        assert!(admit(&mut track, sample(millis, millis)).is_ok());
    }
    track
}

fn held(track: &Track<4>) -> Vec<u64> {
    track.heard().map(|heard| heard.at.since(at(0)).as_millis().unsigned_abs()).collect()
}

/// Refuses the sample for this cause, and changes nothing.
fn refuses(track: &Track<4>, sample: Sample, cause: Cause) {
    let mut tried = track.clone();
    assert_eq!(admit(&mut tried, sample), Err(cause));
    assert!(tried.heard().eq(track.heard()) && tried.newest() == track.newest());
    assert_eq!(tried.link(), track.link());
}

#[test]
fn samples_are_held_in_the_order_of_their_stamps_whatever_order_they_come_in() {
    for order in [[100, 200, 300, 400], [400, 300, 200, 100], [200, 400, 100, 300]] {
        let mut track = Track::<4>::new(LIMITS.period);
        for (place, millis) in order.into_iter().enumerate() {
            let is_newest = order[..place].iter().all(|before| *before < millis);
            let expected = if is_newest { Admission::News } else { Admission::History };
            assert_eq!(admit(&mut track, sample(millis, 500)), Ok(expected), "{order:?} {millis}");
        }
        assert_eq!(held(&track), [100, 200, 300, 400]);
    }
}

#[test]
fn a_full_history_drops_its_oldest_for_anything_newer() {
    let mut track = track([100, 200, 300, 400]);
    assert_eq!(admit(&mut track, sample(250, 500)), Ok(Admission::History));
    assert_eq!(held(&track), [200, 250, 300, 400]);
    assert_eq!(admit(&mut track, sample(450, 500)), Ok(Admission::News));
    assert_eq!(held(&track), [250, 300, 400, 450]);
    refuses(&track, sample(249, 500), Cause::OutOfOrder);
}

#[test]
fn a_stamp_is_too_old_or_too_new_beyond_its_limit_and_not_at_it() {
    let (stale, future) = (LIMITS.stale.as_millis() as u64, LIMITS.future.as_millis() as u64);
    let track = track([]);
    for (sample, refused) in [
        (sample(1_000, 1_000 + stale), None),
        (sample(999, 1_000 + stale), Some(Cause::Stale)),
        (sample(1_000 + future, 1_000), None),
        (sample(1_001 + future, 1_000), Some(Cause::Future)),
    ] {
        match refused {
            None => assert_eq!(admit(&mut track.clone(), sample), Ok(Admission::News)),
            Some(cause) => refuses(&track, sample, cause),
        }
    }
}

#[test]
fn a_stamp_that_is_held_is_a_duplicate_within_its_own_turn_and_that_of_the_newest_always() {
    let track = track([100, 200]);
    refuses(&track, sample(200, 260), Cause::Duplicate);
    refuses(&track, sample(100, 260), Cause::Duplicate);
    // The same stamp repeats after 13.1072 s.
    let round = |millis| Sample { stamp: sample(millis, 0).stamp, ..sample(millis + 13_107, millis + 13_107) };
    assert_eq!(admit(&mut track.clone(), round(100)), Ok(Admission::News));
    refuses(&track, round(200), Cause::Duplicate);
}

#[test]
fn a_horizon_belongs_to_the_sample_with_its_tag_while_that_is_the_newest() {
    let knots = Knots { tag: 2, knots: [Knot::default(); KNOTS] };
    let mut track = track([]);
    assert!(!track.foresee(at(90), knots), "of no sample");
    assert_eq!(admit(&mut track, Sample { tag: 2, ..sample(100, 100) }), Ok(Admission::News));
    assert_eq!(track.knots(), Some(&knots), "it may come before its sample");
    assert_eq!(admit(&mut track, Sample { tag: 3, ..sample(200, 200) }), Ok(Admission::News));
    assert_eq!(track.knots(), None);
}

#[test]
fn a_horizon_of_the_tags_last_round_belongs_to_no_sample() {
    let mut track = track([]);
    assert!(admit(&mut track, Sample { tag: 2, ..sample(100, 100) }).is_ok());
    assert!(track.foresee(at(101), Knots { tag: 2, knots: [Knot::default(); KNOTS] }));
    for (tag, millis) in [(3, 200), (0, 300), (1, 400), (2, 500)] {
        assert!(admit(&mut track, Sample { tag, ..sample(millis, millis) }).is_ok());
        assert_eq!(track.knots(), None, "{millis}");
    }
}

#[test]
fn a_horizon_is_not_joined_to_a_later_sample_that_has_its_tag_however_soon_that_comes() {
    // Messages that were held up on the air come one right after the other.
    let mut track = track([]);
    let knots = Knots { tag: 2, knots: [Knot::default(); KNOTS] };
    assert!(admit(&mut track, Sample { tag: 2, ..sample(100, 900) }).is_ok());
    assert!(track.foresee(at(901), knots));
    assert!(admit(&mut track, Sample { tag: 2, ..sample(500, 905) }).is_ok());
    assert_eq!(track.knots(), None, "its own has not come yet");
    assert!(track.foresee(at(906), knots));
}

#[test]
fn a_slot_beyond_the_capacity_is_refused_and_a_station_is_found_by_its_name() {
    let mut peers = {
        let mut peers = Peers::<2, 4>::idle();
        peers.start(LIMITS.period);
        peers
    };
    assert_eq!(peers.get_mut(Slot(2)).err(), Some(Cause::UnknownSlot));
    assert_eq!(peers.predecessor(StationHash(1), None), None);
    let admitted = peers.get_mut(Slot(1)).map(|track| admit(track, sample(100, 100)));
    assert_eq!(admitted, Ok(Ok(Admission::News)));
    assert_eq!(peers.predecessor(StationHash(1), None), Some(1));
}

#[test]
fn a_horizon_that_was_overtaken_with_its_sample_does_not_displace_the_newest_one_s() {
    let mut track = track::<0>([]);
    let tagged = |true_at, received, tag| Sample { tag, ..sample(true_at, received) };
    let knots = |tag| Knots { tag, knots: [Knot::default(); KNOTS] };
    admit(&mut track, tagged(300, 310, 0)).unwrap();
    assert!(track.foresee(at(310), knots(0)));
    for (true_at, tag) in [(200, 3), (100, 2)] {
        assert_eq!(admit(&mut track, tagged(true_at, 311, tag)), Ok(Admission::History));
        assert!(!track.foresee(at(311), knots(tag)));
        assert_eq!(track.knots(), Some(&knots(0)), "{tag}");
    }
    // A horizon that comes before its sample waits for it.
    assert!(!track.foresee(at(400), knots(1)));
    admit(&mut track, tagged(400, 401, 1)).unwrap();
    assert_eq!(track.knots(), Some(&knots(1)));
}

#[test]
fn what_was_carried_on_is_what_is_certain_whatever_was_heard_since() {
    let mut track = track([100]);
    let now = at(250);
    for heard in [None, Some(200), Some(150), Some(240)] {
        if let Some(millis) = heard {
            admit(&mut track, sample(millis, 250)).unwrap();
        }
        let certain = track.certainty().bound().map(|bound| bound.after(now, &track.reach()));
        assert_eq!(track.bound(now), certain, "{heard:?}");
        track.carry(now);
        assert!(track.is_carried_to(now));
        assert_eq!(track.bound(now), certain, "{heard:?}");
    }
    let seen = Bound::not_behind(now, track.bound(now).unwrap().lowest_position().ahead(Distance::from_mm(10)));
    let before = track.bound(now);
    assert!(track.narrow(&seen));
    assert_ne!(track.bound(now), before);
    track.restart();
    track.carry(now);
    assert_eq!(track.bound(now), None);
}
