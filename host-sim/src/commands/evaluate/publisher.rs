//! A recorded vehicle as a sender: a time of sending enters, the V2X message of that time leaves.
//!
//! A vehicle whose predecessor is recorded too publishes driving parameters. Like any vehicle it names its predecessor
//! only while it drives by its law. Whether it does is decided by its motion: while its acceleration is the law's
//! demand to within 0.5 m/s², it names its predecessor. Otherwise it names no predecessor and publishes only physical
//! limits. A receiver that assumed the law of a vehicle which does not drive by it would be wrong by metres.

use holdover::Config;
use holdover::units::{Acceleration, Jerk, Seconds};
use holdover::wire::driving_parameters::{DrivingParameters, Limits};
use holdover::wire::motion::{Motion as MotionMessage, WirePosition};
use holdover::wire::{Predecessor, StationHash};

use super::listener::{PREDECESSOR, TARGET};
use super::options::Recording;
use super::timeline::{Timeline, seconds};
use crate::input::recording::Motion;
use crate::measure::heard::HeardParameters;
use crate::sim::modem::{REPEATED, V2xMessage};
use crate::sim::quantities::{acceleration, metres, speed};
use crate::sim::station::station;
use crate::sim::time::gnss;

/// Largest difference between the acceleration of a vehicle that drives by its law and the law's demand [`LATE_S`]
/// before.
const SAME_LAW_MPS2: f64 = 0.5;
/// Delay of the measured acceleration. A car's acceleration follows the demand with a lag of 0.3 s, and it is measured
/// as the slope over the last 0.5 s.
const LATE_S: f64 = 0.3 + 0.25;

/// The limits of any car on a dry road, as far as a message can represent them.
const PHYSICAL: Limits = Limits {
    acceleration: Acceleration::from_mm_per_s2(6_000),
    braking: Acceleration::from_mm_per_s2(6_000),
    jerk: Jerk::from_mm_per_s3(50_000),
    emergency_braking: Acceleration::from_mm_per_s2(12_000),
};

/// The sender.
#[derive(Clone, Debug)]
pub struct Publisher<'a> {
    motion: &'a Motion,
    timeline: Timeline,
    station: StationHash,
    follows: Option<(&'a Motion, DrivingParameters)>,
    tag: u8,
}

/// A message, and the time of its sample.
#[derive(Clone, Copy, Debug)]
pub struct Published {
    /// Time of the sample in the message.
    pub sampled_us: i64,
    /// The message.
    pub message: V2xMessage,
}

impl<'a> Publisher<'a> {
    /// The sender of the recorded vehicle, with the vehicle that it follows, if that is recorded too.
    #[must_use]
    pub fn pair(recording: &'a Recording, timeline: Timeline) -> (Self, Option<Self>) {
        let target = Self::new(&recording.motion, timeline, station(TARGET));
        match &recording.predecessor {
            None => (target, None),
            Some((_, motion)) => {
                let ahead = station(PREDECESSOR);
                (target.behind(motion, ahead), Some(Self::new(motion, timeline, ahead)))
            }
        }
    }

    /// The first message of each vehicle.
    #[must_use]
    pub fn first_words(recording: &Recording, timeline: Timeline) -> Vec<V2xMessage> {
        let (target, ahead) = Publisher::pair(recording, timeline);
        let say = |mut sender: Publisher<'_>| Some(sender.publish(timeline.micros(sender.motion.start_s()))?.message);
        ahead.into_iter().chain([target]).filter_map(say).collect()
    }

    /// A vehicle that publishes its motion but no driving parameters.
    #[must_use]
    pub fn new(motion: &'a Motion, timeline: Timeline, station: StationHash) -> Self {
        Self { motion, timeline, station, follows: None, tag: 0 }
    }

    /// The same, behind `ahead`, which is as long as a car. Its law is the default of a unit's configuration, with a
    /// time gap of 1 s, the default of scenarios.
    #[must_use]
    fn behind(self, ahead: &'a Motion, predecessor: StationHash) -> Self {
        let Config { length, lag, limits, law, .. } = Config::car(self.station);
        let parameters = DrivingParameters {
            length,
            standstill: law.standstill,
            predecessor: Predecessor::Station(predecessor),
            // More than a road vehicle drives: a recording does not say what its driver wanted.
            target_speed: speed(50.0),
            catch_up: law.catch_up,
            time_gap: Seconds::from_millis(1_000),
            gain: law.gain,
            damping: law.damping,
            feed_forward: law.feed_forward,
            lag,
            limits,
            horizon_tenths: 0,
        };
        Self { follows: Some((ahead, parameters)), ..self }
    }

    /// The broadcast at this time: the last recorded sample at or before it. `None` before the first sample.
    pub fn publish(&mut self, at_us: i64) -> Option<Published> {
        let known = self.motion.rows().partition_point(|row| self.timeline.micros(row.t_s) <= at_us);
        let sample = self.motion.rows().get(known.checked_sub(1)?)?;
        let sampled_us = self.timeline.micros(sample.t_s);
        let slope_mps2 = self.motion.past_slope(sample.t_s);
        let acceleration = acceleration(slope_mps2);
        self.tag = (self.tag + 1) % 4;
        let motion = MotionMessage {
            tag: self.tag,
            position: WirePosition::from_position(metres(sample.position_m)),
            speed: speed(sample.speed_mps),
            acceleration,
            demand: acceleration,
            stamp: gnss(seconds(sampled_us)).stamp(),
            position_accuracy: None,
            speed_accuracy: None,
            station: self.station,
        };
        let parameters = self.follows.map(|(ahead, parameters)| {
            let is_by_law =
                (demand(&parameters, self.motion, ahead, sample.t_s - LATE_S) - slope_mps2).abs() <= SAME_LAW_MPS2;
            if is_by_law {
                parameters
            } else {
                DrivingParameters { predecessor: Predecessor::Unknown, limits: PHYSICAL, ..parameters }
            }
        });
        Some(Published {
            sampled_us,
            message: V2xMessage {
                motion,
                parameters,
                horizon: None,
                route: None,
                pass: None,
                repeated: [None; REPEATED],
            },
        })
    }
}

/// The law's demand for a vehicle at a time, behind a vehicle of its own length.
fn demand(parameters: &DrivingParameters, motion: &Motion, ahead: &Motion, at_s: f64) -> f64 {
    let parameters = HeardParameters::from_parameters(parameters, None);
    let (own, ahead) = (motion.at(at_s), ahead.at(at_s));
    let gap_m = ahead.position_m - parameters.length_m - own.position_m;
    let wanted_m = parameters.standstill_m + parameters.time_gap_s * own.speed_mps;
    let demand = parameters.gain * (gap_m - wanted_m + parameters.damping_s * (ahead.speed_mps - own.speed_mps));
    demand.clamp(-parameters.braking_mps2, parameters.acceleration_mps2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn the_last_sample_at_or_before_a_send_is_sent_with_its_own_time() {
        let drive =
            Motion::parse(Path::new("m.csv"), b"t_s,position_m,speed_mps\n1,10,5\n1.1,10.5,5.5\n1.2,11.1,6.5").unwrap();
        let timeline = Timeline::around(0.0, 0.01);
        let mut sender = Publisher::new(&drive, timeline, station(0));
        assert!(sender.publish(999_999).is_none());
        let sent: Vec<_> =
            [1_000_000, 1_099_999, 1_100_000, 9_000_000].iter().filter_map(|at| sender.publish(*at)).collect();
        assert_eq!(sent.iter().map(|s| s.sampled_us).collect::<Vec<_>>(), [1_000_000, 1_000_000, 1_100_000, 1_200_000]);
        assert_eq!(sent[0].message.motion.stamp, sent[1].message.motion.stamp);
        assert_eq!(sent[0].message.motion.acceleration.to_mm_per_s2(), 0);
        // Least-squares slope of 5, 5.5, 6.5 m/s at 1, 1.1, 1.2 s.
        assert_eq!(sent[3].message.motion.acceleration.to_mm_per_s2(), 7_500);
        assert_eq!(sent[3].message.motion.position.mm(), 11_100);
    }
}
