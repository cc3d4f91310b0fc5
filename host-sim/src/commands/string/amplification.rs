//! The amplification of a disturbance along a string: the speeds of a string enter; the largest ratio of a vehicle's
//! speed amplitude to its predecessor's leaves.
//!
//! For a sine, the amplitude is that at the driven frequency, over whole periods after settling. For a step, it is the
//! largest difference of the speed to that before the step. If the predecessor's amplitude is below 0.02 m/s, there is
//! nothing to measure.

use std::f64::consts::TAU;

use serde::Serialize;

use super::disturbance::Disturbance;
use crate::sim::world::{Tick, Trace};

/// Least amplitude of a predecessor that is measured, in m/s.
const LEAST_MPS: f64 = 0.02;

/// The largest ratio, and where it is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// The ratio.
    pub ratio: f64,
    /// The disturbance by the leader.
    pub disturbance: String,
    /// The vehicle whose amplitude is larger; 0 is the leader.
    pub vehicle: usize,
}

/// The speeds of a string, for each vehicle from the leader on, tick by tick.
#[derive(Clone, Debug, PartialEq)]
pub struct Speeds {
    /// Time between two ticks; the first is at 0.
    pub period_s: f64,
    /// Speeds in m/s.
    pub vehicles: Vec<Vec<f64>>,
}

impl Speeds {
    /// Those of a run.
    #[must_use]
    pub fn of(trace: &Trace, period_s: f64) -> Self {
        let speeds = |ticks: &Vec<Tick>| ticks.iter().map(|tick| tick.speed_mps).collect();
        Self { period_s, vehicles: trace.vehicles.iter().map(speeds).collect() }
    }

    /// The amplitude of each vehicle.
    #[must_use]
    pub fn amplitudes(&self, disturbance: Disturbance) -> Vec<f64> {
        let tick = |at_s: f64| (at_s / self.period_s).round() as usize;
        let (from, to) = (tick(disturbance.measured_from_s()), tick(disturbance.duration_s()));
        let of = |speeds: &Vec<f64>| {
            let part = &speeds[from.min(speeds.len())..to.min(speeds.len())];
            match disturbance {
                Disturbance::Step => farthest(part),
                Disturbance::Sine(frequency_hz) => harmonic(part, frequency_hz * self.period_s),
            }
        };
        self.vehicles.iter().map(of).collect()
    }

    /// The largest ratio of a vehicle to the vehicle ahead; `None`: no amplitude was large enough to measure.
    #[must_use]
    pub fn worst(&self, disturbance: Disturbance) -> Option<Worst> {
        self.worst_of(disturbance, |_| true)
    }

    /// The same of some vehicles.
    #[must_use]
    pub fn worst_of(&self, disturbance: Disturbance, counts: impl Fn(usize) -> bool) -> Option<Worst> {
        let amplitudes = self.amplitudes(disturbance);
        let ratios =
            amplitudes.windows(2).enumerate().filter(|(ahead, pair)| counts(ahead + 1) && pair[0] >= LEAST_MPS);
        ratios
            .map(|(ahead, pair)| Worst {
                ratio: pair[1] / pair[0],
                disturbance: disturbance.to_string(),
                vehicle: ahead + 1,
            })
            .max_by(|a, b| a.ratio.total_cmp(&b.ratio))
    }
}

/// The largest difference to the first value.
fn farthest(speeds: &[f64]) -> f64 {
    let first = speeds.first().copied().unwrap_or(0.0);
    speeds.iter().map(|speed| (speed - first).abs()).fold(0.0, f64::max)
}

/// The amplitude at a frequency, in cycles per tick.
fn harmonic(speeds: &[f64], frequency: f64) -> f64 {
    let count = speeds.len().max(1) as f64;
    let mean = speeds.iter().sum::<f64>() / count;
    let (mut sines, mut cosines) = (0.0, 0.0);
    for (tick, speed) in speeds.iter().enumerate() {
        let (sine, cosine) = (TAU * frequency * tick as f64).sin_cos();
        sines += (speed - mean) * sine;
        cosines += (speed - mean) * cosine;
    }
    2.0 * sines.hypot(cosines) / count
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Speeds with this amplitude at a frequency, plus another sine whose periods fit the measured time too.
    fn sine(amplitude: f64, frequency_hz: f64) -> Vec<f64> {
        let speed = |t: f64| 15.0 + amplitude * (TAU * frequency_hz * t + 0.7).sin() + 0.5 * (TAU * t / 30.0).sin();
        (0..12_000).map(|tick| speed(f64::from(tick) * 0.01)).collect()
    }

    #[test]
    fn the_amplitude_is_that_of_the_driven_frequency() {
        let vehicles = [1.0, 0.9, 0.99, 0.019, 0.5].map(|amplitude| sine(amplitude, 0.2)).to_vec();
        let speeds = Speeds { period_s: 0.01, vehicles };
        let worst = speeds.worst(Disturbance::Sine(0.2)).unwrap();
        assert!((worst.ratio - 1.1).abs() < 0.02, "{worst:?}");
        // The ratio of 0.5 to 0.019 does not count.
        assert_eq!((worst.vehicle, worst.disturbance.as_str()), (2, "0.2 Hz"));
    }

    #[test]
    fn the_peak_of_a_step_is_the_farthest_from_before() {
        let vehicle = |lowest: f64| {
            (0..9_000)
                .map(|tick| {
                    if tick < 3_500 {
                        15.0
                    } else if tick < 4_000 {
                        lowest
                    } else {
                        13.0
                    }
                })
                .collect()
        };
        let speeds = Speeds { period_s: 0.01, vehicles: vec![vehicle(13.0), vehicle(12.5)] };
        let worst = speeds.worst(Disturbance::Step).unwrap();
        assert!((worst.ratio - 1.25).abs() < 1e-9 && worst.vehicle == 1, "{worst:?}");
    }

    #[test]
    fn where_nothing_moves_there_is_no_ratio() {
        let speeds = Speeds { period_s: 0.01, vehicles: vec![vec![15.0; 9_000]; 3] };
        assert_eq!(speeds.worst(Disturbance::Step), None);
    }
}
