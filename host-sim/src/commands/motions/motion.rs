//! The motion of the target: one of five motions and a phase enter; a scenario with a silence at its last vehicle
//! leaves.
//!
//! The last vehicle listens to the vehicle ahead, the target, over the paper's channel. It stays so far behind that its
//! own motion does not matter. Only its links are impaired, so the silence does not change the target's motion.

use std::f64::consts::TAU;
use std::fmt;
use std::path::Path;

use crate::error::Error;
use crate::input::recording::{Motion, MotionRow};
use crate::input::scenario::{Overrides, Scenario, SensorShare};

/// Length of the silence.
pub const SILENCE_S: f64 = 4.0;
/// Number of phases. Silences of one motion differ in their beginning, or in when the target brakes in them.
pub const PHASES: u32 = 10;

/// Target speed on a free road, and a driver's speed before anything happens.
const CRUISE_MPS: f64 = 13.4;
/// By this time every unit has heard every vehicle.
const EARLIEST_S: f64 = 2.0;
/// Beginning of a silence in which a driver brakes.
const BRAKED_IN_FROM_S: f64 = 5.0;
const SINE_HZ: f64 = 0.2;
/// 10 km/h.
const SINE_MPS: f64 = 10.0 / 3.6;

/// The motion of the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetMotion {
    /// The target leads and accelerates by Algorithm 2, from 1 to 4 m/s to 13.4 m/s. It publishes that.
    FreeAcceleration,
    /// The target moves into its place behind an accelerating leader, from a gap of 6 to 30 m, by the law. It publishes
    /// that.
    SlotFollowing,
    /// A driver's speed oscillates by 10 km/h at 0.2 Hz.
    Sine,
    /// A driver brakes at 2 m/s², beginning 0.2 to 2 s after the silence begins.
    Braking,
    /// A driver brakes at 5 m/s² to a stop, beginning 0.1 to 1 s after the silence begins.
    HardBraking,
}

impl TargetMotion {
    /// All motions.
    pub const ALL: [Self; 5] =
        [Self::FreeAcceleration, Self::SlotFollowing, Self::Sine, Self::Braking, Self::HardBraking];

    /// Its name in the JSON.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::FreeAcceleration => "free_acceleration",
            Self::SlotFollowing => "slot_following",
            Self::Sine => "sine",
            Self::Braking => "braking_2",
            Self::HardBraking => "braking_5",
        }
    }

    /// Whether the target is driven by its unit, which publishes its driving parameters. A driver's intention is not
    /// published.
    #[must_use]
    pub fn is_published(self) -> bool {
        matches!(self, Self::FreeAcceleration | Self::SlotFollowing)
    }

    /// Beginning of the silence.
    #[must_use]
    pub fn silent_from_s(self, phase: u32) -> f64 {
        let phase = f64::from(phase % PHASES);
        match self {
            Self::FreeAcceleration => EARLIEST_S + 1.5 * phase,
            Self::SlotFollowing => EARLIEST_S + phase,
            // Tenths of a period.
            Self::Sine => EARLIEST_S + phase / SINE_HZ / f64::from(PHASES),
            Self::Braking | Self::HardBraking => BRAKED_IN_FROM_S,
        }
    }

    /// The scenario. Its last vehicle listens, and from [`Self::silent_from_s`] on it receives nothing for
    /// [`SILENCE_S`].
    ///
    /// # Errors
    /// None, as long as the text below is a valid scenario.
    pub fn scenario(self, phase: u32, range_sensors: SensorShare) -> Result<Scenario, Error> {
        let from_s = self.silent_from_s(phase);
        let (listener, ahead) = match self {
            Self::FreeAcceleration => (1, vehicle("speed_mps = [1.0, 4.0]")),
            Self::SlotFollowing => {
                let leader = vehicle("speed_mps = [6.0, 10.0]");
                (2, leader + &vehicle("speed_mps = [6.0, 10.0]\ngap_m = [6.0, 30.0]"))
            }
            Self::Sine | Self::Braking | Self::HardBraking => (1, vehicle(&format!("speed_mps = {CRUISE_MPS}"))),
        };
        let text = format!(
            "duration_s = {}\nstep_s = 0.01\nego = {listener}\n[leader]\ntarget_speed_mps = {CRUISE_MPS}\n{ahead}{}[channel]\n\
             applies_to = [{listener}]\noutages = [[{from_s}, {}]]\n",
            from_s + SILENCE_S,
            vehicle("speed_mps = 10.0\ngap_m = 60.0\ntime_gap_s = 3.9"),
            from_s + SILENCE_S,
        );
        let overrides = Overrides { range_sensors: Some(range_sensors), ..Overrides::MESSAGES_ALONE };
        let mut scenario = Scenario::parse(Path::new("motions"), &text, &overrides)?;
        scenario.leader.motion = self.driven(phase, &scenario);
        Ok(scenario)
    }

    /// The driver's motion, if a driver drives, in steps of the units' period.
    fn driven(self, phase: u32, scenario: &Scenario) -> Option<Motion> {
        let brakes_after = |least_s: f64| self.silent_from_s(phase) + least_s * f64::from(phase % PHASES + 1);
        let row: Box<dyn Fn(f64) -> MotionRow> = match self {
            Self::FreeAcceleration | Self::SlotFollowing => return None,
            Self::Sine => Box::new(sine),
            Self::Braking => Box::new(move |t_s| braking(t_s, brakes_after(0.2), 2.0)),
            Self::HardBraking => Box::new(move |t_s| braking(t_s, brakes_after(0.1), 5.0)),
        };
        let rows = (scenario.duration_s / scenario.period_s).ceil() as u32 + 1;
        Some(Motion::of((0..=rows).map(|index| row(f64::from(index) * scenario.period_s)).collect()))
    }
}

impl fmt::Display for TargetMotion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::FreeAcceleration => "free acceleration",
            Self::SlotFollowing => "slot following",
            Self::Sine => "sine, 0.2 Hz, ±10 km/h",
            Self::Braking => "braking at 2 m/s²",
            Self::HardBraking => "5 m/s² to a stop",
        })
    }
}

fn vehicle(lines: &str) -> String {
    format!("[[vehicle]]\nposition_accuracy_m = 0.05\nspeed_accuracy_mps = 0.02\n{lines}\n")
}

fn sine(t_s: f64) -> MotionRow {
    let rate = TAU * SINE_HZ;
    let (sine, cosine) = (rate * t_s).sin_cos();
    MotionRow {
        t_s,
        position_m: CRUISE_MPS * t_s + SINE_MPS * (1.0 - cosine) / rate,
        speed_mps: CRUISE_MPS + SINE_MPS * sine,
        acceleration_mps2: Some(SINE_MPS * rate * cosine),
    }
}

fn braking(t_s: f64, from_s: f64, braking_mps2: f64) -> MotionRow {
    let braked_s = (t_s - from_s).clamp(0.0, CRUISE_MPS / braking_mps2);
    let is_braking = t_s > from_s && t_s < from_s + CRUISE_MPS / braking_mps2;
    MotionRow {
        t_s,
        position_m: CRUISE_MPS * (t_s.min(from_s) + braked_s) - 0.5 * braking_mps2 * braked_s * braked_s,
        speed_mps: CRUISE_MPS - braking_mps2 * braked_s,
        acceleration_mps2: Some(if is_braking { -braking_mps2 } else { 0.0 }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drivers_positions_speeds_and_accelerations_belong_together() {
        for motion in [TargetMotion::Sine, TargetMotion::Braking, TargetMotion::HardBraking] {
            for phase in 0..PHASES {
                let drive = motion.scenario(phase, SensorShare::NONE).unwrap().leader.motion.unwrap();
                for pair in drive.rows().windows(2) {
                    let (a, b) = (pair[0], pair[1]);
                    let way = 0.5 * (a.speed_mps + b.speed_mps) * 0.01;
                    assert!((b.position_m - a.position_m - way).abs() < 1.5e-4, "{motion} at {}", a.t_s);
                    let slope = (b.speed_mps - a.speed_mps) / 0.01;
                    let [low, high] = [a, b].map(|row| row.acceleration_mps2.unwrap());
                    assert!((slope - low).abs() < 0.05 || (slope - high).abs() < 0.05, "{motion} at {}", a.t_s);
                }
            }
        }
    }

    #[test]
    fn a_driver_brakes_only_inside_the_silence_and_the_hard_one_stands_before_its_end() {
        for phase in 0..PHASES {
            for motion in [TargetMotion::Braking, TargetMotion::HardBraking] {
                let from_s = motion.silent_from_s(phase);
                let drive = motion.scenario(phase, SensorShare::NONE).unwrap().leader.motion.unwrap();
                assert_eq!(drive.at(from_s + 0.09).speed_mps, CRUISE_MPS);
                let last = drive.at(from_s + SILENCE_S - 0.1).speed_mps;
                assert!(if motion == TargetMotion::Braking { last < 10.0 } else { last < 1e-9 }, "{motion} {last}");
            }
        }
    }

    #[test]
    fn the_silences_of_the_sine_begin_in_every_tenth_of_its_period() {
        let phases = (0..PHASES).map(|phase| (TargetMotion::Sine.silent_from_s(phase) * SINE_HZ).fract());
        let mut tenths: Vec<u32> = phases.map(|share| (share * 10.0).round() as u32 % 10).collect();
        tenths.sort_unstable();
        assert_eq!(tenths, (0..PHASES).collect::<Vec<_>>());
    }
}
