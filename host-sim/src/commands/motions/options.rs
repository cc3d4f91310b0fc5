//! The options of `motions`: typed values enter, checked ones leave.

use super::arguments::MotionsArguments;
use crate::commands::ending::Destination;
use crate::error::Error;
use crate::seeds;

/// The most silences of a motion: their errors are held at once.
pub const MOST_SILENCES: u32 = 1000;

/// What is to be measured and what becomes of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MotionsOptions {
    /// Silences of each motion; at least 1.
    pub silences: u32,
    /// Seed of the first; there are as many seeds.
    pub seed: u64,
    /// Where its results go.
    pub destination: Destination,
}

impl MotionsOptions {
    /// Checks what the arguments say.
    ///
    /// # Errors
    /// Values that cannot be, and a folder that cannot be written.
    pub fn read(arguments: MotionsArguments) -> Result<Self, Error> {
        let MotionsArguments { silences, seed, json, out, no_report } = arguments;
        if !(1..=MOST_SILENCES).contains(&silences) {
            let remedy = format!("give a number from 1 to {MOST_SILENCES}");
            return Err(Error::new(format!("is {silences}"), remedy).in_option("--silences"));
        }
        seeds::from(seed, u64::from(silences))?;
        let destination = Destination::new(json, (!no_report).then_some(out))?;
        Ok(Self { silences, seed, destination })
    }

    /// The same command again.
    #[must_use]
    pub fn command(&self) -> String {
        format!("holdover-sim motions --silences {} --seed {}", self.silences, self.seed)
    }
}
