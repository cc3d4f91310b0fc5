//! What holds of a pair of gains whatever the situation: `k`, `γ` enter, string stability and stability margin leave.
//!
//! Behind the actuators' lag `T` the law of eq. 5 passes a predecessor's motion on by
//! `G(s) = k (1 + γ s)/(T s³ + s² + k (t_g + γ) s + k)`, and its own loop is
//! `L(s) = k (1 + (t_g + γ) s)/(s² (1 + T s))`.

/// The time gap `t_g` that the gains are made for, in seconds. What holds for it holds for every larger one, and the
/// shipped one is larger.
pub const TIME_GAP_S: f64 = 1.0;
/// The laziest actuators, those of a bus, in seconds.
pub const LAZIEST_S: f64 = 0.5;
/// The largest `|G(jω)|` without lag and with a car's: 1, but for the rounding of this computation.
const LARGEST_GAIN: f64 = 1.000_1;
/// And with the laziest actuators.
const LARGEST_GAIN_LAZY: f64 = 1.002;
/// A car's actuators, in seconds.
const CAR_S: f64 = 0.3;
/// The least phase margin, in radians: 40°.
const LEAST_PHASE: f64 = 0.698;
/// The least delay that the loop bears besides, in seconds: a period of 100 ms and as much again.
const LEAST_DELAY_S: f64 = 0.2;

/// A pair of gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// `k` in 1/s².
    pub gain: f64,
    /// `γ` in s.
    pub damping_s: f64,
}

impl Pair {
    /// The condition without lag: `t_g >= sqrt(γ² + 2/k) - γ`.
    #[must_use]
    pub fn is_string_stable_without_lag(self) -> bool {
        TIME_GAP_S >= (self.damping_s * self.damping_s + 2.0 / self.gain).sqrt() - self.damping_s - 1e-12
    }

    /// The largest `|G(jω)|` over frequencies from 0.01 to 30 rad/s.
    #[must_use]
    pub fn largest_gain(self, lag_s: f64) -> f64 {
        let Self { gain: k, damping_s } = self;
        let square = |w: f64| {
            let passed = k * k * (1.0 + damping_s * damping_s * w * w);
            let (real, imaginary) = (k - w * w, k * (TIME_GAP_S + damping_s) * w - lag_s * w * w * w);
            passed / (real * real + imaginary * imaginary)
        };
        frequencies().map(square).fold(0.0, f64::max).sqrt()
    }

    /// Phase margin in radians and delay margin in seconds.
    #[must_use]
    pub fn margins(self, lag_s: f64) -> (f64, f64) {
        let lead_s = TIME_GAP_S + self.damping_s;
        let loop_gain =
            |w: f64| self.gain * (1.0 + (lead_s * w).powi(2)).sqrt() / (w * w * (1.0 + (lag_s * w).powi(2)).sqrt());
        // The loop's gain falls all the way, so it is 1 once.
        let (mut low, mut high) = (1e-3, 1e3);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if loop_gain(middle) > 1.0 { low = middle } else { high = middle }
        }
        let phase = (lead_s * low).atan() - (lag_s * low).atan();
        (phase, phase / low)
    }

    /// Whether all of it is within the limits.
    #[must_use]
    pub fn is_sound(self) -> bool {
        let (phase, delay_s) = self.margins(LAZIEST_S);
        self.is_string_stable_without_lag()
            && [0.0, CAR_S].into_iter().all(|lag_s| self.largest_gain(lag_s) <= LARGEST_GAIN)
            && self.largest_gain(LAZIEST_S) <= LARGEST_GAIN_LAZY
            && phase >= LEAST_PHASE
            && delay_s >= LEAST_DELAY_S
    }
}

/// 400 of them, evenly on a logarithmic scale: 2 % apart.
fn frequencies() -> impl Iterator<Item = f64> {
    (0..400).map(|step| 0.01 * 3000f64.powf(f64::from(step) / 399.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_condition_without_lag_is_that_of_the_largest_gain() {
        for gain in [0.1, 0.2, 0.3, 0.5, 0.8, 1.2] {
            for damping_s in [0.5, 1.0, 2.0, 3.0, 3.9] {
                let pair = Pair { gain, damping_s };
                let excess = gain * (1.0 + 2.0 * damping_s) - 2.0;
                if excess.abs() > 0.01 {
                    assert_eq!(pair.is_string_stable_without_lag(), excess > 0.0, "{pair:?}");
                    assert_eq!(
                        pair.largest_gain(0.0) <= LARGEST_GAIN,
                        excess > 0.0,
                        "{pair:?} {}",
                        pair.largest_gain(0.0)
                    );
                }
            }
        }
    }

    #[test]
    fn lag_takes_from_string_stability_and_from_the_margin() {
        let pair = Pair { gain: 0.5, damping_s: 2.0 };
        assert!(pair.is_sound());
        assert!(pair.largest_gain(0.75) > 1.1, "a bus that is half as lazy again amplifies");
        let (phase, delay_s) = pair.margins(0.0);
        // Without lag the loop is k(1 + 3 s)/s²: gain 1 at ω = 1.54, phase atan(3 ω).
        assert!(
            (phase - (3.0 * 1.535f64).atan()).abs() < 1e-3 && (delay_s - phase / 1.535).abs() < 1e-3,
            "{phase} {delay_s}"
        );
        assert!(!Pair { gain: 3.0, damping_s: 3.0 }.is_sound());
        assert!(!Pair { gain: 0.3, damping_s: 1.0 }.is_sound());
    }
}
