//! The leader's drive: speed and braking enter; a drive to a stop leaves, tick by tick.

use crate::input::recording::{Motion, MotionRow};

/// When the leader begins to brake. By then every vehicle has reached its place in the string.
pub const BRAKES_AT_S: f64 = 30.0;
/// How fast its braking sets in: as fast as a unit's emergency braking does.
pub const JERK_MPS3: f64 = 25.0;
/// Time after its stop by which the followers stand too.
const AFTERWARDS_S: f64 = 25.0;

/// Length of a run.
#[must_use]
pub fn duration_s(speed_mps: f64, braking_mps2: f64) -> f64 {
    (BRAKES_AT_S + speed_mps / braking_mps2 + AFTERWARDS_S).ceil()
}

/// The drive, in steps of the units' period.
#[must_use]
pub fn motion(speed_mps: f64, braking_mps2: f64, period_s: f64) -> Motion {
    let rows = (duration_s(speed_mps, braking_mps2) / period_s).ceil() as u32 + 1;
    Motion::of((0..=rows).map(|row| at(f64::from(row) * period_s, speed_mps, braking_mps2)).collect())
}

/// The drive at one time: a constant speed; braking that sets in; constant braking; and rest.
fn at(t_s: f64, speed_mps: f64, braking_mps2: f64) -> MotionRow {
    let sets_in = |for_s: f64| (0.5 * JERK_MPS3 * for_s * for_s, JERK_MPS3 * for_s.powi(3) / 6.0);
    // A low speed is used up while the braking still sets in.
    let ramp_s = (braking_mps2 / JERK_MPS3).min((2.0 * speed_mps / JERK_MPS3).sqrt());
    let (lost_mps, less_m) = sets_in(ramp_s);
    let (left_mps, full_mps2) = (speed_mps - lost_mps, JERK_MPS3 * ramp_s);
    let steady_s = left_mps / full_mps2;
    let braked_s = t_s - BRAKES_AT_S;
    let before_m = speed_mps * t_s.min(BRAKES_AT_S);
    let (way_m, speed, acceleration) = if braked_s <= 0.0 {
        (0.0, speed_mps, 0.0)
    } else if braked_s <= ramp_s {
        let (lost, less) = sets_in(braked_s);
        (speed_mps * braked_s - less, speed_mps - lost, -JERK_MPS3 * braked_s)
    } else {
        let for_s = (braked_s - ramp_s).min(steady_s);
        let way_m = speed_mps * ramp_s - less_m + left_mps * for_s - 0.5 * full_mps2 * for_s * for_s;
        let is_moving = braked_s - ramp_s < steady_s;
        if is_moving { (way_m, left_mps - full_mps2 * for_s, -full_mps2) } else { (way_m, 0.0, 0.0) }
    };
    MotionRow { t_s, position_m: before_m + way_m, speed_mps: speed, acceleration_mps2: Some(acceleration) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_speeds_and_accelerations_belong_together_until_it_stands() {
        for (speed, braking) in [(15.0, 2.0), (15.0, 8.0), (40.0, 12.0), (1.0, 12.0), (1.0, 0.5)] {
            let motion = motion(speed, braking, 0.01);
            assert!(motion.end_s() >= duration_s(speed, braking));
            for pair in motion.rows().windows(2) {
                let (a, b) = (pair[0], pair[1]);
                let way = 0.5 * (a.speed_mps + b.speed_mps) * 0.01;
                assert!((b.position_m - a.position_m - way).abs() < 1e-3, "{speed} {braking} at {}", a.t_s);
                assert!(b.speed_mps <= a.speed_mps + 1e-12 && b.speed_mps >= 0.0);
                let [before, after] = [a, b].map(|row| row.acceleration_mps2.unwrap());
                let slope = (b.speed_mps - a.speed_mps) / 0.01;
                let is_between = slope <= before.max(after) + 1e-9 && slope >= before.min(after) - 1e-9;
                assert!(is_between || b.speed_mps == 0.0, "{speed} {braking} at {}: {slope}", a.t_s);
                assert!(after >= before - JERK_MPS3 * 0.01 - 1e-9 && after >= -braking - 1e-9);
            }
            assert_eq!(motion.at(motion.end_s()).speed_mps, 0.0);
        }
    }
}
