//! The properties of a pair of gains in every situation: `k`, `γ` and the time gap enter; string stability and
//! stability margin leave.
//!
//! With the actuators' lag `T` and feed-forward `φ`, the law transmits a predecessor's motion by `G(s) = [φ s² + k (1 + γ s)]/(T s³ + s² +
//! k (t_g + γ) s + k)`. Its own loop is `L(s) = k (1 + (t_g + γ) s)/(s² (1 + T s))`.

/// The slowest actuators, those of a bus, in seconds.
pub const LAZIEST_S: f64 = 0.5;
/// The largest `|G(jω)|` without lag and with a car's: 1, except for the rounding of this computation.
const LARGEST_GAIN: f64 = 1.000_1;
/// The largest `|G(jω)|` with the slowest actuators.
const LARGEST_GAIN_LAZY: f64 = 1.002;
/// Time constant of a car's actuators, in seconds.
pub const CAR_S: f64 = 0.3;
/// The least phase margin, in radians: 40°.
pub const LEAST_PHASE: f64 = 0.698;
/// The least additional delay that the loop has to bear, in seconds: a period of 100 ms, and as much again.
pub const LEAST_DELAY_S: f64 = 0.2;

/// A pair of gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// `k` in 1/s².
    pub gain: f64,
    /// `γ` in s.
    pub damping_s: f64,
}

/// The law of eq. 5 with its gains, at a time gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// Its gains.
    pub pair: Pair,
    /// `t_g` in s.
    pub time_gap_s: f64,
    /// `φ`, the share of the predecessor's acceleration that is passed on.
    pub feed_forward: f64,
}

impl Pair {
    /// The law with these gains at a time gap.
    #[must_use]
    pub fn at(self, time_gap_s: f64) -> Law {
        Law { pair: self, time_gap_s, feed_forward: 0.0 }
    }
}

impl Law {
    /// The same with feed-forward.
    #[must_use]
    pub fn fed(self, feed_forward: f64) -> Self {
        Self { feed_forward, ..self }
    }

    /// `t_g + γ`, the time by which the law looks ahead.
    fn lead_s(self) -> f64 {
        self.time_gap_s + self.pair.damping_s
    }

    /// The condition without lag: `t_g >= sqrt(γ² + 2 (1 - φ)/k) - γ`.
    #[must_use]
    pub fn is_string_stable_without_lag(self) -> bool {
        let Pair { gain, damping_s } = self.pair;
        let left = 1.0 - self.feed_forward;
        self.time_gap_s >= (damping_s * damping_s + 2.0 * left / gain).sqrt() - damping_s - 1e-12
    }

    /// Whether a larger time gap amplifies no frequency by more than 1 and this gap's amplification, with this lag or
    /// any smaller one.
    ///
    /// The numerator of `|G(jω)|²`, `(k - φ ω²)² + k² γ² ω²`, does not depend on the gap. The denominator is `(k - ω²)² + ω² (k
    /// (t_g + γ) - T ω²)²`. Up to `ω² = k (t_g + γ)/T` it grows with `t_g`. Beyond that frequency, its first term alone
    /// is at least the numerator if `ω² (1 - φ²) >= k [2 (1 - φ) + k γ²]`. That holds everywhere beyond if
    /// `(t_g + γ) (1 - φ²) >= T [2 (1 - φ) + k γ²]`.
    #[must_use]
    pub fn is_string_stable_at_larger_time_gaps(self, lag_s: f64) -> bool {
        let Pair { gain, damping_s } = self.pair;
        let share = self.feed_forward;
        self.lead_s() * (1.0 - share * share) >= lag_s * (2.0 * (1.0 - share) + gain * damping_s * damping_s)
    }

    /// The largest `|G(jω)|` over frequencies from 0.01 to 30 rad/s.
    #[must_use]
    pub fn largest_gain(self, lag_s: f64) -> f64 {
        frequencies().map(|frequency| self.gain_at(frequency, lag_s)).fold(0.0, f64::max)
    }

    /// `|G(jω)|` at a frequency in rad/s.
    #[must_use]
    pub fn gain_at(self, frequency: f64, lag_s: f64) -> f64 {
        let Pair { gain: k, damping_s } = self.pair;
        let w = frequency;
        let passed = (k - self.feed_forward * w * w).hypot(k * damping_s * w);
        passed / (k - w * w).hypot(k * self.lead_s() * w - lag_s * w * w * w)
    }

    /// Phase margin in radians and delay margin in seconds.
    #[must_use]
    pub fn margins(self, lag_s: f64) -> (f64, f64) {
        let (gain, lead_s) = (self.pair.gain, self.lead_s());
        let loop_gain =
            |w: f64| gain * (1.0 + (lead_s * w).powi(2)).sqrt() / (w * w * (1.0 + (lag_s * w).powi(2)).sqrt());
        // The loop's gain falls monotonically, so it is 1 at one frequency only.
        let (mut low, mut high) = (1e-3, 1e3);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if loop_gain(middle) > 1.0 { low = middle } else { high = middle }
        }
        let phase = (lead_s * low).atan() - (lag_s * low).atan();
        (phase, phase / low)
    }

    /// Whether all properties are within the limits.
    #[must_use]
    pub fn is_sound(self) -> bool {
        let (phase, delay_s) = self.margins(LAZIEST_S);
        self.is_string_stable_without_lag()
            && self.is_string_stable_at_larger_time_gaps(LAZIEST_S)
            && [0.0, CAR_S].into_iter().all(|lag_s| self.largest_gain(lag_s) <= LARGEST_GAIN)
            && self.largest_gain(LAZIEST_S) <= LARGEST_GAIN_LAZY
            && phase >= LEAST_PHASE
            && delay_s >= LEAST_DELAY_S
    }
}

/// 400 frequencies, evenly on a logarithmic scale: 2 % apart.
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
                let law = Pair { gain, damping_s }.at(1.0);
                let excess = gain * (1.0 + 2.0 * damping_s) - 2.0;
                if excess.abs() > 0.01 {
                    assert_eq!(law.is_string_stable_without_lag(), excess > 0.0, "{law:?}");
                    assert_eq!(
                        law.largest_gain(0.0) <= LARGEST_GAIN,
                        excess > 0.0,
                        "{law:?} {}",
                        law.largest_gain(0.0)
                    );
                }
            }
        }
    }

    #[test]
    fn lag_takes_from_string_stability_and_from_the_margin() {
        let law = Pair { gain: 0.5, damping_s: 2.0 }.at(1.0);
        assert!(law.is_sound());
        assert!(law.largest_gain(0.75) > 1.1, "a bus that is half as lazy again amplifies");
        let (phase, delay_s) = law.margins(0.0);
        // Without lag the loop is k(1 + 3 s)/s²: gain 1 at ω = 1.54, phase atan(3 ω).
        assert!(
            (phase - (3.0 * 1.535f64).atan()).abs() < 1e-3 && (delay_s - phase / 1.535).abs() < 1e-3,
            "{phase} {delay_s}"
        );
        assert!(!Pair { gain: 3.0, damping_s: 3.0 }.at(1.0).is_sound());
        assert!(!Pair { gain: 0.3, damping_s: 1.0 }.at(1.0).is_sound());
    }

    #[test]
    fn a_larger_time_gap_keeps_string_stability_and_takes_from_the_margins() {
        let pair = Pair { gain: 0.5, damping_s: 2.0 };
        assert!(pair.at(1.0).is_string_stable_at_larger_time_gaps(LAZIEST_S));
        let laws = [1.0, 1.6, 2.5, 3.995].map(|time_gap_s| pair.at(time_gap_s));
        for pair in laws.windows(2) {
            assert!(pair[1].largest_gain(LAZIEST_S) <= pair[0].largest_gain(LAZIEST_S).max(LARGEST_GAIN), "{pair:?}");
            assert!(pair[1].margins(LAZIEST_S).1 < pair[0].margins(LAZIEST_S).1, "{pair:?}");
        }
        let phase = |law: Law| law.margins(LAZIEST_S).0;
        assert!(phase(laws[1]) > LEAST_PHASE && phase(laws[3]) < LEAST_PHASE, "{}", phase(laws[3]).to_degrees());
        // Where the condition does not hold, a larger gap can amplify more.
        let (soft, lag_s) = (Pair { gain: 0.1, damping_s: 0.0 }, 0.5);
        assert!(!soft.at(0.1).is_string_stable_at_larger_time_gaps(lag_s));
        assert!(soft.at(0.5).largest_gain(lag_s) > soft.at(0.1).largest_gain(lag_s));
    }
}
