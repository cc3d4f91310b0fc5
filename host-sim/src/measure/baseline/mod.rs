//! The other methods, on the same decoded messages, in float64: messages enter, estimates of one vehicle's motion
//! leave. They are independent of the core: none of them calls its estimator.
//!
//! | name | between messages |
//! |---|---|
//! | [`freeze`] | the position is held, the speed is 0 |
//! | [`constant_speed`] | the speed is held |
//! | [`constant_acceleration`] | the acceleration is held until the vehicle stops |
//! | [`singer`] | the acceleration fades with 1.5 s, until the vehicle stops |
//! | [`kalman`] | a Kalman filter on position and speed, its acceleration held until the vehicle stops |
//! | [`paper`] | the literal paper: its Algorithms 1 to 4 on the chain of vehicles |
//!
//! Rules for all methods: a message of a vehicle counts only if its stamp is newer than all before. So messages out of
//! order and duplicates change nothing. A sample is never extrapolated backwards: before its stamp it holds as it is.

pub mod constant_acceleration;
pub mod constant_speed;
pub mod freeze;
pub mod kalman;
pub mod paper;
pub mod singer;

use crate::measure::heard::Heard;

/// An estimate of the target's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Front bumper along the lane.
    pub position_m: f64,
    /// Speed along the lane.
    pub speed_mps: f64,
}

/// A method that estimates one vehicle, the target, from the messages of all vehicles.
pub trait Baseline: Send {
    /// Its name in the results.
    fn name(&self) -> &'static str;

    /// Takes in a message, in the order of arrival. Messages of all vehicles are passed.
    fn hear(&mut self, heard: &Heard);

    /// The target's motion at `now_s`. This time never decreases and is not before the last arrival. `None` before the
    /// first message of the target.
    fn estimate(&mut self, now_s: f64) -> Option<Estimate>;

    /// A copy with all messages so far, so that two runs can continue from here.
    fn duplicate(&self) -> Box<dyn Baseline>;
}

impl Clone for Box<dyn Baseline> {
    fn clone(&self) -> Self {
        (**self).duplicate()
    }
}

/// All methods for one target, in the order of the table above; `step_s` is the paper's prediction step `δt`.
#[must_use]
pub fn all(target: usize, step_s: f64) -> Vec<Box<dyn Baseline>> {
    vec![
        Box::new(freeze::Freeze::new(target)),
        Box::new(constant_speed::ConstantSpeed::new(target)),
        Box::new(constant_acceleration::ConstantAcceleration::new(target)),
        Box::new(singer::Singer::new(target)),
        Box::new(kalman::Kalman::new(target)),
        Box::new(paper::Paper::new(target, step_s)),
    ]
}

/// The name of a method as people read it, in tables, reports and `--help`: the only one beside the key in JSON and CSV.
#[must_use]
pub fn spoken(name: &str) -> String {
    match name {
        "paper" => "literal paper".into(),
        "kalman" => "Kalman filter".into(),
        "singer" => "Singer's model".into(),
        other => other.replace('_', " "),
    }
}

/// The newest sample of one vehicle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Newest {
    vehicle: usize,
    sample: Option<Heard>,
}

impl Newest {
    pub(crate) fn of(vehicle: usize) -> Self {
        Self { vehicle, sample: None }
    }

    /// Keeps the sample if it is of this vehicle and newer than the one kept. Returns whether it was.
    pub(crate) fn keep(&mut self, heard: &Heard) -> bool {
        let news = heard.vehicle == self.vehicle && self.sample.is_none_or(|kept| heard.stamp_s > kept.stamp_s);
        if news {
            self.sample = Some(*heard);
        }
        news
    }

    /// The sample, with its age at `now_s`, at least 0.
    pub(crate) fn at(&self, now_s: f64) -> Option<(Heard, f64)> {
        self.sample.map(|sample| (sample, (now_s - sample.stamp_s).max(0.0)))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A plain state message of vehicle 0 that arrives 20 ms after its stamp.
    pub(crate) fn state(stamp_s: f64, position_m: f64, speed_mps: f64, acceleration_mps2: f64) -> Heard {
        let at_s = stamp_s + 0.02;
        let demand_mps2 = acceleration_mps2;
        Heard { at_s, stamp_s, vehicle: 0, position_m, speed_mps, acceleration_mps2, demand_mps2, parameters: None }
    }

    #[test]
    fn no_baseline_has_an_estimate_before_its_target_was_heard() {
        for mut baseline in all(1, 0.01) {
            baseline.hear(&state(0.0, 0.0, 10.0, 0.0));
            assert_eq!(baseline.estimate(1.0), None, "{}", baseline.name());
        }
    }

    #[test]
    fn an_older_message_a_second_copy_and_another_vehicle_change_nothing() {
        for mut baseline in all(0, 0.01) {
            let newest = state(1.0, 10.0, 10.0, -1.0);
            baseline.hear(&newest);
            let mut disturbed = baseline.clone();
            let copy = Heard { at_s: 1.05, position_m: 99.0, ..newest };
            let older = Heard { at_s: 1.06, ..state(0.9, -50.0, 3.0, 2.0) };
            let other = Heard { at_s: 1.07, stamp_s: 1.06, vehicle: 5, ..newest };
            for message in [copy, older, other] {
                disturbed.hear(&message);
            }
            assert_eq!(disturbed.estimate(1.5), baseline.estimate(1.5), "{}", baseline.name());
        }
    }

    #[test]
    fn a_duplicate_goes_its_own_way() {
        for mut baseline in all(0, 0.01) {
            baseline.hear(&state(0.0, 0.0, 10.0, 0.0));
            let before = baseline.clone().estimate(2.0);
            let mut duplicate = baseline.clone();
            duplicate.hear(&state(1.0, 50.0, 4.0, 0.0));
            assert_ne!(duplicate.estimate(2.0), before, "{}", baseline.name());
            assert_eq!(baseline.estimate(2.0), before, "{}", baseline.name());
        }
    }

    #[test]
    fn names_are_those_of_the_results() {
        let names: Vec<_> = all(0, 0.01).iter().map(|baseline| baseline.name()).collect();
        assert_eq!(names, ["freeze", "constant_speed", "constant_acceleration", "singer", "kalman", "paper"]);
    }
}
