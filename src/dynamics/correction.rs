//! What eq. 1 does not know of, a load, a grade, a wind: the demand and the measured speed of every tick enter, the
//! acceleration to be asked of eqs 2 and 3 leaves, so that what is reached is the demand all the same.
//!
//! Others predict this vehicle by its law, its lag and its demand. On a grade of 4 % without this, the vehicle is slower
//! than any of them believes by 0.39 m/s², and in a silence of four seconds that is most of a metre.
//!
//! An observer of second order carries the speed on by the actuators' lag under what was asked, and by the disturbance `d`:
//! `ŵ' = lag(u - d) + d + 2 ω (v - ŵ)`, `d' = ω² (v - ŵ)`; what is asked is `u - d`. Both of its poles lie at `-ω`, in steps at
//! `z = e^(-ω h)`. It goes by the speed, because an accelerometer's bias and its share of gravity would pass for a
//! disturbance.
//!
//! It has to be quick: a load or a lag that is wrong is a disturbance which follows the demand, and one that is made up for
//! too late is added to the next demand. At `ω` = 1 /s wrong lags cost three times what they cost without it.
//!
//! *Limits.* `d` stays within ±1.5 m/s², a grade of 15 %, so that an engine at its limit does not wind it up. At rest the
//! brakes hold whatever there is, and `d` is kept. What the model misses stays stable where it is less than
//! `(1 + s/ω)²` of what was asked at every frequency: so with a lag of a third to any multiple of the published one.

use crate::config::Config;
use crate::fixed::{quotient, saturate_i32};
use crate::held::Held;
use crate::model::{Actuator, Decay, Model, State};
use crate::time::Duration;
use crate::units::{Acceleration, Fraction, Speed};

/// `1/ω`: short enough for what follows the demand. Speeds by 2 mm/s make the disturbance jitter by 2 mm/s².
const TIME_CONSTANT: Duration = Duration::from_millis(100);

/// But at least as many periods, so that the gains of a step stay small.
const PERIODS: i64 = 5;

/// The largest disturbance.
const LARGEST: Acceleration = Acceleration::from_mm_per_s2(1_500);

/// The observer.
#[derive(Clone, Debug, Default)]
pub struct Correction {
    memory: Held<Memory>,
}

#[derive(Clone, Copy, Debug)]
struct Memory {
    /// Of speed, of acceleration as the actuators bring it about, and what was asked last.
    state: State,
    disturbance: Acceleration,
    actuator: Actuator,
    /// `1 - z²`: how much of what the speed is off by is corrected in a step.
    damped: Fraction,
    /// `(1 - z)²/h` in 1/s: how fast that changes the disturbance.
    per_second: Fraction,
}

impl Correction {
    /// Nothing known.
    #[must_use]
    pub const fn new() -> Self {
        Self { memory: Held::Nothing }
    }

    /// What to ask of the actuators for this demand; forgets everything where the own motion is unknown or someone else
    /// drives (`ego` is `None`).
    pub fn apply(&mut self, config: &Config, ego: Option<&State>, demand: Acceleration) -> Acceleration {
        let Some(ego) = ego.filter(|_| config.correction) else {
            self.memory.clear();
            return demand;
        };
        let mut memory = self.memory.get().unwrap_or_else(|| Memory::starting(config, ego));
        memory.observe(ego.speed);
        let asked = demand.minus(memory.disturbance);
        memory.state.demand = asked;
        self.memory.set(memory);
        asked
    }
}

impl Memory {
    fn starting(config: &Config, ego: &State) -> Self {
        let lag = Duration::of_fine_seconds(config.lag);
        let unlimited = Model { limits: false, ..Model::HOLDOVER };
        let time_constant = TIME_CONSTANT.max(config.period.times(PERIODS));
        let kept = Decay::over(config.period, time_constant).keep;
        let left = Fraction::ONE.minus(kept);
        let lost = i64::from(left.fraction(left).to_bits());
        // At most 1.7: at 20 ms and a time constant of five periods.
        let per_second = quotient(lost.saturating_mul(1_000_000), config.period.as_micros());
        Self {
            state: *ego,
            disturbance: Acceleration::ZERO,
            actuator: Actuator::over(config.period, lag, &config.limits, &unlimited),
            damped: Fraction::ONE.minus(kept.fraction(kept)),
            per_second: Fraction::from_bits(saturate_i32(per_second)),
        }
    }

    /// One period later, with the speed that is measured then.
    fn observe(&mut self, measured: Speed) {
        if measured == Speed::ZERO {
            self.state.speed = Speed::ZERO;
            self.state.acceleration = Acceleration::ZERO;
            return;
        }
        let next = self.actuator.drive(self.state, self.state.demand);
        let expected = next.speed.plus(self.actuator.gained(self.disturbance));
        let off = measured.minus(expected);
        // The actuators' model is of a vehicle that does not drive backwards, whatever the measurement says.
        let speed = expected.plus(off.fraction(self.damped)).max(Speed::ZERO);
        let change = Acceleration::in_a_second(off).fraction(self.per_second);
        self.state = State { speed, ..next };
        self.disturbance = self.disturbance.plus(change).limited(LARGEST.negated(), LARGEST);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::StationHash;

    const PERIOD_S: f64 = 0.01;

    /// A vehicle at 15 m/s in float64 whose actuators have this lag and give this share of what is asked of them, less
    /// `down`; the demand alternates every 5 s. What is reached, beside the demand behind the published lag, after 20 s:
    /// the largest difference.
    fn worst(lag_s: f64, gain: f64, down: f64, corrected: bool) -> f64 {
        let config = Config { correction: corrected, ..Config::car(StationHash(1)) };
        let (mut correction, mut v, mut a, mut lagged, mut worst) =
            (Correction::new(), 15.0f64, 0.0f64, 0.0f64, 0.0f64);
        for tick in 0..6_000 {
            let demand = if (tick / 500) % 2 == 0 { 0.3 } else { -0.3 };
            let ego = State { speed: Speed::from_mm_per_s((v * 1e3).round() as i32), ..State::default() };
            let demanded = Acceleration::from_mm_per_s2((demand * 1e3f64).round() as i32);
            let asked: f64 = correction.apply(&config, Some(&ego), demanded).get().to_num();
            a += (gain * asked - a) * (1.0 - (-PERIOD_S / lag_s).exp());
            v += (a - down) * PERIOD_S;
            lagged += (demand - lagged) * (1.0 - (-PERIOD_S / 0.3).exp());
            if tick >= 2_000 && tick % 500 >= 300 {
                worst = worst.max((a - down - lagged).abs());
            }
        }
        worst
    }

    #[test]
    fn a_grade_and_a_load_are_made_up_for() {
        assert!(worst(0.3, 1.0, 0.0, true) < 0.005);
        assert!(worst(0.3, 1.0, 0.39, false) > 0.38);
        assert!(worst(0.3, 1.0, 0.39, true) < 0.005);
        assert!(worst(0.3, 1.0 / 1.3, 0.39, true) < 0.02);
        assert!(worst(0.3, 1.0 / 1.3, 0.39, false) > 0.3);
    }

    #[test]
    fn a_lag_that_is_wrong_by_half_or_threefold_leaves_it_stable() {
        assert!(worst(0.45, 1.0, 0.39, true) < 0.02);
        assert!(worst(0.9, 1.0, 0.39, true) < 0.12);
        assert!(worst(0.1, 1.0, 0.39, true) < 0.02);
    }

    #[test]
    fn it_forgets_where_someone_else_drives_and_keeps_what_it_knows_at_rest() {
        let config = Config::car(StationHash(1));
        let mut correction = Correction::new();
        let at = |mm_per_s| State { speed: Speed::from_mm_per_s(mm_per_s), ..State::default() };
        // Nothing is asked and the speed falls by 0.4 m/s every second.
        for tick in 0..600 {
            correction.apply(&config, Some(&at(10_000 - 4 * tick)), Acceleration::ZERO);
        }
        let known = correction.apply(&config, Some(&at(0)), Acceleration::ZERO);
        assert!(known > Acceleration::from_mm_per_s2(300), "{known:?}");
        for _ in 0..1000 {
            assert_eq!(correction.apply(&config, Some(&at(0)), Acceleration::ZERO), known);
        }
        assert_eq!(correction.apply(&config, None, Acceleration::ZERO), Acceleration::ZERO);
        assert_eq!(correction.apply(&config, Some(&at(10_000)), Acceleration::ZERO), Acceleration::ZERO);
    }

    #[test]
    fn speeds_that_jump_down_to_a_crawl_are_taken_as_they_are() {
        let (config, mut correction) = (Config::car(StationHash(1)), Correction::new());
        for tick in 0..100 {
            let speed = Speed::from_mm_per_s(if tick % 3 == 0 { 30_000 } else { 1 });
            let ego = State { speed, ..State::default() };
            let asked = correction.apply(&config, Some(&ego), Acceleration::from_mm_per_s2(-8_000));
            assert!(asked.plus(Acceleration::from_mm_per_s2(8_000)).magnitude() <= LARGEST);
        }
    }

    #[test]
    fn the_disturbance_has_an_end() {
        let (config, mut correction) = (Config::car(StationHash(1)), Correction::new());
        let mut asked = Acceleration::ZERO;
        for tick in 0..1000 {
            let ego = State { speed: Speed::from_mm_per_s(50_000 - 40 * tick), ..State::default() };
            asked = correction.apply(&config, Some(&ego), Acceleration::ZERO);
        }
        assert_eq!(asked, LARGEST);
    }
}
