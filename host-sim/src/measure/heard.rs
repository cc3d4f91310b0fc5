//! A decoded message in float64: the core's fixed-point message enters, the same numbers leave for the baselines. Every
//! conversion is exact, because each of the core's formats fits into a float64.

use holdover::units::Position;
use holdover::wire::Predecessor;
use holdover::wire::driving_parameters::DrivingParameters;
use holdover::wire::motion::Motion;

/// A vehicle's motion as a receiver decoded it, with its stamp and its time of arrival.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heard {
    /// Time of arrival, in seconds of the run's clock.
    pub at_s: f64,
    /// Stamp: when the motion was measured, in seconds of the same clock.
    pub stamp_s: f64,
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Front bumper along the lane.
    pub position_m: f64,
    /// Speed along the lane.
    pub speed_mps: f64,
    /// Acceleration along the lane.
    pub acceleration_mps2: f64,
    /// The acceleration last demanded of the actuators.
    pub demand_mps2: f64,
    /// The vehicle's driving parameters; `None`: this message has none, and the earlier ones still hold.
    pub parameters: Option<HeardParameters>,
}

/// The driving parameters that a vehicle publishes; limits are magnitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeardParameters {
    /// Length, bumper to bumper, `l`.
    pub length_m: f64,
    /// Standstill distance, `s_0`.
    pub standstill_m: f64,
    /// Whether it publishes that it follows no vehicle.
    pub leads: bool,
    /// The vehicle that it follows, if the receiver knows that vehicle.
    pub predecessor: Option<usize>,
    /// Target speed on a free road, `v_∞`.
    pub target_speed_mps: f64,
    /// Share by which it exceeds that to catch up.
    pub catch_up: f64,
    /// Desired time gap, `t_g`.
    pub time_gap_s: f64,
    /// Gain `k` in 1/s², with the adjacency `α` = 1.
    pub gain: f64,
    /// Damping `γ`.
    pub damping_s: f64,
    /// Share of its predecessor's acceleration that it adds, `φ`.
    pub feed_forward: f64,
    /// Time constant of its actuators, `T`.
    pub lag_s: f64,
    /// Largest acceleration that its controller demands.
    pub acceleration_mps2: f64,
    /// Hardest braking that its controller demands.
    pub braking_mps2: f64,
    /// Fastest change of its demand.
    pub jerk_mps3: f64,
}

impl Heard {
    /// The motion of a decoded message. On the wire, position and stamp are modulo their ranges, so the receiver passes
    /// them unwrapped, on the same clock as `at_s`.
    #[must_use]
    pub fn from_motion(at_s: f64, stamp_s: f64, vehicle: usize, position: Position, motion: &Motion) -> Self {
        Self {
            at_s,
            stamp_s,
            vehicle,
            position_m: position.get().to_num(),
            speed_mps: motion.speed.get().to_num(),
            acceleration_mps2: motion.acceleration.get().to_num(),
            demand_mps2: motion.demand.get().to_num(),
            parameters: None,
        }
    }

    /// The same, with the vehicle's latest driving parameters.
    #[must_use]
    pub fn with_parameters(self, parameters: HeardParameters) -> Self {
        Self { parameters: Some(parameters), ..self }
    }
}

impl HeardParameters {
    /// The decoded driving parameters. The message names the predecessor by the hash of its station. The receiver
    /// passes the index of that vehicle.
    #[must_use]
    pub fn from_parameters(parameters: &DrivingParameters, predecessor: Option<usize>) -> Self {
        Self {
            length_m: parameters.length.get().to_num(),
            standstill_m: parameters.standstill.get().to_num(),
            leads: parameters.predecessor == Predecessor::None,
            predecessor,
            target_speed_mps: parameters.target_speed.get().to_num(),
            catch_up: parameters.catch_up.get().to_num(),
            time_gap_s: parameters.time_gap.get().to_num(),
            gain: parameters.gain.get().to_num(),
            damping_s: parameters.damping.get().to_num(),
            feed_forward: parameters.feed_forward.get().to_num(),
            lag_s: parameters.lag.get().to_num(),
            acceleration_mps2: parameters.limits.acceleration.get().to_num(),
            braking_mps2: parameters.limits.braking.get().to_num(),
            jerk_mps3: parameters.limits.jerk.get().to_num(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use holdover::time::Stamp;
    use holdover::units::{Acceleration, Distance, FineSeconds, Fraction, Gain, Jerk, Seconds, Speed};
    use holdover::wire::StationHash;
    use holdover::wire::driving_parameters::Limits;
    use holdover::wire::motion::WirePosition;

    #[test]
    fn a_motion_keeps_its_numbers() {
        let motion = Motion {
            tag: 1,
            position: WirePosition::default(),
            speed: Speed::from_bits(3 << 22),
            acceleration: Acceleration::from_bits(-(5 << 23)),
            demand: Acceleration::from_bits(1 << 22),
            stamp: Stamp::from_raw(7),
            position_accuracy: None,
            speed_accuracy: None,
            station: StationHash(9),
        };
        let heard = Heard::from_motion(2.5, 2.0, 4, Position::from_bits(-7 << 18), &motion);
        assert_eq!(
            heard,
            Heard {
                at_s: 2.5,
                stamp_s: 2.0,
                vehicle: 4,
                position_m: -1.75,
                speed_mps: 1.5,
                acceleration_mps2: -1.25,
                demand_mps2: 0.125,
                parameters: None
            }
        );
    }

    #[test]
    fn driving_parameters_keep_their_numbers_and_tell_a_leader_from_a_silent_one() {
        let parameters = |predecessor| DrivingParameters {
            length: Distance::from_bits(9 << 19),
            standstill: Distance::from_bits(2 << 20),
            predecessor,
            target_speed: Speed::from_bits(11 << 23),
            catch_up: Fraction::from_milli(250),
            time_gap: Seconds::from_bits(3 << 28),
            gain: Gain::from_bits(1 << 28),
            damping: Seconds::from_bits(5 << 27),
            feed_forward: Fraction::from_milli(500),
            lag: FineSeconds::from_bits(1 << 28),
            limits: Limits {
                acceleration: Acceleration::from_bits(2 << 25),
                braking: Acceleration::from_bits(7 << 24),
                jerk: Jerk::from_bits(5 << 24),
                emergency_braking: Acceleration::from_bits(8 << 25),
            },
            horizon_tenths: 50,
        };
        let heard = HeardParameters::from_parameters(&parameters(Predecessor::Station(StationHash(3))), Some(2));
        assert_eq!(
            heard,
            HeardParameters {
                length_m: 4.5,
                standstill_m: 2.0,
                leads: false,
                predecessor: Some(2),
                target_speed_mps: 11.0,
                catch_up: 0.25,
                time_gap_s: 1.5,
                gain: 0.5,
                damping_s: 1.25,
                feed_forward: 0.5,
                lag_s: 0.25,
                acceleration_mps2: 2.0,
                braking_mps2: 3.5,
                jerk_mps3: 2.5
            }
        );
        assert!(HeardParameters::from_parameters(&parameters(Predecessor::None), None).leads);
        assert!(!HeardParameters::from_parameters(&parameters(Predecessor::Unknown), None).leads);
    }
}
