//! The gate behind vehicles that brake less hard than the ego, and harder, in a float64 world: what the gate's own predicate
//! calls safe never collides, and not much way is given away for that.

use crate::rig;
use crate::rig::chase::Chase;
use crate::rig::random::Random;
use crate::rig::road::Road;
use holdover::Config;
use holdover::config::Envelope;
use holdover::time::Duration;
use holdover::units::{Acceleration, Distance, Fraction, Jerk, Seconds};

const BRAKINGS: [f64; 9] = [2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 12.0];

/// No tolerance: what is told is true, and nothing else than the conditions themselves keeps the two apart.
fn exact(envelope: Envelope) -> Envelope {
    Envelope { delay: Duration::ZERO, lag_tolerance: Fraction::ZERO, margin: Distance::from_mm(1), ..envelope }
}

fn gentle() -> Envelope {
    Envelope { braking: Acceleration::from_mm_per_s2(4_000), jerk: Jerk::from_mm_per_s3(6_000), ..Envelope::CAR }
}

#[test]
fn whatever_the_vehicle_ahead_can_brake_with_no_start_that_is_safe_collides() {
    let mut random = Random::new(15);
    let (mut judged, mut closest) = (0, f64::MAX);
    for braking in BRAKINGS {
        for n in 0..240 {
            let limits = if n % 4 == 0 { exact(gentle()) } else { exact(Envelope::CAR) };
            let lag = [0.0, 0.1, 0.3, 0.7][random.below(4) as usize];
            let ahead = (random.extreme(0.0, 45.0), braking);
            let mut chase = Chase::new(&limits, lag, random.extreme(0.0, 45.0), ahead);
            if random.happens(0.5) {
                chase.own.1 = random.extreme(-rig::mps2_of(limits.braking), 3.0);
                chase.own.2 = random.extreme(-rig::mps2_of(limits.braking), 3.0);
            }
            if random.happens(0.6) {
                chase.profile = chase.random_profile(&mut random);
            }
            let Some(nearest) = chase.nearest_safe() else { continue };
            let gap = nearest + [0.0, 0.3, 4.0, 30.0][random.below(4) as usize];
            let least = chase.run(gap);
            assert!(least >= 0.0, "{chase:?} from {gap}: {least}");
            (judged, closest) = (judged + 1, closest.min(least));
        }
    }
    assert!(judged > 1_800 && closest < 0.05, "{judged}, {closest}");
}

/// The least gap from which emergency braking, after a tick, does not collide with the worst, by simulation.
fn needed(chase: &Chase) -> f64 {
    let (b, j) = (rig::mps2_of(chase.limits.braking), f64::from(chase.limits.jerk.to_mm_per_s3()) / 1e3);
    let (mut plant, mut ahead, mut u) = (
        rig::plant::Plant { position: 0.0, speed: chase.own.0, acceleration: 0.0, lag: chase.lag },
        rig::plant::Body { position: 0.0, speed: chase.ahead.0 },
        0.0,
    );
    let mut needed: f64 = 0.0;
    while plant.speed > 0.0 {
        u = f64::max(u - j * 0.01, -b);
        for _ in 0..10 {
            plant.drive(u, 1e-3);
            ahead = ahead.after(-chase.ahead.1, 1e-3);
            needed = needed.max(plant.position - ahead.position);
        }
    }
    needed
}

#[test]
fn the_way_that_is_given_away_against_the_least_gap_of_the_whole_manoeuvre_is_as_stated() {
    let limits = exact(Envelope::CAR);
    let given_away = |own: f64, ahead: f64, braking: f64| {
        let chase = Chase::new(&limits, 0.3, own, (ahead, braking));
        let (nearest, needed) = (chase.nearest_safe().unwrap(), needed(&chase));
        // Nobody begins inside the other.
        nearest - needed.max(0.0)
    };
    let speeds = [2.0, 5.0, 10.0, 13.4, 20.0, 30.0, 40.0];
    for braking in BRAKINGS {
        let (mut following, mut closing_in) = (0.0f64, 0.0f64);
        for own in speeds {
            following = following.max(given_away(own, own, braking));
            for ahead in speeds.into_iter().chain([0.0]).filter(|ahead| *ahead < own) {
                closing_in = closing_in.max(given_away(own, ahead, braking));
            }
        }
        let stated = if braking >= 8.0 { (0.75, 0.75) } else { (1.7, 15.0) };
        assert!(following <= stated.0 && closing_in <= stated.1, "{braking} m/s²: {following} {closing_in}");
    }
}

fn guarded(time_gap: f64) -> Config {
    let mut config = Config { envelope: Some(Envelope::CAR), ..rig::config() };
    config.law.time_gap = Seconds::from_millis((time_gap * 1e3) as i32);
    config
}

#[test]
fn a_unit_that_follows_a_lorry_does_not_hit_it_whenever_it_brakes() {
    for braking in [2.0, 3.0, 4.0, 5.0, 6.0] {
        for speed in [8.0, 14.0, 22.0, 30.0] {
            for (time_gap, silent_for) in [(0.6, 0.0), (1.0, 0.0), (1.0, 0.7), (1.6, 2.0)] {
                let mut road = Road::new(&guarded(time_gap), speed, 2.0 + speed * time_gap);
                (road.braking, road.wants) = (braking, speed);
                road.power_up();
                road.run(0.5);
                road.senses.v2x = silent_for == 0.0;
                road.run(0.01 + silent_for);
                road.acceleration = -braking;
                let least = road.run_to_rest();
                assert!(least > 0.0, "{braking} m/s², {speed} m/s, {time_gap} s, silent for {silent_for} s: {least}");
            }
        }
    }
}

#[test]
fn a_unit_that_closes_in_on_a_lorry_does_not_hit_it_whenever_it_brakes() {
    for braking in [2.0, 3.0, 4.0, 5.0, 6.0] {
        for (own, ahead) in [(20.0, 10.0), (30.0, 20.0), (35.0, 15.0), (38.0, 25.0)] {
            for after in [0.5, 2.0, 4.0, 6.0, 9.0] {
                let mut road = Road::new(&guarded(1.0), own, 160.0);
                road.target.speed = ahead;
                (road.braking, road.wants) = (braking, ahead);
                road.engaged = false;
                road.run(1.0);
                road.engaged = true;
                road.run(after);
                road.senses.v2x = false;
                road.acceleration = -braking;
                let least = road.run_to_rest();
                assert!(least > 0.0, "{braking} m/s², {own} on {ahead} m/s, after {after} s: {least}");
            }
        }
    }
}
