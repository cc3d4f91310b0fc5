//! The cooperative cruise control of Ploeg et al., *Graceful Degradation of Cooperative Adaptive Cruise Control*, IEEE T-ITS 16 (2015),
//! with its constants. What an ideal on-board sensor sees of the vehicle ahead and what that vehicle tells enter; the demand leaves.
//!
//! ```text
//! e = gap - r - h v                                        the spacing error
//! h u' = -u + k_p e + k_d e' + w,   k_p = 0.2, k_d = 0.7
//! ```
//!
//! `w` is the demand that the vehicle ahead told last (CACC), or without a message its acceleration as the sensor lets one estimate it
//! (degraded): a Kalman filter on Singer's model of that acceleration.

use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector2, Vector3};

const K_P: f64 = 0.2;
const K_D: f64 = 0.7;

/// Singer's model: the acceleration is forgotten at this rate, in 1/s.
const FORGOTTEN: f64 = 1.25;
/// It is at most this large in m/s², with this probability, and it is 0 with that one.
const LARGEST_MPS2: f64 = 3.0;
const LARGEST_PROBABILITY: f64 = 0.01;
const NONE_PROBABILITY: f64 = 0.1;
/// Standard deviations of the radar, in m and m/s.
const RADAR: (f64, f64) = (0.029, 0.017);

/// What a sensor without errors sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Bumper to bumper.
    pub gap_m: f64,
    /// Of the vehicle ahead.
    pub speed_mps: f64,
}

/// The own motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Own {
    /// Front bumper.
    pub position_m: f64,
    /// Speed.
    pub speed_mps: f64,
    /// Acceleration reached.
    pub acceleration_mps2: f64,
}

/// The controller of one vehicle.
#[derive(Clone, Debug)]
pub struct Ploeg {
    time_gap_s: f64,
    standstill_m: f64,
    period_s: f64,
    demand_mps2: f64,
    ahead: Ahead,
}

impl Ploeg {
    /// At rest, with a time gap and a distance at standstill.
    #[must_use]
    pub fn new(time_gap_s: f64, standstill_m: f64, period_s: f64) -> Self {
        Self { time_gap_s, standstill_m, period_s, demand_mps2: 0.0, ahead: Ahead::new(period_s) }
    }

    /// The demand of a period. `told_mps2` is the demand of the vehicle ahead, if it tells that.
    pub fn drive(&mut self, own: &Own, view: &View, told_mps2: Option<f64>) -> f64 {
        let estimated = self.ahead.see(Vector2::new(own.position_m + view.gap_m, view.speed_mps));
        let error = view.gap_m - self.standstill_m - self.time_gap_s * own.speed_mps;
        let change = view.speed_mps - own.speed_mps - self.time_gap_s * own.acceleration_mps2;
        let wanted = K_P * error + K_D * change + told_mps2.unwrap_or(estimated);
        self.demand_mps2 += (wanted - self.demand_mps2) * self.period_s / self.time_gap_s;
        self.demand_mps2
    }

    /// Goes on from the demand that is left of it by the limits of the vehicle.
    pub fn set(&mut self, demand_mps2: f64) {
        self.demand_mps2 = demand_mps2;
    }
}

/// The filter of the vehicle ahead: position, speed and acceleration.
#[derive(Clone, Debug)]
struct Ahead {
    step: Matrix3<f64>,
    noise: Matrix3<f64>,
    state: Option<Vector3<f64>>,
    covariance: Matrix3<f64>,
}

impl Ahead {
    fn new(period_s: f64) -> Self {
        let t = period_s;
        // Over a hundredth of a second the acceleration is forgotten by 1 %, so the first order is enough.
        let keep = (-FORGOTTEN * t).exp();
        let step = Matrix3::new(1.0, t, 0.5 * t * t, 0.0, 1.0, t, 0.0, 0.0, keep);
        let variance = LARGEST_MPS2 * LARGEST_MPS2 / 3.0 * (1.0 + 4.0 * LARGEST_PROBABILITY - NONE_PROBABILITY);
        let mut noise = Matrix3::zeros();
        noise[(2, 2)] = variance * (1.0 - keep * keep);
        let covariance = Matrix3::from_diagonal(&Vector3::new(RADAR.0.powi(2), RADAR.1.powi(2), variance));
        Self { step, noise, state: None, covariance }
    }

    /// The acceleration after this view.
    fn see(&mut self, seen: Vector2<f64>) -> f64 {
        let Some(state) = self.state else {
            self.state = Some(Vector3::new(seen.x, seen.y, 0.0));
            return 0.0;
        };
        let looks = Matrix2x3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0);
        let predicted = self.step * state;
        let covariance = self.step * self.covariance * self.step.transpose() + self.noise;
        let errs = Matrix2::from_diagonal(&Vector2::new(RADAR.0.powi(2), RADAR.1.powi(2)));
        let innovation = looks * covariance * looks.transpose() + errs;
        // The radar's variances are not 0, so there is an inverse.
        let gain = covariance * looks.transpose() * innovation.try_inverse().unwrap_or_else(Matrix2::zeros);
        let state = predicted + gain * (seen - looks * predicted);
        self.covariance = (Matrix3::identity() - gain * looks) * covariance;
        self.state = Some(state);
        state.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The amplitude of a follower with this lag, over that of a predecessor that tells its demand, which drives a sine.
    fn ratio(frequency_hz: f64, time_gap_s: f64, lag_s: f64, tells: bool) -> f64 {
        const PERIOD_S: f64 = 0.01;
        let rate = std::f64::consts::TAU * frequency_hz;
        let mut ploeg = Ploeg::new(time_gap_s, 2.0, PERIOD_S);
        let mut own = Own { position_m: 0.0, speed_mps: 15.0, acceleration_mps2: 0.0 };
        let (mut ahead_m, mut told, mut ahead_mps2) = (2.0 + 15.0 * time_gap_s, 0.0, 0.0);
        let (mut ahead_mps, mut extremes) = (15.0f64, [(f64::MAX, f64::MIN); 2]);
        let keep = (-PERIOD_S / lag_s).exp();
        let periods = (20.0 * frequency_hz).ceil() / frequency_hz;
        for tick in 0..(2.0 * periods / PERIOD_S) as usize {
            let view = View { gap_m: ahead_m - own.position_m, speed_mps: ahead_mps };
            let demand = ploeg.drive(&own, &view, tells.then_some(told));
            own.position_m += own.speed_mps * PERIOD_S;
            own.acceleration_mps2 = demand + (own.acceleration_mps2 - demand) * keep;
            own.speed_mps += own.acceleration_mps2 * PERIOD_S;
            told = (rate * tick as f64 * PERIOD_S).cos() * 0.5;
            ahead_m += ahead_mps * PERIOD_S;
            ahead_mps2 = told + (ahead_mps2 - told) * keep;
            ahead_mps += ahead_mps2 * PERIOD_S;
            if tick as f64 * PERIOD_S > periods {
                for (extreme, speed) in extremes.iter_mut().zip([ahead_mps, own.speed_mps]) {
                    *extreme = (extreme.0.min(speed), extreme.1.max(speed));
                }
            }
        }
        let [ahead, own] = extremes.map(|(low, high)| high - low);
        own / ahead
    }

    #[test]
    fn a_predecessor_that_tells_its_demand_is_followed_with_a_first_order_lag_of_the_time_gap() {
        for time_gap_s in [0.6, 1.0] {
            for frequency_hz in [0.05, 0.1, 0.3, 0.5] {
                let rate = std::f64::consts::TAU * frequency_hz * time_gap_s;
                let exact = 1.0 / rate.hypot(1.0);
                let ratio = ratio(frequency_hz, time_gap_s, 0.3, true);
                assert!((ratio - exact).abs() < 0.01, "{time_gap_s} {frequency_hz}: {ratio} {exact}");
            }
        }
    }

    #[test]
    fn without_messages_a_small_time_gap_amplifies() {
        assert!(ratio(0.1, 0.3, 0.3, false) > 1.02, "{}", ratio(0.1, 0.3, 0.3, false));
        assert!(ratio(0.1, 2.0, 0.3, false) < 1.0);
    }

    #[test]
    fn the_estimate_of_a_steady_acceleration_comes_near_it() {
        let mut ahead = Ahead::new(0.01);
        let seen = |t: f64| Vector2::new(15.0 * t - t * t, 15.0 - 2.0 * t);
        let last = (0..100).map(|tick| ahead.see(seen(f64::from(tick) * 0.01))).last().unwrap();
        assert!((last + 2.0).abs() < 0.3, "{last}");
    }
}
