//! The designs: what each of the two tables is made for, and how its curve of `γ` over `k` runs.

use holdover::parameters;

use super::linear::Pair;

/// Points of a curve.
pub const POINTS: u32 = 8;
/// Steps of `γ` in which sound pairs are searched, in milliseconds.
const DAMPING_STEP_MILLI: u32 = 10;
/// The largest `γ`, in milliseconds: what a message can say, in whole steps.
const DAMPING_MOST_MILLI: u32 = 3_990;
/// The time gap at which a car with feed-forward follows as a lag of first order, in seconds.
const FIRST_ORDER_GAP_S: f64 = 0.6;

/// What a table is made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Design {
    /// The name of the table in the core.
    pub name: &'static str,
    /// `φ`, the share of the predecessor's acceleration that is passed on.
    pub feed_forward: f64,
    /// The smallest time gap that the table is made for, in tenths of a second. It is proved at every tenth from there to
    /// [`LARGEST_GAP_TENTHS`].
    pub smallest_gap_tenths: u32,
    /// The first `k` of the curve, in thousandths.
    pub first_milli: u32,
    /// Steps of `k` on the curve, in thousandths.
    pub step_milli: u32,
    /// Distance between the candidates for the cells, in thousandths of `k`.
    pub tried_every_milli: u32,
    /// `k` of a situation in which the vehicle need not react.
    pub usual_gain: f64,
    curve: Curve,
}

/// How `γ` follows from `k`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Curve {
    /// It is the middle of all sound values.
    MiddleOfSound,
    /// `γ = (1 - φ)/(t k)` with `t` = 0.6 s. Then `G(s) = 1/(1 + t s)` at a time gap of `t` for actuators with the lag `φ t`, which is a
    /// car's
    /// 0.3 s: neither a sine nor a step is amplified, whatever `k` is. More `γ` passes the braking ahead on sooner than the gap allows, and
    /// the gap has to be opened again afterwards; with less than `[(1 - φ)/t - k t/2]/k` low frequencies are amplified.
    FirstOrder,
}

/// The largest time gap at which a table is proved, in tenths of a second.
pub const LARGEST_GAP_TENTHS: u32 = 20;

/// The table of the law of eq. 5.
pub const PLAIN: Design = Design {
    name: "PLAIN",
    feed_forward: 0.0,
    smallest_gap_tenths: 10,
    first_milli: 250,
    step_milli: 50,
    tried_every_milli: 25,
    usual_gain: 0.5,
    curve: Curve::MiddleOfSound,
};

/// The table of that law with feed-forward.
#[must_use]
pub fn fed() -> Design {
    Design {
        name: "FED",
        feed_forward: parameters::FEED_FORWARD.get().to_num(),
        smallest_gap_tenths: 7,
        first_milli: 200,
        step_milli: 30,
        tried_every_milli: 10,
        usual_gain: 0.3,
        curve: Curve::FirstOrder,
    }
}

impl Design {
    /// The smallest time gap that the table is made for, in seconds.
    #[must_use]
    pub fn smallest_gap_s(&self) -> f64 {
        f64::from(self.smallest_gap_tenths) / 10.0
    }

    /// The time gaps at which the table is proved, in seconds.
    pub fn time_gaps_s(&self) -> impl Iterator<Item = f64> + use<> {
        (self.smallest_gap_tenths..=LARGEST_GAP_TENTHS).map(|tenths| f64::from(tenths) / 10.0)
    }

    /// The last `k` of the curve, in thousandths.
    #[must_use]
    pub fn last_milli(&self) -> u32 {
        self.first_milli + (POINTS - 1) * self.step_milli
    }

    /// `γ` in milliseconds at this `k`.
    #[must_use]
    pub fn damping_milli(&self, gain: f64) -> u32 {
        match self.curve {
            Curve::MiddleOfSound => self.middle_of_sound_milli(gain),
            Curve::FirstOrder => {
                let damping_s = (1.0 - self.feed_forward) / (FIRST_ORDER_GAP_S * gain);
                ((damping_s * 1e3).round() as u32).min(DAMPING_MOST_MILLI)
            }
        }
    }

    fn middle_of_sound_milli(&self, gain: f64) -> u32 {
        let law = |milli: u32| Pair { gain, damping_s: f64::from(milli) / 1e3 }.at(self.smallest_gap_s());
        let dampings = (50..=DAMPING_MOST_MILLI / DAMPING_STEP_MILLI).map(|step| step * DAMPING_STEP_MILLI);
        let sound = dampings.filter(|milli| law(*milli).fed(self.feed_forward).is_sound());
        let (low, high) = sound.fold((u32::MAX, 0), |(low, high), milli| (low.min(milli), high.max(milli)));
        (low.min(high) + high) / 2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn with_feed_forward_a_car_follows_as_a_lag_of_first_order_at_06_s() {
        let fed = fed();
        for gain in [0.23, 0.3, 0.41] {
            let pair = Pair { gain, damping_s: f64::from(fed.damping_milli(gain)) / 1e3 };
            let law = pair.at(0.6).fed(fed.feed_forward);
            for frequency in [0.1, 0.5, 1.0, 2.0, 5.0f64] {
                let lag = 1.0 / (1.0 + (0.6 * frequency).powi(2)).sqrt();
                assert!((law.gain_at(frequency, 0.3) - lag).abs() < 5e-4, "{gain} {frequency}");
            }
        }
    }
}
