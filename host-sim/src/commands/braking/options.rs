//! The options of `braking`: typed values enter, checked ones leave.

use super::arguments::BrakingArguments;
use crate::commands::ending::Destination;
use crate::commands::string::options::{shipped_time_gap_s, within};
use crate::error::Error;
use crate::input::scenario::SensorShare;
use crate::seeds;

/// The measurement, and where its results go.
#[derive(Clone, Debug, PartialEq)]
pub struct BrakingOptions {
    /// The leader's braking, in m/s²; at least one.
    pub braking_mps2: Vec<f64>,
    /// Time gaps, in seconds; at least one.
    pub time_gaps_s: Vec<f64>,
    /// Speed from which the leader brakes.
    pub speed_mps: f64,
    /// Length of the silence.
    pub silence_s: f64,
    /// Delay of every message.
    pub delay_s: f64,
    /// Fraction of messages lost outside the silence.
    pub loss: f64,
    /// The share of the followers that have a range sensor.
    pub range_sensors: SensorShare,
    /// The first seed.
    pub seed: u64,
    /// Number of seeds; at least 1.
    pub seeds: u64,
    /// Where its results go.
    pub destination: Destination,
}

impl BrakingOptions {
    /// Checks the arguments.
    ///
    /// # Errors
    /// Impossible values, and a folder that cannot be written.
    pub fn read(arguments: BrakingArguments) -> Result<Self, Error> {
        let BrakingArguments { braking, time_gaps, speed, silence, delay, loss, range_sensors, seed, seeds, output } =
            arguments;
        let time_gaps = if time_gaps.is_empty() { vec![shipped_time_gap_s(range_sensors)] } else { time_gaps };
        within("--braking", &braking, "m/s²", (0.5, 12.0))?;
        within("--time-gaps", &time_gaps, "seconds", (0.1, 3.995))?;
        within("--speed", &[speed], "m/s", (1.0, 40.0))?;
        within("--silence", &[silence], "seconds", (0.1, 20.0))?;
        within("--delay", &[delay], "seconds", (0.0, 1.0))?;
        within("--loss", &[loss], "a share", (0.0, 0.9))?;
        seeds::checked(seed, seeds)?;
        Ok(Self {
            braking_mps2: braking,
            time_gaps_s: time_gaps,
            speed_mps: speed,
            silence_s: silence,
            delay_s: delay,
            loss,
            range_sensors,
            seed,
            seeds,
            destination: output.read()?,
        })
    }

    /// The command that repeats this.
    #[must_use]
    pub fn command(&self) -> String {
        let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        format!(
            "holdover-sim braking --braking {} --time-gaps {} --speed {} --silence {} --delay {} --loss {} \
             --range-sensors {} --seed {} --seeds {}",
            list(&self.braking_mps2),
            list(&self.time_gaps_s),
            self.speed_mps,
            self.silence_s,
            self.delay_s,
            self.loss,
            self.range_sensors,
            self.seed,
            self.seeds
        )
    }
}
