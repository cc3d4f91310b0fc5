//! The estimate that is driven by and told stays inside what is certain: whatever a sample's accuracy is worth, and whatever
//! horizon is sent. The truth is a float64 body that the unit knows by frames alone.

use crate::rig;
use crate::rig::plant::Body;
use crate::rig::random::Random;
use crate::rig::{LENGTH, Rig, TARGET, instant, m_of, metres, mps, mps_of, mps2};
use crate::traffic;
use crate::traffic::{receive_all, settled};
use holdover::config::Config;
use holdover::health::Cause;
use holdover::time::Duration;
use holdover::units::{Acceleration, Distance, Speed};
use holdover::wire::Said;
use holdover::wire::driving_parameters::DrivingParameters;
use holdover::wire::horizon::{KNOTS, KNOTS_PER_MILLE, Knot, Knots};

/// The horizon of one that goes on at this speed, after so many tenths of a second.
fn steady(tag: u8, speed: f64, tenths: u8) -> Knots {
    let knots = KNOTS_PER_MILLE.map(|share| Knot {
        displacement: metres(speed * f64::from(tenths) * f64::from(share) * 1e-4),
        speed: mps(speed),
        acceleration: Acceleration::ZERO,
        bow: Distance::ZERO,
    });
    Knots { tag, knots }
}

/// What the target's estimate is off after so many periods without a word of it.
fn off_after(unit: &mut traffic::Unit, traffic: &mut traffic::Traffic, periods: usize) -> f64 {
    let reading = traffic.run(unit, periods).estimate.expect("the target is estimated").reading;
    m_of(reading.position) - traffic.target_at(traffic.now().minus(traffic::PERIOD))
}

#[test]
fn an_honest_sample_of_poor_accuracy_does_not_undo_the_good_ones_before_it() {
    for (off, faster) in [(5.9, 0.0), (-5.9, 0.0), (0.0, 1.4), (3.0, -1.4)] {
        let mut rig = Rig::new(&rig::config());
        rig.power_up(true, 0);
        let mut truth = Body { position: 1_050.0, speed: 20.0 };
        for tick in 0..230 {
            let now = tick * 10_000;
            if now % 500_000 == 0 {
                rig.synchronise(now, 0);
                let _ = rig.target(now, Said::DrivingParameters(rig::parameters(2.5, 8.0)));
            }
            let _ = rig.ego(now, 1_000.0 + 20.0 * now as f64 * 1e-6, 20.0, 0.0, 0.0);
            if now % 100_000 == 0 {
                let _ = rig.request(now, true, holdover::wire::Predecessor::Station(TARGET));
                let is_poor = now == 2_200_000;
                let (off, faster) = if is_poor { (off, faster) } else { (0.0, 0.0) };
                let accuracy = if is_poor { (6.0, 1.5) } else { (0.05, 0.02) };
                let said = (truth.position + off, truth.speed + faster);
                let motion = rig.motion(TARGET, now, said.0, said.1, 0.0, 0.0, Some(accuracy));
                let taken = rig.target(now, Said::Motion(motion));
                assert!(taken.is_ok() || tick < 20, "{taken:?}");
            }
            let heard = rig.tick(now);
            if tick > 100 {
                let estimate = heard.answer.estimate.expect("the target is heard");
                let error = m_of(estimate.reading.position) - truth.position;
                let error_of_speed = mps_of(estimate.reading.speed) - truth.speed;
                let bound = estimate.bound.expect("it is bounded");
                let width = m_of(bound.highest_position()) - m_of(bound.lowest_position());
                assert!(width < 0.6, "{width}");
                assert!(
                    error.abs() < 0.3 && error_of_speed.abs() < 0.9,
                    "{off} {faster} at {tick}: {error} {error_of_speed}"
                );
            }
            truth = truth.after(0.0, 0.01);
        }
    }
}

#[test]
fn a_forged_part_of_a_horizon_before_a_silence_is_not_believed() {
    for part in 0..KNOTS {
        let (mut unit, mut traffic) = settled();
        let frames =
            traffic.peer(0, Said::DrivingParameters(DrivingParameters { horizon_tenths: 40, ..traffic::leads() }));
        receive_all(&mut unit, traffic.now(), &frames);
        traffic.run(&mut unit, 50);
        let now = traffic.now();
        let frames =
            traffic.peer(0, Said::DrivingParameters(DrivingParameters { horizon_tenths: 40, ..traffic::leads() }));
        receive_all(&mut unit, now, &frames);
        let motion = traffic.motion(traffic::TARGET, 17_000, now);
        let mut forged = steady(motion.tag, 10.0, 40);
        forged.knots[part] = Knot {
            displacement: Distance::from_mm(262_143),
            speed: Speed::from_mm_per_s(65_534),
            acceleration: Acceleration::from_mm_per_s2(20_000),
            bow: Distance::ZERO,
        };
        // The first frame of an identifier is not trusted yet, so the first of three completes none.
        for said in [Said::Motion(motion), Said::Horizon(forged), Said::Horizon(forged), Said::Horizon(forged)] {
            let frames = traffic.peer(0, said);
            receive_all(&mut unit, now, &frames);
        }
        traffic.target = false;
        let off = (0..450).map(|_| off_after(&mut unit, &mut traffic, 1).abs()).fold(0.0, f64::max);
        assert!(off < 0.1, "part {part}: {off} m within 4.5 s");
        assert_eq!(unit.health().of(Cause::Unreachable), 1, "part {part}: {off}");
    }
}

#[test]
fn an_honest_horizon_is_used_and_not_counted() {
    // It brakes for a speed of its own that nobody could foresee: only its horizon tells.
    let (mut unit, mut traffic) = settled();
    traffic.run(&mut unit, 50);
    let now = traffic.now();
    let mut knots = steady(0, 10.0, 40);
    for (knot, share) in knots.knots.iter_mut().zip(KNOTS_PER_MILLE) {
        let t = f64::from(share) * 4e-3;
        *knot = Knot {
            displacement: metres(10.0 * t - 0.5 * 1.5 * t * t),
            speed: mps(10.0 - 1.5 * t),
            acceleration: mps2(-1.5),
            bow: Distance::ZERO,
        };
    }
    let mut motion = traffic.motion(traffic::TARGET, 17_000, now);
    (motion.acceleration, motion.demand, knots.tag) = (mps2(-1.5), mps2(-1.5), motion.tag);
    let parameters = Said::DrivingParameters(DrivingParameters { horizon_tenths: 40, ..traffic::leads() });
    for said in [parameters, Said::Motion(motion), Said::Horizon(knots), Said::Horizon(knots), Said::Horizon(knots)] {
        let frames = traffic.peer(0, said);
        receive_all(&mut unit, now, &frames);
    }
    traffic.target = false;
    let off = off_after(&mut unit, &mut traffic, 300);
    let braked = -0.5 * 1.5 * 2.99 * 2.99;
    assert!((off - braked).abs() < 0.02, "{off} {braked}");
    assert_eq!(unit.health().of(Cause::Unreachable), 0);
}

/// A random drive: honest motions of any accuracy, forged horizons, silences, a sensor at times. How many ticks were checked.
fn drive(seed: u64) -> u64 {
    let mut random = Random::new(seed);
    let mut config: Config = rig::config();
    config.link.holdover = Duration::from_millis(8_000);
    let mut rig = Rig::new(&config);
    rig.power_up(true, 0);
    let (mut ego, mut truth) = (1_000.0, Body { position: 1_060.0, speed: 15.0 });
    let (mut acceleration, mut is_heard, mut is_seen, mut checked) = (0.0, true, false, 0);
    let (braking, rising) = (random.between(4.0, 9.0), random.between(1.0, 4.0));
    for tick in 0..1_200 {
        let now = tick * 10_000;
        if tick % 70 == 0 {
            acceleration = random.extreme(-braking, rising) * f64::from(u8::from(random.happens(0.8)));
            is_heard = tick < 100 || random.happens(0.7);
            is_seen = random.happens(0.3);
        }
        if now % 500_000 == 0 {
            rig.synchronise(now, 0);
            let parameters = DrivingParameters { horizon_tenths: 6, ..rig::parameters(rising, braking) };
            let _ = rig.target(now, Said::DrivingParameters(parameters));
        }
        let _ = rig.ego(now, ego, 15.0, 0.0, 0.0);
        if now % 100_000 == 0 {
            let _ = rig.request(now, true, holdover::wire::Predecessor::Station(TARGET));
        }
        if now % 100_000 == 0 && is_heard {
            let accuracy = (random.extreme(0.0, 6.0), random.extreme(0.0, 1.4));
            // To the wire's own steps, upwards, the accuracy is what it says; the error is within it.
            let off = random.extreme(-accuracy.0, accuracy.0);
            let faster = random.extreme(-accuracy.1, accuracy.1).max(-truth.speed);
            let said = (truth.position + off, truth.speed + faster);
            let motion = rig.motion(TARGET, now, said.0, said.1, acceleration, acceleration, Some(accuracy));
            let tag = motion.tag;
            let _ = rig.target(now, Said::Motion(motion));
            if random.happens(0.6) {
                let mut knots = steady(tag, truth.speed, 6);
                for knot in &mut knots.knots {
                    if random.happens(0.3) {
                        knot.displacement = metres(random.extreme(0.0, 262.0));
                        knot.speed = mps(random.extreme(0.0, 65.0));
                        knot.acceleration = mps2(random.extreme(-20.0, 20.0));
                    } else {
                        // Just so much that it may be true: only what is between the knots is not.
                        knot.acceleration = mps2(random.extreme(-20.0, 20.0));
                    }
                }
                let _ = rig.target(now, Said::Horizon(knots));
            }
        }
        let gap = truth.position - LENGTH - ego;
        if is_seen && now % 50_000 == 0 && (0.5..250.0).contains(&gap) {
            let _ = rig.range(now, gap + random.extreme(-0.2, 0.2), truth.speed - 15.0 + random.extreme(-0.2, 0.2), 0);
        }
        let heard = rig.tick(now);
        if let Some(estimate) = heard.answer.estimate {
            let (bound, reading) = (estimate.bound.expect("whoever is estimated is bounded"), estimate.reading);
            let (low, high) = (m_of(bound.lowest_position()), m_of(bound.highest_position()));
            assert!(
                (low..=high).contains(&truth.position),
                "seed {seed} at {tick}: {} not in {low}..{high}",
                truth.position
            );
            let position = m_of(reading.position);
            assert!((low..=high).contains(&position), "seed {seed} at {tick}: {position} not in {low}..{high}");
            let (low, high) = (mps_of(bound.lowest_speed()), mps_of(bound.highest_speed()));
            let speed = mps_of(reading.speed);
            assert!((low..=high).contains(&speed), "seed {seed} at {tick}: {speed} not in {low}..{high}");
            // What it drives by is of one period later.
            let next = rig.unit.bound(2, instant(now + 10_000)).expect("likewise");
            let read = rig.unit.estimator().read_inside(2, instant(now + 10_000), rig.unit.peers()).expect("likewise");
            assert!(
                (next.lowest_position()..=next.highest_position()).contains(&read.position),
                "seed {seed} at {tick}"
            );
            checked += 1;
        }
        ego += 0.15;
        truth = truth.after(acceleration, 0.01);
        if gap < 5.0 {
            return checked;
        }
    }
    checked
}

#[test]
fn in_random_drives_with_forged_horizons_the_estimate_never_leaves_what_is_certain() {
    let checked: u64 = (0..200).map(drive).sum();
    assert!(checked > 30_000, "{checked}");
}
