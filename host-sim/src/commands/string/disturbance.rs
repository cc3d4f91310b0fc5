//! The disturbance by the leader: a step or a sine enters; the leader's drive leaves, tick by tick.

use std::f64::consts::TAU;
use std::fmt;

use crate::input::recording::{Motion, MotionRow};

/// Speed at which the string drives, in m/s.
pub const CRUISE_MPS: f64 = 15.0;
/// Time by which ten vehicles have settled, in seconds. Each vehicle passes a change on within two seconds, and the
/// slowest of its own motions dies out in three.
pub const SETTLED_S: f64 = 60.0;

/// Time of the step. By then every vehicle has reached its place in the string.
const STEP_AT_S: f64 = 30.0;
/// Size of the step; the leader brakes at the same number in m/s².
const STEP_MPS: f64 = 2.0;
const STEP_MPS2: f64 = 2.0;
/// Time for which a step is measured.
const STEP_WATCHED_S: f64 = 60.0;
/// Least time over which a sine is measured, in whole periods, so that chance averages out.
const WATCHED_S: f64 = 60.0;
/// Amplitude of a sine, or that of an acceleration of 1 m/s² if that is less.
const SINE_MPS: f64 = 2.0;
const SINE_MPS2: f64 = 1.0;

/// The disturbance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Disturbance {
    /// The leader slows down by 2 m/s, at 2 m/s².
    Step,
    /// The leader's speed oscillates at this frequency, in Hz.
    Sine(f64),
}

impl fmt::Display for Disturbance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step => f.write_str("step"),
            Self::Sine(frequency_hz) => write!(f, "{frequency_hz} Hz"),
        }
    }
}

impl Disturbance {
    /// The driven frequency of a sine.
    #[must_use]
    pub fn frequency_hz(self) -> Option<f64> {
        match self {
            Self::Step => None,
            Self::Sine(frequency_hz) => Some(frequency_hz),
        }
    }

    /// Time from which it is measured.
    #[must_use]
    pub fn measured_from_s(self) -> f64 {
        match self {
            Self::Step => STEP_AT_S,
            Self::Sine(_) => SETTLED_S,
        }
    }

    /// Length of a run: to the end of the measurement.
    #[must_use]
    pub fn duration_s(self) -> f64 {
        match self {
            Self::Step => STEP_AT_S + STEP_WATCHED_S,
            Self::Sine(frequency_hz) => SETTLED_S + (WATCHED_S * frequency_hz).ceil() / frequency_hz,
        }
    }

    /// The leader's drive, in steps of the units' period.
    #[must_use]
    pub fn motion(self, period_s: f64) -> Motion {
        let rows = (self.duration_s() / period_s).ceil() as u32 + 1;
        Motion::of((0..=rows).map(|row| self.row(f64::from(row) * period_s)).collect())
    }

    fn row(self, t_s: f64) -> MotionRow {
        let (way_m, off_mps, acceleration) = match self {
            Self::Step => {
                let ramp_s = STEP_MPS / STEP_MPS2;
                let braked_s = (t_s - STEP_AT_S).clamp(0.0, ramp_s);
                let after_s = (t_s - STEP_AT_S - ramp_s).max(0.0);
                let acceleration = if braked_s > 0.0 && after_s == 0.0 { -STEP_MPS2 } else { 0.0 };
                (-0.5 * STEP_MPS2 * braked_s * braked_s - STEP_MPS * after_s, -STEP_MPS2 * braked_s, acceleration)
            }
            Self::Sine(frequency_hz) => {
                let rate = TAU * frequency_hz;
                let amplitude = SINE_MPS.min(SINE_MPS2 / rate);
                let (sine, cosine) = (rate * t_s).sin_cos();
                (amplitude * (1.0 - cosine) / rate, amplitude * sine, amplitude * rate * cosine)
            }
        };
        MotionRow {
            t_s,
            position_m: CRUISE_MPS * t_s + way_m,
            speed_mps: CRUISE_MPS + off_mps,
            acceleration_mps2: Some(acceleration),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_speeds_and_accelerations_belong_together() {
        for disturbance in [Disturbance::Step, Disturbance::Sine(0.05), Disturbance::Sine(1.0)] {
            let motion = disturbance.motion(0.01);
            assert!(motion.end_s() >= disturbance.duration_s());
            for pair in motion.rows().windows(2) {
                let (a, b) = (pair[0], pair[1]);
                let way = 0.5 * (a.speed_mps + b.speed_mps) * 0.01;
                assert!((b.position_m - a.position_m - way).abs() < 1e-4, "{disturbance} at {}", a.t_s);
                let slope = (b.speed_mps - a.speed_mps) / 0.01;
                let [low, high] = [a, b].map(|row| row.acceleration_mps2.unwrap());
                assert!((slope - low).abs() < 0.08 || (slope - high).abs() < 0.08, "{disturbance} at {}", a.t_s);
            }
        }
        let last = Disturbance::Step.motion(0.01);
        assert!((last.at(80.0).speed_mps - 13.0).abs() < 1e-9);
    }
}
