//! The log of one vehicle's bus: frames with the times of their ends enter, a candump log leaves.

use std::path::{Path, PathBuf};

use holdover::time::Instant;

use crate::bus::Frame;
use crate::bus::candump::LogWriter;
use crate::draft::Draft;
use crate::error::Error;
use crate::sim::time::{EPOCH_US, micros};

/// A bus to log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candump {
    /// The log.
    pub file: PathBuf,
    /// Index of the vehicle whose bus it is.
    pub vehicle: usize,
}

impl Candump {
    /// Writes the frames, which have times of the run. The log has GNSS time.
    ///
    /// # Errors
    /// The log cannot be written.
    pub fn write(&self, frames: &[(f64, Frame)]) -> Result<(), Error> {
        let file: &Path = &self.file;
        let unwritable = |error: &std::io::Error| Error::unwritable(file, error);
        let Some(mut log) = LogWriter::new(Draft::of(file)?, "can0") else {
            return Err(Error::new("the interface has no name", "report this").in_file(file));
        };
        let instant = |at_s: f64| Instant::from_micros(EPOCH_US.saturating_add_signed(micros(at_s)));
        for (at_s, frame) in frames {
            log.write(instant(*at_s), frame).map_err(|error| unwritable(&error))?;
        }
        log.finish().map_err(|error| unwritable(&error))?.finish()
    }
}
