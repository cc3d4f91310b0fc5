//! The truth never leaves a bound that a range sensor narrows, whatever the errors within the accuracies of the sensor and
//! of the ego's own motion, while both vehicles accelerate and brake; and no such view is taken for a disagreement.

use crate::rig;
use crate::rig::plant::Body;
use crate::rig::random::Random;
use crate::rig::road::Road;
use crate::rig::{EGO, Rig, TARGET, instant, m_of, metres, mps, mps_of};
use holdover::controller::{FallbackCause, Mode};
use holdover::time::Duration;
use holdover::wire::range_sensor::RangeSample;
use holdover::wire::{Message, Predecessor, Said};

/// The ego as it was up to 63 ms ago.
fn at(past: &[(i64, Body, Body)], at: i64) -> (Body, Body) {
    let after = past.iter().rposition(|(when, ..)| *when <= at).unwrap();
    let (when, ego, target) = past[after];
    let part = (at - when) as f64 / 1e4;
    let next = past.get(after + 1).copied().unwrap_or(past[after]);
    let mixed = |a: Body, b: Body| Body {
        position: a.position + (b.position - a.position) * part,
        speed: a.speed + (b.speed - a.speed) * part,
    };
    (mixed(ego, next.1), mixed(target, next.2))
}

fn run(seed: u64) -> u64 {
    let mut random = Random::new(seed);
    let (near, slow) = (0.05 * random.below(12) as f64, 0.1 * random.below(8) as f64);
    let (own, own_speed) = (0.05 * random.below(20) as f64, 0.02 * random.below(20) as f64);
    let mut road = Road::new(&rig::config(), 20.0, 60.0);
    road.senses = rig::road::Senses { ego: false, ..road.senses };
    road.engaged = false;
    let (mut past, mut own_a, mut checked) = (Vec::new(), 0.0, 0);
    for tick in 0..1_500 {
        if tick % 60 == 0 {
            own_a = random.extreme(-7.9, 2.4);
            road.acceleration = random.extreme(-7.9, 2.4);
        }
        road.senses.v2x = tick < 60 || (tick / 300) % 2 == 1;
        let now = road.now;
        let ego = Body { position: road.ego.position, speed: road.ego.speed };
        past.push((now, ego, road.target));
        let (off, faster) = (random.extreme(-own, own), random.extreme(-own_speed, own_speed));
        let standing = if ego.speed == 0.0 && own_a < 0.0 { 0.0 } else { own_a };
        let motion =
            road.rig.motion(EGO, now, ego.position + off, ego.speed + faster, standing, 0.0, Some((own, own_speed)));
        let _ = road.rig.put(now, &Message::Ego(Said::Motion(motion)));
        if tick % 7 == 3 {
            let age = random.below(64) as i64;
            // The age is rounded up, and the frame takes up to 300 µs.
            let taken =
                now - (age * 1000 - if age > 0 { random.below(1000) as i64 } else { 0 }) - random.below(300) as i64;
            let (ego, target) = at(&past, taken.max(past[0].0));
            let (error, drift) = (random.extreme(-near, near), random.extreme(-slow, slow));
            let sample = RangeSample {
                distance: metres((target.position - rig::LENGTH - ego.position + error).max(0.0)),
                speed_difference: mps(target.speed - ego.speed + drift),
                distance_accuracy: metres(near),
                speed_accuracy: mps(slow),
                age: Duration::from_millis(age),
                nobody: false,
            };
            let _ = road.rig.put(now, &Message::Range(sample));
        }
        let heard = road.step();
        let named = matches!(heard.answer.mode, Mode::Fallback { cause: FallbackCause::RangeDisagrees, .. });
        assert!(!named, "seed {seed} at {tick}");
        road.ego = rig::plant::Plant { acceleration: own_a, ..road.ego };
        let moved = ego.after(own_a, 0.01);
        (road.ego.position, road.ego.speed) = (moved.position, moved.speed);
        let Some(bound) = road.rig.unit.bound(2, instant(road.now)) else { continue };
        let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
        let truth = road.target;
        assert!((low..=high).contains(&truth.position), "seed {seed} at {tick}: {} in {low}..{high}", truth.position);
        let (low, high) = (mps_of(bound.lowest_speed()), mps_of(bound.highest_speed()));
        assert!((low..=high).contains(&truth.speed), "seed {seed} at {tick}: {} in {low}..{high}", truth.speed);
        checked += 1;
        // Never further ahead than the sensor can say, nor behind the ego.
        if road.gap() < 5.0 || road.gap() > 200.0 {
            road.target.position = road.ego.position + 60.0 + rig::LENGTH;
            return checked;
        }
    }
    assert!(road.rig.unit.peers().get(2).unwrap().station() == Some(TARGET));
    checked
}

#[test]
fn the_truth_stays_inside_a_bound_that_a_sensor_narrows() {
    let checked: u64 = (0..400).map(run).sum();
    assert!(checked > 100_000, "{checked}");
}

/// An ego at 60 m/s that names a standing vehicle 260 m ahead when told to, and hears it within that accuracy.
fn coming(accuracy: f64, named: impl Fn(usize) -> bool) -> (Rig, i64) {
    let mut rig = Rig::new(&rig::config());
    rig.power_up(true, 0);
    let mut now = 0;
    for tick in 0..40 {
        now = tick as i64 * 10_000;
        if tick % 10 == 0 {
            let _ = rig.target(now, Said::DrivingParameters(rig::parameters(3.0, 8.0)));
            let motion = rig.motion(TARGET, now, 260.0 + rig::LENGTH, 0.0, 0.0, 0.0, Some((accuracy, 0.2)));
            let _ = rig.target(now, Said::Motion(motion));
        }
        let _ = rig.request(now, true, if named(tick) { Predecessor::Station(TARGET) } else { Predecessor::None });
        let motion = rig.motion(EGO, now, 60.0 * now as f64 * 1e-6, 60.0, 0.0, 0.0, Some((0.0, 0.0)));
        let _ = rig.put(now, &Message::Ego(Said::Motion(motion)));
        rig.tick(now);
    }
    (rig, now)
}

fn view(distance: f64, difference: f64, age_ms: i64) -> Message {
    Message::Range(RangeSample {
        distance: metres(distance),
        speed_difference: mps(difference),
        distance_accuracy: metres(0.0),
        speed_accuracy: mps(0.0),
        age: Duration::from_millis(age_ms),
        nobody: false,
    })
}

#[test]
fn an_age_that_was_rounded_up_by_almost_a_millisecond_leaves_the_truth_inside() {
    let (mut rig, now) = coming(0.5, |_| true);
    let at = now + 5_000;
    // Taken 50 µs before, by which the ego had come nearer.
    let taken = (at - 50) as f64 * 1e-6;
    let before = rig.unit.bound(2, instant(at)).unwrap();
    let _ = rig.put(at, &view(260.0 - 60.0 * taken, -60.0, 1)); // not trusted yet
    rig.put(at, &view(260.0 - 60.0 * taken, -60.0, 1)).unwrap();
    rig.tick(at);
    let bound = rig.unit.bound(2, instant(at)).unwrap();
    let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
    let truth = 260.0 + rig::LENGTH;
    assert!((low..=high).contains(&truth), "{truth} in {low}..{high}");
    let width = m_of(before.highest_position()) - m_of(before.lowest_position());
    assert!(high - low < 0.7 * width, "it narrows: {low}..{high} of {width}");
}

#[test]
fn a_view_from_before_somebody_was_named_says_nothing_of_who_was() {
    // The sensor saw another vehicle 4 m beyond: the one that is named was not on the way then. A view that says to be 3 ms old may
    // have waited for the bus for 3 ms more, and then it is from before the naming, 5 ms ago.
    for (age, is_of_it) in [(20, false), (3, false), (1, true)] {
        let (mut rig, now) = coming(6.0, |tick| tick == 39);
        let at = now + 5_000;
        let before = rig.unit.bound(2, instant(at)).unwrap();
        let beyond = view(264.0 - 60.0 * (at - age * 1_000) as f64 * 1e-6, -60.0, age);
        let _ = rig.put(at, &beyond); // not trusted yet
        rig.put(at, &beyond).unwrap();
        rig.tick(at);
        assert_eq!(rig.unit.bound(2, instant(at)).unwrap() != before, is_of_it, "{age}");
    }
}

/// The place of the target is told wrongly, by up to three times its accuracy, and a short vehicle drives between: the sensor sees that
/// one's rear.
#[test]
fn a_vehicle_between_that_the_targets_accuracy_leaves_room_for_is_not_taken_for_the_target() {
    for (accuracy, bias, length, between) in [
        (1.0, -2.5, 1.5, 1.0),
        (2.0, -3.4, 2.2, 0.3),
        (3.0, -6.0, 2.0, 1.5),
        (5.0, -10.0, 4.5, 1.0),
        (5.0, -14.5, 4.5, 5.0),
    ] {
        let mut rig = Rig::new(&rig::config());
        rig.power_up(true, 0);
        let v = 10.0;
        for tick in 0..1_000 {
            let now = tick * 10_000;
            let (ego, target) = (v * now as f64 * 1e-6, 60.0 + rig::LENGTH + v * now as f64 * 1e-6);
            if tick % 50 == 0 {
                rig.synchronise(now, 0);
                let _ = rig.target(now, Said::DrivingParameters(rig::parameters(2.5, 5.0)));
            }
            let _ = rig.ego(now, ego, v, 0.0, 0.0);
            if tick % 10 == 0 {
                let _ = rig.request(now, false, Predecessor::Station(TARGET));
                let motion = rig.motion(TARGET, now, target + bias, v, 0.0, 0.0, Some((accuracy, 0.2)));
                let _ = rig.target(now, Said::Motion(motion));
            }
            if tick % 2 == 0 && tick > 200 {
                let _ = rig.range(now, target - rig::LENGTH - between - length - ego, 0.0, 0);
            }
            rig.tick(now);
            let Some(bound) = rig.unit.bound(2, instant(now)) else { continue };
            let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
            assert!((low..=high).contains(&target), "{accuracy} m, tick {tick}: {target} in {low}..{high}");
        }
    }
}
