//! The longest stay of an ego in an area beside a body that is as lazy as the envelope allows, in float64.

use super::*;
use crate::units::FineSeconds;
use crate::wire::StationHash;

/// When a body has made a way, in seconds: its actuators follow with this lag, and each command comes into force so much later. It has
/// reached `a` and commanded `u`; the next command is given a period later, and goes over to `to` with this jerk. It never drives backwards.
fn made_after(way: f64, [v, a, u]: [f64; 3], to: f64, [lag, delay, jerk]: [f64; 3]) -> f64 {
    const STEP: f64 = 0.000_5;
    let (mut time, mut speed, mut reached, mut made) = (0.0, v, a, 0.0);
    while made < way {
        let commanded = (u + jerk * (time - delay).max(0.0)).min(to);
        reached += (commanded - reached) * STEP / lag;
        speed = f64::max(0.0, speed + reached * STEP);
        made += speed * STEP;
        time += STEP;
    }
    time
}

/// The end of a stay of an ego with this speed, reached and commanded acceleration that has a way to make, in seconds.
fn stays(config: &Config, way: f64, [v, a, u]: [f64; 3], to: f64) -> f64 {
    let mm = |value: f64| (value * 1_000.0).round() as i32;
    let zero = Position::ZERO;
    let ego = Range {
        now: Instant::from_micros(0),
        rearmost: zero,
        foremost: zero,
        slowest: Speed::from_mm_per_s(mm(v)),
        fastest: Speed::from_mm_per_s(mm(v)),
        reached: Acceleration::from_mm_per_s2(mm(a)),
        commanded: Acceleration::from_mm_per_s2(mm(u)),
    };
    let to = Acceleration::from_mm_per_s2(mm(to));
    let (speed, turns) = ego.turning(config, to);
    let way = Way { length: Distance::from_mm(mm(way)), top: Speed::from_mm_per_s(13_200), acceleration: to };
    way.within(speed, turns).as_micros() as f64 / 1e6
}

#[test]
fn an_ego_as_lazy_as_the_envelope_allows_is_out_at_most_the_clearance_after_its_longest_stay() {
    for (lag, period) in [(0.3, 10), (0.5, 10), (0.1, 20), (0.3, 100)] {
        let config = Config {
            period: Duration::from_millis(period),
            lag: FineSeconds::from_millis((lag * 1e3) as i32),
            ..Config::car(StationHash(1))
        };
        let limits = Envelope::CAR;
        let lazy = [
            lag * 1.25,
            (limits.delay.as_micros() + 1_000 * period) as f64 / 1e6,
            f64::from(limits.jerk.to_mm_per_s3()) / 1e3,
        ];
        let late = f64::min(Rules::UNIT.clearance.as_micros() as f64 / 1e6, lazy[0] + lazy[1] - lag);
        for (to, way) in [(1.5, 5.0), (1.5, 12.9), (1.5, 30.0), (1.2, 22.0)] {
            for v in (0..24).map(|half| f64::from(half) / 2.0) {
                for a in (0..=16).map(|half| f64::from(half) / -2.0) {
                    for u in [a, a - 1.0, 0.0, (a + 1.0).min(0.0), -5.0] {
                        let (foreseen, true_) =
                            (stays(&config, way, [v, a, u], to), made_after(way, [v, a, u], to, lazy));
                        assert!(
                            true_ <= foreseen + late + 0.005,
                            "lag {lag} s, {way} m from {v} m/s, reached {a}, commanded {u}: {true_} s, foreseen {foreseen} s"
                        );
                    }
                }
            }
        }
    }
}
