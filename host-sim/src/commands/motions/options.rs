//! The options of `motions`: typed values enter, checked ones leave.

use super::arguments::MotionsArguments;
use crate::commands::ending::Destination;
use crate::error::Error;
use crate::input::scenario::SensorShare;
use crate::seeds;

/// The most silences of a motion; the errors of all of them are in memory at once.
pub const MOST_SILENCES: u32 = 1000;

/// The measurement, and where its results go.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionsOptions {
    /// Silences of each motion; at least 1.
    pub silences: u32,
    /// Seed of the first silence; there are as many seeds as silences.
    pub seed: u64,
    /// Which vehicles have a range sensor.
    pub range_sensors: SensorShare,
    /// Where its results go.
    pub destination: Destination,
}

impl MotionsOptions {
    /// Checks the arguments.
    ///
    /// # Errors
    /// Impossible values, and a folder that cannot be written.
    pub fn read(arguments: MotionsArguments) -> Result<Self, Error> {
        let MotionsArguments { silences, seed, range_sensors, output } = arguments;
        if !(1..=MOST_SILENCES).contains(&silences) {
            let remedy = format!("give a number from 1 to {MOST_SILENCES}");
            return Err(Error::new(format!("is {silences}"), remedy).in_option("--silences"));
        }
        seeds::from(seed, u64::from(silences))?;
        let destination = output.read()?;
        Ok(Self { silences, seed, range_sensors, destination })
    }

    /// The command that repeats this.
    #[must_use]
    pub fn command(&self) -> String {
        let Self { silences, seed, range_sensors, .. } = self;
        format!("holdover-sim motions --silences {silences} --seed {seed} --range-sensors {range_sensors}")
    }
}
