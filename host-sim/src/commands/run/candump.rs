//! The log of one vehicle's bus: frames with the times of their ends enter, a candump log leaves.

use std::io;
use std::path::PathBuf;

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

/// A log, as far as it is written.
pub struct CandumpFile {
    file: PathBuf,
    log: LogWriter<Draft>,
    /// The first failure. After it nothing more is written, and the run goes on.
    written: io::Result<()>,
}

impl Candump {
    /// Writes the frames, which have times of the run. The log has GNSS time.
    ///
    /// # Errors
    /// The log cannot be written.
    pub fn write(&self, frames: &[(f64, Frame)]) -> Result<(), Error> {
        let mut log = self.begin()?;
        log.note(frames);
        log.finish()
    }

    /// Begins the log, which is to be written while the run goes on.
    ///
    /// # Errors
    /// The log cannot be created.
    pub fn begin(&self) -> Result<CandumpFile, Error> {
        let Some(log) = LogWriter::new(Draft::of(&self.file)?, "can0") else {
            return Err(Error::new("the interface has no name", "report this").in_file(&self.file));
        };
        Ok(CandumpFile { file: self.file.clone(), log, written: Ok(()) })
    }
}

impl CandumpFile {
    /// Writes further frames.
    pub fn note(&mut self, frames: &[(f64, Frame)]) {
        let instant = |at_s: f64| Instant::from_micros(EPOCH_US.saturating_add_signed(micros(at_s)));
        if self.written.is_ok() {
            self.written = frames.iter().try_for_each(|(at_s, frame)| self.log.write(instant(*at_s), frame));
        }
    }

    /// Ends the log.
    ///
    /// # Errors
    /// A log that could not be written.
    pub fn finish(self) -> Result<(), Error> {
        let Self { file, log, written } = self;
        written.and_then(|()| log.finish()).map_err(|error| Error::unwritable(&file, &error))?.finish()
    }
}
